"""What a measurement file really held: the report that decides whether a verdict may rest on it."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from html import escape
from typing import Any


@dataclass(frozen=True)
class Finding:
    """One thing worth knowing about a run's data.

    Attributes
    ----------
    kind : str
        One of ``cut``, ``gap``, ``duplicate_time``, ``reversed_time``, ``not_finite``, ``clipped``, ``stuck``,
        ``uneven``, ``estimated_torque``, ``unit_assumed``, ``filtered_unknown``, ``note``.
    text : str
        A sentence for the engineer, with the place (line, row, seconds) in it.
    doubtful : bool
        Whether a verdict on the affected stretch must be "inconclusive".
    channel : str or None
        The channel concerned; None for the time axis or the whole file.
    from_s, to_s : float or None
        The stretch concerned, seconds from the file's own time; None for the whole record.
    places : tuple of (float, float) [s]
        Where one finding speaks of several stretches: the first and last time of each.
    """

    kind: str
    text: str
    doubtful: bool
    channel: str | None = None
    from_s: float | None = None
    to_s: float | None = None
    places: tuple[tuple[float, float], ...] = ()

    def stretches_s(self) -> tuple[tuple[float, float], ...]:
        """Return the first and last time of every stretch concerned; minus to plus infinity for the whole record."""
        low = -math.inf if self.from_s is None else self.from_s
        high = math.inf if self.to_s is None else self.to_s
        return self.places or ((low, high),)

    def concerns(self, first_s: float, last_s: float) -> bool:
        """Whether the finding speaks of a part of ``first_s`` to ``last_s``."""
        return any(a <= last_s and b >= first_s for a, b in self.stretches_s())

    def to_dict(self) -> dict[str, Any]:
        """Return the finding as plain JSON values."""
        return {
            "kind": self.kind,
            "text": self.text,
            "doubtful": self.doubtful,
            "channel": self.channel,
            "from_s": self.from_s,
            "to_s": self.to_s,
            "count": max(1, len(self.places)),
        }


def _finite(value: float | None) -> float | None:
    """JSON has no infinity."""
    return value if value is not None and math.isfinite(value) else None


@dataclass(frozen=True)
class Integrity:
    """The integrity report of one run.

    Attributes
    ----------
    rows_declared : int or None
        Rows the file says it has (AB Dynamics ``Points=``, a MAT variable's length); None where it does not say.
    rows_read : int
        Rows that were read.
    complete : bool
        False where the file ends in the middle (fewer rows than declared, a broken last line, a truncated archive).
    dt_median_s, dt_min_s, dt_max_s : float or None
        The sampling interval as found.
    units : mapping of channel to (unit as read, unit as used)
    columns : mapping of channel to the column's name in the file
    findings : tuple of Finding
    columns_found : tuple of str
        Every column of the file, read or not; empty for arrays.
    """

    rows_declared: int | None
    rows_read: int
    complete: bool
    dt_median_s: float | None
    dt_min_s: float | None
    dt_max_s: float | None
    units: dict[str, tuple[str, str]] = field(default_factory=dict)
    columns: dict[str, str] = field(default_factory=dict)
    findings: tuple[Finding, ...] = ()
    columns_found: tuple[str, ...] = ()

    @property
    def evenly_sampled(self) -> bool:
        """Whether one sampling interval describes the whole record."""
        return not any(f.kind in ("gap", "duplicate_time", "reversed_time", "uneven") for f in self.findings)

    @property
    def doubtful(self) -> tuple[Finding, ...]:
        """The findings that forbid a verdict on the stretch they concern."""
        return tuple(f for f in self.findings if f.doubtful)

    def to_dict(self) -> dict[str, Any]:
        """Return the report as plain JSON values."""
        return {
            "rows_declared": self.rows_declared,
            "rows_read": self.rows_read,
            "complete": self.complete,
            "dt_median_s": _finite(self.dt_median_s),
            "dt_min_s": _finite(self.dt_min_s),
            "dt_max_s": _finite(self.dt_max_s),
            "units": {k: {"read": a, "used": b} for k, (a, b) in self.units.items()},
            "columns": dict(self.columns),
            "findings": [f.to_dict() for f in self.findings],
            "columns_found": list(self.columns_found),
        }

    def _repr_html_(self) -> str:
        rows = "".join(
            f"<tr><td>{escape(f.kind)}</td><td>{'doubtful' if f.doubtful else ''}</td><td>{escape(f.text)}</td></tr>"
            for f in self.findings
        )
        state = "complete" if self.complete else "<b>not complete</b>"
        return f"<p>{self.rows_read} rows, {state}</p><table>{rows}</table>"
