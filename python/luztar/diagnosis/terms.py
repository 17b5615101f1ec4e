"""The effects of a model with values for their inner parameters: what the core's columns are made from."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from types import MappingProxyType

import numpy as np

from ..model import Model, card
from ..model.cards import Parameter
from .prepare import Prepared

# Points of a search grid. Speeds, travels and times are searched geometrically: a factor of 1.3 between points loses
# less than 1 % of the effect's power before the refinement.
_POINTS = {"speed": 14, "travel": 20, "time": 7, "delay": 20, "place": 13, "width": 5, "resolution": 7}

# A travel below this many steps of the position sensor is no travel to speak of.
SHOWN_STEPS = 2.5


@dataclass(frozen=True)
class Terms:
    """Effects in order, with the values of their inner parameters.

    Attributes
    ----------
    effects : tuple of str
    inner : mapping of str to tuple of float
        Values for the effects that have inner parameters, in the order of their cards.
    """

    effects: tuple[str, ...]
    inner: Mapping[str, tuple[float, ...]]

    def __post_init__(self) -> None:
        object.__setattr__(self, "inner", MappingProxyType(dict(self.inner)))

    def pairs(self) -> list[tuple[str, list[float]]]:
        """Return the terms as the core takes them."""
        return [(name, list(self.inner.get(name, ()))) for name in self.effects]

    def having(self, name: str, values: tuple[float, ...]) -> Terms:
        """Return the same terms with other inner values for one effect, which is appended where it is new."""
        effects = self.effects if name in self.effects else (*self.effects, name)
        inner = {**self.inner, name: values} if values else dict(self.inner)
        return Terms(effects, inner)


def shapes_contact(name: str) -> bool:
    """Whether an effect changes the columns of others: the friction state or the delay."""
    return name in ("presliding", "freeplay", "delay", "coulomb")


def start_terms(model: Model, runs: Sequence[Prepared]) -> Terms:
    """Return a model's terms with start values: the user's, else the middle of the search grid."""
    inner = {}
    for name in model.effects:
        parameters = card(name, model.structure_name).inner
        if not parameters:
            continue
        values = []
        for p in parameters:
            key = f"{name}.{p.key}"
            given = model.known.get(key, model.start.get(key))
            points = grid(p, runs)
            values.append(float(points[len(points) // 2]))
            if given is not None:
                values[-1] = float(given)
        inner[name] = tuple(values)
    return Terms(model.effects, inner)


def least_travel(runs: Sequence[Prepared]) -> float:
    """Return the smallest gap or break-away that a position sensor shows: a smaller one is a sharp break-away."""
    step = max(r.recording.resolution for r in runs)
    reach = max(r.recording.range for r in runs)
    return min(SHOWN_STEPS * step, 0.005 * reach)


def grid(parameter: Parameter, runs: Sequence[Prepared]) -> np.ndarray:
    """Return the values at which an inner parameter is searched, from what the runs can show."""
    word, number = parameter.grid if parameter.grid else ("", 0.0)
    reach = max(r.recording.range for r in runs)
    step = max(r.recording.resolution for r in runs)
    low, high = min(float(r.motion.min()) for r in runs), max(float(r.motion.max()) for r in runs)
    top_speed = max(float(np.abs(r.speed).max()) for r in runs)
    points = _POINTS.get(word, 0)
    match word:
        case "speed":
            # The slowest speed worth a law of its own: 1 % of the top speed, or what moves ten steps per second.
            return np.geomspace(max(0.015 * top_speed, 10 * step), 0.7 * top_speed, points)
        case "travel":
            return np.geomspace(least_travel(runs), number * reach, points)
        case "resolution":
            return step * np.geomspace(0.03, 2.0, points)
        case "place":
            return np.linspace(low, high, points + 2)[1:-1]
        case "width":
            return np.geomspace(0.02, 0.2, points) * reach
        case "time":
            return np.geomspace(2.0, max(4.0, max(r.duration_s for r in runs)), points)
        case "delay":
            return np.linspace(parameter.high / points, parameter.high, points)
        case "count":
            return np.arange(parameter.low, parameter.high + 0.5)
        case "shape":
            return np.array([0.0, 1.0])
        case "waves_per_range":
            return np.array([2.0 * math.pi * number / reach])
    raise AssertionError(f"no grid for {parameter.key}")


def inner_grid(name: str, model: Model, runs: Sequence[Prepared]) -> list[tuple[float, ...]]:
    """Return every combination of an effect's inner values to try; one empty tuple where it has none."""
    combinations: list[tuple[float, ...]] = [()]
    for p in card(name, model.structure_name).inner:
        known = model.known.get(f"{name}.{p.key}")
        points = grid(p, runs) if known is None else np.array([known])
        combinations = [(*c, float(v)) for c in combinations for v in points]
    return combinations
