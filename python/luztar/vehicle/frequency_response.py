"""The frequency response: a continuous sine at the handwheel, frequency by frequency, all of them side by side."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from .._arrays import number, vector
from ..errors import ParameterError
from .car import Car
from .run_cars import simulate
from .signals import Pieces

# Periods that pass before the ones that count, at least; and seconds, for what dies away in time and not in periods.
SETTLING_PERIODS = 3
SETTLING_S = 6.0
# Periods that count, and steps in each at least.
PERIODS = 2
STEPS = 400


@dataclass(frozen=True)
class FrequencyResponse:
    """Response per handwheel angle, first harmonic.

    Attributes
    ----------
    frequency_hz : ndarray, shape (n,)
    yaw_rate_per_s, lateral_acceleration_m_s2_per_rad, roll_rad_per_rad, column_torque_nm_per_rad : ndarray of complex
        Size is the gain, argument the phase (negative: late), shape (n,).
    """

    frequency_hz: np.ndarray
    yaw_rate_per_s: np.ndarray
    lateral_acceleration_m_s2_per_rad: np.ndarray
    roll_rad_per_rad: np.ndarray
    column_torque_nm_per_rad: np.ndarray

    def delay_s(self, channel: str) -> np.ndarray:
        """Return by how much a channel is late, from its phase unwrapped from the lowest frequency."""
        return -np.unwrap(np.angle(getattr(self, channel))) / (2.0 * np.pi * self.frequency_hz)

    def to_dict(self) -> dict[str, Any]:
        """Return gains and phases as plain JSON values."""
        told: dict[str, Any] = {"frequency_hz": self.frequency_hz.tolist()}
        for name in (
            "yaw_rate_per_s",
            "lateral_acceleration_m_s2_per_rad",
            "roll_rad_per_rad",
            "column_torque_nm_per_rad",
        ):
            value = getattr(self, name)
            told[name] = {"gain": np.abs(value).tolist(), "phase_rad": np.angle(value).tolist()}
        return told


def frequency_response(
    car: Car,
    *,
    speed_m_s: float,
    handwheel_rad: float,
    frequency_hz: Any,
    step_s: float = 0.0025,
    model: str = "lateral_roll",
    tyre: str | None = None,
    vary: Mapping[str, float] | None = None,
) -> FrequencyResponse:
    """Move the handwheel along a sine of each frequency and keep the first harmonic of what follows.

    Of the kind of the continuous sine of ISO 7401; its text was not at hand. Freeplay and dry friction make the answer
    depend on the amplitude.

    Parameters
    ----------
    car : Car
    speed_m_s : float
    handwheel_rad : float
        Amplitude.
    frequency_hz : array_like, shape (n,), > 0
    step_s : float
        The longest step; a quick sine takes shorter ones, 400 a period.
    model, tyre, vary
        As :func:`simulate`, one value each.

    Raises
    ------
    ParameterError
        As :func:`simulate`; an amplitude of 0, a frequency that is not positive.
    """
    angle, frequencies = number("handwheel_rad", handwheel_rad), vector("frequency_hz", frequency_hz)
    if angle == 0.0:
        raise ParameterError("handwheel_rad is 0", "handwheel_rad", "Give an amplitude.")
    if not np.all(frequencies > 0.0):
        raise ParameterError("frequency_hz holds values that are not positive", "frequency_hz", "Give Hz above 0.")
    longest = number("step_s", step_s)
    columns: dict[str, list[complex]] = {}
    for frequency in frequencies:
        # A whole number of steps a period: the first harmonic is then an exact sum.
        steps = max(STEPS, int(np.ceil(1.0 / (frequency * longest))))
        settle = max(SETTLING_PERIODS, int(np.ceil(SETTLING_S * frequency)))
        run = simulate(
            car,
            handwheel_rad=Pieces(start_s=[0.0], amplitude=angle, frequency_hz=frequency),
            speed_m_s=speed_m_s,
            duration_s=(settle + PERIODS) / frequency,
            step_s=1.0 / (frequency * steps),
            model=model,
            tyre=tyre,
            vary=vary,
        )
        last = slice(settle * steps, (settle + PERIODS) * steps)
        wave = np.exp(-2j * np.pi * np.arange(PERIODS * steps) / steps)
        sent = run.handwheel_rad[last] @ wave
        for name in ("yaw_rate_rad_s", "lateral_acceleration_m_s2", "roll_rad", "column_torque_nm"):
            columns.setdefault(name, []).append(complex(getattr(run, name)[last] @ wave / sent))
    return FrequencyResponse(frequencies, *(np.array(values) for values in columns.values()))
