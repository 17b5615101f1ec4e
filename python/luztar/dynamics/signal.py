"""Drives that are known at every instant: piecewise cubics and sums of sinusoids."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from .. import _core
from .._arrays import number, refuse_not_finite, rows, vector
from ..errors import ParameterError

# (breaks, coefficients, sines), as the core takes a signal.
Parts = tuple[np.ndarray, np.ndarray, np.ndarray]


def _none() -> np.ndarray:
    return np.empty((0, 3))


@dataclass(frozen=True, eq=False)
class Signal:
    """A drive known at every instant: cubics between breaks, and sinusoids, added.

    Attributes
    ----------
    breaks_s : ndarray, shape (m,), m >= 1
        Where each cubic begins, increasing. The first holds before its break too, the last for ever.
    coefficients : ndarray, shape (m, 4)
        Of 1, tau, tau^2, tau^3, with tau the seconds since the cubic's break.
    sines : ndarray, shape (k, 3)
        Amplitude, circular frequency (rad/s, >= 0) and phase (rad) of each ``a sin(w t + phase)``.
    end_s : float
        The last instant at which the drive is known; infinite unless it was sampled.
    """

    breaks_s: np.ndarray
    coefficients: np.ndarray
    sines: np.ndarray = field(default_factory=_none)
    end_s: float = math.inf

    @classmethod
    def polynomial(cls, *coefficients: float) -> Signal:
        """Return ``c0 + c1 t + c2 t^2 + c3 t^3``: a constant, a ramp, at most a cubic."""
        if len(coefficients) > 4:
            raise ParameterError(f"{len(coefficients)} coefficients", "coefficients", "Give at most four.")
        row = [number("coefficients", c) for c in coefficients] + [0.0] * (4 - len(coefficients))
        return cls(np.zeros(1), np.array([row]))

    @classmethod
    def sine(cls, amplitude: float, frequency_rad_s: float, phase_rad: float = 0.0) -> Signal:
        """Return ``amplitude * sin(frequency_rad_s * t + phase_rad)``; several are added with ``+``."""
        given = {"amplitude": amplitude, "frequency_rad_s": frequency_rad_s, "phase_rad": phase_rad}
        row = [number(name, value) for name, value in given.items()]
        return cls(np.zeros(1), np.zeros((1, 4)), np.array([row]))

    @classmethod
    def samples(cls, values: Any, sample_rate_hz: float) -> Signal:
        """Return even samples from the time 0 on, joined by the cubics that :func:`simulate` runs along.

        Raises
        ------
        ParameterError
            Fewer than two samples, NaN, a rate that is not positive.
        """
        array = vector("values", values, minimum=2)
        rate = number("sample_rate_hz", sample_rate_hz)
        cubics = _core.sampled_cubics(array, rate)
        return cls(np.arange(array.size - 1) / rate, cubics, end_s=(array.size - 1) / rate)

    @classmethod
    def cubics(cls, breaks_s: Any, coefficients: Any) -> Signal:
        """Return piecewise cubics of one's own; :class:`scipy.interpolate.PPoly` has its coefficients in reverse."""
        return cls(vector("breaks_s", breaks_s), rows("coefficients", coefficients, 4))

    def __call__(self, time_s: Any) -> np.ndarray:
        """Return the drive at some instants, in an array of their shape."""
        t = np.asarray(time_s, dtype=np.float64)
        piece = np.maximum(np.searchsorted(self.breaks_s, t, side="right") - 1, 0)
        tau, c = t - self.breaks_s[piece], self.coefficients[piece]
        out = c[..., 0] + tau * (c[..., 1] + tau * (c[..., 2] + tau * c[..., 3]))
        for amplitude, w, phase in self.sines:
            out = out + amplitude * np.sin(w * t + phase)
        return out

    def __add__(self, other: Signal) -> Signal:
        """Return the sum of two drives."""
        breaks = np.union1d(self.breaks_s, other.breaks_s)
        total = self._moved(breaks) + other._moved(breaks)
        sines = np.vstack((self.sines, other.sines))
        return Signal(breaks, total, sines, min(self.end_s, other.end_s))

    def __mul__(self, factor: float) -> Signal:
        """Return a multiple of the drive."""
        f = number("factor", factor)
        return Signal(self.breaks_s, f * self.coefficients, self.sines * np.array([f, 1.0, 1.0]), self.end_s)

    __rmul__ = __mul__

    def _moved(self, breaks_s: np.ndarray) -> np.ndarray:
        """Return the coefficients of the same cubics, counted from other breaks."""
        piece = np.maximum(np.searchsorted(self.breaks_s, breaks_s, side="right") - 1, 0)
        d, (a, b, c, e) = breaks_s - self.breaks_s[piece], self.coefficients[piece].T
        moved = (a + d * (b + d * (c + d * e)), b + d * (2.0 * c + 3.0 * d * e), c + 3.0 * d * e, e)
        return np.column_stack(moved)

    def parts(self, name: str) -> Parts:
        """Return the drive as the core takes it.

        Raises
        ------
        ParameterError
            Arrays of the wrong shape, or NaN, with ``name`` as the place.
        """
        breaks = vector(f"{name}.breaks_s", self.breaks_s)
        cubics = rows(f"{name}.coefficients", self.coefficients, 4)
        sines = rows(f"{name}.sines", self.sines, 3)
        refuse_not_finite(f"{name}.coefficients", cubics)
        refuse_not_finite(f"{name}.sines", sines)
        return breaks, cubics, sines


def drive(name: str, value: Signal | float, times_s: Sequence[float] | np.ndarray) -> Parts:
    """Return a signal or a constant as the core takes it, known at all the times.

    Raises
    ------
    ParameterError
        Neither a signal nor a number, or samples that end before the last time.
    """
    made = value if isinstance(value, Signal) else Signal.polynomial(number(name, value))
    if len(times_s) and times_s[-1] > made.end_s:
        raise ParameterError(
            f"{name} is known until {made.end_s:g} s, the last time is {times_s[-1]:g} s",
            name,
            "Ask for times within the samples.",
        )
    return made.parts(name)
