"""Fits that outliers do not bend: Theil-Sen and Huber."""

from __future__ import annotations

from dataclasses import asdict, dataclass
from typing import Any

from .. import _core
from .._arrays import number, vector
from .._printed import Printed
from .intervals import normal_quantile
from .linear import LinearFit


@dataclass(frozen=True)
class TheilSenLine(Printed):
    """The line with the median slope of all pairs of points.

    Attributes
    ----------
    slope : float [unit of y per unit of x]
    intercept : float [unit of y]
        The median of ``y - slope * x``.
    slope_low, slope_high : float
        The confidence interval of the slope.
    level : float
        Its level.
    n : int
    """

    slope: float
    intercept: float
    slope_low: float
    slope_high: float
    level: float
    n: int

    def to_dict(self) -> dict[str, Any]:
        """Return the fields as plain JSON values."""
        return asdict(self)

    def _rows(self) -> list[tuple[str, str]]:
        return [
            ("slope", f"{self.slope:.9g}, {100 * self.level:g} % from {self.slope_low:.6g} to {self.slope_high:.6g}"),
            ("intercept", f"{self.intercept:.9g}"),
            ("points", f"{self.n}"),
        ]


def theil_sen(x: Any, y: Any, *, level: float = 0.95) -> TheilSenLine:
    """Fit a line by the median of the slopes of all pairs of points.

    Parameters
    ----------
    x, y : array_like, shape (n,), any units
        n >= 2, finite; x must vary.
    level : float
        Of the slope's confidence interval (Kendall's statistic, no assumption on the residuals' distribution).

    Notes
    -----
    Up to 29 % of the points may be anywhere. Up to 2048 points all pairs are made; beyond, the median is found by
    counting inversions, in some hundred sorts (``test_both_ways_to_the_median_slope_agree``).

    References
    ----------
    .. [1] Sen, J. Am. Stat. Assoc. 63 (1968) 1379.

    Examples
    --------
    >>> theil_sen([0.0, 1.0, 2.0, 3.0, 4.0], [1.0, 3.0, 5.0, 7.0, 900.0]).slope
    2.0
    """
    found = _core.theil_sen(vector("x", x, minimum=2), vector("y", y, minimum=2), normal_quantile(level))
    slope, intercept, low, high, n = found
    return TheilSenLine(slope, intercept, low, high, level, n)


@dataclass(frozen=True, eq=False)
class HuberFit(Printed):
    """A fit that counts large residuals by their size instead of their square.

    Attributes
    ----------
    fit : LinearFit
        Coefficients with the standard errors of the robust estimate; its sums of squares are weighted.
    scale : float
        The median absolute residual / 0.6745: the standard deviation of the residuals that are not outliers.
    outliers : int
        Rows that weigh less than 1.
    repetitions : int
    """

    fit: LinearFit
    scale: float
    outliers: int
    repetitions: int

    def to_dict(self) -> dict[str, Any]:
        """Return the fields as plain JSON values."""
        others = {"scale": self.scale, "outliers": self.outliers, "repetitions": self.repetitions}
        return {"fit": self.fit.to_dict(), **others}

    def _rows(self) -> list[tuple[str, str]]:
        return [*self.fit._rows(), ("scale", f"{self.scale:.6g}"), ("outliers", f"{self.outliers}")]


def huber(x: Any, y: Any, *, intercept: bool = True, threshold: float = 1.345) -> HuberFit:
    """Fit several predictors robustly.

    Parameters
    ----------
    x : array_like, shape (n, p) or (n,) for one predictor
    y : array_like, shape (n,)
    intercept : bool
    threshold : float [scales]
        Residuals beyond it count by their size; 1.345 keeps 95 % of the efficiency for normal residuals.

    Raises
    ------
    ParameterError
        As of :func:`linear`; weights that do not settle.

    Notes
    -----
    Protects against outliers of y, not against points far out in x: use :func:`theil_sen` there.

    References
    ----------
    .. [1] Huber, Ronchetti, "Robust Statistics", 2nd ed., sections 7.6 to 7.8.

    Examples
    --------
    >>> fit = huber([0.0, 1.0, 2.0, 3.0, 4.0, 5.0], [1.0, 3.1, 4.9, 7.0, 9.1, 99.0])
    >>> round(float(fit.fit.coefficients[1]), 1), fit.outliers
    (2.2, 1)
    """
    found, scale, outliers, repetitions = _core.huber(x, y, bool(intercept), number("threshold", threshold))
    return HuberFit(LinearFit(*found, bool(intercept)), scale, outliers, repetitions)
