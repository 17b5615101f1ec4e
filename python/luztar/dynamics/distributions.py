"""Distributions of parameters, each by its quantiles: a number in (0, 1) in, a value out."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from .._arrays import number, vector
from ..errors import ParameterError


@dataclass(frozen=True)
class Uniform:
    """Evenly between ``low`` and ``high``."""

    low: float
    high: float

    def __post_init__(self) -> None:
        _finite("uniform", self.low, self.high)
        if not self.low < self.high:
            raise ParameterError(f"uniform from {self.low:g} to {self.high:g}", "uniform", "Give low < high.")

    def quantiles(self, shares: np.ndarray) -> np.ndarray:
        """Return the values below which these shares of the distribution lie."""
        return self.low + (self.high - self.low) * shares


@dataclass(frozen=True)
class Normal:
    """Normal, cut off below ``low`` and above ``high``: friction is never negative."""

    mean: float
    std: float
    low: float = -math.inf
    high: float = math.inf

    def __post_init__(self) -> None:
        _finite("normal", self.mean, self.std)
        if not self.std > 0.0:
            raise ParameterError(f"a standard deviation of {self.std:g}", "normal", "Give one above 0, or a number.")
        from scipy.special import ndtr

        below, above = ndtr((self.low - self.mean) / self.std), ndtr((self.high - self.mean) / self.std)
        if not below < above:
            remedy = "Give low < high, not far out in one tail."
            raise ParameterError(f"nothing is left from {self.low:g} to {self.high:g}", "normal", remedy)

    def quantiles(self, shares: np.ndarray) -> np.ndarray:
        """Return the values below which these shares of the distribution lie."""
        from scipy.special import ndtr, ndtri

        below, above = ndtr((self.low - self.mean) / self.std), ndtr((self.high - self.mean) / self.std)
        made = self.mean + self.std * ndtri(below + (above - below) * shares)
        # The last rounding may lie beyond an edge.
        return np.clip(made, self.low, self.high)


@dataclass(frozen=True)
class LogNormal:
    """A value whose logarithm is normal: half of it lies below ``median``, ``sigma`` is the logarithm's deviation."""

    median: float
    sigma: float

    def __post_init__(self) -> None:
        _finite("lognormal", self.median, self.sigma)
        if not (self.median > 0.0 and self.sigma > 0.0):
            raise ParameterError(
                f"a median of {self.median:g} and a sigma of {self.sigma:g}", "lognormal", "Give both > 0."
            )

    def quantiles(self, shares: np.ndarray) -> np.ndarray:
        """Return the values below which these shares of the distribution lie."""
        from scipy.special import ndtri

        return self.median * np.exp(self.sigma * ndtri(shares))


@dataclass(frozen=True)
class Choice:
    """One of some values, with these weights or equally often."""

    values: Sequence[float]
    weights: Sequence[float] | None = None

    def __post_init__(self) -> None:
        values = vector("choice", self.values)
        weights = np.ones(values.size) if self.weights is None else vector("weights", self.weights)
        if weights.size != values.size or (weights < 0.0).any() or not weights.sum() > 0.0:
            remedy = "Give one weight >= 0 for each value, not all 0."
            raise ParameterError(f"{values.size} values with weights that do not fit", "choice", remedy)

    def quantiles(self, shares: np.ndarray) -> np.ndarray:
        """Return the values below which these shares of the distribution lie."""
        values = vector("choice", self.values)
        weights = np.ones(values.size) if self.weights is None else vector("weights", self.weights)
        edges = np.cumsum(weights) / weights.sum()
        return values[np.searchsorted(edges[:-1], shares, side="right")]


Distribution = Uniform | Normal | LogNormal | Choice
NAMES: Mapping[str, type] = {"uniform": Uniform, "normal": Normal, "lognormal": LogNormal, "choice": Choice}


def distribution(key: str, given: Any) -> Distribution | float:
    """Return a distribution as it stands in a file or a call: a number is fixed.

    ``{"uniform": [4, 12]}``, ``{"normal": {"mean": 8, "std": 1, "low": 0}}``, ``{"choice": [[0.0, 0.1], [3, 1]]}``.

    Raises
    ------
    ParameterError
        Names the parameter.
    """
    if isinstance(given, Distribution):
        return given
    if not isinstance(given, Mapping):
        value = number(key, given)
        _finite(key, value)
        return value
    if len(given) != 1 or not set(given) <= {*NAMES, "fixed"}:
        known = ", ".join((*NAMES, "fixed"))
        raise ParameterError(
            f"{key} is {dict(given)}", key, f'Give a number or one of {known}: {{"uniform": [4, 12]}}.'
        )
    ((name, values),) = given.items()
    if name == "fixed":
        return distribution(key, values)
    try:
        if name == "choice" and not isinstance(values, Mapping) and np.ndim(values[0]) == 0:
            return Choice(values)
        return NAMES[name](**values) if isinstance(values, Mapping) else NAMES[name](*values)
    except ParameterError as error:
        raise ParameterError(error.kind, key, error.remedy) from None
    except (TypeError, IndexError):
        raise ParameterError(f"{key} is {dict(given)}", key, f"{name} is: {NAMES[name].__doc__}") from None


def _finite(name: str, *values: Any) -> None:
    for value in values:
        if not math.isfinite(number(name, value)):
            raise ParameterError(f"{name} holds {value}", name, "Give finite numbers.")
