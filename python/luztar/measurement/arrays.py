"""A run from arrays in memory."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any

import numpy as np

from ..errors import MeasurementError, ParameterError
from . import units as _units
from .check import assumed_is_plausible, inspect
from .columns import QUANTITY
from .integrity import Finding, Integrity
from .run import CHANNEL_UNITS, as_si


def from_arrays(
    time: Any, sample_rate_hz: float | None, units: Mapping[str, str] | None, name: str, channels: Mapping[str, Any]
) -> tuple[str, np.ndarray, dict[str, np.ndarray], Integrity, str, None]:
    """Return the parts of a run given by arrays; the arguments are those of :class:`Run`."""
    unknown = [key for key in channels if key not in CHANNEL_UNITS]
    if unknown:
        raise ParameterError(
            f"unknown channel {unknown[0]!r}", unknown[0], f"The channels are {', '.join(CHANNEL_UNITS)}."
        )
    if not channels:
        raise ParameterError("a run needs at least one channel", "channels", "Give angle= and torque=, for example.")
    for key in units or {}:
        if key not in QUANTITY:
            raise ParameterError(f"unknown channel {key!r} in units", "units", f"The keys are {', '.join(QUANTITY)}.")
    sizes = {key: _si_size(key, (units or {}).get(key)) for key in ("time", *channels)}
    if (time is None) == (sample_rate_hz is None):
        raise ParameterError("the time axis is not settled", "time", "Give either time= or sample_rate_hz=.")
    if time is None:
        assert sample_rate_hz is not None
        check_rate(sample_rate_hz)
        first = as_si(next(iter(channels)), next(iter(channels.values())), None)
        time_s = np.arange(first.size) / float(sample_rate_hz)
    else:
        time_s = as_si("time", time, None) * sizes["time"][1]
    n = time_s.size
    converted = {key: as_si(key, values, n) * sizes[key][1] for key, values in channels.items()}
    time_s, findings, steps = inspect(time_s, converted)
    findings = [*_assumed(converted, units or {}), *findings]
    integrity = Integrity(
        rows_declared=None,
        rows_read=int(n),
        complete=True,
        **steps,
        units={key: sizes[key][0] for key in ("time", *channels)},
        columns={key: key for key in ("time", *channels) if key != "time" or time is not None},
        findings=tuple(findings),
    )
    return str(name), time_s, converted, integrity, "arrays", None


def _assumed(channels: Mapping[str, np.ndarray], units: Mapping[str, str]) -> list[Finding]:
    """Return a finding where units were not given: one remark, and a doubt for numbers that can hardly be SI."""
    bare = [key for key in channels if key not in units]
    if not bare:
        return []
    listed = ", ".join(f"{key} in {CHANNEL_UNITS[key]}" for key in bare)
    found = [Finding("unit_assumed", f"no unit was given: {listed} (units= says otherwise)", False)]
    for key in bare:
        if not assumed_is_plausible(key, channels[key]):
            used, other = CHANNEL_UNITS[key], {"position": "mm"}.get(key, "deg")
            text = f"{key} is taken as {used}, and its numbers are too large for that: units={{'{key}': '{other}'}}?"
            found.append(Finding("unit_assumed", text, True, key))
    return found


def check_rate(sample_rate_hz: float) -> float:
    """Return the sample rate as float, refusing what is not a positive finite number."""
    try:
        rate = float(sample_rate_hz)
    except (TypeError, ValueError):
        rate = math.nan
    if not (math.isfinite(rate) and rate > 0.0):
        raise ParameterError(
            f"the sample rate is {sample_rate_hz!r}", "sample_rate_hz", "Give a positive number of Hz."
        )
    return rate


def _si_size(key: str, spelling: str | None) -> tuple[tuple[str, str], float]:
    quantity = QUANTITY[key]
    used = _units.SI_SYMBOL[quantity]
    if spelling is None:
        return (used, used), 1.0
    unit = _units.parse(str(spelling), f"units[{key!r}]")
    if unit.quantity != quantity:
        raise MeasurementError(
            f"{spelling!r} measures {unit.quantity}", f"units[{key!r}]", f"Give a unit of {quantity}."
        )
    return (str(spelling), used), unit.si
