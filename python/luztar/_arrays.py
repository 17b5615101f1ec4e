"""The one door through which arrays come in: contiguous, aligned, finite float64."""

from __future__ import annotations

import numbers
import reprlib
from typing import Any

import numpy as np

from .errors import ParameterError


def vector(name: str, values: Any, *, minimum: int = 1, finite: bool = True) -> np.ndarray:
    """Return ``values`` as a C-contiguous, aligned float64 vector, the very same object where it already is one.

    Parameters
    ----------
    name : str
        The argument's name, for the message.
    values : array_like, shape (n,)
        Real numbers; integers and float32 are converted, complex, text, dates and masked arrays are refused.
    minimum : int
        The least number of values.
    finite : bool
        Whether NaN and infinities are refused.

    Raises
    ------
    ParameterError
        Names the argument and, for NaN, the first positions.
    """
    array = real(name, values)
    if array.ndim != 1:
        raise ParameterError(f"{name} has the shape {array.shape}", name, "Give a one-dimensional array.")
    if array.size < minimum:
        raise ParameterError(f"{name} holds {array.size} values", name, f"Give at least {minimum}.")
    array = np.require(array, np.float64, ["C", "A"])
    if finite:
        refuse_not_finite(name, array)
    return array


def integers(name: str, values: Any) -> np.ndarray:
    """Return ``values`` as a contiguous int32 vector.

    Raises
    ------
    ParameterError
        Not whole numbers (floats are not, whatever their value), not one-dimensional, or beyond 32 bits.
    """
    array = real(name, values)
    if array.ndim != 1 or (array.dtype.kind not in "iu" and array.size):
        raise ParameterError(f"{name} is {array.dtype} of the shape {array.shape}", name, "Give whole numbers.")
    if array.size and not (-(2**31) <= int(array.min()) and int(array.max()) < 2**31):
        raise ParameterError(f"{name} holds values beyond 32 bits", name, "Use a QuantileSketch.")
    return np.require(array, np.int32, ["C", "A"])


def rows(name: str, values: Any, columns: int | None = None) -> np.ndarray:
    """Return ``values`` as contiguous float64 rows; a vector is one column. Whether they are finite is not looked at.

    Raises
    ------
    ParameterError
        Not real, not of two dimensions, or of another number of columns.
    """
    array = real(name, values)
    if array.ndim == 1 and columns in (None, 1):
        array = array[:, np.newaxis]
    if array.ndim != 2 or (columns is not None and array.shape[1] != columns):
        wanted = "p" if columns is None else columns
        raise ParameterError(f"{name} has the shape {array.shape}", name, f"Give rows of the shape (n, {wanted}).")
    return np.require(array, np.float64, ["C", "A"])


def rows_along(name: str, values: Any, axis: int, *, finite: bool = True) -> tuple[np.ndarray, tuple[int, ...]]:
    """Return ``values`` as contiguous float64 rows, one per record along ``axis``, and the shape with ``axis`` last.

    Raises
    ------
    ParameterError
        As :func:`vector`, or an axis that the array does not have.
    """
    array = real(name, values)
    if array.ndim == 0 or array.size == 0:
        raise ParameterError(f"{name} has the shape {array.shape}", name, "Give at least one sample.")
    axis = whole_number("axis", axis, -array.ndim, array.ndim - 1)
    if finite:
        refuse_not_finite(name, array)
    array = np.moveaxis(array, axis, -1)
    rows = np.require(array, np.float64, ["C", "A"]).reshape(-1, array.shape[-1])
    return rows, array.shape


def weights(values: Any, y: Any, needed: int) -> np.ndarray | None:
    """Return the weights of points, or None where none are given; whether they are in range is for the callee to say.

    Parameters
    ----------
    values : array_like, shape (points,), or None
    y : array_like, shape (points,)
    needed : int
        Points whose weight must be above 0.

    Raises
    ------
    ParameterError
        Not a vector, or too few weights above 0.
    """
    if values is None:
        return None
    made = vector("weights", values, minimum=0)
    points, counted = real("y", y).size, int(np.count_nonzero(made))
    if made.size == points >= needed > counted:
        kind = f"weights leaves {counted} of {points} points" if counted else f"weights is 0 for all {points} points"
        raise ParameterError(kind, "weights", f"Give at least {needed} points a weight above 0.")
    return made


def pair(name: str, value: Any) -> tuple[float, float]:
    """Return two real numbers.

    Raises
    ------
    ParameterError
        Not two of them.
    """
    if isinstance(value, str) or not hasattr(value, "__iter__") or len(both := tuple(value)) != 2:
        raise ParameterError(f"{name} is {reprlib.repr(value)}", name, "Give two numbers.")
    return number(name, both[0]), number(name, both[1])


def number(name: str, value: Any) -> float:
    """Return one real number; whether it is in range is for the callee to say.

    Raises
    ------
    ParameterError
        Not a number.
    """
    if isinstance(value, numbers.Real):
        return float(value)
    raise ParameterError(f"{name} is {reprlib.repr(value)}", name, "Give a real number.")


def whole_number(name: str, value: Any, low: int, high: int) -> int:
    """Return a whole number in [low, high]; 4.0 is one, True is not.

    Raises
    ------
    ParameterError
        Not a whole number, or outside the interval.
    """
    whole = isinstance(value, numbers.Real) and not isinstance(value, bool) and value == value // 1
    if whole and low <= value <= high:
        return int(value)
    raise ParameterError(f"{name} is {value!r}", name, f"Give a whole number from {low} to {high}.")


def writable(name: str, out: Any, shape: tuple[int, ...], *, contiguous: bool = True) -> np.ndarray:
    """Return ``out`` if a float64 result of this shape can be written into it.

    Raises
    ------
    ParameterError
        Not an array, of another type or shape, read-only, or not contiguous where that is needed.
    """
    if not isinstance(out, np.ndarray) or out.dtype != np.float64 or out.shape != shape:
        found = f"{out.dtype} {out.shape}" if isinstance(out, np.ndarray) else type(out).__name__
        raise ParameterError(f"{name} is {found}", name, f"Give a float64 array of the shape {shape}.")
    if not out.flags.writeable or (contiguous and not (out.flags.c_contiguous and out.flags.aligned)):
        raise ParameterError(f"{name} cannot be written as it lies", name, "Give a contiguous, writeable array.")
    return out


def real(name: str, values: Any) -> np.ndarray:
    """Return ``values`` as an array of real numbers, whatever its shape.

    Raises
    ------
    ParameterError
        Masked, ragged, or of a type that is no real number.
    """
    if isinstance(values, np.ma.MaskedArray):
        raise ParameterError(f"{name} is a masked array", name, "Fill or drop the masked values first.")
    try:
        array = np.asarray(values)
    except ValueError as ragged:
        raise ParameterError(f"{name} is not an array: {ragged}", name, "Give real numbers.") from None
    if array.dtype.kind not in "fiub":
        raise ParameterError(f"{name} has the type {array.dtype}", name, "Give real numbers.")
    return array


def is_plain(values: Any) -> bool:
    """Return whether ``values`` is a contiguous, aligned vector of doubles that can be used as it lies."""
    if type(values) is not np.ndarray or values.dtype != np.float64 or values.ndim != 1:
        return False
    flags = values.flags
    return flags.c_contiguous and flags.aligned and values.dtype.isnative


def refuse_not_finite(name: str, array: np.ndarray) -> None:
    """Refuse NaN and infinities.

    Raises
    ------
    ParameterError
        Names the first ten positions.
    """
    good = np.isfinite(array)
    if good.all():
        return
    at = np.argwhere(~good)
    shown = ", ".join(str(int(i[0])) if len(i) == 1 else str(tuple(map(int, i))) for i in at[:10])
    more = f" and {len(at) - 10} more" if len(at) > 10 else ""
    raise ParameterError(
        f"{name} holds {len(at)} values that are not finite, at index {shown}{more}",
        name,
        "Remove them or split the record there.",
    )
