"""What the numbers of a run say about themselves: time axis, missing values, clipped and stuck stretches.

Each threshold stands here with its reason, and each finding says where.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import TypedDict

import numpy as np

from ..errors import MeasurementError
from .integrity import Finding

# A step of more than 1.5 median steps means that at least one sample is missing: rounding the stamps moves a step by
# less than that, a lost sample makes it 2.
GAP_STEPS = 1.5

# A record whose steps are no multiples of the median, for more than one step in twenty, was not sampled evenly to begin
# with (bus traffic, events), and neither was one where every fifth step is long. Long steps are its nature; there only
# a step of ten medians is a gap (one in a thousand where the moments are independent: 2^-10).
UNEVEN_SHARE = 0.05
LONG_SHARE = 0.2
UNEVEN_GAP_STEPS = 10.0

# A step may differ from the median by this part of it. Stamps rounded to 0.1 ms move a step by up to 0.1 ms: 10 % at
# 1 kHz, 5 % at 500 Hz. At 40 deg/s and 1 kHz a quarter step is 0.01 deg, half the step of a usual encoder.
EVEN_STEP = 0.25

# The mean step over a window may differ from that of the whole record by this part, plus what rounding can do at the
# window's ends. A filter's cut-off moves with the sample rate: 1 % of 6 Hz is 0.06 Hz.
EVEN_RATE = 0.01
RATE_WINDOW = 100

# A channel with noise cannot stand exactly still. Long enough: 0.1 s and 20 samples, and ten times as long as all but
# one in a hundred of the channel's ordinary plateaus (a coarse converter repeats values).
STUCK_S = 0.1
STUCK_SAMPLES = 20
PLATEAU_RATIO = 10.0

# At the extreme value a stretch is shorter, since the signal swings beyond the range and back.
CLIPPED_SAMPLES = 10
CLIPPED_RATIO = 5.0

# Where noise steps over two of a converter's levels and more from sample to sample, at most one sample in five repeats
# its neighbour: ten in a row at an extreme are a limit, however often they come.
LEVELS_IN_A_STEP = 2.0

# White noise turns at two thirds of its samples, a smooth signal hardly ever.
NOISY_TURNS = 0.2

# Findings of one kind and channel beyond this many are counted in one closing finding over the rest of the record.
MOST_FINDINGS = 20
# Of a channel that clips again and again one finding is enough, and so many of its places.
SHOWN_PLACES = 3

_LOADED = ("torque", "force", "load")
_MOVING = ("angle", "position", "handwheel", "roadwheel")

Place = Callable[[int], str]


class Steps(TypedDict):
    """The sampling interval as found, s."""

    dt_median_s: float | None
    dt_min_s: float | None
    dt_max_s: float | None


def inspect(
    time_s: np.ndarray, channels: Mapping[str, np.ndarray], place: Place | None = None
) -> tuple[np.ndarray, list[Finding], Steps]:
    """Look through a run's numbers.

    Parameters
    ----------
    time_s : ndarray, shape (n,) [s]
        As read; n >= 2.
    channels : mapping of str to ndarray, shape (n,)
        In SI units.
    place : callable, optional
        Turns a row (from 0) into words, such as "line 57".

    Returns
    -------
    time_s : ndarray, shape (n,) [s]
        The same, with stamps that are not finite filled from their neighbours (each one is a doubtful finding).
    findings : list of Finding
    steps : Steps

    Raises
    ------
    MeasurementError
        Where fewer than two stamps are finite.
    """
    where = place or (lambda row: f"row {row}")
    # Differences of infinities and of numbers near the largest float are no fault of the check.
    with np.errstate(over="ignore", invalid="ignore"):
        time_s, findings = _fill_time(time_s, where)
        step_findings, steps = _time_axis(time_s, where)
        findings += step_findings
        for key, values in channels.items():
            findings += _not_finite(key, values, time_s, where)
        for key in channels:
            findings += _still(key, channels, time_s, where)
    return time_s, findings, steps


def stretches(mask: np.ndarray) -> list[tuple[int, int]]:
    """Return the first and last index of every run of True."""
    edges = np.flatnonzero(np.diff(np.concatenate(([0], mask.view(np.int8), [0]))))
    return [(int(a), int(b) - 1) for a, b in zip(edges[::2], edges[1::2], strict=True)]


def _capped(found: list[tuple[int, int, Finding]], kind: str, time_s: np.ndarray) -> list[Finding]:
    """Keep the first findings; fold the rest into one that covers them all."""
    kept = [finding for _, _, finding in found[:MOST_FINDINGS]]
    rest = found[MOST_FINDINGS:]
    if rest:
        first, last = rest[0][2], rest[-1][2]
        span = f"from {first.from_s:.4f} s to {last.to_s:.4f} s"
        text = f"{len(rest)} more of the same kind ({kind.replace('_', ' ')}) {span}"
        doubtful = any(f.doubtful for _, _, f in rest)
        kept.append(Finding(kind, text, doubtful, first.channel, first.from_s, last.to_s))
    return kept


def _in_one(found: list[Finding], text: str) -> list[Finding]:
    """Return one finding for all stretches of a kind and channel, with the first places; one alone stays as it is."""
    if len(found) < 2:
        return found
    first = found[0]
    places = tuple(place for f in found for place in f.stretches_s())
    others = ", ".join(f"{a:.4f} s" for a, _ in places[1 : 1 + SHOWN_PLACES])
    more = " and so on" if len(places) > 1 + SHOWN_PLACES else ""
    text = f"{text}, first from {places[0][0]:.4f} s to {places[0][1]:.4f} s, then from {others}{more}: {first.kind}?"
    return [Finding(first.kind, text, first.doubtful, first.channel, places[0][0], places[-1][1], places)]


def _fill_time(time_s: np.ndarray, where: Place) -> tuple[np.ndarray, list[Finding]]:
    bad = ~np.isfinite(time_s)
    if not bad.any():
        return time_s, []
    good = np.flatnonzero(~bad)
    if good.size < 2:
        raise MeasurementError("fewer than two time stamps are numbers", where(0), "Look at the time column.")
    filled = time_s.copy()
    rows = np.arange(time_s.size)
    filled[bad] = np.interp(rows[bad], good, time_s[good])
    step = float(np.median(np.diff(time_s[good]) / np.diff(good)))
    head, tail = rows < good[0], rows > good[-1]
    filled[head] = time_s[good[0]] + (rows[head] - good[0]) * step
    filled[tail] = time_s[good[-1]] + (rows[tail] - good[-1]) * step
    found = []
    for a, b in stretches(bad):
        text = f"the time is missing at {_span(a, b, where)}; it was filled from the neighbouring stamps"
        at = (float(filled[max(a - 1, 0)]), float(filled[min(b + 1, filled.size - 1)]))
        found.append((a, b, Finding("not_finite", text, True, "time", *at)))
    return filled, _capped(found, "not_finite", filled)


def _span(a: int, b: int, where: Place) -> str:
    return where(a) if a == b else f"{where(a)} to {where(b)} ({b - a + 1} rows)"


def _time_axis(time_s: np.ndarray, where: Place) -> tuple[list[Finding], Steps]:
    dt = np.diff(time_s)
    median = float(np.median(dt))
    steps: Steps = {
        "dt_median_s": median,
        "dt_min_s": float(dt.min()),
        "dt_max_s": float(dt.max()),
    }
    findings: list[Finding] = []
    for kind, at, words in (
        ("duplicate_time", np.flatnonzero(dt == 0.0), "the time stands still"),
        ("reversed_time", np.flatnonzero(dt < 0.0), "the time runs backwards"),
    ):
        found = []
        for i in at:
            a, b = float(time_s[i]), float(time_s[i + 1])
            text = f"{words} at {where(int(i) + 1)}: {b:.6g} s after {a:.6g} s"
            found.append((int(i), int(i) + 1, Finding(kind, text, True, None, min(a, b), max(a, b))))
        findings += _capped(found, kind, time_s)
    if median <= 0.0:
        text = f"the median time step is {median:.6g} s: the time column does not run forward"
        findings.append(Finding("uneven", text, True))
        return findings, steps
    ratio = dt / median
    odd = np.abs(ratio - np.maximum(np.round(ratio), 1.0)) > EVEN_STEP
    irregular = odd.mean() > UNEVEN_SHARE or (ratio > GAP_STEPS).mean() > LONG_SHARE
    limit = UNEVEN_GAP_STEPS if irregular else GAP_STEPS
    gaps = np.flatnonzero(dt > limit * median)
    found = []
    for i in gaps:
        a, b = float(time_s[i]), float(time_s[i + 1])
        lost = max(float(np.rint((b - a) / median)) - 1.0, 1.0)
        span = f"{a:.6g} s to {b:.6g} s"
        text = f"gap of {b - a:.4g} s before {where(int(i) + 1)} ({span}): about {lost:.6g} samples are missing"
        found.append((int(i), int(i) + 1, Finding("gap", text, True, None, a, b)))
    findings += _capped(found, "gap", time_s)
    findings += _uneven(time_s, dt, median, limit, where)
    return findings, steps


def _uneven(time_s: np.ndarray, dt: np.ndarray, median: float, limit: float, where: Place) -> list[Finding]:
    whole = (dt > 0.0) & (dt <= limit * median)
    # Stamps of 10^9 s (seconds since 1970) carry 10^-7 s of rounding of their own.
    grain = 4.0 * float(np.spacing(np.abs(time_s).max()))
    off = whole & (np.abs(dt - median) > EVEN_STEP * median + grain)
    if off.any():
        # Judged against the mean too: the median of steps that are rounded to 0.1 ms is off the mean by up to 0.1 ms.
        mean = float(dt[whole].mean())
        off &= np.abs(dt - mean) > EVEN_STEP * mean + grain
    if off.any():
        i = int(np.flatnonzero(off)[0])
        text = (
            f"{int(off.sum())} of {dt.size} time steps differ from the median {median:.4g} s by more than "
            f"{EVEN_STEP:.0%}; the first before {where(i + 1)} ({dt[i]:.4g} s)"
        )
        return [Finding("uneven", text, False)]
    if whole.all() and dt.size >= 2 * RATE_WINDOW:
        windows = (time_s[RATE_WINDOW:] - time_s[:-RATE_WINDOW]) / RATE_WINDOW
        mean = float(time_s[-1] - time_s[0]) / dt.size
        rounding = 2.0 * float(np.abs(dt - mean).max()) / RATE_WINDOW
        drift = np.abs(windows - mean)
        if drift.max() > EVEN_RATE * mean + rounding + grain:
            i = int(drift.argmax())
            text = (
                f"the sample rate wanders: {1.0 / windows[i]:.6g} Hz over the {RATE_WINDOW} samples from {where(i)}, "
                f"{1.0 / mean:.6g} Hz over the record"
            )
            return [Finding("uneven", text, False)]
    return []


def _not_finite(key: str, values: np.ndarray, time_s: np.ndarray, where: Place) -> list[Finding]:
    bad = ~np.isfinite(values)
    if not bad.any():
        return []
    found = []
    for a, b in stretches(bad):
        what = "is infinite" if np.isinf(values[a : b + 1]).any() else "is missing"
        text = f"{key} {what} at {_span(a, b, where)}, {time_s[a]:.6g} s to {time_s[b]:.6g} s"
        found.append((a, b, Finding("not_finite", text, True, key, float(time_s[a]), float(time_s[b]))))
    return _capped(found, "not_finite", time_s)


def _still(key: str, channels: Mapping[str, np.ndarray], time_s: np.ndarray, where: Place) -> list[Finding]:
    values = channels[key]
    finite = np.isfinite(values)
    if not finite.any():
        return []
    low, high = float(values[finite].min()), float(values[finite].max())
    if low == high:
        text = f"{key} is exactly {low:.6g} over the whole record"
        return [Finding("stuck", text, False, key)]
    if key not in _LOADED or not _is_noisy(values[finite]):
        # A motion channel rests on one encoder count for seconds, and a signal without noise is a computed one: neither
        # says anything about a fault.
        return []
    same = np.diff(values) == 0.0
    plateaus = stretches(same)
    if not plateaus:
        return []
    lengths = np.array([b - a + 2 for a, b in plateaus])
    n_single = max(values.size - int(lengths.sum()), 0)
    ordinary = _quantile_of_plateaus(lengths, n_single)
    least = CLIPPED_SAMPLES if _is_fine(values, low, high) else max(CLIPPED_SAMPLES, CLIPPED_RATIO * ordinary)
    moving = next((channels[k] for k in _MOVING if k in channels), None)
    clipped: list[Finding] = []
    stuck: list[Finding] = []
    levels: set[float] = set()
    clipped_samples = stuck_samples = 0
    for (a, b), length in zip(plateaus, lengths, strict=True):
        first, last = a, b + 1
        at = (float(time_s[first]), float(time_s[last]))
        value = float(values[first])
        span = f"from {at[0]:.4f} s to {at[1]:.4f} s ({length} samples)"
        if value in (low, high) and length >= least:
            text = f"{key} stays at its extreme {value:.6g} {span}: clipped?"
            clipped.append(Finding("clipped", text, True, key, *at))
            levels.add(value)
            clipped_samples += int(length)
        elif length >= max(STUCK_SAMPLES, PLATEAU_RATIO * ordinary) and at[1] - at[0] >= STUCK_S:
            if moving is not None and not _moves(moving, first, last):
                continue
            text = f"{key} stays at exactly {value:.6g} {span}: stuck?"
            stuck.append(Finding("stuck", text, True, key, *at))
            stuck_samples += int(length)
    extremes = f"its extreme{'s' if len(levels) > 1 else ''} {' and '.join(f'{v:.6g}' for v in sorted(levels))}"
    often = f"in {len(clipped)} stretches, {_share(clipped_samples, values.size)} of the record"
    still = f"{key} stays at one value in {len(stuck)} stretches, {_share(stuck_samples, values.size)} of the record"
    return [
        *_in_one(clipped, f"{key} stays at {extremes} {often}"),
        *_in_one(stuck, still),
    ]


def _share(samples: int, of: int) -> str:
    return f"{100.0 * samples / of:.2g} %"


def _is_noisy(values: np.ndarray) -> bool:
    steps = np.diff(values)
    steps = steps[steps != 0.0]
    if steps.size < STUCK_SAMPLES:
        return False
    return bool((np.sign(steps[1:]) != np.sign(steps[:-1])).mean() > NOISY_TURNS)


def _is_fine(values: np.ndarray, low: float, high: float) -> bool:
    """Whether noise steps over several levels of the converter away from the channel's extremes."""
    inside = (values > low) & (values < high)
    steps = np.abs(np.diff(values))[inside[1:] & inside[:-1]]
    levels = np.unique(values[inside])
    if steps.size < STUCK_SAMPLES or levels.size < STUCK_SAMPLES:
        return False
    return bool(np.median(steps) >= LEVELS_IN_A_STEP * float(np.diff(levels).min()))


def _quantile_of_plateaus(lengths: np.ndarray, n_single: int) -> float:
    """Return the length that 99 of 100 plateaus do not exceed, single values counted as plateaus of one."""
    total = lengths.size + n_single
    beyond = max(total // 100, min(lengths.size, 1))
    ordered = np.sort(lengths)[::-1]
    return float(ordered[beyond]) if beyond < ordered.size else 1.0


def _moves(moving: np.ndarray, first: int, last: int) -> bool:
    """Whether the motion covers more than 0.5 % of its range within the stretch: beyond an encoder's step at rest."""
    part = moving[first : last + 1]
    part = part[np.isfinite(part)]
    whole = moving[np.isfinite(moving)]
    return bool(part.size and np.ptp(part) > 0.005 * np.ptp(whole))


def assumed_is_plausible(key: str, values: np.ndarray) -> bool:
    """Whether numbers whose unit nobody wrote down can be SI: at most five turns, ten metres, one second a step."""
    limits: dict[str, float] = {"angle": 31.4, "handwheel": 31.4, "roadwheel": 31.4, "position": 10.0}
    finite = values[np.isfinite(values)]
    if key == "time":
        return finite.size < 2 or float(np.median(np.diff(finite))) < 1.0
    return key not in limits or not finite.size or float(np.abs(finite).max()) <= limits[key]
