"""Several predictors by least squares, by way of a triangular factor that rows are pushed into and merged."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from .. import _arrays, _core
from .._arrays import number, rows, vector, whole_number
from .._printed import Printed, known, with_error
from .._stream import Stream
from .intervals import student_quantile

_MOST_PREDICTORS = 512


@dataclass(frozen=True, eq=False)
class LinearFit(Printed):
    """The least-squares fit ``y = b0 + b1 x1 + ... + bp xp``.

    Attributes
    ----------
    coefficients : ndarray, shape (p + 1,) or (p,)
        The intercept first, if there is one.
    standard_errors : ndarray or None
        For independent residuals of one variance, weights taken as inverse variances; None without degrees of freedom.
    residual_std : float or None
        ``sqrt(residual_squares / degrees_of_freedom)``.
    residual_squares, explained_squares : float
        Sums of squares; the latter about the mean with an intercept, about zero without.
    n : int
    degrees_of_freedom : float
        Rows less coefficients; with forgetting the sum of the weights less coefficients.
    intercept : bool
    """

    coefficients: np.ndarray
    standard_errors: np.ndarray | None
    residual_std: float | None
    residual_squares: float
    explained_squares: float
    n: int
    degrees_of_freedom: float
    intercept: bool

    @property
    def r_squared(self) -> float:
        """The share of the squares of y that is explained (about the mean with an intercept); 0 for a constant y."""
        total = self.residual_squares + self.explained_squares
        return self.explained_squares / total if total > 0.0 else 0.0

    def intervals(self, level: float = 0.95) -> np.ndarray | None:
        """Return the confidence intervals, shape (coefficients, 2); None without degrees of freedom."""
        if self.standard_errors is None:
            return None
        half = student_quantile(level, self.degrees_of_freedom) * self.standard_errors
        return np.column_stack([self.coefficients - half, self.coefficients + half])

    def predict(self, x: Any) -> np.ndarray:
        """Return the fit at rows of predictors, shape (n, p) or (n,) for one predictor."""
        slopes = self.coefficients[int(self.intercept) :]
        return rows("x", x, slopes.size) @ slopes + (self.coefficients[0] if self.intercept else 0.0)

    def to_dict(self) -> dict[str, Any]:
        """Return the fields as plain JSON values."""
        return {key: _plain(getattr(self, key)) for key in self.__dataclass_fields__}

    def _rows(self) -> list[tuple[str, str]]:
        errors = self.standard_errors if self.standard_errors is not None else [None] * len(self.coefficients)
        pairs = enumerate(zip(self.coefficients, errors, strict=True))
        return [
            *((f"b{i + (not self.intercept)}", with_error(b, e)) for i, (b, e) in pairs),
            ("residual std", known(self.residual_std)),
            ("r squared", f"{self.r_squared:.6g}"),
        ]


def linear(x: Any, y: Any, weights: Any = None, *, intercept: bool = True) -> LinearFit:
    """Fit several predictors by least squares.

    Parameters
    ----------
    x : array_like, shape (n, p) or (n,) for one predictor
        Finite, of magnitude up to 1e150; no column a combination of the others.
    y : array_like, shape (n,)
        n at least the number of coefficients.
    weights : array_like, shape (n,), optional
        Inverse variances up to a common factor, 0 or above; a point of weight 0 is no observation.
    intercept : bool
        Whether there is a constant term.

    Raises
    ------
    ParameterError
        Columns that depend on each other (named); too few rows; not real or not finite.

    Notes
    -----
    Householder reflections of blocks of rows (TSQR [1]_), every column relative to its first value; up to 50,000
    numbers the solution is corrected in twice the precision [2]_. Longley's coefficients have 13 certified digits
    (``test_linear_sets_have_their_certified_digits``).

    References
    ----------
    .. [1] Demmel, Grigori, Hoemmen, Langou, SIAM J. Sci. Comput. 34 (2012) A206.
    .. [2] Björck, "Numerical Methods for Least Squares Problems" (1996), section 6.6.5.

    Examples
    --------
    >>> fit = linear([[1.0, 0.0], [0.0, 1.0], [1.0, 1.0], [2.0, 1.0]], [3.0, 4.0, 6.0, 8.0])
    >>> fit.coefficients.round(9).tolist()
    [1.0, 2.0, 3.0]
    """
    if weights is not None:
        weights = _arrays.weights(weights, y, _arrays.rows("x", x).shape[1] + bool(intercept))
    fit = _core.fit_linear(x, y, weights, bool(intercept))
    return LinearFit(*fit, bool(intercept))


class LinearSums(Stream, _core.LinearSums):
    """Several predictors, pushed in chunks of rows, in constant memory.

    Parameters
    ----------
    predictors : int
        Columns of x, 1 to 512.
    intercept : bool
    forgetting : float
        Each row weighs this much of the one after it, in (0, 1].

    Notes
    -----
    Kept is the triangular factor of the rows, never their products: half of the digits would go into those. The
    residual is an entry of the factor and loses nothing to a difference. A push allocates nothing.

    Examples
    --------
    >>> sums = LinearSums(2)
    >>> sums.push([[1.0, 0.0], [0.0, 1.0]], [3.0, 4.0])
    >>> sums.push([[1.0, 1.0], [2.0, 1.0]], [6.0, 8.0])
    >>> sums.fit().coefficients.round(9).tolist()
    [1.0, 2.0, 3.0]
    """

    __slots__ = ()

    def __new__(cls, predictors: int = 1, *, intercept: bool = True, forgetting: float = 1.0) -> LinearSums:  # noqa: D102
        predictors = whole_number("predictors", predictors, 1, _MOST_PREDICTORS)
        return super().__new__(cls, predictors, intercept=bool(intercept), forgetting=number("forgetting", forgetting))

    def push(self, x: Any, y: Any, weights: Any = None) -> None:
        """Add rows: x of shape (n, p) or (n,) for one predictor, y and weights of shape (n,), n >= 0."""
        self.push_rows(x, y, _weights(weights))

    def fit(self) -> LinearFit:
        """Return the fit; raises ParameterError for too few rows or columns that depend on each other."""
        fit = self.figures()
        return LinearFit(*fit, intercept=len(fit[0]) > self.predictors)

    def __repr__(self) -> str:
        return f"<luztar.regression.LinearSums: {self.count} rows of {self.predictors} predictors>"


def _weights(weights: Any) -> np.ndarray | None:
    return None if weights is None else vector("weights", weights, minimum=0)


def _plain(value: Any) -> Any:
    return value.tolist() if isinstance(value, np.ndarray) else value
