"""Samples that are missing: refused, left out or held."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

from .._arrays import vector
from ..errors import ParameterError


def stretches(x: Any) -> list[slice]:
    """Return the stretches of finite samples of a vector, in order.

    Parameters
    ----------
    x : array_like, shape (n,)

    Returns
    -------
    list of slice
        Empty if no sample is finite.

    Examples
    --------
    >>> stretches([1.0, float("nan"), 2.0, 3.0])
    [slice(0, 1, None), slice(2, 4, None)]
    """
    good = np.isfinite(vector("x", x, minimum=0, finite=False))
    change = np.flatnonzero(np.diff(good, prepend=False, append=False))
    return [slice(int(a), int(b)) for a, b in zip(change[::2], change[1::2], strict=True)]


def split(rows: np.ndarray, out: np.ndarray, run: Callable[[np.ndarray, np.ndarray], None]) -> None:
    """Filter every finite stretch of every row as a record of its own; what is missing stays NaN."""
    out.fill(np.nan)
    for x, y in zip(rows, out, strict=True):
        for part in stretches(x):
            run(x[part], y[part])


def held(rows: np.ndarray) -> np.ndarray:
    """Return the rows with the last finite sample in place of the missing ones, and the first before it.

    Raises
    ------
    ParameterError
        A row without a finite sample.
    """
    good = np.isfinite(rows)
    empty = np.flatnonzero(~good.any(axis=1))
    if empty.size:
        raise ParameterError(f"x has no finite sample in record {int(empty[0])}", "x", "Leave that record out.")
    last = np.maximum.accumulate(np.where(good, np.arange(rows.shape[1]), -1), axis=1)
    last = np.where(last < 0, good.argmax(axis=1)[:, np.newaxis], last)
    return np.take_along_axis(rows, last, axis=1)
