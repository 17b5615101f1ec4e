"""luz and tar and the operators made of them, over arrays.

``luz(x, a) = x - clip(x, -a, a)`` is freeplay; its inverse tar is dry friction; one implicit step of dry friction is
luz again. With a memory they become play (backlash) and stop (friction before break-away).

Source: Wieckowski, Zardecki, "Influence of freeplay and friction in steering system on double lane change manoeuvre",
equations (1) to (4).
"""

from __future__ import annotations

from typing import Any

import numpy as np

from . import _core
from ._arrays import number
from .errors import ParameterError


def luz(x: Any, a: Any) -> Any:
    """Return ``x - clip(x, -a, a)``: 0 inside the gap, the distance to it outside.

    Parameters
    ----------
    x : array_like
    a : array_like, >= 0
        Half the gap. Arguments are broadcast against each other.

    Returns
    -------
    float or ndarray

    Examples
    --------
    >>> import luztar
    >>> luztar.projections.luz([-1.0, 0.2, 1.0], 0.5).tolist()
    [-0.5, 0.0, 0.5]
    """
    return _each("luz", {"x": x, "a": a})


def tar(x: Any, a: Any) -> tuple[Any, Any]:
    """Return ``x + a Sgn(x)`` as an interval, lower and upper end: they differ where ``x`` is 0.

    Parameters
    ----------
    x : array_like
    a : array_like, >= 0
    """
    return _each("tar_low", {"x": x, "a": a}), _each("tar_high", {"x": x, "a": a})


def asymmetric(x: Any, up: Any, down: Any) -> Any:
    """Return the resolvent of dry friction with one level per direction: y with ``y + S(y) = x``.

    Parameters
    ----------
    x : array_like
    up, down : array_like, >= 0
        Level for y > 0 and for y < 0.
    """
    return _each("asymmetric", {"x": x, "up": up, "down": down})


def drag(x: Any, c: Any) -> Any:
    """Return the resolvent of quadratic drag: y with ``y + c |y| y = x``.

    Parameters
    ----------
    x : array_like
    c : array_like, >= 0
    """
    return _each("drag", {"x": x, "c": c})


def play(x: Any, radius: Any, start: float = 0.0) -> np.ndarray:
    """Return what a gap of full width ``2 radius`` transmits of a record: ``y += luz(x - y, radius)``.

    Parameters
    ----------
    x : array_like, shape (n,)
        A record, in order.
    radius : array_like, >= 0
    start : float
        Output before the first sample.
    """
    return _along("play", x, radius, start)


def stop(x: Any, radius: Any, start: float = 0.0) -> np.ndarray:
    """Return the friction state of a record in length units: it follows the motion and slips at the radius.

    Parameters
    ----------
    x : array_like, shape (n,)
        A record, in order.
    radius : array_like, >= 0
    start : float
        State at the first sample.
    """
    return _along("stop", x, radius, start)


def _prepared(given: dict[str, Any]) -> list[np.ndarray]:
    arrays = []
    for name, value in given.items():
        try:
            array = np.asarray(value, dtype=np.float64)
        except (TypeError, ValueError):
            raise ParameterError(f"{name} is {value!r}", name, "Give real numbers.") from None
        if not np.isfinite(array).all():
            at = np.argwhere(~np.isfinite(np.atleast_1d(array)))[0]
            place = ", ".join(map(str, at))
            raise ParameterError(f"{name} is not finite at index {place}", name, "Remove or replace what is not.")
        if name != "x" and (array < 0.0).any():
            raise ParameterError(f"{name} is {array.min():g}", name, "Give values that are not negative.")
        arrays.append(array)
    try:
        return list(np.broadcast_arrays(*arrays))
    except ValueError:
        shapes = ", ".join(f"{n} {a.shape}" for n, a in zip(given, arrays, strict=True))
        raise ParameterError(f"the shapes do not fit together: {shapes}", "x", "Give shapes that broadcast.") from None


def _each(name: str, given: dict[str, Any]) -> Any:
    arrays = _prepared(given)
    flat = [np.ascontiguousarray(a).ravel() for a in arrays]
    out = np.empty(flat[0].size)
    _core.project(name, flat[0], flat[1], flat[-1], 0.0, out)
    shaped = out.reshape(arrays[0].shape)
    return float(shaped) if shaped.ndim == 0 else shaped


def _along(name: str, x: Any, radius: Any, start: float) -> np.ndarray:
    arrays = _prepared({"x": x, "radius": radius})
    if arrays[0].ndim != 1:
        raise ParameterError(f"x has the shape {arrays[0].shape}", "x", "Give one record, a one-dimensional array.")
    first = number("start", start)
    if not np.isfinite(first):
        raise ParameterError(f"start is {first}", "start", "Give a finite number.")
    flat = [np.ascontiguousarray(a) for a in arrays]
    if name == "stop" and flat[1].size and abs(first) > flat[1][0]:
        raise ParameterError(f"start is {first}", "start", "It cannot be beyond the radius.")
    out = np.empty(flat[0].size)
    _core.project(name, flat[0], flat[1], flat[1], first, out)
    return out
