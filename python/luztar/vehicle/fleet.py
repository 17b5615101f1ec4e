"""Cars at the door of the core: one row of parameters, start, speed, duration per car."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from .. import _core
from .._arrays import number, refuse_not_finite
from ..errors import ParameterError
from .car import CAR_COLUMNS, CHANNELS, START_COLUMNS, SUMMARY_COLUMNS, Car, check_key
from .corridor import Corridor
from .signals import Pieces, Samples, signal

MODELS = ("single_track", "lateral_roll", "twelve")
STEERS = ("angle", "torque")


@dataclass(frozen=True)
class Fleet:
    """What is to be driven; rows of cars, starts and durations as the core takes them."""

    cars: np.ndarray
    many: bool
    starts: np.ndarray
    durations_s: np.ndarray
    speed: Pieces | Samples
    hand: Pieces | Samples
    steer: str
    model: str
    tyre: str
    step_s: float
    corridor: Corridor | None
    width: str

    @property
    def steps(self) -> int:
        """How many steps the longest run takes: the same as in the core."""
        return max(1, math.ceil(float(self.durations_s.max()) / self.step_s - 1e-6))

    def run(self, part: slice, *, every: int, summary: bool) -> np.ndarray:
        """Run some of the cars; return (cars, numbers of a summary) or (cars, channels, samples)."""
        cars = self.cars[part]
        nothing = np.empty(0)
        shape = (len(cars), len(SUMMARY_COLUMNS))
        if not summary:
            shape = (len(cars), len(CHANNELS), self.steps // every + 1)
        out = np.empty(math.prod(shape))
        _core.drive_cars(
            cars,
            self.starts[part],
            self.durations_s[part],
            self.speed.played(part),
            self.hand.played(part),
            None if self.corridor is None else self.corridor.laid_out(part),
            sections=0 if self.corridor is None else self.corridor.sections,
            steer=self.steer,
            model=self.model,
            tyre=self.tyre,
            step_s=self.step_s,
            every=every,
            width=self.width,
            summary=out if summary else nothing,
            traces=nothing if summary else out,
        )
        return out.reshape(shape)


def fleet(
    car: Car,
    *,
    handwheel_rad: Any,
    torque_nm: Any,
    speed_m_s: Any,
    duration_s: Any,
    step_s: Any,
    model: str,
    tyre: str | None,
    vary: Mapping[str, Any] | None,
    start: Mapping[str, Any] | None,
    corridor: Corridor | None,
    width: str,
) -> Fleet:
    """Return what is to be driven, every argument checked."""
    if not isinstance(car, Car):
        raise ParameterError(f"car is {type(car).__name__}", "car", "Give a luztar.vehicle.Car.")
    if (handwheel_rad is None) == (torque_nm is None):
        remedy = "Give handwheel_rad or torque_nm, one of the two."
        raise ParameterError("the driver gives an angle or a torque", "handwheel_rad", remedy)
    if model not in MODELS:
        raise ParameterError(f"there is no model {model!r}", "model", f"Known are: {', '.join(MODELS)}.")
    hand = signal("torque_nm", torque_nm) if handwheel_rad is None else signal("handwheel_rad", handwheel_rad)
    speed = signal("speed_m_s", speed_m_s)
    values = {key: _per_car(key, value) for key, value in (vary or {}).items()}
    for key in values:
        check_key(key)
    begins = {key: _per_car(key, value) for key, value in (start or {}).items()}
    for key in begins:
        if key not in START_COLUMNS:
            remedy = f"Known are: {', '.join(START_COLUMNS)}."
            raise ParameterError(f"a start has no '{key}'", "start", remedy)
    durations = _per_car("duration_s", duration_s)
    sizes = {key: a.size for key, a in {**values, **begins, "duration_s": durations}.items() if a.ndim == 1}
    for name, each in (("driver", hand), ("speed_m_s", speed), ("corridor", corridor)):
        if each is not None and each.cars is not None:
            sizes[name] = each.cars
    lanes = max(sizes.values(), default=1)
    for key, size in sizes.items():
        if size != lanes:
            raise ParameterError(f"{key} speaks of {size} cars, others of {lanes}", key, "Give one value per car.")
    rows = np.empty((lanes, len(CAR_COLUMNS)))
    for column, key in enumerate(CAR_COLUMNS):
        rows[:, column] = values[key] if key in values else car[key]
    starts = np.zeros((lanes, len(START_COLUMNS)))
    for key, value in begins.items():
        starts[:, START_COLUMNS.index(key)] = value
    step = number("step_s", step_s)
    if not (math.isfinite(step) and step > 0.0):
        raise ParameterError(f"step_s is {step}", "step_s", "Give a positive number of seconds.")
    return Fleet(
        cars=rows,
        many=bool(sizes),
        starts=starts,
        durations_s=np.array(np.broadcast_to(durations, lanes)),
        speed=speed,
        hand=hand,
        steer="torque" if handwheel_rad is None else "angle",
        model=model,
        tyre=tyre or car.tyre,
        step_s=step,
        corridor=corridor,
        width=width,
    )


def _per_car(key: str, value: Any) -> np.ndarray:
    try:
        array = np.asarray(value, dtype=np.float64)
    except (TypeError, ValueError):
        raise ParameterError(f"{key} is {value!r}", key, "Give a number, or one per car.") from None
    if array.ndim > 1 or array.size == 0:
        raise ParameterError(f"{key} has the shape {array.shape}", key, "Give a number, or one per car.")
    refuse_not_finite(key, np.atleast_1d(array))
    return array
