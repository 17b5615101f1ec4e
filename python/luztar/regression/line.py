"""The straight line by least squares: at once, pushed in chunks, fading, over a window, over time."""

from __future__ import annotations

from dataclasses import asdict, dataclass
from typing import Any

import numpy as np

from .. import _arrays, _core
from .._arrays import number, vector, whole_number
from .._printed import Printed, known, with_error
from .._stream import Stream
from ..errors import ParameterError
from .intervals import around, student_quantile

_LONGEST = 10_000_000


@dataclass(frozen=True)
class Line(Printed):
    """The least-squares line ``y = intercept + slope * x``.

    Attributes
    ----------
    slope : float [unit of y per unit of x]
    intercept : float [unit of y]
        At x = 0: far outside the data (time stamps) it is an extrapolation; use :meth:`predict` there.
    slope_se, intercept_se : float or None
        Standard errors for independent residuals of one variance (correlated samples need more), weights taken as
        inverse variances; None where no degree of freedom is left.
    r : float
        The correlation; 0 where y is constant.
    residual_std : float or None [unit of y]
        ``sqrt(sum of squared residuals / degrees_of_freedom)``.
    n : int
        How many points.
    degrees_of_freedom : float
        n - 2; with forgetting the sum of the weights less 2.
    x_mean, y_mean : float
        The weighted means: the point the line turns about.
    x_mean_rest : float
        What rounding took off ``x_mean``: a time stamp of today holds a ten-millionth of a second.
    mean_se : float or None [unit of y]
        The standard error of the line at ``x_mean``.
    """

    slope: float
    intercept: float
    slope_se: float | None
    intercept_se: float | None
    r: float
    residual_std: float | None
    n: int
    degrees_of_freedom: float
    x_mean: float
    x_mean_rest: float
    y_mean: float
    mean_se: float | None

    @property
    def r_squared(self) -> float:
        """The share of the variance of y that the line explains."""
        return self.r * self.r

    def slope_interval(self, level: float = 0.95) -> tuple[float, float] | None:
        """Return the confidence interval of the slope; None where no degree of freedom is left."""
        return around(self.slope, self.slope_se, level, self.degrees_of_freedom)

    def intercept_interval(self, level: float = 0.95) -> tuple[float, float] | None:
        """Return the confidence interval of the intercept; None where no degree of freedom is left."""
        return around(self.intercept, self.intercept_se, level, self.degrees_of_freedom)

    def predict(self, x: Any) -> np.ndarray:
        """Return the line at x, shape (n,), from the means, so that time stamps keep their digits."""
        return self.y_mean + self.slope * self._from_mean(x)

    def band(self, x: Any, level: float = 0.95) -> tuple[np.ndarray, np.ndarray] | None:
        """Return the lower and upper end of the line's confidence interval at x; None without degrees of freedom."""
        if self.mean_se is None or self.slope_se is None:
            return None
        middle = self.predict(x)
        error = np.hypot(self.mean_se, self.slope_se * self._from_mean(x))
        half = student_quantile(level, self.degrees_of_freedom) * error
        return middle - half, middle + half

    def _from_mean(self, x: Any) -> np.ndarray:
        return (vector("x", x, minimum=0) - self.x_mean) - self.x_mean_rest

    def residuals(self, x: Any, y: Any) -> np.ndarray:
        """Return y less the line, shape (n,); :func:`luztar.stats.describe` has their statistics."""
        predicted, y = self.predict(x), vector("y", y, minimum=0)
        if y.shape != predicted.shape:
            raise ParameterError(f"y has {y.size} values", "y", f"Give {predicted.size}, as many as x.")
        return y - predicted

    def to_dict(self) -> dict[str, Any]:
        """Return the fields as plain JSON values."""
        return asdict(self)

    def _rows(self) -> list[tuple[str, str]]:
        return [
            ("slope", with_error(self.slope, self.slope_se)),
            ("intercept", with_error(self.intercept, self.intercept_se)),
            ("r squared", f"{self.r_squared:.6g}"),
            ("residual std", known(self.residual_std)),
            ("points", f"{self.n}"),
        ]


def _line(figures: tuple[Any, ...]) -> Line:
    slope, intercept, (slope_se, intercept_se, mean_se, residual_std), r, n, degrees, means = figures
    return Line(slope, intercept, slope_se, intercept_se, r, residual_std, n, degrees, *means, mean_se)


def line(x: Any, y: Any, weights: Any = None) -> Line:
    """Fit a straight line by least squares.

    Parameters
    ----------
    x, y : array_like, shape (n,), any units
        n >= 2, finite, of magnitude up to 1e150; x must vary.
    weights : array_like, shape (n,), optional
        Inverse variances up to a common factor, 0 or above; a point of weight 0 is no observation.

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
    return _line(_core.fit_line(x, y, _arrays.weights(weights, y, 2)))


class LineSums(Stream, _core.LineSums):
    """A straight line through everything pushed so far, in constant memory.

    Parameters
    ----------
    forgetting : float
        Each point weighs this much of the one after it, in (0, 1]; ``1 - 1/n`` remembers about n points.

    Notes
    -----
    :meth:`fit` takes the residuals from a difference of sums: standard errors lose ``log10(1 / (1 - r**2))`` digits
    against :func:`line`, which reads the data twice; slope and intercept lose none. A push allocates nothing.

    Examples
    --------
    >>> sums = LineSums()
    >>> sums.push([0.0, 1.0], [1.0, 3.0])
    >>> sums.push([2.0], [5.0])
    >>> sums.fit().intercept
    1.0
    """

    __slots__ = ()

    def __new__(cls, *, forgetting: float = 1.0) -> LineSums:  # noqa: D102
        return super().__new__(cls, forgetting=number("forgetting", forgetting))

    def push(self, x: Any, y: Any, weights: Any = None) -> None:
        """Add points: array_likes of shape (n,), n >= 0, finite, of magnitude up to 1e150; weights 0 or above."""
        self.push_points(x, y, None if weights is None else vector("weights", weights, minimum=0))

    def merge(self, other: LineSums) -> None:
        """Add the points another object has seen; with forgetting they count as fresh as this one's."""
        if not isinstance(other, LineSums):
            raise ParameterError(f"other is a {type(other).__name__}", "other", "Give another LineSums.")
        self.merge_points(other)

    def fit(self) -> Line:
        """Return the line; raises ParameterError below two points or if x does not vary."""
        return _line(self.figures())

    def __repr__(self) -> str:
        return f"<luztar.regression.LineSums: {self.count} points>"


class RollingLine(Stream, _core.RollingLine):
    """A straight line through the last ``window`` points, exact: nothing is subtracted when a point leaves.

    Parameters
    ----------
    window : int
        Points, 2 to 10,000,000.

    Notes
    -----
    As of :class:`luztar.stats.Rolling`, with the sums of a line. Until the window is full the line is through what
    there is.

    Examples
    --------
    >>> r = RollingLine(3)
    >>> r.push([0.0, 1.0, 2.0, 3.0], [1e9, 3.0, 5.0, 7.0])
    >>> r.fit().slope
    2.0
    """

    __slots__ = ()

    def __new__(cls, window: int = 2) -> RollingLine:  # noqa: D102
        return super().__new__(cls, whole_number("window", window, 2, _LONGEST))

    def fit(self) -> Line:
        """Return the line; raises ParameterError below two points or if x does not vary."""
        return _line(self.figures())

    def __repr__(self) -> str:
        return f"<luztar.regression.RollingLine: {self.count} of {self.window} points>"


class TimeLine(Stream, _core.LineSums):
    """A straight line of evenly sampled values over time ``start_s + n / sample_rate_hz``.

    Parameters
    ----------
    sample_rate_hz : float
    start_s : float [s]
        The time of the first sample; a UNIX time is as good as 0.
    forgetting : float
        As of :class:`LineSums`.

    Notes
    -----
    The sums are over sample numbers, which are exact; times are put in at the end. At 1e9 s a time stamp keeps 1e-7 s;
    the slope here keeps all its digits (``test_even_time_keeps_every_digit_at_a_billion_seconds``).

    Examples
    --------
    >>> t = TimeLine(1000.0, start_s=1e9)
    >>> t.push([0.0, 0.002, 0.004])
    >>> round(t.fit().slope, 12)
    2.0
    """

    __slots__ = ("_origin",)
    _origin: tuple[float, float]

    def __new__(cls, sample_rate_hz: float = 1.0, *, start_s: float = 0.0, forgetting: float = 1.0) -> TimeLine:  # noqa: D102
        made = super().__new__(cls, forgetting=number("forgetting", forgetting))
        rate, start = number("sample_rate_hz", sample_rate_hz), number("start_s", start_s)
        if not (0.0 < rate < np.inf and np.isfinite(start)):
            raise ParameterError(
                f"sample_rate_hz is {rate}, start_s {start}", "TimeLine", "Give a positive rate and a finite start."
            )
        made._origin = (start, rate)
        return made

    def push(self, y: Any) -> None:
        """Add samples: array_like of shape (n,), n >= 0, finite, of magnitude up to 1e150."""
        self.push_series(y)

    def fit(self) -> Line:
        """Return the line over time in seconds; raises ParameterError below two samples."""
        start, rate = self._origin
        return _line(self.figures_over(start, 1.0 / rate))

    def __getstate__(self) -> tuple[list[int], list[float]]:
        integers, numbers = self.state()
        return integers, [*self._origin, *numbers]

    def __setstate__(self, state: tuple[list[int], list[float]]) -> None:
        integers, numbers = state
        if len(numbers) < 2:
            raise ParameterError("state holds too few numbers", "state", "Store it anew.")
        self.restore(integers, numbers[2:])
        self._origin = (numbers[0], numbers[1])

    def __repr__(self) -> str:
        return f"<luztar.regression.TimeLine: {self.count} samples at {self._origin[1]:g} Hz>"


def time_line(y: Any, sample_rate_hz: float, *, start_s: float = 0.0) -> Line:
    """Fit a straight line to evenly sampled values over time.

    Parameters
    ----------
    y : array_like, shape (n,), any unit
        n >= 2, finite.
    sample_rate_hz : float
    start_s : float [s]
        The time of the first sample.

    Returns
    -------
    Line
        Slope per second; its ``predict`` takes times.

    Examples
    --------
    >>> round(time_line([1.0, 1.5, 2.0], 10.0).slope, 12)
    5.0
    """
    stream = TimeLine(sample_rate_hz, start_s=start_s)
    stream.push(vector("y", y, minimum=2))
    return stream.fit()
