"""Zero phase for live use: late by a chosen time, wrong by no more than a known bound."""

from __future__ import annotations

from typing import Any

import numpy as np

from .. import _core
from .._arrays import number, refuse_not_finite, vector
from ..errors import ParameterError
from .design import Design


class FixedLag:
    """A zero-phase filter on a stream: every sample comes out ``delay_s`` late.

    The backward pass starts at the newest sample, as if the signal stayed there; by the time it reaches the sample that
    is due it has nearly forgotten that.

    Parameters
    ----------
    design : LowPass, HighPass, BandPass or BandStop
        With two passes.
    delay_s : float [s]
        From one sample to 2**24 samples; rounded to whole samples.

    Raises
    ------
    ParameterError
        A value outside its interval.

    Notes
    -----
    ``error_bound`` is the tail of the zero-phase impulse response beyond 63/64 of the delay. The error of any sample is
    at most that times the farthest the signal gets from its newest sample while the filter remembers; a signal that
    reaches it exists (``test_fixed_lag_keeps_and_reaches_its_bound``). The first outputs belong to the time before the
    stream, when the signal is taken to have been its first sample forever. Results do not depend on how the stream is
    cut, bit for bit.

    Examples
    --------
    >>> from luztar.signal import LowPass
    >>> live = FixedLag(LowPass(poles=4, cutoff_hz=6, sample_rate_hz=1000), delay_s=0.5)
    >>> live.delay_samples
    500
    >>> live.push([2.0, 2.0])
    array([2., 2.])
    """

    __slots__ = ("_core", "_delay", "_design")

    def __init__(self, design: Design, delay_s: float) -> None:
        if not isinstance(design, Design) or not design.zero_phase:
            raise ParameterError("design runs forward only", "design", "Design it with zero_phase=True.")
        samples = number("delay_s", delay_s) * design.sample_rate_hz
        if not 0.5 < samples <= 2**24:
            raise ParameterError(
                f"delay_s is {delay_s}, {samples:g} samples", "delay_s", f"Give from 1 to {2**24} samples."
            )
        self._design, self._delay = design, round(samples)
        self._core = _core.FixedLag(design._design(), self._delay)

    @property
    def design(self) -> Design:
        """The filter whose zero-phase result comes out late."""
        return self._design

    @property
    def delay_samples(self) -> int:
        """How late the output is [samples]."""
        return self._delay

    @property
    def delay_s(self) -> float:
        """How late the output is [s]."""
        return self._delay / self._design.sample_rate_hz

    @property
    def error_bound(self) -> float:
        """The largest error per unit that the signal moves away from its newest sample."""
        return self._core.error_bound

    def push(self, chunk: Any) -> np.ndarray:
        """Return as many results as there are samples, those of ``delay_s`` before.

        Parameters
        ----------
        chunk : array_like, shape (n,), any unit
            n >= 0, finite, of magnitude up to 1e150.

        Returns
        -------
        y : ndarray, shape (n,), float64, unit of chunk

        Raises
        ------
        ParameterError
            The chunk cannot be used; the memory is as it was.
        """
        x = vector("chunk", chunk, minimum=0, finite=False)
        y = np.empty_like(x)
        try:
            self._core.push_into(x, y)
        except ParameterError:
            refuse_not_finite("chunk", x)
            raise
        return y

    def reset(self, to: float | None = None) -> None:
        """Forget the past: settled at the level ``to``, or at the next sample if None."""
        self._core.reset(None if to is None else number("to", to))

    def copy(self) -> FixedLag:
        """Return an independent filter with the same memory."""
        twin = FixedLag.__new__(FixedLag)
        twin._design, twin._delay, twin._core = self._design, self._delay, self._core.copy()
        return twin

    __copy__ = copy

    def __deepcopy__(self, _memo: Any) -> FixedLag:
        return self.copy()

    def describe(self) -> str:
        """Return what the filter does and how wrong it can be, in words."""
        return (
            f"{self._design.describe()}; {self.delay_s:.4g} s late, within {self.error_bound:.2g} of what the signal "
            "moves after"
        )

    def __repr__(self) -> str:
        return f"<luztar.signal.FixedLag: {self.describe()}>"
