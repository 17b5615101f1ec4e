"""One verification: the friction of one run in one direction, against the limits."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from .crossings import Crossing
from .record import Piece, Record
from .rules import Judgement, RuleSet, judge

if TYPE_CHECKING:
    from ..stats import Moments

# Means and deviations of a torque that varies are compared after rounding to 1e-12 Nm: the filter and the sums round at
# about 1e-14 Nm, so that a level of exactly 1.5 Nm could otherwise fall on either side. A constant torque passes both
# unchanged and is compared to the last bit, as `judge` always does.
ROUNDING_DECIMALS = 12
# Slower than this the wheel is held rather than turned, and friction at rest may carry any torque up to its level.
REST_DEG_S = 1.0
DIRECTION_WORD = {1: "increasing", -1: "decreasing"}


@dataclass(frozen=True)
class Verification:
    """The figures and the verdict of one run in one direction.

    Attributes
    ----------
    run, direction : str
        ``direction`` is ``increasing`` or ``decreasing``.
    mean_nm : float or None [Nm]
        Mean of torque times the sign of motion.
    std_nm : float or None [Nm]
        Population standard deviation of the torque.
    max_abs_nm, min_abs_nm : float or None [Nm]
        Of the torque's absolute value.
    slope_nm_per_deg, intercept_nm : float or None
        The least-squares trend line of the recorded torque against angle.
    samples : int
        Samples inside the window, all full crossings pooled.
    angle_from_deg, angle_to_deg : float or None [deg]
        Where the samples begin and end, in the sense of motion.
    max_speed_deg_s : float or None [deg/s]
    below_max, above_min, steady : bool or None
        The three comparisons (:func:`luztar.tb038.judge`); None without samples.
    verdict : str
        ``pass``, ``fail`` or ``inconclusive``.
    why : str or None
        The reasons for a fail or an inconclusive verdict.
    """

    run: str
    direction: str
    mean_nm: float | None
    std_nm: float | None
    max_abs_nm: float | None
    min_abs_nm: float | None
    slope_nm_per_deg: float | None
    intercept_nm: float | None
    samples: int
    angle_from_deg: float | None
    angle_to_deg: float | None
    max_speed_deg_s: float | None
    below_max: bool | None
    above_min: bool | None
    steady: bool | None
    verdict: str
    why: str | None

    def to_dict(self) -> dict[str, Any]:
        """Return the verification as plain JSON values, None for what is not known."""
        return {key: getattr(self, key) for key in self.__dataclass_fields__}


def pooled(record: Record, direction: int) -> list[tuple[Piece, Crossing]]:
    """Return the crossings that make up a verification: the full ones, or the parts there are where none is full."""
    all_of_them = [(p, c) for p in record.pieces for c in p.crossings if c.direction == direction]
    return [(p, c) for p, c in all_of_them if c.full] or all_of_them


def verify(
    record: Record, direction: int, rules: RuleSet, reading: str | None = None, offset_nm: float = 0.0
) -> Verification:
    """Return one verification.

    Parameters
    ----------
    record : Record
    direction : int
        +1 or -1.
    rules : RuleSet
    reading : str, optional
        Which reading of the filter; the rule set's own where not given.
    offset_nm : float [Nm]
        Taken off the torque first.

    Returns
    -------
    Verification
        Inconclusive where the record casts doubt on this direction, whatever the figures.
    """
    from .. import regression, stats

    reading = reading or rules.reading
    parts = pooled(record, direction)
    doubts = [doubt.text for doubt in record.doubts[direction]]
    word = DIRECTION_WORD[direction]
    if not parts:
        return _without_samples(record.name, word, doubts)
    torque = np.concatenate([p.torque_nm[reading][c.inside] for p, c in parts]) - offset_nm
    angle = np.concatenate([p.angle_deg[c.inside] for p, c in parts])
    moving = np.concatenate([np.abs(p.speed_deg_s[c.inside]) >= REST_DEG_S for p, c in parts])
    mean, std = _settled(stats.Moments(direction * torque))
    line = regression.line(angle, torque)
    found = judge(mean, std, rules)
    doubts += _doubt_rest(direction * torque, moving, found, rules)
    size = np.abs(torque)
    if doubts:
        verdict, why = "inconclusive", "; ".join(doubts)
    elif found.passed:
        verdict, why = "pass", None
    else:
        verdict, why = "fail", "; ".join(_reasons(mean, std, found, rules))
    return Verification(
        run=record.name,
        direction=word,
        mean_nm=_finite(mean),
        std_nm=_finite(std),
        max_abs_nm=_finite(size.max()),
        min_abs_nm=_finite(size.min()),
        slope_nm_per_deg=_finite(line.slope),
        intercept_nm=_finite(line.intercept),
        samples=int(torque.size),
        # In the sense of motion the least advanced sample comes first.
        angle_from_deg=_finite(direction * np.min(direction * angle)),
        angle_to_deg=_finite(direction * np.max(direction * angle)),
        max_speed_deg_s=_finite(max(c.max_speed_deg_s for _, c in parts)),
        below_max=found.below_max,
        above_min=found.above_min,
        steady=found.steady,
        verdict=verdict,
        why=why,
    )


def _doubt_rest(signed_nm: np.ndarray, moving: np.ndarray, found: Judgement, rules: RuleSet) -> list[str]:
    # A wheel that is held keeps any torque up to its friction level: samples at rest may not decide a verdict.
    if moving.all() or not moving.any():
        return []
    from .. import stats

    if judge(*_settled(stats.Moments(signed_nm[moving])), rules) == found:
        return []
    share = 100.0 * (1.0 - float(moving.mean()))
    return [f"the wheel rested inside the window ({share:.0f} % of the samples), and the verdict rests on that"]


def _reasons(mean: float, std: float, found: Judgement, rules: RuleSet) -> list[str]:
    reasons = []
    if not found.below_max:
        reasons.append(f"mean {mean:.6g} Nm exceeds {rules.mean_max_nm:g} Nm ({rules.section('mean_max')})")
    if not found.above_min:
        reasons.append(f"mean {mean:.6g} Nm does not exceed {rules.mean_above_nm:g} Nm ({rules.section('mean_above')})")
    if not found.steady:
        reasons.append(
            f"standard deviation {std:.6g} Nm is not below {rules.std_below_nm:g} Nm ({rules.section('std')})"
        )
    return reasons


def _without_samples(run: str, direction: str, doubts: list[str]) -> Verification:
    nothing: dict[str, Any] = dict.fromkeys(Verification.__dataclass_fields__)
    why = "; ".join(doubts)
    return Verification(
        **{**nothing, "run": run, "direction": direction, "samples": 0, "verdict": "inconclusive", "why": why}
    )


def _settled(moments: Moments) -> tuple[float, float]:
    mean, std = moments.mean, moments.std_population
    if mean is None or std is None:
        return math.nan, math.nan
    return (mean, std) if std == 0.0 else (round(mean, ROUNDING_DECIMALS), round(std, ROUNDING_DECIMALS))


def _finite(value: Any) -> float | None:
    number = float(value)
    return number if math.isfinite(number) else None
