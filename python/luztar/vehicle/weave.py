"""The on-centre weave: where freeplay and friction of the steering show, in loops over the handwheel's angle."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from .._arrays import number
from ..errors import ParameterError
from .car import Car
from .drive import Drive
from .run_cars import simulate
from .signals import Pieces

# Periods before the one that counts.
SETTLING = 2
# Steps of the secant that finds the amplitude, and how near it must come.
SEARCH = 12
NEAR = 1e-3
# Share of the amplitude that counts as centre.
CENTRE = 0.2
FIGURES = (
    "sensitivity_m_s2_per_rad",
    "angle_hysteresis_rad",
    "acceleration_hysteresis_m_s2",
    "torque_hysteresis_nm",
    "torque_at_centre_nm",
    "acceleration_without_torque_m_s2",
    "delay_s",
)


@dataclass(frozen=True)
class Weave:
    """Figures of the last period of a weave, each of shape (cars,) or a number.

    A loop is cut at a level on its way up and on its way down; its width is the distance of the two cuts, its middle
    their mean.

    Attributes
    ----------
    handwheel_rad : ndarray or float
        Amplitude of the handwheel.
    sensitivity_m_s2_per_rad : ndarray or float
        Lateral acceleration per handwheel angle about the centre: slope of the line through both branches where the
        angle is below a fifth of its amplitude.
    angle_hysteresis_rad : ndarray or float
        Width of the loop in handwheel angle at no lateral acceleration.
    acceleration_hysteresis_m_s2 : ndarray or float
        Width in lateral acceleration at handwheel angle 0.
    torque_hysteresis_nm : ndarray or float
        Width of the loop of column torque at handwheel angle 0: what friction and damping hold.
    torque_at_centre_nm : ndarray or float
        Half the width of the loop of column torque at no lateral acceleration.
    acceleration_without_torque_m_s2 : ndarray or float
        Half the width of the loop of lateral acceleration at no column torque: what is left when the hand lets go.
    delay_s : ndarray or float
        By how much the lateral acceleration is late, first harmonic.
    drive : Drive
        The last period.
    """

    handwheel_rad: Any
    sensitivity_m_s2_per_rad: Any
    angle_hysteresis_rad: Any
    acceleration_hysteresis_m_s2: Any
    torque_hysteresis_nm: Any
    torque_at_centre_nm: Any
    acceleration_without_torque_m_s2: Any
    delay_s: Any
    drive: Drive

    def to_dict(self) -> dict[str, Any]:
        """Return the figures as plain JSON values, without the drive."""
        names = (name for name in self.__dataclass_fields__ if name != "drive")
        return {name: np.asarray(getattr(self, name)).tolist() for name in names}


def weave(
    car: Car,
    *,
    speed_m_s: Any = 100.0 / 3.6,
    lateral_acceleration_m_s2: float = 2.0,
    frequency_hz: float = 0.2,
    step_s: float = 0.0025,
    model: str = "lateral_roll",
    tyre: str | None = None,
    vary: Mapping[str, Any] | None = None,
) -> Weave:
    """Weave about the centre with a slow sine whose amplitude reaches a lateral acceleration.

    Of the kind of ISO 13674-1 (0.2 Hz, 100 km/h, 2 m/s2); its text was not at hand, the figures are defined in
    :class:`Weave`.

    Parameters
    ----------
    car : Car
    speed_m_s : float or array_like, shape (cars,)
    lateral_acceleration_m_s2 : float, > 0
        What the amplitude is chosen for, car by car.
    frequency_hz : float, > 0
    step_s, model, tyre, vary
        As :func:`simulate`.

    Raises
    ------
    ParameterError
        As :func:`simulate`; a lateral acceleration that no amplitude reaches.
    """
    wanted = number("lateral_acceleration_m_s2", lateral_acceleration_m_s2)
    frequency = number("frequency_hz", frequency_hz)
    for name, value in (("lateral_acceleration_m_s2", wanted), ("frequency_hz", frequency)):
        if not value > 0.0:
            raise ParameterError(f"{name} is {value}", name, "Give a positive number.")
    steps = int(np.ceil(1.0 / (frequency * number("step_s", step_s))))

    def driven(amplitude: Any) -> Drive:
        return simulate(
            car,
            handwheel_rad=Pieces(
                start_s=[0.0], amplitude=np.asarray(amplitude)[..., np.newaxis], frequency_hz=frequency
            ),
            speed_m_s=speed_m_s,
            duration_s=(SETTLING + 1) / frequency,
            step_s=1.0 / (frequency * steps),
            model=model,
            tyre=tyre,
            vary=vary,
        )

    def reached(run: Drive) -> np.ndarray:
        return np.abs(run.lateral_acceleration_m_s2[..., -steps - 1 :]).max(axis=-1)

    # Beyond its gap the answer is nearly a line: a secant from half and from twice a first guess.
    low = np.asarray(wanted / 50.0)
    run = driven(low)
    at_low = reached(run)
    high = 2.0 * low * np.maximum(wanted / np.maximum(at_low, 0.1 * wanted), 0.5)
    amplitude = high
    for _ in range(SEARCH):
        run = driven(amplitude)
        found = reached(run)
        if np.all(np.abs(found - wanted) <= NEAR * wanted):
            break
        slope = (found - at_low) / np.where(amplitude == low, 1.0, amplitude - low)
        low, at_low = amplitude, found
        amplitude = np.maximum(amplitude + (wanted - found) / np.where(slope > 0.0, slope, np.inf), 0.1 * amplitude)
    else:
        raise ParameterError(
            f"the lateral acceleration of {wanted} m/s2 is not reached", "lateral_acceleration_m_s2", "Ask for less."
        )
    last = slice(-steps - 1, None)
    period = Drive(run.time_s[last], **{n: getattr(run, n)[..., last] for n in _channels()})
    figures = weave_figures(
        period.handwheel_rad, period.lateral_acceleration_m_s2, period.column_torque_nm, 1.0 / frequency
    )
    return Weave(handwheel_rad=amplitude, **figures, drive=period)


def _channels() -> list[str]:
    return [name for name in Drive.__dataclass_fields__ if name != "time_s"]


def weave_figures(angle: np.ndarray, side: np.ndarray, torque: np.ndarray, period_s: float) -> dict[str, Any]:
    """Return the figures of closed loops of one period (n,) or (cars, n), first and last sample alike."""
    rows = [np.atleast_2d(c) for c in (angle, side, torque)]
    told: dict[str, list[float]] = {name: [] for name in FIGURES}
    for psi, a, t in zip(*rows, strict=True):
        wave = np.exp(-2j * np.pi * np.arange(psi.size - 1) / (psi.size - 1))
        late = -np.angle((a[:-1] @ wave) / (psi[:-1] @ wave))
        values = (
            slope(psi, a),
            width(psi, a),
            width(a, psi),
            width(t, psi),
            0.5 * width(t, a),
            0.5 * width(a, t),
            late * period_s / (2.0 * np.pi),
        )
        for name, value in zip(FIGURES, values, strict=True):
            told[name].append(value)
    arrays = {name: np.array(values) for name, values in told.items()}
    return arrays if angle.ndim == 2 else {name: float(values[0]) for name, values in arrays.items()}


def slope(angle: np.ndarray, of: np.ndarray) -> float:
    """Return the slope of the two branches of a loop about the centre, each with its own middle."""
    near = np.abs(angle) <= CENTRE * np.abs(angle).max()
    up = np.gradient(angle) > 0.0
    products = squares = 0.0
    for branch in (near & up, near & ~up):
        if branch.any():
            x = angle[branch] - angle[branch].mean()
            products += float(x @ of[branch])
            squares += float(x @ x)
    return products / squares if squares > 0.0 else float("nan")


def width(of: np.ndarray, over: np.ndarray) -> float:
    """Return the distance of the two values of a loop where the other channel is 0; NaN where it is never."""
    cuts = []
    for k in _crossings(over):
        share = over[k] / (over[k] - over[k + 1])
        cuts.append(of[k] + share * (of[k + 1] - of[k]))
    return float(max(cuts) - min(cuts)) if len(cuts) > 1 else float("nan")


def _crossings(values: np.ndarray) -> np.ndarray:
    """Return the indices before a change of sign; a stretch of exact zeros counts at both of its ends."""
    here, there = values[:-1], values[1:]
    return np.flatnonzero(((here <= 0.0) & (there > 0.0)) | ((here >= 0.0) & (there < 0.0)))
