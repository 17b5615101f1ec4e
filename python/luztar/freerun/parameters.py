"""The parameters of a free-run fit: which are free, their scales and bounds, how far each is varied."""

from __future__ import annotations

from collections.abc import Collection, Mapping
from dataclasses import dataclass

import numpy as np

from .. import _core
from ..dynamics import COLUMNS
from ..errors import ModelError
from ..model import Model, card

# A step of the numerical derivative, as a share of the parameter's scale: well above what the simulation leaves of
# rounding, well below what bends the answer.
STEP_SHARE = 1e-3
SENSOR_KEYS = ("delay.time_s", "offset.level_rad")
# Free to have either sign, or bounded by another parameter, beyond what the card says.
SCALE_SETTERS = ("steering.inertia_kg_m2", "steering.stiffness_nm_per_rad", "steering.aligning_nm_per_rad")


# What must be above 0, and how far below its size the search goes. The size of the inertia belongs to an oscillation of
# 6 Hz: a fiftieth of it to 42 Hz, beyond which an angle shows nothing of it and the simulation needs ever more steps.
LEAST_SHARE: Mapping[str, float] = {
    "steering.inertia_kg_m2": 0.02,
    "steering.stiffness_nm_per_rad": 1e-3,
    "stribeck.speed_rad_s": 1e-3,
    "dwell.time_s": 1e-2,
    "presliding.breakaway_rad": 0.02,
}


@dataclass(frozen=True)
class Parameters:
    """The parameters of one model.

    Attributes
    ----------
    model : Model
    free : tuple of str
        Keys that are estimated.
    scale, low, high : ndarray, shape (len(free),)
        Size that counts as large, and bounds.
    columns : dict of str to int
        Column of the core per key; sensor parameters have none.
    """

    model: Model
    free: tuple[str, ...]
    scale: np.ndarray
    low: np.ndarray
    high: np.ndarray
    columns: Mapping[str, int]

    def rows(self, values: np.ndarray) -> tuple[np.ndarray, dict[str, np.ndarray]]:
        """Return the core's rows for value sets, shape (lanes, len(free)), and the sensor parameters per lane."""
        rows = np.zeros((len(values), len(self.columns)))
        sensors: dict[str, np.ndarray] = {}
        for key in (*self.model.known, *self.free):
            given = values[:, self.free.index(key)] if key in self.free else np.full(len(values), self.model.known[key])
            if key in SENSOR_KEYS:
                sensors[key] = given
            else:
                rows[:, self.columns[key]] = given
        at = self.columns
        # A step of a derivative or a trial may ask for friction that drives: the nearest that does not.
        coulomb = rows[:, at["coulomb.level_nm"]]
        for key, limit in (
            ("asymmetric_coulomb.difference_nm", coulomb),
            ("asymmetric_viscous.difference_nm_s_per_rad", rows[:, at["viscous.coefficient_nm_s_per_rad"]]),
        ):
            rows[:, at[key]] = np.clip(rows[:, at[key]], -limit, limit)
        least = coulomb - np.abs(rows[:, at["asymmetric_coulomb.difference_nm"]])
        rows[:, at["stribeck.extra_nm"]] = np.maximum(rows[:, at["stribeck.extra_nm"]], -least)
        return rows, sensors

    def inside(self, values: np.ndarray) -> np.ndarray:
        """Return values moved inside the bounds."""
        return np.clip(values, self.low, self.high)

    def values_of(self, values: np.ndarray) -> dict[str, float]:
        """Return one value set by key, the known ones included, in the order of the model."""
        found = {**self.model.known, **dict(zip(self.free, map(float, values), strict=True))}
        return {key: found[key] for key in keys_of(self.model)}


def keys_of(model: Model) -> tuple[str, ...]:
    """Return the keys of all parameters of a model, those of the structure first."""
    own = card(model.structure_name, model.structure_name)
    cards = (own, *(card(e, model.structure_name) for e in model.effects))
    return tuple(f"{c.name}.{p.key}" for c in cards for p in c.parameters)


# On an elastic contact nothing is at rest: what is felt at rest only is no part of it.
APART: tuple[frozenset[str], ...] = (frozenset({"presliding", "stiction"}), frozenset({"presliding", "dwell"}))


def are_apart(effects: Collection[str]) -> bool:
    """Return whether two of some effects exclude each other in a free run."""
    return any(pair <= set(effects) for pair in APART)


def require_one_contact(model: Model) -> None:
    """Refuse a model whose contact is elastic and rigid at once.

    Raises
    ------
    ModelError
    """
    if are_apart(model.effects):
        others = " and ".join(e for e in ("stiction", "dwell") if e in model.effects)
        remedy = f"Take out presliding or {others}; stribeck goes with presliding."
        raise ModelError(f"presliding leaves nothing at rest, where {others} is felt", "effects", remedy)


def require_scale(model: Model) -> None:
    """Refuse a model whose torques have no scale: angles alone do not show it.

    Raises
    ------
    ModelError
    """
    if "steering.ratio" not in model.known:
        raise ModelError("the ratio is not given", "known", "Give steering.ratio: angles alone do not determine it.")
    if not any(key in model.known for key in SCALE_SETTERS):
        remedy = "Give one of steering.stiffness_nm_per_rad, steering.inertia_kg_m2, steering.aligning_nm_per_rad."
        raise ModelError("nothing sets the scale of the torques; angles alone do not show it", "known", remedy)


def parameters_of(model: Model, sizes: Mapping[str, float]) -> Parameters:
    """Return the parameters of a model.

    Parameters
    ----------
    model : Model
    sizes : mapping
        What is large for each key, from :func:`luztar.freerun.sizes.sizes_of`.
    """
    require_scale(model)
    require_one_contact(model)
    names = _core.steering_parameters()
    columns = {key: names.index(column) for key, column in COLUMNS.items()}
    free = tuple(key for key in keys_of(model) if key not in model.known)
    low, high = [], []
    for key in free:
        effect, _, name = key.partition(".")
        p = next(p for p in card(effect, model.structure_name).parameters if p.key == name)
        share = LEAST_SHARE.get(key)
        least = share * sizes[key] if share is not None else max(p.low, 0.0) if _one_sided(key) else p.low
        low.append(least)
        high.append(min(p.high, 1e3 * sizes[key]))
    scale = np.array([sizes[key] for key in free])
    return Parameters(
        model,
        free,
        scale,
        np.maximum(np.array(low, float), -1e3 * scale),
        np.array(high, float),
        columns,
    )


def _one_sided(key: str) -> bool:
    """Whether a free run allows only one sign: static friction below the kinetic one never holds a body."""
    return key in (
        "coulomb.level_nm",
        "viscous.coefficient_nm_s_per_rad",
        "stiction.extra_nm",
        "dwell.extra_nm",
        "freeplay.gap_rad",
    )


def step_of(parameters: Parameters, values: np.ndarray) -> np.ndarray:
    """Return the step of the numerical derivative per parameter, pointing inside the bounds."""
    step = STEP_SHARE * np.maximum(np.abs(values), parameters.scale)
    return np.where(values + step > parameters.high, -step, step)
