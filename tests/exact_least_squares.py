"""Least squares and moments of the stored doubles in rational arithmetic: the reference nothing is lost in."""

from __future__ import annotations

import math
from fractions import Fraction

import numpy as np


def solve(matrix: list[list[Fraction]], right: list[Fraction]) -> list[Fraction]:
    """Gauss elimination; rational numbers need no pivoting but for zeros."""
    rows = [[*row, r] for row, r in zip(matrix, right, strict=True)]
    n = len(rows)
    for i in range(n):
        pivot = next(j for j in range(i, n) if rows[j][i] != 0)
        rows[i], rows[pivot] = rows[pivot], rows[i]
        for j in range(i + 1, n):
            factor = rows[j][i] / rows[i][i]
            rows[j] = [a - factor * b for a, b in zip(rows[j], rows[i], strict=True)]
    found = [Fraction(0)] * n
    for i in reversed(range(n)):
        known = sum((rows[i][j] * found[j] for j in range(i + 1, n)), Fraction(0))
        found[i] = (rows[i][n] - known) / rows[i][i]
    return found


def least_squares(columns: list[list[Fraction]], y: list[Fraction]) -> tuple[list[float], float]:
    """Coefficients and residual standard deviation, each rounded once, at the end."""

    def dot(a, b):
        return sum((p * q for p, q in zip(a, b, strict=True)), Fraction(0))

    normal = [[dot(a, b) for b in columns] for a in columns]
    found = solve(normal, [dot(a, y) for a in columns])
    residual = [v - sum((b * c[i] for b, c in zip(found, columns, strict=True)), Fraction(0)) for i, v in enumerate(y)]
    squares = dot(residual, residual)
    return [float(b) for b in found], root(squares / (len(y) - len(columns)))


def polynomial(x: np.ndarray, y: np.ndarray, degree: int) -> tuple[list[float], float]:
    """A polynomial in powers of x."""
    exact = [Fraction(v) for v in x.tolist()]
    return least_squares([[v**k for v in exact] for k in range(degree + 1)], [Fraction(v) for v in y.tolist()])


def linear(x: np.ndarray, y: np.ndarray, intercept: bool = True) -> tuple[list[float], float]:
    """Several predictors, the intercept first."""
    columns = [[Fraction(v) for v in column.tolist()] for column in x.T]
    if intercept:
        columns.insert(0, [Fraction(1)] * len(y))
    return least_squares(columns, [Fraction(v) for v in y.tolist()])


def moments(x: np.ndarray) -> tuple[float, float, float, float]:
    """Mean, sample standard deviation, skewness, excess kurtosis."""
    values = [Fraction(v) for v in x.tolist()]
    n = len(values)
    mean = sum(values) / n
    second, third, fourth = (sum((v - mean) ** k for v in values) / n for k in (2, 3, 4))
    deviation = Fraction(math.isqrt(int(second * 10**80)), 10**40)
    skew = float(third / second / deviation) if second else math.nan
    return float(mean), root(second * n / (n - 1)), skew, float(fourth / second**2 - 3) if second else math.nan


def root(value: Fraction) -> float:
    """The square root, rounded once."""
    shift = 10 ** (60 + max(0, 2 * (math.ceil(-math.log10(value)) // 2) if 0 < value < 1 else 0))
    return float(Fraction(math.isqrt(int(value * shift**2)), shift))
