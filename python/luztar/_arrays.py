"""The one door through which arrays come in: contiguous, aligned, finite float64."""

from __future__ import annotations

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
    if isinstance(values, np.ma.MaskedArray):
        raise ParameterError(f"{name} is a masked array", name, "Fill or drop the masked values first.")
    array = np.asarray(values)
    if array.dtype.kind not in "fiub":
        raise ParameterError(f"{name} has the type {array.dtype}", name, "Give real numbers.")
    if array.ndim != 1:
        raise ParameterError(f"{name} has the shape {array.shape}", name, "Give a one-dimensional array.")
    if array.size < minimum:
        raise ParameterError(f"{name} holds {array.size} values", name, f"Give at least {minimum}.")
    array = np.require(array, np.float64, ["C", "A"])
    if finite and not np.isfinite(array).all():
        at = np.flatnonzero(~np.isfinite(array))
        shown = ", ".join(str(i) for i in at[:10])
        more = f" and {at.size - 10} more" if at.size > 10 else ""
        raise ParameterError(
            f"{name} holds {at.size} values that are not finite, at index {shown}{more}",
            name,
            "Remove them or split the record there.",
        )
    return array
