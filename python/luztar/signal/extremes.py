"""Fewer points for a picture, without losing a peak."""

from __future__ import annotations

from typing import Any

import numpy as np

from .. import _core
from .._arrays import vector, whole_number


def extremes(x: Any, stretches: int) -> np.ndarray:
    """Return the places of the least and greatest value of each stretch, and of its first NaN.

    Parameters
    ----------
    x : array_like, shape (n,)
        May hold NaN: a break in the line stays one.
    stretches : int, > 0
        Into how many parts of about equal length the record is cut, at most n.

    Returns
    -------
    ndarray of int64, increasing, at most 3 per stretch
        The extremes of the whole record are among them.

    Raises
    ------
    ParameterError
        Not a vector of real numbers, or no stretch.

    Examples
    --------
    >>> extremes([0.0, 5.0, 1.0, -2.0, 3.0, 3.0], 2)
    array([0, 1, 3, 4])
    """
    x = vector("x", x, minimum=0, finite=False)
    return _core.extremes(x, whole_number("stretches", stretches, 1, 2**31))
