"""The effects of a model with values for their inner parameters: what the core's columns are made from."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from types import MappingProxyType

import numpy as np

from .._stream import Mappings
from ..model import Model, card
from .grids import is_continuous, points
from .prepare import Prepared


@dataclass(frozen=True)
class Terms(Mappings):
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
            tried = points(p, runs)
            values.append(float(tried[len(tried) // 2]))
            if given is not None:
                # Of a count the nearest that there is.
                snap = key not in model.known and not is_continuous(p)
                values[-1] = float(tried[np.argmin(np.abs(tried - given))]) if snap else float(given)
        inner[name] = tuple(values)
    return Terms(model.effects, inner)


def inner_grid(name: str, model: Model, runs: Sequence[Prepared]) -> list[tuple[float, ...]]:
    """Return every combination of an effect's inner values to try; one empty tuple where it has none."""
    combinations: list[tuple[float, ...]] = [()]
    for p in card(name, model.structure_name).inner:
        key = f"{name}.{p.key}"
        known = model.known.get(key)
        tried = points(p, runs) if known is None else np.array([known])
        if key in model.start and is_continuous(p):
            # Beside the grid and not in its place: a poor start must not keep the search from a better valley.
            tried = np.unique(np.append(tried, model.start[key]))
        combinations = [(*c, float(v)) for c in combinations for v in tried]
    return combinations
