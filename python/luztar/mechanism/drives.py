"""What drives a mechanism, at the door: channels by name, starts by body."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any

import numpy as np

from .._arrays import number, vector, whole_number
from ..errors import ParameterError
from .mechanism import Mechanism

MOST_SUBSTEPS = 1_000_000
# Share of the longest step: the quickest motion on springs is then out of phase by (0.2)^2 / 24 of a turn per turn.
ACCURATE = 0.1


def channels(m: Mechanism, drives: Mapping[str, Any], samples: int | None = None) -> np.ndarray:
    """Return the channels as rows, in the mechanism's order; loads that are not given are 0.

    Raises
    ------
    ParameterError
        A channel that is unknown, missing, of another length, or holds NaN: named with the sample.
    """
    for name in drives:
        if name not in m.channels:
            known = ", ".join(m.channels) or "none"
            raise ParameterError(f"nothing is driven by '{name}'", "drives", f"Known are: {known}.")
    given = {name: vector(name, values, minimum=2) for name, values in drives.items()}
    sizes = {name: values.size for name, values in given.items()}
    length = next(iter(sizes.values()), samples)
    if length is None or length < 2:
        raise ParameterError("there is no drive", "drives", "Give a channel of at least two samples, or seconds.")
    for name, size in sizes.items():
        if size != length:
            raise ParameterError(f"{name} has {size} samples, others {length}", name, "Give channels of one length.")
    for node in m.driven:
        if node.name not in given:
            raise ParameterError(
                f"the motion of '{node.name}' is missing", "drives", f"Give {node.name} as an array of {node.unit}."
            )
    rows = np.zeros((len(m.channels), length))
    for i, name in enumerate(m.channels):
        if name in given:
            rows[i] = given[name]
    return rows


def by_body(name: str, m: Mechanism, values: Mapping[str, float] | None) -> np.ndarray:
    """Return one number per body, 0 where none is given."""
    out = np.zeros(len(m.bodies))
    names = [b.name for b in m.bodies]
    for body, value in (values or {}).items():
        if body not in names:
            raise ParameterError(f"there is no body '{body}'", name, f"Known are: {', '.join(names)}.")
        out[names.index(body)] = number(f"{name} of {body}", value)
    return out


def parts(m: Mechanism, step_s: float, substeps: int | None) -> int:
    """Return the number of core steps per step; chosen here, enough for springs to be followed to 0.2 %."""
    if substeps is not None:
        return whole_number("substeps", substeps, 1, MOST_SUBSTEPS)
    longest = m.longest_step_s
    return 1 if math.isinf(longest) else min(MOST_SUBSTEPS, max(1, math.ceil(step_s / (ACCURATE * longest))))


def positive(name: str, value: Any) -> float:
    """Return a number that is positive and finite."""
    got = number(name, value)
    if not (math.isfinite(got) and got > 0.0):
        raise ParameterError(f"{name} is {got}", name, "Give a positive number.")
    return got
