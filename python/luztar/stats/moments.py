"""Count, mean, deviations, shape and extremes of everything pushed so far."""

from __future__ import annotations

import math
from dataclasses import asdict, dataclass
from typing import Any, Literal

from .. import _core
from .._arrays import pair
from .._printed import Printed
from .._stream import Stream, same_kind
from ..errors import ParameterError


@dataclass(frozen=True)
class Description(Printed):
    """What a record holds, in the unit of the record.

    Attributes
    ----------
    count : int
        Samples in the figures; those skipped are not.
    mean, rms, min, max : float
    std_population : float
        Squared deviations divided by n (the standard deviation of TB 038).
    std_sample : float or None
        Squared deviations divided by n - 1; None for a single sample.
    skew, excess_kurtosis : float or None
        ``m3 / m2**1.5`` and ``m4 / m2**2 - 3`` with n as the divisor of the moments; None where nothing varies or the
        shape was not asked for.
    min_index, max_index : int
        Where the extremes were first met, from 0; skipped samples have their places.
    nan_count : int
        NaN that were skipped.
    clipped_count : int
        Samples at or beyond the limits of the converter, if limits were given.
    """

    count: int
    mean: float
    std_population: float
    std_sample: float | None
    rms: float
    min: float
    min_index: int
    max: float
    max_index: int
    skew: float | None = None
    excess_kurtosis: float | None = None
    nan_count: int = 0
    clipped_count: int = 0

    def to_dict(self) -> dict[str, Any]:
        """Return the fields as plain JSON values."""
        return asdict(self)

    def _rows(self) -> list[tuple[str, str]]:
        rows = [
            ("samples", f"{self.count}"),
            ("mean", f"{self.mean:.9g}"),
            ("std (n)", f"{self.std_population:.9g}"),
            ("rms", f"{self.rms:.9g}"),
            ("min", f"{self.min:.9g} at {self.min_index}"),
            ("max", f"{self.max:.9g} at {self.max_index}"),
        ]
        if self.skew is not None and self.excess_kurtosis is not None:
            rows += [("skew", f"{self.skew:.6g}"), ("excess kurtosis", f"{self.excess_kurtosis:.6g}")]
        rows += [("NaN skipped", f"{self.nan_count}")] * bool(self.nan_count)
        rows += [("clipped", f"{self.clipped_count}")] * bool(self.clipped_count)
        return rows


class Moments(Stream, _core.Moments):
    """Count, mean, spread, shape and extremes of everything pushed so far.

    Parameters
    ----------
    x : array_like, shape (n,), optional
        The first chunk.
    shape : bool
        Sum the third and fourth powers too, for ``skew`` and ``excess_kurtosis``; a third slower.
    nan : {"raise", "skip"}
        What to do with NaN: refuse the chunk and say where, or leave them out and count them. Infinities are refused
        in either case.
    clipped_at : (float, float), optional
        Samples at or below the first or at or above the second are counted as clipped (and still taken).

    Raises
    ------
    ParameterError
        Values that are not real, not finite or above 1e150 in magnitude (1e75 with ``shape``); nothing of a refused
        chunk is added.

    Notes
    -----
    ``push`` takes a float or an array. Samples are summed in blocks of 1024, each centred on its own mean and joined by
    the pairwise update [1]_ [2]_; the running mean keeps its rounding remainder. The figures are the same to the last
    bit however the stream was cut into chunks (``test_chunks_do_not_change_a_bit``), and on every instruction set. The
    standard deviation agrees with the exact rational answer to 14 digits on NumAcc1 to 4
    (``test_standard_deviation_has_fourteen_digits_of_the_exact_answer``). Merging equals pushing the joined record up
    to rounding (``test_merging_two_parts_is_pushing_both``); moments that lack the shape, or count clipping at other
    limits, are refused. Arrays of int16, int32 and float32 are taken as they are,
    without a converted copy. A push allocates nothing. One object serves one thread: a push while another is running
    raises ``RuntimeError``.

    References
    ----------
    .. [1] Chan, Golub, LeVeque, The American Statistician 37 (1983) 242.
    .. [2] Pébay, Sandia report SAND2008-6212 (2008).

    Examples
    --------
    >>> m = Moments([1.0, 2.0])
    >>> m.push([3.0])
    >>> m.mean, m.std_sample, m.max_index
    (2.0, 1.0, 2)
    """

    __slots__ = ()

    def __new__(  # noqa: D102
        cls,
        x: Any = None,
        *,
        shape: bool = False,
        nan: Literal["raise", "skip"] = "raise",
        clipped_at: tuple[float, float] | None = None,
    ) -> Moments:
        if nan not in ("raise", "skip"):
            raise ParameterError(f"nan is {nan!r}", "nan", 'Give "raise" or "skip".')
        low, high = (-math.inf, math.inf) if clipped_at is None else pair("clipped_at", clipped_at)
        if not low < high:
            raise ParameterError(f"clipped_at is {clipped_at}", "clipped_at", "Give the lower limit first.")
        made = super().__new__(cls, shape=bool(shape), skip_nan=nan == "skip", clipped_at=(low, high))
        if x is not None:
            made.push(x)
        return made

    def merge(self, other: Moments) -> None:
        """Add what another object has seen, as if it came after this one's samples."""
        same_kind(other, Moments)
        super().merge(other)

    def describe(self) -> Description:
        """Return everything at once.

        Raises
        ------
        ParameterError
            Nothing was pushed yet.
        """
        (count, nan, clipped), (mean, std, std_sample, rms), shape, extremes = self.figures()
        if mean is None or std is None or rms is None:
            what = f"all {nan} samples are NaN" if nan else "nothing was pushed yet"
            raise ParameterError(what, "Moments", "Push at least one sample.")
        return Description(count, mean, std, std_sample, rms, *extremes, *shape, nan, clipped)  # type: ignore[arg-type]

    def __repr__(self) -> str:
        return f"<luztar.stats.Moments: {self.count} samples, mean {self.mean}, std {self.std_population}>"


def describe(
    x: Any, *, nan: Literal["raise", "skip"] = "raise", clipped_at: tuple[float, float] | None = None
) -> Description:
    """Describe a record: count, mean, standard deviations, shape, rms, extremes and where they are.

    Parameters
    ----------
    x : array_like, shape (n,), any unit
        n >= 1, of magnitude up to 1e75.
    nan : {"raise", "skip"}
        Refuse NaN and say where, or leave them out and count them.
    clipped_at : (float, float), optional
        The converter's limits, in the unit of x: samples at or beyond them are counted.

    Returns
    -------
    Description
        Frozen, in the unit of x.

    Raises
    ------
    ParameterError
        Empty, not real or not finite.

    Examples
    --------
    >>> describe([3.0, 1.0, 2.0]).min_index
    1
    >>> describe([3.0, float("nan"), 5.0], nan="skip", clipped_at=(-5, 5)).to_dict()["clipped_count"]
    1
    """
    return Moments(x, shape=True, nan=nan, clipped_at=clipped_at).describe()
