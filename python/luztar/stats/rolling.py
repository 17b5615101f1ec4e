"""Statistics of the last samples, exact: an outlier leaves no trace when it leaves the window."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from .. import _core
from .._arrays import vector, whole_number
from .._stream import Stream
from ..errors import ParameterError

_LONGEST = 10_000_000


class Rolling(Stream, _core.Rolling):
    """Mean, standard deviation, minimum and maximum of the last ``window`` samples.

    Parameters
    ----------
    window : int
        Samples, 1 to 10,000,000; four times 8 bytes of memory for the sums and two times 8 for the samples of each.

    Notes
    -----
    Nothing is ever subtracted from a sum. The stream is cut into segments as long as the window; every window is the
    end of one segment, pooled once from its back, and the start of the next [1]_. The figures depend on the samples in
    the window alone (``test_an_outlier_leaves_no_trace``). Three joins a sample on average; the sample that completes a
    segment pays for ``window`` of them at once. Until the window is full the figures are of what there is.

    References
    ----------
    .. [1] van Herk, Pattern Recognition Letters 13 (1992) 517, there for extremes.

    Examples
    --------
    >>> r = Rolling(2)
    >>> r.push([1e9, 3.0, 5.0])
    >>> r.mean, r.std_population, r.max
    (4.0, 1.0, 5.0)
    """

    __slots__ = ()

    def __new__(cls, window: int = 1) -> Rolling:  # noqa: D102
        return super().__new__(cls, whole_number("window", window, 1, _LONGEST))

    def __repr__(self) -> str:
        return f"<luztar.stats.Rolling: {self.count} of {self.window} samples, mean {self.mean}>"


@dataclass(frozen=True)
class RollingFigures:
    """The figures of every full window of a record.

    Attributes
    ----------
    mean, std_population, min, max : ndarray, shape (n - window + 1,)
        Entry i belongs to the samples i to i + window - 1.
    window : int
    """

    mean: np.ndarray
    std_population: np.ndarray
    min: np.ndarray
    max: np.ndarray
    window: int

    def to_dict(self) -> dict[str, Any]:
        """Return the figures as plain JSON values."""
        names = ("mean", "std_population", "min", "max")
        return {"window": self.window, **{name: getattr(self, name).tolist() for name in names}}

    def __len__(self) -> int:
        return len(self.mean)


def rolling(x: Any, window: int) -> RollingFigures:
    """Return mean, standard deviation, minimum and maximum of every full window.

    Parameters
    ----------
    x : array_like, shape (n,), any unit
        Finite, of magnitude up to 1e150.
    window : int
        Samples, at most n.

    Raises
    ------
    ParameterError
        The window does not fit into the record; values that are not real or not finite.

    Examples
    --------
    >>> rolling([1.0, 2.0, 6.0], 2).mean.tolist()
    [1.5, 4.0]
    """
    x = vector("x", x)
    window = whole_number("window", window, 1, _LONGEST)
    if window > x.size:
        raise ParameterError(f"window is {window} but x has {x.size} samples", "window", "Give a shorter window.")
    out = np.empty((x.size - window + 1, 4))
    _core.rolling(x, window, out)
    out.flags.writeable = False
    return RollingFigures(*out.T, window)
