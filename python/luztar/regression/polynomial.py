"""Polynomials by least squares, in Chebyshev polynomials over the range of x."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from .. import _arrays, _core
from .._arrays import number, vector, whole_number
from .._printed import Printed, known, with_error
from .._stream import Stream
from ..errors import ParameterError
from .intervals import student_quantile

_HIGHEST = 30
_LONGEST = 10_000_000


@dataclass(frozen=True, eq=False)
class PolynomialFit(Printed):
    """The least-squares polynomial.

    Attributes
    ----------
    coefficients : ndarray, shape (degree + 1,)
        Of the powers of x, from the constant up. Far from x = 0 they cancel when summed; :meth:`predict` does not.
    standard_errors : ndarray or None
        For independent residuals of one variance, weights taken as inverse variances; None without degrees of freedom.
    residual_std : float or None
        ``sqrt(residual_squares / degrees_of_freedom)``.
    residual_squares, explained_squares : float
        Sums of squares, the latter about the mean.
    n : int
    degrees_of_freedom : float
        Points less coefficients; with forgetting the sum of the weights less coefficients.
    chebyshev : ndarray, shape (degree + 1,)
        Of the Chebyshev polynomials over ``domain``.
    domain : (float, float)
        The range of x that is mapped to [-1, 1].
    """

    coefficients: np.ndarray
    standard_errors: np.ndarray | None
    residual_std: float | None
    residual_squares: float
    explained_squares: float
    n: int
    degrees_of_freedom: float
    chebyshev: np.ndarray
    domain: tuple[float, float]

    @property
    def degree(self) -> int:
        """The degree."""
        return len(self.coefficients) - 1

    @property
    def r_squared(self) -> float:
        """The share of the squares of y about the mean that is explained; 0 for a constant y."""
        total = self.residual_squares + self.explained_squares
        return self.explained_squares / total if total > 0.0 else 0.0

    def intervals(self, level: float = 0.95) -> np.ndarray | None:
        """Return the confidence intervals, shape (degree + 1, 2); None without degrees of freedom."""
        if self.standard_errors is None:
            return None
        half = student_quantile(level, self.degrees_of_freedom) * self.standard_errors
        return np.column_stack([self.coefficients - half, self.coefficients + half])

    def predict(self, x: Any) -> np.ndarray:
        """Return the polynomial at x, shape (n,)."""
        low, high = self.domain
        half = 0.5 * high - 0.5 * low
        u = (vector("x", x, minimum=0) - (0.5 * low + 0.5 * high)) / (half if half > 0.0 else 1.0)
        return np.polynomial.chebyshev.chebval(u, self.chebyshev)

    def to_dict(self) -> dict[str, Any]:
        """Return the fields as plain JSON values."""
        values = {key: getattr(self, key) for key in self.__dataclass_fields__}
        return {key: v.tolist() if isinstance(v, np.ndarray) else v for key, v in values.items()}

    def _rows(self) -> list[tuple[str, str]]:
        errors = self.standard_errors if self.standard_errors is not None else [None] * len(self.coefficients)
        pairs = enumerate(zip(self.coefficients, errors, strict=True))
        return [
            *((f"x^{i}", with_error(b, e)) for i, (b, e) in pairs),
            ("residual std", known(self.residual_std)),
            ("r squared", f"{self.r_squared:.6g}"),
        ]


def polynomial(x: Any, y: Any, degree: int, weights: Any = None) -> PolynomialFit:
    """Fit a polynomial by least squares.

    Parameters
    ----------
    x, y : array_like, shape (n,), any units
        Finite, of magnitude up to 1e150; at least ``degree + 1`` distinct x.
    degree : int
        0 to 30.
    weights : array_like, shape (n,), optional
        Inverse variances up to a common factor, 0 or above; a point of weight 0 is no observation.

    Raises
    ------
    ParameterError
        Too few distinct x; lengths that differ; not real or not finite.

    Notes
    -----
    Chebyshev polynomials over the range of x, Householder reflections, up to 50,000 numbers (points times coefficients)
    a correction in twice the precision, and the way back to powers of x in twice the precision. Filip's coefficients
    have 12 certified digits (``test_polynomials_have_their_certified_digits``).

    Examples
    --------
    >>> polynomial([0.0, 1.0, 2.0, 3.0], [1.0, 2.0, 5.0, 10.0], 2).coefficients.round(9).tolist()
    [1.0, 0.0, 1.0]
    """
    degree = whole_number("degree", degree, 0, _HIGHEST)
    return _fit(_core.fit_polynomial(x, y, _arrays.weights(weights, y, degree + 1), degree))


class PolynomialSums(Stream, _core.PolynomialSums):
    """A polynomial through everything pushed so far, in constant memory.

    Parameters
    ----------
    degree : int
        0 to 30.
    domain : (float, float)
        Where x is expected. Points outside are allowed; far outside they cost digits.
    forgetting : float
        Each point weighs this much of the one after it, in (0, 1].

    Examples
    --------
    >>> sums = PolynomialSums(2, (0.0, 3.0))
    >>> sums.push([0.0, 1.0], [1.0, 2.0])
    >>> sums.push([2.0, 3.0], [5.0, 10.0])
    >>> sums.fit().coefficients.round(9).tolist()
    [1.0, 0.0, 1.0]
    """

    __slots__ = ()

    def __new__(  # noqa: D102
        cls, degree: int = 1, domain: tuple[float, float] = (-1.0, 1.0), *, forgetting: float = 1.0
    ) -> PolynomialSums:
        degree = whole_number("degree", degree, 0, _HIGHEST)
        low, high = (number("domain", v) for v in domain)
        if not low < high:
            raise ParameterError(f"domain is {domain}", "domain", "Give the lower end first.")
        return super().__new__(cls, degree, (low, high), forgetting=number("forgetting", forgetting))

    def push(self, x: Any, y: Any, weights: Any = None) -> None:
        """Add points: array_likes of shape (n,), n >= 0, finite, of magnitude up to 1e150; weights 0 or above."""
        self.push_points(x, y, None if weights is None else vector("weights", weights, minimum=0))

    def fit(self) -> PolynomialFit:
        """Return the polynomial; raises ParameterError for too few distinct x."""
        return _fit(self.figures())

    def __repr__(self) -> str:
        return f"<luztar.regression.PolynomialSums: {self.count} points, degree {self.degree}>"


class RollingPolynomial(Stream, _core.RollingPolynomial):
    """A polynomial through the last ``window`` points, fitted from the points themselves when it is asked for.

    Parameters
    ----------
    degree : int
        0 to 30.
    window : int
        Points, more than the degree, up to 10,000,000.

    Notes
    -----
    A push only stores; :meth:`fit` costs what :func:`polynomial` costs on as many points. For a straight line that is
    asked for after every sample use :class:`RollingLine`.

    Examples
    --------
    >>> r = RollingPolynomial(2, 4)
    >>> r.push([0.0, 1.0, 2.0, 3.0, 4.0], [1e9, 2.0, 5.0, 10.0, 17.0])
    >>> r.fit().coefficients.round(9).tolist()
    [1.0, 0.0, 1.0]
    """

    __slots__ = ()

    def __new__(cls, degree: int = 1, window: int = 2) -> RollingPolynomial:  # noqa: D102
        degree = whole_number("degree", degree, 0, _HIGHEST)
        return super().__new__(cls, degree, whole_number("window", window, degree + 1, _LONGEST))

    def fit(self) -> PolynomialFit:
        """Return the polynomial; raises ParameterError for too few distinct x."""
        return _fit(self.figures())

    def __repr__(self) -> str:
        return f"<luztar.regression.RollingPolynomial: {self.count} of {self.window} points, degree {self.degree}>"


def _fit(figures: tuple[Any, ...]) -> PolynomialFit:
    linear, chebyshev, domain = figures
    return PolynomialFit(*linear, chebyshev, domain)
