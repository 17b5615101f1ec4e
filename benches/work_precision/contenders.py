"""Who runs the trajectories, at which settings: every call returns the angle at the grid's instants."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass

import numpy as np

from luztar.dynamics import summarise

from . import mujoco_joint, numba_loops, scipy_events
from .problems import GRID_S, Problem

LANES = 256
# The lane that is the problem itself; the others differ in one parameter, from half to one and a half times its value.
OWN_LANE = 0
STEPS_S = (1e-2, 5e-3, 2e-3, 1e-3, 5e-4, 2e-4, 1e-4, 5e-5, 2e-5)
# Longer records of shorter steps say nothing new of loops that take seconds for them.
SHORTEST_SLOW_S = 1e-4
TOLERANCES = tuple(10.0**-k for k in range(3, 11))
# Between these instants the drive is a cubic with an error of 1e-11: finer samples cost memory and show nothing.
FINEST_SAMPLES_S = 1e-3
QUICK = 3


@dataclass(frozen=True)
class Entry:
    """One setting of one way: the call, and how many trajectories it runs."""

    way: str
    setting: str
    call: Callable[[], np.ndarray]
    trajectories: int = 1


def entries(p: Problem, *, quick: bool) -> Iterator[Entry]:
    """Yield every way at all of its settings; peers that are not installed are left out."""
    steps = STEPS_S[1::QUICK] if quick else STEPS_S
    tolerances = TOLERANCES[1::QUICK] if quick else TOLERANCES
    levels = p.parameters[p.varied] * np.linspace(0.5, 1.5, LANES)
    levels[OWN_LANE] = p.parameters[p.varied]
    for h in steps:
        for method in ("split", "moreau_jean"):
            yield Entry(f"luztar {method}, {LANES} lanes", f"{h:g} s", _batch(p, h, levels, method), LANES)
        yield Entry("luztar split, one alone", f"{h:g} s", _batch(p, h, levels[:1], "split"))
    for name, loop, shortest in (
        ("numba, the split step by hand", numba_loops.split_loop(), 0.0),
        ("numba, tanh and Runge-Kutta", numba_loops.smoothed_loop(), SHORTEST_SLOW_S),
    ):
        if loop is not None:
            for h in steps:
                if h >= shortest:
                    yield Entry(name, f"{h:g} s", _loop(p, h, levels, loop), LANES)
    for method in ("RK45", "DOP853", "LSODA"):
        for tolerance in tolerances:
            call = lambda m=method, e=tolerance: scipy_events.run(p, m, e)  # noqa: E731
            yield Entry(f"scipy {method} with events", f"{tolerance:.0e}", call)
    # MuJoCo's hinge has no gear with freeplay.
    if mujoco_joint.available() and not p.parameters.get("freeplay.gap_rad"):
        for tuned in (False, True):
            for h in steps:
                name = "MuJoCo, tuned solref" if tuned else "MuJoCo, defaults"
                yield Entry(name, f"{h:g} s", mujoco_joint.joint(p, h, tuned=tuned))


def _batch(p: Problem, step_s: float, levels: np.ndarray, method: str) -> Callable[[], np.ndarray]:
    interval = max(step_s, FINEST_SAMPLES_S)
    psi = p.handwheel_rad(interval)
    given = {**p.parameters, p.varied: levels}

    def run() -> np.ndarray:
        made = summarise(
            given,
            psi,
            sample_rate_hz=1.0 / interval,
            substeps=round(interval / step_s),
            start_rad=p.start_rad,
            method=method,
            keep="samples",
            times_s=p.times_s,
        )
        return made["sample_rad"][OWN_LANE]

    return run


def _loop(p: Problem, step_s: float, levels: np.ndarray, loop: Callable[..., None]) -> Callable[[], np.ndarray]:
    psi, given = numba_loops.half_steps(p, step_s), numba_loops.constants(p)
    out = np.empty((levels.size, p.times_s.size))

    def run() -> np.ndarray:
        loop(given, levels, p.start_rad, psi, step_s, round(GRID_S / step_s), out)
        return out[OWN_LANE]

    return run
