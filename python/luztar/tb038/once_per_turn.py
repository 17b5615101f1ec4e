"""A torque that comes back once per turn (Annex I 12): how large, how sure, and whether this angle range can show it.

Within 60 degrees to either side the best straight line through a sine leaves less than 0.3 % of its variance: there
a once-per-turn pattern and a spring are one curve, and the amplitude below is what it would be if it were once per
turn. At a range of 270 degrees the line leaves a tenth of the variance; from there on a slope is fitted beside the
sine, and the two are told apart.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from .crossings import reversals
from .record import Record
from .rules import RuleSet

# After a reversal the torque climbs over the first degrees; that is presliding, not a pattern of the turn.
AFTER_REVERSAL_DEG = 5.0
# interface.md: below this speed a sample belongs to the reversal zone.
MOVING_DEG_S = 2.0


@dataclass(frozen=True)
class OncePerTurn:
    """The once-per-turn pattern of all runs together.

    Attributes
    ----------
    amplitude_nm : float or None [Nm]
        By least squares; None where the record cannot carry the fit.
    standard_error_nm : float or None [Nm]
        By leaving out one stroke at a time, since the samples of a stroke are not independent.
    prominent : bool
        Amplitude above both the rule set's level and its number of standard errors.
    identifiable : bool
        Whether the angle range is wide enough to tell it from a spring.
    range_deg : float or None [deg]
        The angle range of the samples used.
    """

    amplitude_nm: float | None
    standard_error_nm: float | None
    prominent: bool
    identifiable: bool
    range_deg: float | None

    def to_dict(self) -> dict[str, Any]:
        """Return amplitude, prominence and identifiability as the JSON interface prints them."""
        return {
            "amplitude_nm": self.amplitude_nm,
            "prominent": self.prominent,
            "identifiable": self.identifiable,
        }


def once_per_turn(records: Sequence[Record], rules: RuleSet) -> OncePerTurn:
    """Fit a sine of one period per turn to the filtered torque of every stroke.

    Each stroke has its own level (friction, offset and drift fall out); all share the sine, a viscous term (the speed
    of a hand-turned wheel peaks in mid-stroke, much as a cosine does) and, where the range allows, a slope.

    Parameters
    ----------
    records : sequence of Record
    rules : RuleSet

    Returns
    -------
    OncePerTurn
    """
    strokes = [stroke for record in records for stroke in _strokes(record, rules)]
    if not strokes:
        return OncePerTurn(None, None, False, False, None)
    low = min(float(angle.min()) for angle, _, _ in strokes)
    high = max(float(angle.max()) for angle, _, _ in strokes)
    range_deg = high - low
    identifiable = bool(range_deg >= rules.range_deg)
    normal, moment = [], []
    for angle, speed, torque in strokes:
        x = np.deg2rad(angle)
        columns = [np.sin(x), np.cos(x), np.deg2rad(speed)] + ([x] if identifiable else [])
        basis = np.column_stack([c - c.mean() for c in columns])
        normal.append(basis.T @ basis)
        moment.append(basis.T @ (torque - torque.mean()))
    total_normal, total_moment = np.sum(normal, axis=0), np.sum(moment, axis=0)
    amplitude = _amplitude(total_normal, total_moment)
    if amplitude is None:
        return OncePerTurn(None, None, False, identifiable, range_deg)
    left_out = [
        _amplitude(total_normal - n, total_moment - m) for n, m in zip(normal, moment, strict=True) if len(strokes) > 1
    ]
    known = [a for a in left_out if a is not None]
    error = None
    if len(known) == len(strokes) > 1:
        # The jackknife's variance: (G - 1)/G times the sum of squares over the G strokes left out in turn.
        spread = float(np.sum((np.array(known) - np.mean(known)) ** 2))
        error = float(np.sqrt((len(known) - 1) / len(known) * spread))
    prominent = bool(error is not None and amplitude > rules.prominent_nm and amplitude > rules.standard_errors * error)
    return OncePerTurn(amplitude, error, prominent, identifiable, range_deg)


def _strokes(record: Record, rules: RuleSet) -> list[tuple[np.ndarray, np.ndarray, np.ndarray]]:
    found = []
    for piece in record.pieces:
        turning = reversals(piece.angle_deg)
        for start, stop in zip(turning[:-1], turning[1:], strict=True):
            angle = piece.angle_deg[start : stop + 1]
            speed = piece.speed_deg_s[start : stop + 1]
            clear = np.minimum(np.abs(angle - angle[0]), np.abs(angle - angle[-1])) >= AFTER_REVERSAL_DEG
            used = clear & (np.abs(speed) >= MOVING_DEG_S)
            # A sine is not visible in a stroke shorter than the window.
            if used.sum() > 3 and np.ptp(angle[used]) >= rules.half_width_deg:
                torque = piece.torque_nm[rules.reading][start : stop + 1]
                found.append((angle[used], speed[used], torque[used]))
    return found


def _amplitude(normal: np.ndarray, moment: np.ndarray) -> float | None:
    # Scaled to a unit diagonal first, so that the rank does not depend on the units of the columns.
    scale = np.sqrt(np.diag(normal))
    if not (scale > 0.0).all():
        # A motion at one constant speed has no viscous column of its own.
        keep = scale > 0.0
        if not keep[:2].all():
            return None
        return _amplitude(normal[np.ix_(keep, keep)], moment[keep])
    unit = normal / np.outer(scale, scale)
    values, vectors = np.linalg.eigh(unit)
    # Directions that the record does not excite get no say (relative size of rounding over about 1e4 samples).
    sound = values > 1e-9 * values[-1]
    inverse = (vectors[:, sound] / values[sound]) @ vectors[:, sound].T
    solution = (inverse @ (moment / scale)) / scale
    amplitude = float(np.hypot(solution[0], solution[1]))
    return amplitude if np.isfinite(amplitude) else None
