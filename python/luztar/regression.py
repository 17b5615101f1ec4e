"""Least squares: the straight line, at once or pushed in chunks."""

from __future__ import annotations

from dataclasses import asdict, dataclass
from typing import Any

from . import _core
from ._arrays import vector
from .errors import ParameterError


@dataclass(frozen=True)
class Line:
    """The least-squares line ``y = intercept + slope * x``.

    Attributes
    ----------
    slope : float [unit of y per unit of x]
    intercept : float [unit of y]
    slope_se, intercept_se : float or None
        Standard errors for independent residuals of one variance (correlated samples need more); None for two points.
    r : float
        The correlation; 0 where y is constant.
    residual_std : float or None [unit of y]
        ``sqrt(sum of squared residuals / (n - 2))``; None for two points.
    n : int
        How many points.
    """

    slope: float
    intercept: float
    slope_se: float | None
    intercept_se: float | None
    r: float
    residual_std: float | None
    n: int

    def to_dict(self) -> dict[str, Any]:
        """Return the fields as plain JSON values."""
        return asdict(self)


def line(x: Any, y: Any) -> Line:
    """Fit a straight line by least squares.

    Parameters
    ----------
    x, y : array_like, shape (n,), any units
        n >= 2, finite, of magnitude up to 1e150; x must vary.

    Returns
    -------
    Line
        A constant y gives a slope of exactly 0.

    Raises
    ------
    ParameterError
        x does not vary; fewer than two points; lengths that differ; not real or not finite.

    Notes
    -----
    Sums are centred and the residuals are read from the data a second time, so that time stamps near 1e9 s keep
    their digits. Norris' slope has 13 certified digits (``test_norris_has_the_certified_line``).

    References
    ----------
    .. [1] Draper, Smith, "Applied Regression Analysis", 3rd ed., section 1.4.

    Examples
    --------
    >>> line([0.0, 1.0, 2.0], [1.0, 3.0, 5.0]).slope
    2.0
    """
    return Line(*_core.fit_line(vector("x", x, minimum=2), vector("y", y, minimum=2)))


class LineSums:
    """A straight line through everything pushed so far, in constant memory.

    Notes
    -----
    :meth:`fit` takes the residuals from a difference of sums: standard errors lose ``log10(1 / (1 - r**2))`` digits
    against :func:`line`, which reads the data twice; slope and intercept lose none.

    Examples
    --------
    >>> sums = LineSums()
    >>> sums.push([0.0, 1.0], [1.0, 3.0])
    >>> sums.push([2.0], [5.0])
    >>> sums.fit().intercept
    1.0
    """

    __slots__ = ("_core",)

    def __init__(self) -> None:
        self._core = _core.LineSums()

    def push(self, x: Any, y: Any) -> None:
        """Add points: two array_likes of shape (n,), n >= 0, finite, of magnitude up to 1e150."""
        self._core.push(vector("x", x, minimum=0), vector("y", y, minimum=0))

    def merge(self, other: LineSums) -> None:
        """Add the points another object has seen."""
        if not isinstance(other, LineSums):
            raise ParameterError(f"other is a {type(other).__name__}", "other", "Give another LineSums.")
        self._core.merge(other._core.copy())

    def fit(self) -> Line:
        """Return the line; raises ParameterError below two points or if x does not vary."""
        return Line(*self._core.fit())

    @property
    def count(self) -> int:
        """How many points."""
        return self._core.count

    def copy(self) -> LineSums:
        """Return an independent object with the same content."""
        twin = LineSums()
        twin._core = self._core.copy()
        return twin

    __copy__ = copy

    def __deepcopy__(self, _memo: Any) -> LineSums:
        return self.copy()

    def __getstate__(self) -> tuple[Any, ...]:
        return self._core.state()

    def __setstate__(self, state: tuple[Any, ...]) -> None:
        self._core = _core.LineSums.from_state(*state)

    def __repr__(self) -> str:
        return f"<luztar.regression.LineSums: {self.count} points>"
