"""Confidence intervals from standard errors."""

from __future__ import annotations

from typing import Any

from .._arrays import number
from ..errors import ParameterError


def level_of(level: Any) -> float:
    """Return a confidence level inside (0, 1).

    Raises
    ------
    ParameterError
        Not a number, or outside.
    """
    level = number("level", level)
    if not 0.0 < level < 1.0:
        raise ParameterError(f"level is {level}", "level", "Give a share between 0 and 1, for instance 0.95.")
    return level


def student_quantile(level: float, degrees_of_freedom: float) -> float:
    """Return how many standard errors a two-sided interval reaches to each side (Student's t)."""
    from scipy.special import stdtrit

    return float(stdtrit(degrees_of_freedom, 0.5 + 0.5 * level_of(level)))


def normal_quantile(level: float) -> float:
    """Return how many standard deviations a two-sided interval reaches to each side (normal)."""
    from statistics import NormalDist

    return NormalDist().inv_cdf(0.5 + 0.5 * level_of(level))


def around(value: float, error: float | None, level: float, degrees_of_freedom: float) -> tuple[float, float] | None:
    """Return the interval around a value; None where there is no standard error."""
    if error is None:
        level_of(level)
        return None
    half = student_quantile(level, degrees_of_freedom) * error
    return (value - half, value + half)
