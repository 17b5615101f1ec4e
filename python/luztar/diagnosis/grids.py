"""Where the inner parameters of an effect are looked for, from what the runs can show."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from ..model.cards import Parameter
from .prepare import Prepared

# Points of a search grid. Speeds, travels and times are searched geometrically: a factor of 1.3 between points loses
# less than 1 % of the effect's power before the refinement.
_POINTS = {
    "speed": 14,
    "travel": 20,
    "time": 7,
    "rest": 6,
    "delay": 20,
    "place": 13,
    "width": 5,
    "reach": 8,
    "resolution": 7,
}
# A travel below this many steps of the position sensor is no travel to speak of.
SHOWN_STEPS = 2.5
# A break-away may be so much sharper than the sharpest of the grid.
SHARPEST = 30.0
# Searched in the logarithm.
_GEOMETRIC = ("speed", "travel", "time", "rest", "width", "resolution", "delay")
# A few values, taken as they are.
_DISCRETE = ("count", "shape")
# One value, given by the runs.
_GIVEN = ("waves_per_range",)


def word(parameter: Parameter) -> str:
    """Return how a parameter is searched; empty for one that is not inside the law."""
    return parameter.grid[0] if parameter.grid else ""


def is_geometric(parameter: Parameter) -> bool:
    """Whether a parameter is searched in the logarithm."""
    return word(parameter) in _GEOMETRIC


def is_continuous(parameter: Parameter) -> bool:
    """Whether a parameter is refined between the points of its grid."""
    return bool(parameter.grid) and word(parameter) not in (*_DISCRETE, *_GIVEN)


def is_sharpness(parameter: Parameter) -> bool:
    """Whether a parameter is the break-away that the position sensor cannot resolve."""
    return word(parameter) == "resolution"


def least_travel(runs: Sequence[Prepared]) -> float:
    """Return the smallest gap or break-away that a position sensor shows: a smaller one is a sharp break-away."""
    step = max(r.recording.resolution for r in runs)
    reach = max(r.recording.range for r in runs)
    return min(SHOWN_STEPS * step, 0.005 * reach)


def points(parameter: Parameter, runs: Sequence[Prepared]) -> np.ndarray:
    """Return the values at which an inner parameter is tried before it is refined."""
    kind, low, high = parameter.grid if parameter.grid else ("", 0.0, 0.0)
    span = max(r.recording.range for r in runs)
    step = max(r.recording.resolution for r in runs)
    count = _POINTS.get(kind, 0)
    match kind:
        case "speed":
            return np.geomspace(max(r.recording.slowest_speed for r in runs), 0.7 * _top_speed(runs), count)
        case "travel":
            return np.geomspace(least_travel(runs), high * span, count)
        case "resolution":
            return step * np.geomspace(0.03, 2.0, count)
        case "place":
            first = min(float(r.motion.min()) for r in runs)
            last = max(float(r.motion.max()) for r in runs)
            return np.linspace(first, last, count + 2)[1:-1]
        case "reach":
            return np.linspace(low, high, count) * max(float(np.abs(r.motion).max()) for r in runs)
        case "width":
            return np.geomspace(0.015, 0.1, count) * span
        case "time":
            return np.geomspace(2.0, max(4.0, max(r.duration_s for r in runs)), count)
        case "rest":
            # From a tenth of a second, shorter than a hand can pause, to ten times the usual rest.
            return np.geomspace(0.1, 5.0, count)
        case "delay":
            # From one sample of the record, by which channels may well be apart.
            sample_s = min(r.duration_s / len(r.recording) for r in runs)
            return np.geomspace(min(sample_s, 0.1 * parameter.high), parameter.high, count)
        case "count":
            return np.arange(parameter.low, parameter.high + 0.5)
        case "shape":
            return np.array([0.0, 1.0])
        case "waves_per_range":
            return np.array([2.0 * math.pi * high / span])
    raise AssertionError(f"no grid for {parameter.key}")


def limits(parameter: Parameter, runs: Sequence[Prepared]) -> tuple[float, float]:
    """Return the range in which an inner parameter is refined."""
    kind = word(parameter)
    if not is_continuous(parameter):
        return -math.inf, math.inf
    grid = points(parameter, runs)
    first, last = float(grid[0]), float(grid[-1])
    if kind == "travel":
        return first, parameter.high
    if kind == "resolution":
        # A gap opens with the first travel back, however small.
        return first / SHARPEST, last
    if kind in ("reach", "width"):
        # Beyond, the law is another effect's: a wide dead zone is an end stop, a spot as wide as the range any curve (a
        # blunt break-away is presliding).
        return first, last
    if is_geometric(parameter):
        # Beyond four times the grid the law is a simpler one (a constant, or nothing).
        return first / 4.0, min(parameter.high, 4.0 * last)
    return parameter.low, parameter.high


def _top_speed(runs: Sequence[Prepared]) -> float:
    return max(float(np.abs(r.speed).max()) for r in runs)
