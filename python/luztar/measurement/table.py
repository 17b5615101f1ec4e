"""What every reader hands over, and how a run is made of it."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np

from ..errors import MeasurementError
from .check import assumed_is_plausible, inspect
from .columns import resolve
from .headers import Column
from .integrity import Finding, Integrity
from .run import Run


@dataclass(frozen=True)
class Loaded:
    """The columns asked for, as raw numbers.

    Attributes
    ----------
    values : dict of column index to ndarray, shape (n,)
    complete : bool
    findings : list of Finding
    place : callable or None
        Turns a row (from 0) into words.
    rows_declared : int or None
    """

    values: dict[int, np.ndarray]
    complete: bool = True
    findings: list[Finding] = field(default_factory=list)
    place: Callable[[int], str] | None = None
    rows_declared: int | None = None


@dataclass(frozen=True)
class Table:
    """A file or frame whose columns are known and whose numbers are not read yet.

    Attributes
    ----------
    columns : sequence of Column
    load : callable
        Takes column indices, returns :class:`Loaded`.
    where : str
        The file, for messages.
    sha256 : str or None
    sample_rate_hz : float or None
        Where the file declares it.
    unitless_is_si : bool
        Whether the format has nowhere to write units.
    """

    columns: Sequence[Column]
    load: Callable[[Sequence[int]], Loaded]
    where: str
    sha256: str | None = None
    sample_rate_hz: float | None = None
    unitless_is_si: bool = False


def to_run(
    table: Table,
    *,
    name: str,
    mapped: Mapping[str, str],
    units: Mapping[str, str],
    sample_rate_hz: float | None = None,
) -> Run:
    """Find the channels in a table, read them, bring them to SI, and look them through."""
    rate = sample_rate_hz or table.sample_rate_hz
    sources, notes = resolve(
        table.columns,
        mapped=mapped,
        units=units,
        where=table.where,
        need_time=rate is None,
        unitless_is_si=table.unitless_is_si,
    )
    loaded = table.load(sorted({s.column.index for s in sources.values()}))
    findings = [*loaded.findings, *(Finding("note", text, False) for text in notes)]
    channels: dict[str, np.ndarray] = {}
    for key, source in sources.items():
        values = loaded.values[source.column.index] * source.to_si
        if source.assumed:
            _check_assumption(key, values, bool(units.get(key)) or "*" in source.unit_read, table.where)
            findings.append(Finding("unit_assumed", source.assumed, False, key))
        channels[key] = values
    torque = sources.get("torque")
    if torque is not None and torque.column.estimated:
        text = (
            f"the only torque is {torque.column.header!r}, which is estimated and not measured; "
            'name the load cell, such as --map torque="ADC6*0.52"'
        )
        findings.append(Finding("estimated_torque", text, False, "torque"))
    if "time" in channels:
        time_s = channels.pop("time")
    else:
        assert rate is not None
        time_s = np.arange(next(iter(channels.values())).size) / rate
        findings.append(Finding("note", f"the time was made from the declared sample rate of {rate:g} Hz", False))
    if time_s.size < 2:
        raise MeasurementError(f"the record holds {time_s.size} rows", table.where, "A run needs at least two.")
    try:
        time_s, found, steps = inspect(time_s, channels, loaded.place)
    except MeasurementError as error:
        raise MeasurementError(error.kind, f"{table.where}, {error.where}", error.remedy) from None
    integrity = Integrity(
        rows_declared=loaded.rows_declared,
        rows_read=int(time_s.size),
        complete=loaded.complete,
        **steps,
        units={key: (s.unit_read, s.unit_used) for key, s in sources.items()},
        columns={key: s.column_text for key, s in sources.items()},
        findings=tuple(findings + found),
        columns_found=tuple(c.header for c in table.columns),
    )
    return Run.from_parts(name, time_s, channels, integrity, table.where, table.sha256)


def _check_assumption(key: str, values: np.ndarray, said: bool, where: str) -> None:
    if not said and not assumed_is_plausible(key, values):
        other = {"time": "ms", "position": "mm"}.get(key, "deg")
        raise MeasurementError(
            f"{key} has no unit and its numbers are too large to be SI",
            where,
            f"Say --unit {key}={other}, or what it is.",
        )
