"""The parameters of a free-run fit: which are free, their scales and bounds, how far each is varied."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from ..model import Model, card
from .plant import Plant

# A step of the numerical derivative, as a share of the parameter's scale: well above what the simulation leaves of
# rounding, well below what bends the answer.
STEP_SHARE = 1e-3
# No search goes further than this many sizes.
MOST_SIZES = 1e3


@dataclass(frozen=True)
class Parameters:
    """The parameters of one model.

    Attributes
    ----------
    plant : Plant
    model : Model
    free : tuple of str
        Keys that are estimated.
    scale, low, high : ndarray, shape (len(free),)
        Size that counts as large, and bounds.
    """

    plant: Plant
    model: Model
    free: tuple[str, ...]
    scale: np.ndarray
    low: np.ndarray
    high: np.ndarray

    def by_key(self, values: np.ndarray) -> dict[str, np.ndarray]:
        """Return value sets, shape (lanes, len(free)), by key, the known ones included."""
        known = {k: np.full(len(values), v) for k, v in self.model.known.items()}
        return {**known, **{k: values[:, i] for i, k in enumerate(self.free)}}

    def inside(self, values: np.ndarray) -> np.ndarray:
        """Return values moved inside the bounds."""
        return np.clip(values, self.low, self.high)

    def values_of(self, values: np.ndarray) -> dict[str, float]:
        """Return one value set by key, the known ones included, in the order of the model."""
        found = {**self.model.known, **dict(zip(self.free, map(float, values), strict=True))}
        return {key: found[key] for key in self.plant.keys(self.model)}


def parameters_of(plant: Plant, model: Model, sizes: Mapping[str, float]) -> Parameters:
    """Return the parameters of a model.

    Parameters
    ----------
    plant : Plant
    model : Model
    sizes : mapping
        What is large for each key, from :meth:`Plant.sizes`.

    Raises
    ------
    ModelError
        Where the model lacks what the channels cannot show.
    """
    plant.require(model)
    free = tuple(key for key in plant.keys(model) if key not in model.known)
    low, high = [], []
    for key in free:
        effect, _, name = key.partition(".")
        p = next(p for p in card(effect, model.structure_name).parameters if p.key == name)
        share = plant.least_share.get(key)
        least = share * sizes[key] if share is not None else max(p.low, 0.0) if key in plant.one_sided else p.low
        low.append(least)
        high.append(min(p.high, MOST_SIZES * sizes[key]))
    scale = np.array([sizes[key] for key in free])
    bound = np.maximum(np.array(low, float), -MOST_SIZES * scale)
    return Parameters(plant, model, free, scale, bound, np.array(high, float))


def step_of(parameters: Parameters, values: np.ndarray) -> np.ndarray:
    """Return the step of the numerical derivative per parameter, pointing inside the bounds."""
    step = STEP_SHARE * np.maximum(np.abs(values), parameters.scale)
    return np.where(values + step > parameters.high, -step, step)
