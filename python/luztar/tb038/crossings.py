"""Crossings of the window: where, and how soundly, the wheel went through it in one motion.

A *stroke* runs between two reversals of the filtered angle that lie at least 5 degrees apart. Where a stroke overlaps
the window it is a crossing; it is *full* where it starts beyond one edge and reaches the other.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from .rules import RuleSet

# interface.md's stroke: travel of at least 5 degrees. A motion that enters the window by less is no crossing of it.
STROKE_TRAVEL_DEG = 5.0
# The same page's hysteresis: a turn back of up to 1 degree is a tremor of the hand, more is another motion.
TURN_BACK_DEG = 1.0
# Arithmetic rounding of an angle converted from radians; a record that rests at exactly 45 degrees is not beyond them.
ROUNDING_DEG = 1e-9
# What a speed from an encoder of 0.02 degrees can resolve after the 6 Hz filter (0.03 deg/s at 500 Hz), rounded up: a
# motion at exactly the limit is not over it.
SPEED_RESOLUTION_DEG_S = 0.05


@dataclass(frozen=True, eq=False)
class Crossing:
    """One passage through the window, or the part of one that was recorded.

    Attributes
    ----------
    direction : int
        +1 for increasing angle, -1 for decreasing.
    start, stop : int
        The stroke's samples within its stretch: ``start`` to ``stop`` inclusive.
    inside : ndarray of int
        Indices of the samples inside the window.
    starts_beyond, ends_beyond : bool
        Whether the stroke starts beyond the edge it comes from, and reaches the edge it goes to.
    start_deg, end_deg : float [deg]
        The angles of the two reversals (or of the stretch's ends).
    max_speed_deg_s : float [deg/s]
        The highest speed inside the window.
    turned_back_deg : float [deg]
        The farthest turn back inside the window.
    """

    direction: int
    start: int
    stop: int
    inside: np.ndarray
    starts_beyond: bool
    ends_beyond: bool
    start_deg: float
    end_deg: float
    max_speed_deg_s: float
    turned_back_deg: float

    @property
    def full(self) -> bool:
        """Whether the whole window was traversed."""
        return self.starts_beyond and self.ends_beyond


def starts_beyond(angle_deg: float, direction: int, rules: RuleSet) -> bool:
    """Return whether a stroke from ``angle_deg`` starts beyond the edge it comes from (2.2.8: strictly)."""
    return bool(-direction * angle_deg > rules.half_width_deg + ROUNDING_DEG)


def reaches(angle_deg: float, direction: int, rules: RuleSet) -> bool:
    """Return whether a stroke that ends at ``angle_deg`` reaches the far edge."""
    return bool(direction * angle_deg >= rules.half_width_deg - ROUNDING_DEG)


def too_fast(speed_deg_s: float, rules: RuleSet) -> bool:
    """Return whether a speed is over the limit; NaN counts as over it."""
    return not bool(speed_deg_s <= rules.speed_max_deg_s + SPEED_RESOLUTION_DEG_S)


def reversals(angle_deg: np.ndarray, travel_deg: float = STROKE_TRAVEL_DEG) -> list[int]:
    """Return the indices between which the angle runs in one direction, first and last sample included.

    Parameters
    ----------
    angle_deg : ndarray, shape (n,), n >= 1 [deg]
    travel_deg : float [deg]
        A reversal counts once the angle has come back from its extreme by this much.

    Returns
    -------
    list of int
        Ascending; empty where the angle never travels ``travel_deg``.
    """
    n = angle_deg.size
    # Only local extremes can be reversals: the loop below sees these few instead of every sample.
    turns = np.flatnonzero(np.diff(np.sign(np.diff(angle_deg)))) + 1
    candidates = np.unique(np.concatenate(([0], turns, [n - 1])))
    found: list[int] = []
    low = high = extreme = 0
    direction = 0
    for index in candidates:
        i = int(index)
        angle = angle_deg[i]
        if direction == 0:
            low = i if angle < angle_deg[low] else low
            high = i if angle > angle_deg[high] else high
            if angle - angle_deg[low] >= travel_deg:
                found.append(low)
                direction, extreme = 1, i
            elif angle_deg[high] - angle >= travel_deg:
                found.append(high)
                direction, extreme = -1, i
        elif direction * (angle - angle_deg[extreme]) > 0.0:
            extreme = i
        elif direction * (angle_deg[extreme] - angle) >= travel_deg:
            found.append(extreme)
            direction, extreme = -direction, i
    if direction:
        found.append(extreme)
    return found


def find(
    angle_deg: np.ndarray, raw_deg: np.ndarray, speed_deg_s: np.ndarray, sample_rate_hz: float, rules: RuleSet
) -> list[Crossing]:
    """Return the crossings of the window in one evenly sampled stretch, in time order.

    Parameters
    ----------
    angle_deg, raw_deg, speed_deg_s : ndarray, shape (n,) [deg], [deg], [deg/s]
        The filtered angle, the angle as recorded, and the filtered angle's rate.
    sample_rate_hz : float [Hz]
    rules : RuleSet

    Returns
    -------
    list of Crossing
        Strokes that overlap the window by less than 5 degrees are left out.
    """
    half = rules.half_width_deg
    turning = reversals(angle_deg)
    near = round(sample_rate_hz / rules.cutoff_hz)
    crossings = []
    for start, stop in zip(turning[:-1], turning[1:], strict=True):
        first, last = float(angle_deg[start]), float(angle_deg[stop])
        overlap = min(max(first, last), half) - max(min(first, last), -half)
        if overlap < STROKE_TRAVEL_DEG:
            continue
        direction = 1 if last > first else -1
        inside = start + np.flatnonzero(np.abs(angle_deg[start : stop + 1]) <= half)
        along = direction * angle_deg[inside]
        # The filter overshoots where a motion sets in abruptly: the recorded angle must have been beyond the edge too.
        recorded = -direction * float(np.max(-direction * raw_deg[max(0, start - near) : start + near + 1]))
        crossings.append(
            Crossing(
                direction=direction,
                start=start,
                stop=stop,
                inside=inside,
                starts_beyond=starts_beyond(first, direction, rules) and starts_beyond(recorded, direction, rules),
                ends_beyond=reaches(last, direction, rules),
                start_deg=first,
                end_deg=last,
                max_speed_deg_s=float(np.max(np.abs(speed_deg_s[inside]), initial=0.0)),
                turned_back_deg=float(np.max(np.maximum.accumulate(along) - along, initial=0.0)),
            )
        )
    return crossings
