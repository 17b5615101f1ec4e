"""A manoeuvre to be driven: a car, a track, a speed, a form of signal, a criterion."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

import numpy as np

from .._arrays import number
from ..errors import ParameterError
from ..vehicle import Car, Drive, Pieces, Samples, simulate, summarise
from .criterion import LATERAL_ACCELERATION_LIMIT_M_S2, Scores, score
from .form import Box, Form
from .track import Track, named
from .weights import Weights, weights_at

STEERS = ("angle", "torque")
# J_w of a drive agrees with a fifth of it to 1e-4 (tests/test_manoeuvre_criterion.py).
STEP_S = 0.005
# The gain is read off a small constant input after this time.
SETTLED_S = 6.0
SMALL = {"angle": 0.01, "torque": 0.1}
# What would keep a small input from turning the car; the paper's reference model has none of it.
NOMINAL = dict.fromkeys(
    (
        "freeplay.gap_rad",
        "coulomb.level_nm",
        "stiction.extra_nm",
        "stribeck.extra_nm",
        "handwheel.coulomb_nm",
        "handwheel.stiction_nm",
    ),
    0.0,
)


@dataclass(frozen=True)
class Manoeuvre:
    """A double lane change as a task for an optimiser.

    Parameters
    ----------
    car : Car
        Its width has to fit the track.
    track : Track
    speed_m_s : float, > 0
    form : Form
        Of the signal.
    steer : {"angle", "torque"}
        Whether the signal is the angle of the handwheel (kinematic) or a torque on it (dynamic).
    weights : Weights, optional
        Those of luztar's table at this speed where not given.
    limit_m_s2 : float, > 0
        Permissible lateral acceleration.
    model, tyre, step_s
        As :func:`luztar.vehicle.simulate` takes them.

    Raises
    ------
    ParameterError
        A car wider than a lane, a speed that is not positive or outside the table, an unknown word.
    """

    car: Car
    track: Track
    speed_m_s: float
    form: Form = Form()
    steer: str = "angle"
    weights: Weights | None = None
    limit_m_s2: float = LATERAL_ACCELERATION_LIMIT_M_S2
    model: str = "lateral_roll"
    tyre: str | None = None
    step_s: float = STEP_S

    def __post_init__(self) -> None:
        for key in ("speed_m_s", "limit_m_s2"):
            value = number(key, getattr(self, key))
            if not (math.isfinite(value) and value > 0.0):
                raise ParameterError(f"{key} is {value:g}", key, "Give a finite number above 0.")
            object.__setattr__(self, key, value)
        if self.steer not in STEERS:
            raise ParameterError(f"there is no steer {self.steer!r}", "steer", f"Known are: {', '.join(STEERS)}.")
        self.track.check_width(self.car["body.width_m"])
        if self.weights is None:
            object.__setattr__(self, "weights", weights_at(self.speed_m_s))

    @property
    def duration_s(self) -> float:
        """From the start to the end of the exit lane."""
        return self.track.exit_m[1] / self.speed_m_s

    @property
    def direction(self) -> float:
        """1 where the other lane lies to the left, -1 to the right."""
        return math.copysign(1.0, self.track.shift_m)

    @property
    def unit(self) -> str:
        """Of the signal."""
        return "rad" if self.steer == "angle" else "Nm"

    @cached_property
    def box(self) -> Box:
        """Where the parameters of the signal are searched."""
        small = SMALL[self.steer]
        key = "handwheel_rad" if self.steer == "angle" else "torque_nm"
        kept = summarise(
            self.car.with_(NOMINAL),
            speed_m_s=self.speed_m_s,
            duration_s=SETTLED_S,
            model=self.model,
            tyre=self.tyre,
            step_s=self.step_s,
            **{key: small},
        )
        gain = abs(float(kept["end_yaw_rate_rad_s"][0])) / small
        if not gain > 0.0:
            raise ParameterError(
                f"{self.car.name} does not turn at {self.speed_m_s:g} m/s", "car", "Give a car whose tyres steer it."
            )
        return Box(self.form, self.track, self.speed_m_s, gain)

    def signals(self, values: Any) -> Pieces:
        """Return the signals of parameter rows; see :meth:`Form.pieces`."""
        return self.form.pieces(values, self.direction)

    def scores(self, values: Any, vary: Mapping[str, Any] | None = None, *, speed_m_s: Any = None) -> Scores:
        """Return the criterion of signals given by their parameters.

        Parameters
        ----------
        values : array_like, shape (parameters,) or (cars, parameters)
            In the order of ``form.names``.
        vary : mapping of str to float or array_like, shape (cars,)
            Parameters of the car that differ.
        speed_m_s : array_like, shape (cars,), optional
            Speeds that differ from the task's, whose weights they keep.

        Raises
        ------
        ParameterError
            As :meth:`Form.pieces` and :func:`luztar.vehicle.summarise`.
        """
        return self.scores_of(self.signals(values), vary, speed_m_s=speed_m_s)

    def scores_of(
        self, signal: Pieces | Samples, vary: Mapping[str, Any] | None = None, *, speed_m_s: Any = None
    ) -> Scores:
        """Return the criterion of any signal, a measured trace among them."""
        weights = self.weights
        assert weights is not None  # set above
        run = self._run(signal)
        if speed_m_s is not None:
            run |= {"speed_m_s": speed_m_s, "duration_s": self.track.exit_m[1] / np.asarray(speed_m_s)}
        kept = summarise(corridor=self.track.corridor(), vary=vary, **run)
        return score(kept, weights, limit_m_s2=self.limit_m_s2, exit_m=self.track.exit_m[0])

    def drive(self, values: Any, vary: Mapping[str, Any] | None = None, *, every: int = 2) -> Drive:
        """Return whole traces of signals given by their parameters."""
        return simulate(every=every, vary=vary, **self._run(self.signals(values)))

    def drive_of(self, signal: Pieces | Samples, vary: Mapping[str, Any] | None = None, *, every: int = 2) -> Drive:
        """Return whole traces of any signal."""
        return simulate(every=every, vary=vary, **self._run(signal))

    def with_car(self, values: Mapping[str, float]) -> Manoeuvre:
        """Return the same task for a car with other values."""
        return replace(self, car=self.car.with_(values))

    def _run(self, signal: Pieces | Samples) -> dict[str, Any]:
        return {
            "car": self.car,
            "handwheel_rad" if self.steer == "angle" else "torque_nm": signal,
            "speed_m_s": self.speed_m_s,
            "duration_s": self.duration_s,
            "step_s": self.step_s,
            "model": self.model,
            "tyre": self.tyre,
            "start": {"y_m": self.track.start_y_m},
        }

    def to_dict(self) -> dict[str, Any]:
        """Return the task as plain JSON values."""
        weights = self.weights
        assert weights is not None  # set above
        return {
            "car": self.car.to_dict(),
            "track": self.track.to_dict(),
            "speed_m_s": self.speed_m_s,
            "form": self.form.name,
            "steer": self.steer,
            "weights": weights.to_dict(),
            "limit_m_s2": self.limit_m_s2,
            "model": self.model,
            "tyre": self.tyre or self.car.tyre,
            "step_s": self.step_s,
            "duration_s": self.duration_s,
        }

    def __str__(self) -> str:
        return (
            f"{self.track}\n{self.car.title} ({self.model}, tyres {self.tyre or self.car.tyre}) at {self.speed_m_s:g} "
            f"m/s, steered by {self.steer}, signal of the form {self.form.name}, a_y up to {self.limit_m_s2:g} m/s2"
        )


def manoeuvre(
    name: str,
    *,
    length_m: float | None = None,
    speed_m_s: float,
    car: Car | str = "bmw_320i",
    form: str = "two_sines",
    track: Mapping[str, Any] | None = None,
    vary: Mapping[str, float] | None = None,
    **options: Any,
) -> Manoeuvre:
    """Return a task by names.

    Parameters
    ----------
    name : {"avoiding", "overtaking", "iso_3888_1", "iso_3888_2"}
    length_m : float
        L of the paper's corridors; the others have their own.
    speed_m_s : float
    car : Car or str
        Or the name of a built-in one.
    form : str
        Of the signal; see :class:`Form`.
    track : mapping, optional
        Other arguments of the track, as :func:`avoiding` takes them.
    vary : mapping of str to float, optional
        Values of the car that differ (``freeplay.gap_rad`` ...).
    **options
        ``steer``, ``weights``, ``limit_m_s2``, ``model``, ``tyre``, ``step_s`` of :class:`Manoeuvre`.

    Raises
    ------
    ParameterError
        Names the argument.

    Examples
    --------
    >>> import luztar
    >>> task = luztar.manoeuvre.manoeuvre("avoiding", length_m=90.0, speed_m_s=20.0)
    >>> task.track.length_m, round(task.duration_s, 2)
    (90.0, 8.5)
    """
    chosen = Car.named(car) if isinstance(car, str) else car
    if not isinstance(chosen, Car):
        raise ParameterError(f"car is {type(car).__name__}", "car", "Give a luztar.vehicle.Car or a name.")
    chosen = chosen.with_(vary) if vary else chosen
    try:
        made = named(name, length_m=length_m, car_width_m=chosen["body.width_m"], **dict(track or {}))
    except TypeError as problem:
        raise ParameterError(f"{name} does not know this: {problem}", "track", "See its arguments.") from None
    return Manoeuvre(chosen, made, speed_m_s, Form(form), **options)
