"""One run made ready: split where it is broken, filtered as a whole, its crossings found and its doubts collected."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from . import crossings as _crossings
from . import filters, stretches
from .crossings import Crossing
from .rules import RuleSet
from .torque_source import torque_of

if TYPE_CHECKING:
    from ..measurement.integrity import Finding
    from ..measurement.run import Run

# Findings that `stretches` handles sample by sample; the others are taken from the integrity report.
_SPLIT_HERE = frozenset({"gap", "duplicate_time", "reversed_time"})
BOTH = (1, -1)


class Doubt(NamedTuple):
    """Why a verification cannot have a verdict.

    ``kind`` is one of ``start``, ``missing``, ``speed``, ``turned_back``, ``broken``, ``cut``, ``uneven``, ``rate``,
    ``data``; ``text`` says it to the engineer.
    """

    kind: str
    text: str


@dataclass(frozen=True, eq=False)
class Piece:
    """One even stretch of a run after filtering.

    Attributes
    ----------
    time_s, angle_deg, speed_deg_s : ndarray, shape (n,) [s], [deg], [deg/s]
        Angle by the ruling filter, and its rate.
    torque_nm : dict of reading to ndarray, shape (n,) [Nm]
        The torque by each reading of the filter.
    crossings : tuple of Crossing
    """

    time_s: np.ndarray
    angle_deg: np.ndarray
    speed_deg_s: np.ndarray
    torque_nm: dict[str, np.ndarray]
    crossings: tuple[Crossing, ...]


@dataclass(frozen=True, eq=False)
class Record:
    """One run, ready for its two verifications.

    Attributes
    ----------
    name : str
    pieces : tuple of Piece
    doubts : dict of direction (+1, -1) to tuple of Doubt
        Why this direction's verification must be inconclusive; empty where nothing stands against it.
    notes : tuple of str
        What the engineer should know, without weight for the verdict.
    torque_channel : str
        ``torque`` or ``force``.
    angle_span_deg : float [deg]
        How far the wheel was turned, as recorded; NaN without a finite angle.
    """

    name: str
    pieces: tuple[Piece, ...]
    doubts: dict[int, tuple[Doubt, ...]]
    notes: tuple[str, ...]
    torque_channel: str
    angle_span_deg: float


@dataclass
class _Doubts:
    by_direction: dict[int, list[Doubt]] = field(default_factory=lambda: {d: [] for d in BOTH})

    crossings: dict[tuple[int, str], list[tuple[float, str]]] = field(default_factory=dict)

    def add(self, direction: int, kind: str, text: str) -> None:
        doubt = Doubt(kind, text)
        for each in (direction,) if direction else BOTH:
            if doubt not in self.by_direction[each]:
                self.by_direction[each].append(doubt)

    def add_crossing(self, direction: int, kind: str, size: float, text: str) -> None:
        """Add what may be wrong with several crossings: the worst of them is spoken of."""
        self.crossings.setdefault((direction, kind), []).append((size, text))

    def frozen(self) -> dict[int, tuple[Doubt, ...]]:
        for (direction, kind), found in self.crossings.items():
            _, text = max(found)
            more = f" (the worst of {len(found)} such crossings)" if len(found) > 1 else ""
            self.add(direction, kind, f"{text}{more}")
        self.crossings.clear()
        return {direction: tuple(found) for direction, found in self.by_direction.items()}


def prepare(run: Run, rules: RuleSet, link_distance_m: float) -> Record:
    """Split, filter and search one run.

    Parameters
    ----------
    run : Run
        With an ``angle`` [rad] and a ``torque`` [Nm] or ``force`` [N].
    rules : RuleSet
    link_distance_m : float [m]

    Raises
    ------
    MeasurementError
        Where a channel is missing.
    """
    source = torque_of(run, link_distance_m)
    raw_deg = np.rad2deg(run["angle"])
    doubts = _Doubts()
    notes = [source.note] if source.note else []
    _doubt_whole_run(run, doubts)

    parts = stretches.split(run.time_s, (raw_deg, source.torque_nm))
    for broken in stretches.breaks(run.time_s, raw_deg, parts, rules):
        if broken.in_window:
            doubts.add(broken.direction, "broken", f"{broken.text}, inside the window")
        else:
            notes.append(f"{broken.text}, outside the window")
    pieces = []
    left_out: list[float] = []
    for part in parts:
        piece = _filtered(run.time_s, raw_deg, source.torque_nm, part, rules, doubts)
        if piece is not None:
            pieces.append(piece)
            for crossing in piece.crossings:
                _doubt_crossing(crossing, piece, part, run, source.channel, rules, doubts, left_out)
    if len(left_out) == 1:
        notes.append(f"a crossing ends at {left_out[0]:.1f} deg, before the far edge, and is left out")
    elif left_out:
        first = f"the first at {left_out[0]:.1f} deg"
        notes.append(f"{len(left_out)} crossings end before the far edge, {first}, and are left out")
    for direction, word in ((1, "increasing"), (-1, "decreasing")):
        if not any(c.full and c.direction == direction for p in pieces for c in p.crossings):
            half = rules.half_width_deg
            doubts.add(direction, "missing", f"no full crossing of -{half:g} to {half:g} deg with {word} angle")
    finite = raw_deg[np.isfinite(raw_deg)]
    span = float(finite.max() - finite.min()) if finite.size else float("nan")
    return Record(run.name, tuple(pieces), doubts.frozen(), tuple(notes), source.channel, span)


def _doubt_whole_run(run: Run, doubts: _Doubts) -> None:
    if not run.integrity.complete:
        cut = [f.text for f in run.integrity.findings if f.kind == "cut"]
        doubts.add(0, "cut", f"the file is not complete: {cut[0]}" if cut else "the file is not complete")
    for finding in run.integrity.findings:
        # Uneven sampling is no fault of the data, but the filter is not defined on it.
        if finding.kind == "uneven":
            doubts.add(0, "uneven", f"uneven sampling: {finding.text}; export at a constant rate, or resample first")
        elif finding.kind == "cut" and not run.integrity.complete:
            continue
        elif finding.doubtful and not _split_here(finding) and finding.from_s is None and finding.to_s is None:
            doubts.add(0, "data", finding.text)


def _split_here(finding: Finding) -> bool:
    # A missing time stamp was filled from its neighbours and leaves no NaN behind: it stays a finding.
    return finding.kind in _SPLIT_HERE or (finding.kind == "not_finite" and finding.channel != "time")


def _filtered(
    time_s: np.ndarray,
    raw_deg: np.ndarray,
    torque_nm: np.ndarray,
    part: stretches.Stretch,
    rules: RuleSet,
    doubts: _Doubts,
) -> Piece | None:
    where = slice(part.start, part.stop)
    rate_hz = stretches.sample_rate_hz(time_s[where])
    # Shorter than one period of the cut-off, a stretch shows the filter's edge and nothing else.
    if not time_s[where][-1] - time_s[where][0] > 1.0 / rules.cutoff_hz:
        return None
    unusable = filters.unusable_rate(rate_hz, rules)
    if unusable:
        doubts.add(0, "rate", unusable)
        return None
    angle = np.ascontiguousarray(raw_deg[where])
    torque = np.ascontiguousarray(torque_nm[where])
    angle_deg = filters.low_pass(angle, rate_hz, rules, "two_forward_two_backward")
    speed_deg_s = np.gradient(angle_deg, 1.0 / rate_hz)
    by_reading = {
        reading: filters.low_pass(torque, rate_hz, rules, reading) for reading in (rules.reading, *rules.other_readings)
    }
    found = []
    for crossing in _crossings.find(angle_deg, angle, speed_deg_s, rate_hz, rules):
        # Two samples make a line; a passage with fewer was far too fast for the clock.
        if crossing.inside.size < 2:
            doubts.add(crossing.direction, "speed", "a crossing has fewer than two samples inside the window")
        else:
            found.append(crossing)
    return Piece(time_s[where], angle_deg, speed_deg_s, by_reading, tuple(found))


def _doubt_crossing(
    crossing: Crossing,
    piece: Piece,
    part: stretches.Stretch,
    run: Run,
    torque_channel: str,
    rules: RuleSet,
    doubts: _Doubts,
    left_out: list[float],
) -> None:
    from_s, to_s = (float(piece.time_s[i]) for i in (crossing.inside[0], crossing.inside[-1]))
    way = crossing.direction
    # One period of the cut-off: what lies nearer to a crossing than this still colours its filtered torque.
    margin_s = 1.0 / rules.cutoff_hz
    near_start = part.starts_at_break and from_s - float(piece.time_s[0]) < margin_s
    near_end = part.ends_at_break and float(piece.time_s[-1]) - to_s < margin_s
    if near_start:
        doubts.add(way, "broken", f"the record is broken just before {from_s:.3f} s, at {crossing.start_deg:.1f} deg")
    elif not crossing.starts_beyond:
        start = rules.section("start")
        inside_deg = rules.half_width_deg + way * crossing.start_deg
        text = f"a crossing starts at {crossing.start_deg:.1f} deg, inside the window ({start})"
        doubts.add_crossing(way, "start", inside_deg, text)
    if near_end:
        doubts.add(way, "broken", f"the record is broken just after {to_s:.3f} s, at {crossing.end_deg:.1f} deg")
    elif crossing.starts_beyond and not crossing.ends_beyond:
        # Returning the wheel to the middle at the end is no test: it is neither pooled nor held against the run.
        left_out.append(crossing.end_deg)
        return
    if _crossings.too_fast(crossing.max_speed_deg_s, rules):
        limit = f"over {rules.speed_max_deg_s:g} deg/s ({rules.section('speed')})"
        speed = crossing.max_speed_deg_s
        doubts.add_crossing(way, "speed", speed, f"{speed:.1f} deg/s inside the window, {limit}")
    if crossing.turned_back_deg > _crossings.TURN_BACK_DEG:
        back = crossing.turned_back_deg
        doubts.add_crossing(way, "turned_back", back, f"the wheel turned back by {back:.1f} deg inside the window")
    for finding in run.integrity.doubtful:
        concerned = finding.channel in (None, "time", "angle", torque_channel)
        if finding.kind == "uneven" or _split_here(finding) or not concerned:
            continue
        if finding.from_s is None and finding.to_s is None:
            continue
        if finding.concerns(from_s - margin_s, to_s + margin_s):
            doubts.add(way, "data", finding.text)
