"""Tests that a workshop can do, each with its motion and in its own words."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, field

import numpy as np

from .motion import drawn_speeds, path, strokes

DEG = math.pi / 180.0
# Every trial is judged by this many runs, each turned differently; its minutes are those of one.
SEEDS = (1, 2)


@dataclass(frozen=True)
class Trial:
    """One test that could be done.

    Attributes
    ----------
    name : str
    text : str
        What to do, in the words of the workshop.
    make : callable
        (seconds between samples, seed) to the positions of one run, in the motion's unit.
    """

    name: str
    text: str
    make: Callable[[float, int], np.ndarray] = field(repr=False)


def _turned(
    low: float,
    high: float,
    speeds: tuple[float, float] | None,
    count: int,
    *,
    ladder: tuple[float, ...] = (),
    rests_s: tuple[float, ...] = (0.4, 0.8, 0.5),
    overshoot: float = 0.0,
    creep: tuple[float, float] | None = None,
) -> Callable[[float, int], np.ndarray]:
    """Return a motion of ``count`` strokes: speeds drawn from a range, or a ladder of speeds, two strokes each."""

    def make(step_s: float, seed: int) -> np.ndarray:
        rng = np.random.default_rng(seed)
        if speeds is not None:
            each = drawn_speeds(*speeds, count, rng).tolist()
        else:
            each = np.resize(np.repeat(ladder, 2), count).tolist()
        start, moves = strokes(low, high, each, rng, rests_s=rests_s, overshoot=overshoot, creep=creep)
        return path(start, moves, step_s, rng)

    return make


def as_planned(
    amplitude: float,
    speeds: tuple[float, float],
    count: int,
    overshoot: float | None = None,
    ladder: tuple[float, ...] = (),
) -> Callable[[float, int], np.ndarray]:
    """Return the motion of plain strokes beyond plus and minus an amplitude.

    Parameters
    ----------
    amplitude : float
        Every stroke starts and ends beyond it, in the motion's unit.
    speeds : tuple of float
        Slowest and fastest speed.
    count : int
        Strokes in a run.
    overshoot : float, optional
        By how much strokes go beyond; 15 % where not given.
    ladder : tuple of float
        Even speeds in place of the range, two strokes each.
    """
    beyond = 0.15 * amplitude if overshoot is None else overshoot
    return _turned(-amplitude, amplitude, None if ladder else speeds, count, ladder=ladder, overshoot=beyond)


def rig_trials() -> tuple[Trial, ...]:
    """Return the tests of a friction rig or a steering robot turned by hand."""
    window = 50.0 * DEG
    usual = (5.0 * DEG, 38.0 * DEG)
    return (
        Trial(
            "wide",
            "Turn from beyond -180 to beyond +180 degrees and back, slowly (10 to 60 degrees per second), six strokes "
            "a run: more than one whole turn",
            _turned(-185.0 * DEG, 185.0 * DEG, (10.0 * DEG, 60.0 * DEG), 6, overshoot=10.0 * DEG),
        ),
        Trial(
            "very_wide",
            "Turn three whole turns from beyond -540 to beyond +540 degrees and back (30 to 120 degrees per second), "
            "six strokes a run",
            _turned(-545.0 * DEG, 545.0 * DEG, (30.0 * DEG, 120.0 * DEG), 6, overshoot=15.0 * DEG),
        ),
        Trial(
            "slow_breakaway",
            "Turn the usual strokes, but begin each with a slow break-away: about 1 degree per second over the first 2 "
            "degrees, then on at the usual speed, eight strokes a run",
            _turned(-window, window, usual, 8, overshoot=8.0 * DEG, creep=(1.0 * DEG, 2.0 * DEG)),
        ),
        Trial(
            "speed_ladder",
            "Turn the same strokes at three even speeds, two strokes at each: near 3, near 12 and near 40 degrees per "
            "second",
            _turned(-window, window, None, 6, ladder=(3.0 * DEG, 12.0 * DEG, 40.0 * DEG), overshoot=8.0 * DEG),
        ),
        Trial(
            "dwell_ladder",
            "Turn the usual strokes and rest before each for a different time: a quarter, half, one, two and four "
            "seconds, ten strokes a run, each begun slowly",
            _turned(
                -window,
                window,
                (10.0 * DEG, 38.0 * DEG),
                10,
                rests_s=(0.25, 0.5, 1.0, 2.0, 4.0),
                overshoot=8.0 * DEG,
                creep=(1.0 * DEG, 2.0 * DEG),
            ),
        ),
        Trial(
            "small_reversals",
            "Rock the wheel by about 5 degrees to either side of one angle, as slowly as the hand allows (3 to 15 "
            "degrees per second), twenty times",
            _turned(-4.0 * DEG, 4.0 * DEG, (3.0 * DEG, 15.0 * DEG), 20, overshoot=2.0 * DEG),
        ),
        Trial(
            "longer",
            "Record the usual strokes for longer: sixteen strokes a run of different speed, 5 to 38 degrees per second",
            _turned(-window, window, usual, 16, overshoot=8.0 * DEG),
        ),
    )


def axis_trials(low: float, high: float, top_speed: float) -> tuple[Trial, ...]:
    """Return the tests of a driven axis.

    Parameters
    ----------
    low, high : float [m]
        The range it has been moved over.
    top_speed : float [m/s]
        The fastest it has been moved.
    """
    span, middle = high - low, 0.5 * (low + high)
    short = 0.04 * span
    usual = (0.3 * top_speed, top_speed)
    creep = (0.01 * top_speed, 0.005 * span)
    return (
        Trial(
            "slow_breakaway",
            "Move over the same range, but begin each stroke with a slow break-away: at a hundredth of the top speed "
            "over the first half per cent of the range, eight strokes a run",
            _turned(low, high, usual, 8, creep=creep),
        ),
        Trial(
            "speed_ladder",
            "Move over the same range at three even speeds, two strokes at each: a twentieth, a quarter and the whole "
            "of the top speed",
            _turned(low, high, None, 6, ladder=(0.05 * top_speed, 0.25 * top_speed, top_speed)),
        ),
        Trial(
            "dwell_ladder",
            "Move over the same range and rest before each stroke for a different time: a quarter, half, one, two and "
            "four seconds, ten strokes a run, each begun slowly",
            _turned(low, high, usual, 10, rests_s=(0.25, 0.5, 1.0, 2.0, 4.0), creep=creep),
        ),
        Trial(
            "small_reversals",
            "Move back and forth by a twelfth of the range about one place, slowly, twenty times",
            _turned(middle - short, middle + short, (0.05 * top_speed, 0.25 * top_speed), 20),
        ),
        Trial(
            "longer",
            "Record the usual strokes over the whole range for longer: sixteen strokes a run of different speed",
            _turned(low, high, usual, 16),
        ),
    )
