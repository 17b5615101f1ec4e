"""Recursive least squares: coefficients at any time, with forgetting, in square-root form."""

from __future__ import annotations

from typing import Any

import numpy as np

from .. import _core
from .._arrays import number, rows, vector
from .._stream import Stream


class RecursiveLeastSquares(Stream, _core.Recursive):
    """Least squares that is updated row by row: ``y = b1 x1 + ... + bp xp``.

    Parameters
    ----------
    start : array_like, shape (p,)
        The coefficients before anything is measured; a constant term needs a column of ones in x.
    start_error : float
        How far ``start`` may be off: as if each had been measured with a standard error of this many residual standard
        deviations.
    forgetting : float
        Each row weighs this much of the one after it, in (0, 1].

    Notes
    -----
    Kept is the triangular factor of the information; a row is rotated into it [1]_. Nothing is subtracted, so that
    it cannot lose its sign as the covariance form does. Forgetting stands still while a direction would fall below
    the information of the start: without excitation the estimate stays (no windup). Without forgetting the result is
    that of :func:`linear` with the start as further rows (``test_recursive_is_least_squares_with_the_start_as_rows``).

    References
    ----------
    .. [1] Björck, "Numerical Methods for Least Squares Problems" (1996), section 3.3.3.

    Examples
    --------
    >>> r = RecursiveLeastSquares([0.0, 0.0])
    >>> r.push([[1.0, 0.0], [1.0, 1.0], [1.0, 2.0]], [1.0, 3.0, 5.0])
    >>> r.coefficients.round(6).tolist()
    [1.0, 2.0]
    """

    __slots__ = ()

    def __new__(  # noqa: D102
        cls, start: Any = (0.0,), *, start_error: float = 1e6, forgetting: float = 1.0
    ) -> RecursiveLeastSquares:
        start = vector("start", start).tolist()
        start_error, forgetting = number("start_error", start_error), number("forgetting", forgetting)
        return super().__new__(cls, start, start_error=start_error, forgetting=forgetting)

    def push(self, x: Any, y: Any) -> None:
        """Add rows: x of shape (n, p), or (n,) for one coefficient, y of shape (n,), n >= 0."""
        self.push_rows(x, y, None)

    def push_and_compare(self, x: Any, y: Any) -> np.ndarray:
        """Add rows and return y less the prediction made just before each, shape (n,)."""
        y = vector("y", y, minimum=0)
        errors = np.empty_like(y)
        self.push_rows(x, y, errors)
        return errors

    def predict(self, x: Any) -> np.ndarray:
        """Return the prediction for rows, shape (n,)."""
        return rows("x", x, self.size) @ self.coefficients

    def __repr__(self) -> str:
        return f"<luztar.regression.RecursiveLeastSquares: {self.count} rows, coefficients {self.coefficients}>"
