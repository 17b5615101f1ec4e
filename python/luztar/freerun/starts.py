"""Where the searches start: grids over what a local search would not find, the rest as known so far."""

from __future__ import annotations

import itertools
import math
from collections.abc import Mapping

import numpy as np

from .parameters import Parameters

# Shares of the sizes. A gap or a break-away moves events: the loss over it has several valleys.
GRIDS: Mapping[str, Mapping[str, tuple[float, ...]]] = {
    "freeplay": {"freeplay.gap_rad": (0.1, 0.4, 1.0, 2.0, 4.0)},
    "coulomb": {"coulomb.level_nm": (0.03, 0.1, 0.3, 1.0)},
    "stiction": {"coulomb.level_nm": (0.2, 0.5, 0.8, 1.0), "stiction.extra_nm": (0.1, 0.3, 0.6, 1.0)},
    "stribeck": {
        "coulomb.level_nm": (0.6, 0.95),
        "stribeck.extra_nm": (-0.3, 0.3, 0.8),
        "stribeck.speed_rad_s": (0.1, 1.0, 4.0),
    },
    "hardening": {"hardening.coefficient_nm_per_rad3": (-0.05, 0.05, 0.5)},
    "drag": {"drag.coefficient_nm_s2_per_rad2": (0.1, 0.6)},
    "asymmetric_coulomb": {"asymmetric_coulomb.difference_nm": (-0.3, 0.3)},
    "asymmetric_viscous": {"asymmetric_viscous.difference_nm_s_per_rad": (-0.3, 0.3)},
    "end_stop": {
        "end_stop.stiffness_nm_per_rad": (0.1, 1.0),
        "end_stop.limit_rad": (0.7, 0.85, 0.95),
    },
    "once_per_rev": {
        "once_per_rev.amplitude_nm": (0.3,),
        "once_per_rev.phase_rad": (-0.5 * math.pi, 0.0, 0.5 * math.pi, 0.95 * math.pi),
    },
    "presliding": {"presliding.breakaway_rad": (0.2, 1.0, 4.0), "presliding.shape": (0.0, 1.0)},
    "dwell": {"dwell.extra_nm": (0.3, 1.0), "dwell.time_s": (0.3, 1.0, 4.0)},
    "delay": {"delay.time_s": (0.1, 1.0, 4.0)},
    "offset": {"offset.level_rad": (0.0,)},
}
# What is no amount of an effect: it stands at its size until it is searched.
WHOLE = ("stribeck.speed_rad_s", "dwell.time_s", "end_stop.limit_rad", "presliding.breakaway_rad", "cogging.per_turn")
# Where an effect does next to nothing, as a share of the size.
NOTHING: Mapping[str, float] = {"presliding.breakaway_rad": 0.05}
STRUCTURE_GRID: Mapping[str, tuple[float, ...]] = {
    "steering.inertia_kg_m2": (0.3, 1.0, 3.0),
    "viscous.coefficient_nm_s_per_rad": (0.3, 1.0, 3.0),
}


def first_starts(parameters: Parameters) -> np.ndarray:
    """Return starts where nothing is known yet, shape (starts, free)."""
    sizes = dict(zip(parameters.free, parameters.scale, strict=True))
    return _product(parameters, _from_model(parameters), STRUCTURE_GRID, sizes)


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
    level = found.get("coulomb.level_nm", 0.0)
    if effect in ("stiction", "stribeck", "asymmetric_coulomb") and level > 0.0:
        # The level found so far stands between kinetic and static friction.
        for key in ("coulomb.level_nm", "stiction.extra_nm", "stribeck.extra_nm", "asymmetric_coulomb.difference_nm"):
            if key in sizes:
                sizes[key] = level
    if effect == "asymmetric_viscous":
        sizes["asymmetric_viscous.difference_nm_s_per_rad"] = found.get("viscous.coefficient_nm_s_per_rad", 1.0)
    made = _product(parameters, base, GRIDS.get(effect, {}), sizes)
    # As it was, with next to nothing of the effect: never worse than without it.
    return np.vstack([made, parameters.inside(_next_to_nothing(parameters, base, effect))])


def _next_to_nothing(parameters: Parameters, base: np.ndarray, effect: str) -> np.ndarray:
    out = base.copy()
    for i, key in enumerate(parameters.free):
        if key in NOTHING:
            out[i] = NOTHING[key] * parameters.scale[i]
        elif key.startswith(f"{effect}.") and key not in WHOLE:
            out[i] = 1e-3 * parameters.scale[i]
    return out


def _from_model(parameters: Parameters) -> np.ndarray:
    """Return the model's start values; what has none stands at its size if the structure needs it, else at 0."""
    out = np.zeros(len(parameters.free))
    for i, key in enumerate(parameters.free):
        whole = key.startswith(("steering.", "viscous.")) or key in WHOLE
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
