"""What tests ask of an estimate with its interval."""

from __future__ import annotations

from scipy.stats import t

from luztar.diagnosis.intervals import Estimate


def inside_99(estimate: Estimate, truth: float, strokes: int) -> bool:
    """Whether the truth lies in the 99 % interval, from the half width of the 95 % one."""
    half = (estimate.high - estimate.low) / 2.0
    wider = t.ppf(0.995, strokes - 1) / t.ppf(0.975, strokes - 1)
    return abs(estimate.value - truth) <= wider * half
