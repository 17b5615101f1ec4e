"""Stretches: the parts of a record that are finite and evenly sampled, and the breaks between them."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from .crossings import STROKE_TRAVEL_DEG
from .rules import RuleSet

# A step of the clock outside half to one and a half of the usual one has lost, doubled or reversed a sample.
STEP_LOW, STEP_HIGH = 0.5, 1.5
# How much of the record on each side of a break shows which way the wheel was turning.
LOOK_S = 0.25


@dataclass(frozen=True)
class Stretch:
    """Samples ``start`` to ``stop`` (exclusive), and whether the record breaks at either end.

    The record's own first and last sample are no breaks.
    """

    start: int
    stop: int
    starts_at_break: bool
    ends_at_break: bool


@dataclass(frozen=True)
class Break:
    """A place where the record is interrupted.

    Attributes
    ----------
    at_s : float [s]
        The time of the last sound sample before it.
    direction : int
        Which way the wheel was turning (+1, -1), 0 where that cannot be seen.
    in_window : bool
        Whether the wheel was, or may have passed, inside the window meanwhile.
    text : str
        What interrupts the record, with the time.
    """

    at_s: float
    direction: int
    in_window: bool
    text: str


def split(time_s: np.ndarray, values: tuple[np.ndarray, ...]) -> list[Stretch]:
    """Return the stretches in which every channel is finite and the clock steps evenly.

    Parameters
    ----------
    time_s : ndarray, shape (n,) [s]
    values : tuple of ndarray, shape (n,)
        The channels that must be finite.

    Returns
    -------
    list of Stretch
    """
    sound = np.isfinite(time_s)
    for channel in values:
        sound &= np.isfinite(channel)
    step = np.diff(time_s)
    usual = _usual_step(step)
    joined = sound[:-1] & sound[1:] & (step > STEP_LOW * usual) & (step < STEP_HIGH * usual)
    # A stretch is a run of sound samples of which each is joined to the next.
    opens = sound & np.concatenate(([True], ~joined))
    closes = sound & np.concatenate((~joined, [True]))
    starts, stops = np.flatnonzero(opens), np.flatnonzero(closes) + 1
    n = time_s.size
    return [Stretch(int(a), int(b), bool(a > 0), bool(b < n)) for a, b in zip(starts, stops, strict=True)]


def sample_rate_hz(time_s: np.ndarray) -> float:
    """Return the rate of an even stretch; NaN for fewer than two samples."""
    if time_s.size < 2 or not time_s[-1] > time_s[0]:
        return float("nan")
    rate = (time_s.size - 1) / float(time_s[-1] - time_s[0])
    # Stamps carry rounding: 499.9999999998 Hz is 500 Hz.
    snapped = round(rate, 3)
    return snapped if abs(rate - snapped) <= 1e-9 * rate else rate


def breaks(time_s: np.ndarray, angle_deg: np.ndarray, stretches: list[Stretch], rules: RuleSet) -> list[Break]:
    """Return the breaks between stretches, with what the raw angle says about each.

    Parameters
    ----------
    time_s, angle_deg : ndarray, shape (n,) [s], [deg]
        As recorded, NaN where they are missing.
    stretches : list of Stretch
    rules : RuleSet
    """
    found = []
    half = rules.half_width_deg
    usual = _usual_step(np.diff(time_s))
    look = max(1, round(LOOK_S / usual)) if np.isfinite(usual) and usual > 0.0 else 1
    for before, after in zip(stretches[:-1], stretches[1:], strict=True):
        last, first = before.stop - 1, after.start
        a, b = float(angle_deg[last]), float(angle_deg[first])
        overlap = min(max(a, b), half) - max(min(a, b), -half)
        in_window = abs(a) <= half or abs(b) <= half or overlap >= STROKE_TRAVEL_DEG
        # Over stretches' edges on purpose: between two breaks close together a stretch shows no direction of its own.
        earlier = float(np.nanmean(angle_deg[max(0, last - look) : last + 1]))
        later = float(np.nanmean(angle_deg[first : first + look + 1]))
        missing = first - last - 1
        what = f"{missing} unreadable sample{'s' if missing > 1 else ''}" if missing else "a break in the time axis"
        at_s = float(time_s[last])
        found.append(Break(at_s, int(np.sign(later - earlier)), in_window, f"{what} after {at_s:.3f} s"))
    return found


def _usual_step(step: np.ndarray) -> float:
    forward = step[np.isfinite(step) & (step > 0.0)]
    return float(np.median(forward)) if forward.size else float("nan")
