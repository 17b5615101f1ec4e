"""A record with uneven time, read at even times so that a filter may run over it."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Literal

import numpy as np

from .. import _core
from .._arrays import number, vector
from ..errors import ParameterError


@dataclass(frozen=True)
class EvenRecord:
    """An even record made from an uneven one."""

    x: np.ndarray
    """The values, NaN inside the gaps."""
    start_s: float
    """The time of the first one [s]."""
    sample_rate_hz: float
    gaps_s: tuple[tuple[float, float], ...]
    """First and last time of each stretch without samples longer than allowed [s]."""

    @property
    def time_s(self) -> np.ndarray:
        """The times [s]."""
        return self.start_s + np.arange(self.x.size) / self.sample_rate_hz

    def to_dict(self) -> dict[str, Any]:
        """Return the record as plain JSON values, null inside the gaps."""
        return {
            "x": [None if np.isnan(v) else v for v in self.x.tolist()],
            "start_s": self.start_s,
            "sample_rate_hz": self.sample_rate_hz,
            "gaps_s": [list(gap) for gap in self.gaps_s],
        }


def resample(
    time_s: Any,
    x: Any,
    *,
    sample_rate_hz: float,
    max_gap_s: float = float("inf"),
    between: Literal["linear", "cubic"] = "linear",
) -> EvenRecord:
    """Read an uneven record at even times.

    Parameters
    ----------
    time_s : array_like, shape (n,) [s]
        Increasing, finite.
    x : array_like, shape (n,), any unit
    sample_rate_hz : float [Hz], > 0
        Of the result. Nothing is low-passed: give at least the densest rate of the record, filter, then decimate.
    max_gap_s : float [s], > 0
        Longer stretches without samples become NaN; filter with ``missing="split"``.
    between : {"linear", "cubic"}
        Straight lines, which never leave the range of the samples, or cubics with the slopes of the parabolas through
        neighbours, of third order.

    Returns
    -------
    EvenRecord

    Raises
    ------
    ParameterError
        Lengths that differ, not finite, time that does not increase.

    Examples
    --------
    >>> resample([0.0, 1.0, 3.0], [0.0, 1.0, 3.0], sample_rate_hz=1.0).x
    array([0., 1., 2., 3.])
    """
    if between not in ("linear", "cubic"):
        raise ParameterError(f"between is {between!r}", "between", "Give 'linear' or 'cubic'.")
    t, v = vector("time_s", time_s), vector("x", x)
    rate = number("sample_rate_hz", sample_rate_hz)
    made, gaps = _core.even(t, v, rate, number("max_gap_s", max_gap_s), between == "cubic")
    return EvenRecord(made, float(t[0]), rate, tuple(gaps))
