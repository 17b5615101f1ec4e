"""Many parameter sets at the door of the core: rows of columns, starts, rates, methods."""

from __future__ import annotations

import math
from collections.abc import Mapping
from types import MappingProxyType
from typing import Any

import numpy as np

from .. import _core
from .._arrays import number
from ..errors import ParameterError

# Key as in model files and JSON: column of the core.
COLUMNS: Mapping[str, str] = MappingProxyType(
    {
        "steering.inertia_kg_m2": "inertia_kg_m2",
        "steering.ratio": "ratio",
        "steering.stiffness_nm_per_rad": "stiffness_nm_per_rad",
        "steering.aligning_nm_per_rad": "aligning_nm_per_rad",
        "freeplay.gap_rad": "gap_rad",
        "hardening.coefficient_nm_per_rad3": "hardening_nm_per_rad3",
        "viscous.coefficient_nm_s_per_rad": "viscous_nm_s_per_rad",
        "asymmetric_viscous.difference_nm_s_per_rad": "asymmetric_viscous_nm_s_per_rad",
        "drag.coefficient_nm_s2_per_rad2": "drag_nm_s2_per_rad2",
        "coulomb.level_nm": "coulomb_nm",
        "asymmetric_coulomb.difference_nm": "asymmetric_coulomb_nm",
        "stribeck.extra_nm": "stribeck_nm",
        "stribeck.speed_rad_s": "stribeck_speed_rad_s",
        "stiction.extra_nm": "stiction_nm",
        "end_stop.stiffness_nm_per_rad": "end_stop_nm_per_rad",
        "end_stop.limit_rad": "end_stop_limit_rad",
        "dead_zone.stiffness_nm_per_rad": "dead_zone_nm_per_rad",
        "dead_zone.half_width_rad": "dead_zone_half_width_rad",
        "once_per_rev.amplitude_nm": "once_per_rev_nm",
        "once_per_rev.phase_rad": "once_per_rev_phase_rad",
        "twice_per_rev.amplitude_nm": "twice_per_rev_nm",
        "twice_per_rev.phase_rad": "twice_per_rev_phase_rad",
        "cogging.amplitude_nm": "cogging_nm",
        "cogging.phase_rad": "cogging_phase_rad",
        "cogging.per_turn": "cogging_per_turn",
        "position_coulomb.slope_nm_per_rad": "position_coulomb_nm_per_rad",
        "tight_spot.extra_nm": "tight_spot_nm",
        "tight_spot.angle_rad": "tight_spot_angle_rad",
        "tight_spot.width_rad": "tight_spot_width_rad",
        "load.coefficient": "load_coefficient",
        "dwell.extra_nm": "dwell_nm",
        "dwell.time_s": "dwell_time_s",
        "presliding.breakaway_rad": "presliding_breakaway_rad",
        "presliding.shape": "presliding_shape",
        "lugre.breakaway_rad": "lugre_breakaway_rad",
        "lugre.damping_nm_s_per_rad": "lugre_damping_nm_s_per_rad",
    }
)
METHODS = ("split", "moreau_jean")


def columns(parameters: Mapping[str, Any]) -> dict[str, np.ndarray]:
    """Return parameters by the core's names, each a number or one per lane.

    Raises
    ------
    ParameterError
        Names the parameter.
    """
    values: dict[str, np.ndarray] = {}
    for key, value in parameters.items():
        if key not in COLUMNS:
            raise ParameterError(f"there is no parameter '{key}'", "parameters", f"Known are: {', '.join(COLUMNS)}.")
        try:
            array = np.asarray(value, dtype=np.float64)
        except (TypeError, ValueError):
            raise ParameterError(f"{key} is {value!r}", key, "Give a number, or one per lane.") from None
        if array.ndim > 1:
            raise ParameterError(f"{key} has the shape {array.shape}", key, "Give a number, or one per lane.")
        values[COLUMNS[key]] = array
    for needed in ("steering.inertia_kg_m2", "steering.ratio", "steering.stiffness_nm_per_rad"):
        if COLUMNS[needed] not in values:
            raise ParameterError(f"{needed} is missing", "parameters", "Give inertia, ratio and stiffness.")
    return values


def agreed(sizes: Mapping[str, int]) -> int:
    """Return the number of lanes that all arguments agree on; 1 where none has lanes.

    Raises
    ------
    ParameterError
        Names the argument.
    """
    lanes = max(sizes.values(), default=1)
    for key, size in sizes.items():
        if size != lanes:
            raise ParameterError(f"{key} has {size} values, others {lanes}", key, "Give one value per lane.")
    if lanes == 0:
        raise ParameterError("there are no lanes", "parameters", "Give at least one value.")
    return lanes


def rows(values: Mapping[str, np.ndarray], index: np.ndarray) -> np.ndarray:
    """Return some lanes as rows of the core's columns."""
    names = _core.steering_parameters()
    made = np.zeros((index.size, len(names)))
    for i, name in enumerate(names):
        if name in values:
            made[:, i] = values[name][index] if values[name].ndim else values[name]
    return made


def table(parameters: Mapping[str, Any]) -> tuple[np.ndarray, bool]:
    """Return parameters as rows of the core's columns, and whether they are many.

    Raises
    ------
    ParameterError
        Names the parameter.
    """
    values = columns(parameters)
    sizes = {key: a.size for key, a in values.items() if a.ndim == 1}
    return rows(values, np.arange(agreed(sizes))), bool(sizes)


def rate(sample_rate_hz: Any) -> float:
    """Return a sample rate that is positive and finite."""
    value = number("sample_rate_hz", sample_rate_hz)
    if not (math.isfinite(value) and value > 0.0):
        raise ParameterError(f"sample_rate_hz is {value}", "sample_rate_hz", "Give a positive number of Hz.")
    return value


def require_bounded(index: np.ndarray, values: np.ndarray) -> None:
    """Refuse lanes whose results, one row each, are not finite.

    The longest step follows from the springs at rest; what grows with the speed may ask for a shorter one.
    """
    # A sum of finite numbers is finite, short of the end of the doubles.
    wrong = np.flatnonzero(~np.isfinite(values.sum(axis=1)))
    if wrong.size:
        raise ParameterError(
            f"the motion of lane {index[wrong[0]]} grows beyond all bounds",
            "substeps",
            "Take more substeps: drag at this speed, or a hardening spring, asks for a shorter step.",
        )


def check_method(method: str) -> None:
    """Refuse a method that is not there."""
    if method not in METHODS:
        raise ParameterError(f"there is no method {method!r}", "method", f"Known are: {', '.join(METHODS)}.")


def starts(lanes: int, angle_rad: Any, speed_rad_s: Any) -> np.ndarray:
    """Return angle and speed at the start, one row per lane."""
    rows = np.zeros((lanes, 2))
    for column, (name, value) in enumerate((("start_rad", angle_rad), ("start_speed_rad_s", speed_rad_s))):
        try:
            array = np.asarray(value, dtype=np.float64)
        except (TypeError, ValueError):
            raise ParameterError(f"{name} is {value!r}", name, "Give a number, or one per lane.") from None
        if array.ndim > 1 or array.size not in (1, lanes):
            raise ParameterError(f"{name} has the shape {array.shape}", name, "Give a number, or one per lane.")
        rows[:, column] = array
    return rows
