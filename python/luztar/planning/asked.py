"""The test that is asked for: every value looked at in the unit it was given in, and the work kept within bounds."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from .._arrays import number, whole_number
from ..errors import ParameterError
from ..model import Model
from .rehearse import Sensor, planning_rate_hz

# What is planned where nothing is said: a TB 038 test with an encoder of 0.02 degrees, or strokes of a ball screw.
USUAL: dict[str, dict[str, Any]] = {
    "rig": {"step": 0.02, "rate": 500.0, "speed": (5.0, 38.0), "reach": 50.0, "noise": 0.02},
    "axis": {"step": 1e-6, "rate": 1000.0, "speed": (0.04, 0.13), "reach": 0.24, "noise": 1.0},
}
MOST_RUNS, MOST_STROKES = 50, 400
# A look says nothing below six strokes.
LEAST_STROKES = 6
# A rehearsal of so many kept samples takes about ten seconds: two hours of a rig, a quarter of an hour of an axis.
MOST_SAMPLES = 1_000_000
# Rest and ramps of one stroke, on the average.
STROKE_REST_S = 0.9
# Beyond these the numbers are a slip of the pen. Degrees and degrees per second of a rig: a stroke counts from 5
# degrees of travel, nothing turns more than ten times to each side, a sensor coarser than the 1 degree that marks a
# reversal shows none, and no robot turns at 5000 degrees per second. Metres of an axis.
STEP = {"rig": (1e-6, 1.0), "axis": (1e-12, 1e-2)}
REACH = {"rig": (2.5, 3600.0), "axis": (1e-5, 100.0)}
SPEED = {"rig": (0.01, 5000.0), "axis": (1e-6, 100.0)}
RATE_HZ = (1.0, 1e7)
NOISE = (1e-12, 1e9)
FRICTION = (0.0, 1e9)
NOISE_TIME_S = (0.0, 1e3)
# The strokes of an axis are seen in at least as many steps of the sensor; those of a rig by the bounds above.
STEPS_IN_A_STROKE = 20.0
WORDS = {"rig": ("encoder_deg", "angle_deg", "deg", "deg/s"), "axis": ("step_m", "travel_m", "m", "m/s")}


@dataclass(frozen=True)
class Asked:
    """A test whose values make sense.

    Attributes
    ----------
    sensor : Sensor
    reach : float [deg or m]
        Strokes of a rig go beyond plus and minus it; those of an axis are as long.
    low, high : float [deg/s or m/s]
    speeds : tuple of float [deg/s or m/s]
    runs, strokes : int
    friction : float or None [Nm or N]
    """

    sensor: Sensor
    reach: float
    low: float
    high: float
    speeds: tuple[float, ...]
    runs: int
    strokes: int
    friction: float | None


def asked(
    model: Model,
    *,
    encoder_deg: float | None,
    step_m: float | None,
    rate_hz: float | None,
    speed: tuple[float, float] | None,
    speeds: Sequence[float],
    angle_deg: float | None,
    travel_m: float | None,
    runs: int,
    strokes: int,
    minutes: float | None,
    noise: float | None,
    noise_time_s: float,
    friction: float | None,
) -> Asked:
    """Return the test that is asked for; see :func:`luztar.plan`.

    Raises
    ------
    ParameterError
        Names the value that makes no test, in the unit it was given in.
    """
    name = model.structure_name
    usual = USUAL[name]
    step_word, reach_word, unit, speed_unit = WORDS[name]
    given = {"encoder_deg": encoder_deg, "step_m": step_m, "angle_deg": angle_deg, "travel_m": travel_m}
    for word, value in given.items():
        if value is not None and word not in (step_word, reach_word):
            there = step_word if word in ("encoder_deg", "step_m") else reach_word
            raise ParameterError(f"the structure '{name}' has no such value", word, f"Give {there} instead.")
    reach = _within(reach_word, given[reach_word], usual["reach"], REACH[name], unit)
    step = _within(step_word, given[step_word], usual["step"], STEP[name], unit)
    if name == "axis" and step * STEPS_IN_A_STROKE > reach:
        raise ParameterError(
            f"{step:g} m is too coarse for strokes of {reach:g} m", step_word, "Take a finer sensor or longer strokes."
        )
    low, high = _range(speed, usual["speed"], SPEED[name], speed_unit)
    ladder = tuple(_within("speeds", v, v, SPEED[name], speed_unit) for v in _listed(speeds))
    assert model.band_hz is not None
    rate = _within("rate_hz", rate_hz, usual["rate"], RATE_HZ, "Hz")
    if not model.band_hz < 0.45 * rate:
        raise ParameterError(
            f"{rate:g} Hz is too slow for a band of {model.band_hz:g} Hz",
            "rate_hz",
            f"Sample with more than {model.band_hz / 0.45:.0f} Hz.",
        )
    effort = model.structure.effort_unit
    sensor = Sensor(
        math.radians(step) if name == "rig" else step,
        planning_rate_hz(rate, model.band_hz),
        _within("noise", noise, usual["noise"], NOISE, effort),
        _within("noise_time_s", noise_time_s, noise_time_s, NOISE_TIME_S, "s"),
    )
    runs, strokes = whole_number("runs", runs, 1, MOST_RUNS), whole_number("strokes", strokes, 1, MOST_STROKES)
    travel = 2.0 * reach if name == "rig" else reach
    # A ladder is climbed from its beginning, two strokes each, however few the strokes.
    each = np.resize(np.repeat(ladder, 2), strokes) if ladder else np.geomspace(low, high, 16)
    stroke_s = travel * float((1.0 / each).mean()) + STROKE_REST_S
    if minutes is not None:
        most = MOST_SAMPLES / sensor.rate_hz / 60.0
        minutes = _within("minutes", minutes, minutes, (0.0, most), "min", above=True)
        strokes = max(1, round(60.0 * minutes / stroke_s / runs))
        if strokes > MOST_STROKES:
            raise ParameterError(
                f"{minutes:g} minutes are {strokes} strokes a run at these speeds",
                "minutes",
                f"Give more runs; at most {MOST_STROKES} strokes each.",
            )
    _enough(runs, strokes, "strokes" if minutes is None else "minutes")
    _bounded(runs, strokes, stroke_s, sensor.rate_hz, f"{travel:g} {unit}", "speeds" if ladder else "speed")
    level = None if friction is None else _within("friction", friction, friction, FRICTION, effort)
    return Asked(sensor, reach, low, high, ladder, runs, strokes, level)


def _within(
    name: str, value: Any, usual: float, bounds: tuple[float, float], unit: str, *, above: bool = False
) -> float:
    given = number(name, usual if value is None else value)
    low, high = bounds
    if math.isfinite(given) and low <= given <= high and not (above and given == low):
        return given
    words = f"above {low:g} and up to {high:g}" if above else f"from {low:g} to {high:g}"
    raise ParameterError(f"{given:g} {unit} makes no test", name, f"Give a number {words} {unit}.")


def _range(speed: Any, usual: tuple[float, float], bounds: tuple[float, float], unit: str) -> tuple[float, float]:
    pair = usual if speed is None else _listed(speed, "speed")
    if len(pair) != 2:
        raise ParameterError(f"{speed!r} is no range of speeds", "speed", "Give the slowest and the fastest.")
    low, high = (_within("speed", v, v, bounds, unit) for v in pair)
    if low > high:
        raise ParameterError(
            f"the slowest speed, {low:g} {unit}, is above the fastest, {high:g}", "speed", "Swap them."
        )
    return low, high


def _listed(speeds: Any, name: str = "speeds") -> tuple[Any, ...]:
    if isinstance(speeds, str) or not hasattr(speeds, "__iter__"):
        raise ParameterError(f"{speeds!r} is no list of speeds", name, "Give numbers in a tuple.")
    return tuple(speeds)


def _enough(runs: int, strokes: int, name: str) -> None:
    if runs * strokes < LEAST_STROKES:
        raise ParameterError(
            f"{runs * strokes} {'stroke' if runs * strokes == 1 else 'strokes'} in all make no test",
            name,
            f"Plan at least {LEAST_STROKES} strokes over all runs: below that nothing is said about an effect.",
        )


def _bounded(runs: int, strokes: int, stroke_s: float, rate_hz: float, travel: str, name: str) -> None:
    needed_s, most_s = runs * strokes * stroke_s, MOST_SAMPLES / rate_hz
    if needed_s > most_s:
        raise ParameterError(
            f"{runs * strokes} strokes of {travel} take {_time(needed_s)} at these speeds",
            name,
            f"Turn faster or less far, or plan fewer strokes: a test of up to {_time(most_s)} can be rehearsed.",
        )


def _time(seconds: float) -> str:
    return f"{seconds / 60.0:.0f} minutes" if seconds < 7200.0 else f"{seconds / 3600.0:.1f} hours"
