"""Quantiles of streams: within a stated relative error, or exact where the data are whole numbers."""

from __future__ import annotations

from typing import Literal

from .. import _core
from .._arrays import number
from .._stream import Stream, same_kind
from ..errors import ParameterError


class QuantileSketch(Stream, _core.QuantileSketch):
    """Quantiles with a hard bound on their relative error, in memory that does not grow with the stream.

    Parameters
    ----------
    relative_error : float
        6.2e-5 to 0.25. What holds is the next power of two below (``.relative_error``).

    Notes
    -----
    ``quantile(q)`` is within the bound of the sample whose rank is exactly ``floor(q (n - 1))``
    (``test_sketch_is_within_its_bound_of_the_exact_rank``); magnitudes below 2.3e-308 count as zero. Merging adds
    counts: parts merged in any order are the sketch of the whole, exactly. Buckets are the leading bits of the number,
    so a push costs neither a logarithm nor a search; one that meets a magnitude outside 1e-9 to 1e9 for the first time
    may allocate. The guarantee is that of [1]_. Memory at 1 %: 0.16 MiB.

    References
    ----------
    .. [1] Masson, Rim, Lee, "DDSketch", Proc. VLDB Endowment 12 (2019) 2195.

    Examples
    --------
    >>> s = QuantileSketch(0.01)
    >>> s.push(range(1, 1001))
    >>> abs(s.quantile(0.5) - 500) <= 500 * s.relative_error
    True
    """

    __slots__ = ()

    def __new__(cls, relative_error: float = 0.01) -> QuantileSketch:  # noqa: D102
        return super().__new__(cls, number("relative_error", relative_error))

    def quantile(self, q: float) -> float | None:
        """Return the quantile of the share ``q``, 0 to 1, within the bound; None of nothing."""
        return super().quantile(number("q", q))

    def merge(self, other: QuantileSketch) -> None:
        """Add the samples another sketch has seen."""
        same_kind(other, QuantileSketch)
        super().merge(other)

    def __repr__(self) -> str:
        return f"<luztar.stats.QuantileSketch: {self.count} samples, within {100 * self.relative_error:.3g} %>"


class Counts(Stream, _core.Counts):
    """Every value of int16 or int32 data counted: quantiles, mean and deviation without any error.

    Notes
    -----
    Made for converter counts: int16 and int32 arrays are counted as they lie. Memory: 32 KiB for each page of 4096
    neighbouring values that occur, 8192 pages at most (twice the range of a 24-bit converter).

    Examples
    --------
    >>> c = Counts()
    >>> c.push([3, 1, 2, 2])
    >>> c.quantile(0.5), c.min, c.max, c.mean
    (2.0, 1, 3, 2.0)
    """

    __slots__ = ()

    def quantile(self, q: float, method: Literal["linear", "lower"] = "linear") -> float | None:
        """Return a quantile as NumPy defines it, exactly.

        Parameters
        ----------
        q : float
            0 to 1.
        method : {"linear", "lower"}
            Between the two neighbouring samples, or the lower of them.
        """
        if method not in ("linear", "lower"):
            raise ParameterError(f"method is {method!r}", "method", 'Give "linear" or "lower".')
        found = self.neighbours(number("q", q))
        if found is None:
            return None
        low, high, between = found
        return float(low if method == "lower" else low + (high - low) * between)

    def merge(self, other: Counts) -> None:
        """Add the samples another object has counted."""
        same_kind(other, Counts)
        super().merge(other)

    def __repr__(self) -> str:
        return f"<luztar.stats.Counts: {self.count} samples from {self.min} to {self.max}>"
