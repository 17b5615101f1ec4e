"""A trajectory by SciPy's solvers with events: forward, backward and stuck, each mode until its event.

As lean as it can be written: scalar right-hand sides with ``math``, springs in closed form, no scan of a body that
cannot break away.
"""

from __future__ import annotations

import math

import numpy as np
from scipy.integrate import solve_ivp
from scipy.optimize import brentq

from .problems import Problem

# A body at rest is looked at this often: the hand turns once in a second.
SCANS_PER_S = 50


def run(p: Problem, method: str, tolerance: float) -> np.ndarray:
    """Return the angle at the grid's instants."""
    get = p.parameters.get
    inertia, ratio = p.parameters["steering.inertia_kg_m2"], p.parameters["steering.ratio"]
    stiffness, half_gap = p.parameters["steering.stiffness_nm_per_rad"], 0.5 * get("freeplay.gap_rad", 0.0)
    mu, kinetic = get("viscous.coefficient_nm_s_per_rad", 0.0), get("coulomb.level_nm", 0.0)
    static = kinetic + get("stiction.extra_nm", 0.0)
    amplitude, w = p.amplitude_rad, p.frequency_rad_s

    def torque(t: float, phi: float) -> float:
        z = amplitude * math.sin(w * t) - ratio * phi
        wound = z - half_gap if z > half_gap else z + half_gap if z < -half_gap else 0.0
        return ratio * stiffness * wound

    times, end = p.times_s, p.seconds
    out = np.empty(times.size)
    t, phi, v, side = 0.0, p.start_rad, 0.0, 0
    while True:
        rest = times >= t
        if side == 0:
            grid = np.linspace(t, end, max(2, math.ceil((end - t) * SCANS_PER_S) + 1)) if amplitude else [t]
            out[rest] = phi
            broken = next((k for k, x in enumerate(grid) if abs(torque(x, phi)) > static), None)
            if broken is None:
                return out
            if broken > 0:
                beyond = lambda x, phi=phi: abs(torque(x, phi)) - static  # noqa: E731
                t = brentq(beyond, grid[broken - 1], grid[broken], xtol=1e-14, rtol=1e-14)
            side, v = (1 if torque(grid[broken], phi) > 0.0 else -1), 0.0
        dry = side * kinetic

        def rate(x: float, y: np.ndarray, dry: float = dry) -> tuple[float, float]:
            return y[1], (torque(x, y[0]) - dry - mu * y[1]) / inertia

        def stops(x: float, y: np.ndarray, side: int = side) -> float:
            return side * y[1]

        stops.terminal, stops.direction = True, -1.0  # type: ignore[attr-defined]
        # From an exact 0 the event would be found at once: a first instant by the series.
        first = 1e-9
        pull = rate(t, np.array([phi, v]))[1]
        begin = (phi + v * first + 0.5 * pull * first**2, v + pull * first)
        if side * begin[1] <= 0.0:
            side, v = 0, 0.0
            continue
        wanted = times[times > t + first]
        made = solve_ivp(
            rate,
            (t + first, end),
            begin,
            method=method,
            rtol=tolerance,
            atol=1e-2 * tolerance,
            t_eval=wanted,
            events=stops,
        )
        out[np.searchsorted(times, made.t)] = made.y[0] if made.t.size else ()
        if made.status != 1:
            return out
        t, phi = float(made.t_events[0][0]), float(made.y_events[0][0][0])
        pull = torque(t, phi)
        side, v = (0 if abs(pull) <= static else 1 if pull > 0.0 else -1), 0.0
