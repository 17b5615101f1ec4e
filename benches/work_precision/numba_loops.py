"""What one writes by hand with numba: the split step over all cores, and smoothed friction with Runge and Kutta."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

from .problems import Problem

# Friction is smoothed over speeds of this size: smaller ones creep less and need smaller steps.
SMOOTHING_RAD_S = 1e-2


def constants(p: Problem) -> tuple[float, ...]:
    """Return what the loops need: inertia, viscous, ratio, stiffness, half gap, static above kinetic friction."""
    get = p.parameters.get
    return (
        p.parameters["steering.inertia_kg_m2"],
        get("viscous.coefficient_nm_s_per_rad", 0.0),
        p.parameters["steering.ratio"],
        p.parameters["steering.stiffness_nm_per_rad"],
        0.5 * get("freeplay.gap_rad", 0.0),
        get("stiction.extra_nm", 0.0),
    )


def split_loop() -> Callable[..., None] | None:
    """Return the split step as a loop over lanes and steps, or None without numba.

    Called with (constants, levels, start, drive at every half step, step, steps per kept sample, out).
    """
    try:
        import numba
    except ImportError:
        return None

    @numba.njit(inline="always")
    def torque(psi: float, q: float, ratio: float, stiffness: float, gap: float) -> float:
        z = psi - ratio * q
        return ratio * stiffness * (z - min(max(z, -gap), gap))

    @numba.njit(parallel=True)
    def run(given: Any, levels: Any, start: float, psi: Any, h: float, every: int, out: Any) -> None:
        inertia, mu, p, stiffness, gap, extra = given
        k = h * mu / (2.0 * inertia)
        for lane in numba.prange(levels.size):
            kinetic, q, v = levels[lane], start, 0.0
            static = kinetic + extra
            out[lane, 0] = q
            for i in range(psi.size // 2):
                a, m, b = psi[2 * i], psi[2 * i + 1], psi[2 * i + 2]
                middle = q + h * v / 2.0
                s = (v > 0.0) - (v < 0.0)
                v1 = (v * (1.0 - k) + h * (torque(m, middle, p, stiffness, gap) - kinetic * s) / inertia) / (1.0 + k)
                if v1 * v > 0.0:
                    q, v = middle + h * v1 / 2.0, v1
                else:
                    share = v / (v - v1) if v != 0.0 else 0.0
                    q += share * h * v / 2.0
                    at = a + share * (4.0 * m - 3.0 * a - b + share * 2.0 * (a - 2.0 * m + b))
                    m0, m1 = torque(at, q, p, stiffness, gap), torque(b, q, p, stiffness, gap)
                    if abs(m0) > static:
                        stuck, way = 0.0, m0
                    elif abs(m1) > static:
                        stuck, way = (static - abs(m0)) / (abs(m1) - abs(m0)), m1
                    else:
                        stuck, way = 1.0, m1
                    left = (1.0 - share) * (1.0 - stuck) * h
                    mean = (m0 + (m1 - m0) * stuck + m1) / 2.0 - (kinetic if way > 0.0 else -kinetic)
                    v = left * mean / inertia / (1.0 + left * mu / (2.0 * inertia))
                    if v * way <= 0.0:
                        v = 0.0
                    q += left * v / 2.0
                if (i + 1) % every == 0:
                    out[lane, (i + 1) // every] = q

    return run


def smoothed_loop() -> Callable[..., None] | None:
    """Return Runge and Kutta's fourth order with ``tanh(v / vs)`` for the sign, over lanes; None without numba."""
    try:
        import numba
    except ImportError:
        return None
    import math

    @numba.njit(inline="always")
    def pull(psi: float, q: float, v: float, level: float, given: Any) -> float:
        inertia, mu, p, stiffness, gap, _ = given
        z = psi - p * q
        spring = p * stiffness * (z - min(max(z, -gap), gap))
        return (spring - mu * v - level * math.tanh(v / SMOOTHING_RAD_S)) / inertia

    @numba.njit(parallel=True)
    def run(given: Any, levels: Any, start: float, psi: Any, h: float, every: int, out: Any) -> None:
        for lane in numba.prange(levels.size):
            level, q, v = levels[lane], start, 0.0
            out[lane, 0] = q
            for i in range(psi.size // 2):
                a, m, b = psi[2 * i], psi[2 * i + 1], psi[2 * i + 2]
                k1 = pull(a, q, v, level, given)
                k2 = pull(m, q + h / 2 * v, v + h / 2 * k1, level, given)
                k3 = pull(m, q + h / 2 * (v + h / 2 * k1), v + h / 2 * k2, level, given)
                k4 = pull(b, q + h * (v + h / 2 * k2), v + h * k3, level, given)
                q += h * v + h * h / 6 * (k1 + k2 + k3)
                v += h / 6 * (k1 + 2 * k2 + 2 * k3 + k4)
                if (i + 1) % every == 0:
                    out[lane, (i + 1) // every] = q

    return run


def half_steps(p: Problem, step_s: float) -> np.ndarray:
    """Return the drive at every half step."""
    return p.handwheel_rad(0.5 * step_s)
