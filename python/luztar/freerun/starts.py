"""Where the searches start: grids over what a local search would not find, the rest as known so far."""

from __future__ import annotations

import itertools
from collections.abc import Mapping

import numpy as np

from .parameters import Parameters


def first_starts(parameters: Parameters) -> np.ndarray:
    """Return starts where nothing is known yet, shape (starts, free)."""
    sizes = dict(zip(parameters.free, parameters.scale, strict=True))
    return _product(parameters, _from_model(parameters), parameters.plant.structure_grid, sizes)


def starts_with(parameters: Parameters, found: Mapping[str, float], effect: str) -> np.ndarray:
    """Return starts for a model in which one effect is new, shape (starts, free).

    Parameters
    ----------
    parameters : Parameters
        Of the model with the effect.
    found : mapping
        The values of the model without it.
    effect : str
    """
    base = _from_model(parameters)
    sizes = dict(zip(parameters.free, parameters.scale, strict=True))
    for i, key in enumerate(parameters.free):
        if key in found:
            base[i] = found[key]
    sizes |= {k: v for k, v in parameters.plant.sizes_for(effect, found).items() if k in sizes}
    made = _product(parameters, base, parameters.plant.grids.get(effect, {}), sizes)
    # As it was, with next to nothing of the effect: never worse than without it.
    return np.vstack([made, parameters.inside(_next_to_nothing(parameters, base, effect))])


def _next_to_nothing(parameters: Parameters, base: np.ndarray, effect: str) -> np.ndarray:
    out = base.copy()
    for i, key in enumerate(parameters.free):
        nothing = parameters.plant.nothing(key, float(parameters.scale[i]))
        if key.startswith(f"{effect}.") and nothing is not None:
            out[i] = nothing
    return out


def _from_model(parameters: Parameters) -> np.ndarray:
    """Return the model's start values; what has none stands at its size if the structure needs it, else at 0."""
    out = np.zeros(len(parameters.free))
    for i, key in enumerate(parameters.free):
        whole = parameters.plant.whole(key)
        out[i] = parameters.model.start.get(key, parameters.scale[i] if whole else 0.0)
    return parameters.inside(out)


def _product(
    parameters: Parameters,
    base: np.ndarray,
    grid: Mapping[str, tuple[float, ...]],
    sizes: Mapping[str, float],
) -> np.ndarray:
    keys = [k for k in grid if k in parameters.free and k not in parameters.model.start]
    rows = []
    for shares in itertools.product(*(grid[k] for k in keys)):
        row = base.copy()
        for key, share in zip(keys, shares, strict=True):
            row[parameters.free.index(key)] = share * sizes[key]
        rows.append(row)
    return parameters.inside(np.array(rows))
