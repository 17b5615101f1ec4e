"""One free run with everything that happened in it."""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType
from typing import Any

import numpy as np

from .. import _core
from .._arrays import number, vector, whole_number
from ..errors import ParameterError
from . import lanes
from .trajectory import Event, Trace


def trace(
    parameters: Mapping[str, float],
    handwheel_rad: Any,
    *,
    sample_rate_hz: float,
    load_nm: Any = None,
    start_rad: float = 0.0,
    start_speed_rad_s: float = 0.0,
    substeps: int = 1,
    method: str = "split",
) -> Trace:
    """Run one mechanism and keep what happened: every event with its instant, and where the energy went.

    Parameters are those of :func:`simulate`, one value each; the samples have the same bits.

    Raises
    ------
    ParameterError
        As :func:`simulate`.
    """
    rows, many = lanes.table(parameters)
    if many:
        raise ParameterError("there are several lanes", "parameters", "Give one value each, or call simulate.")
    psi = vector("handwheel_rad", handwheel_rad, minimum=2)
    load = None if load_nm is None else vector("load_nm", load_nm)
    rate = number("sample_rate_hz", sample_rate_hz)
    start = (number("start_rad", start_rad), number("start_speed_rad_s", start_speed_rad_s))
    steps = whole_number("substeps", substeps, 1, 1_000_000)
    phi, speed, friction, events, energies = _core.trace_steering(
        rows, start, psi, load, sample_rate_hz=rate, substeps=steps, method=method
    )
    lanes.require_bounded(np.arange(1), phi[np.newaxis])
    return Trace(
        time_s=np.arange(psi.size) / rate,
        roadwheel_rad=phi,
        speed_rad_s=speed,
        handwheel_rad=psi,
        friction_nm=friction,
        events=tuple(Event(t, kind, int(direction)) for t, kind, direction in events),
        energy_j=MappingProxyType(dict(energies)),
    )
