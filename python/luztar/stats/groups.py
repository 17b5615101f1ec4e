"""Moments of the parts of a record: by label, by direction of motion, by window."""

from __future__ import annotations

import reprlib
from collections.abc import Iterable
from operator import index
from typing import Any, Literal

import numpy as np

from .. import _core
from .._arrays import number, vector
from ..errors import ParameterError
from .moments import Description, Moments


def by_label(
    x: Any, labels: Any, *, nan: Literal["raise", "skip"] = "raise", clipped_at: tuple[float, float] | None = None
) -> dict[int, Description]:
    """Describe the samples of every label.

    Parameters
    ----------
    x : array_like, shape (n,), any unit
    labels : array_like of whole numbers, shape (n,)
        For instance the number of the stroke a sample belongs to.
    nan, clipped_at
        As of :func:`describe`.

    Returns
    -------
    dict of int to Description
        In the order of the labels; extremes carry the index in x. A label with nothing but NaN is left out.

    Raises
    ------
    ParameterError
        Labels that are not whole numbers or not as many as samples; what :func:`describe` refuses.

    Examples
    --------
    >>> {k: d.mean for k, d in by_label([1.0, 3.0, 9.0], [0, 0, 1]).items()}
    {0: 2.0, 1: 9.0}
    """
    x = vector("x", x, finite=nan != "skip")
    labels = np.asarray(labels)
    if labels.dtype.kind not in "iub" or labels.shape != x.shape:
        raise ParameterError(
            f"labels is {labels.dtype} of the shape {labels.shape}", "labels", f"Give {x.size} whole numbers."
        )
    like = Moments(shape=True, nan=nan, clipped_at=clipped_at)
    parts = _core.moments_by_label(x, np.ascontiguousarray(labels, dtype=np.int64), like)
    return {label: _described(part) for label, part in parts if part.count}


def by_direction(
    x: Any,
    motion: Any,
    *,
    rest: float = 0.0,
    nan: Literal["raise", "skip"] = "raise",
    clipped_at: tuple[float, float] | None = None,
) -> dict[int, Description]:
    """Describe a record by the sign of motion.

    Parameters
    ----------
    x : array_like, shape (n,), any unit
        For instance torque.
    motion : array_like, shape (n,), any unit
        Speed, or anything else with the sign of motion.
    rest : float, in the unit of ``motion``
        Samples with ``abs(motion) <= rest`` are at rest.
    nan, clipped_at
        As of :func:`describe`; ``motion`` must be finite.

    Returns
    -------
    dict of int to Description
        Keys -1, 0 (at rest) and 1, those that occur.

    Raises
    ------
    ParameterError
        A motion of another length or not finite, a negative ``rest``; what :func:`describe` refuses.

    Examples
    --------
    >>> torque, speed = [1.0, 1.2, 0.1, -0.9], [2.0, 2.0, 0.0, -2.0]
    >>> {k: d.mean for k, d in by_direction(torque, speed).items()}
    {-1: -0.9, 0: 0.1, 1: 1.1}
    """
    motion = vector("motion", motion)
    rest = number("rest", rest)
    if not rest >= 0.0:
        raise ParameterError(f"rest is {rest}", "rest", "Give a value of 0 or above.")
    x = vector("x", x, finite=nan != "skip")
    if x.shape != motion.shape:
        raise ParameterError(f"motion has {motion.size} values, x {x.size}", "motion", "Give one for every sample.")
    labels = (motion > rest).astype(np.int64) - (motion < -rest)
    return by_label(x, labels, nan=nan, clipped_at=clipped_at)


def by_window(
    x: Any,
    windows: Iterable[tuple[int, int]],
    *,
    nan: Literal["raise", "skip"] = "raise",
    clipped_at: tuple[float, float] | None = None,
) -> list[Description]:
    """Describe windows of a record.

    Parameters
    ----------
    x : array_like, shape (n,), any unit
    windows : iterable of (int, int)
        First sample and the one after the last, of each.
    nan, clipped_at
        As of :func:`describe`.

    Returns
    -------
    list of Description
        Extremes carry the index in x.

    Raises
    ------
    ParameterError
        A window that is empty, reversed or not inside the record; what :func:`describe` refuses.

    Examples
    --------
    >>> [d.mean for d in by_window([1.0, 3.0, 9.0], [(0, 2), (1, 3)])]
    [2.0, 6.0]
    """
    x = vector("x", x, finite=nan != "skip")
    pairs = _pairs(windows)
    for start, end in pairs:
        if not 0 <= start < end <= x.size:
            raise ParameterError(
                f"windows holds ({start}, {end})", "windows", f"Give start < end within [0, {x.size}]."
            )
    like = Moments(shape=True, nan=nan, clipped_at=clipped_at)
    return [_described(part) for part in _core.moments_by_window(x, pairs, like)]


def _pairs(windows: Any) -> list[tuple[int, int]]:
    try:
        given = [(*window,) for window in windows]
        made = [(index(start), index(end)) for start, end in given]
    except (TypeError, ValueError):
        raise ParameterError(
            f"windows is {reprlib.repr(windows)}", "windows", "Give pairs of whole numbers: [(first, after the last)]."
        ) from None
    return made


def _described(part: _core.Moments) -> Description:
    whole = Moments()
    whole.restore(*part.state())
    return whole.describe()
