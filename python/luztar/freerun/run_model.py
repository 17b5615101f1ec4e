"""Running a model whose every parameter is given along a handwheel angle."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import replace
from typing import Any

import numpy as np

from .. import _core
from .._arrays import vector
from ..dynamics import COLUMNS, Trace, trace
from ..dynamics.lanes import columns, rows
from ..errors import ModelError
from ..model import Model
from .parameters import keys_of

# As in fits: an error of 4e-5 in the frequency of the mechanism's own oscillation.
STEPS_PER_RADIAN = 30.0
# More than this is asked for by a mistake in a parameter: without them the step is refused with the spring's name.
MOST_SUBSTEPS = 10_000
# A few thousand rows of the core: memory does not grow with the lanes.
LANES_AT_ONCE = 4096
# An aligning torque and an effect that the model does not hold are nothing.
OPTIONAL = ("steering.aligning_nm_per_rad",)


def parameters_given(model: Model) -> dict[str, float]:
    """Return every parameter of a model, from ``known`` and ``start``.

    Raises
    ------
    ModelError
        Where the structure cannot be run freely, or a parameter has no value.
    """
    if not model.structure.is_free:
        remedy = 'Give a model file with structure = "steering".'
        raise ModelError(f"'{model.structure_name}' is driven: it cannot be simulated", "structure", remedy)
    given = {**model.start, **model.known}
    missing = [key for key in keys_of(model) if key not in given and key not in OPTIONAL]
    if missing:
        remedy = "Give every parameter in [known] or [start]."
        raise ModelError(f"no value for {', '.join(missing)}", "known", remedy)
    return {key: given[key] for key in keys_of(model) if key in given}


def substeps_for(physical: Mapping[str, Any], handwheel_rad: np.ndarray, sample_rate_hz: float) -> int:
    """Return the sub-steps that the stiffest of one or many mechanisms asks for.

    Raises
    ------
    ParameterError
        A mechanism that makes no sense, named.
    """
    given = columns(physical)
    lanes = max(a.size for a in given.values())
    wound, highest = float(np.abs(handwheel_rad).max()), 0.0
    for first in range(0, lanes, LANES_AT_ONCE):
        part = rows(given, np.arange(first, min(first + LANES_AT_ONCE, lanes)))
        highest = max(highest, float(np.max(_core.steering_highest_rad_s(part, wound, first))))
    steps = STEPS_PER_RADIAN * highest / sample_rate_hz
    return max(1, math.ceil(steps)) if steps <= MOST_SUBSTEPS else 1


def run_model(model: Model, handwheel_rad: Any, *, sample_rate_hz: float) -> Trace:
    """Run a steering model along a handwheel angle, sensor effects included.

    Parameters
    ----------
    model : Model
        Every parameter in ``known`` or ``start``.
    handwheel_rad : array_like, shape (n,)
    sample_rate_hz : float

    Returns
    -------
    Trace

    Raises
    ------
    ModelError, ParameterError
    """
    given = parameters_given(model)
    psi = vector("handwheel_rad", handwheel_rad, minimum=2)
    physical = {k: v for k, v in given.items() if k in COLUMNS}
    substeps = substeps_for(physical, psi, sample_rate_hz)
    made = trace(physical, psi, sample_rate_hz=sample_rate_hz, substeps=substeps)
    late, shift = given.get("delay.time_s", 0.0), given.get("offset.level_rad", 0.0)
    if late == 0.0 and shift == 0.0:
        return made
    seen = np.interp(made.time_s - late, made.time_s, made.roadwheel_rad) + shift
    return replace(made, roadwheel_rad=seen)
