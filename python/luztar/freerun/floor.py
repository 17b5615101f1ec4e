"""The noise floor of recorded motion: what no model can predict, from the record alone."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from ..diagnosis.floor import NoiseFloor

if TYPE_CHECKING:
    from .record import Record

# Third differences of white noise have 20 times its variance (1 + 9 + 9 + 1), those of a smooth motion none.
THIRD_DIFFERENCES = 20.0
# A cubic over this time, at most so many samples, follows any motion of a mechanism; what it leaves holds noise of
# longer memory, too.
WINDOW_S = 0.16
WIDEST, NARROWEST = 31, 9
DEGREE = 3


def window_of(rate_hz: float) -> int:
    """Return over how many samples the cubic runs, an odd number."""
    return min(max(2 * math.floor(0.5 * WINDOW_S * rate_hz) + 1, NARROWEST), WIDEST)


def noise_of(arrays: Sequence[np.ndarray], rate_hz: float) -> tuple[float, float, float]:
    """Return the noise of one channel in several runs: between low and high, low, high.

    Low is the noise that changes from sample to sample; high is what a cubic over 31 samples leaves, which holds
    noise of longer memory and the corners of the motion.
    """
    from scipy.signal import savgol_coeffs, savgol_filter

    rough, smooth, samples = 0.0, 0.0, 0
    window = window_of(rate_hz)
    coefficients = savgol_coeffs(window, DEGREE)
    own = float(coefficients[window // 2])
    # Variance of sample less smoothed sample, for white noise of variance 1.
    left = 1.0 - 2.0 * own + float(np.sum(coefficients**2))
    for values in arrays:
        n = values.size
        rough += n * float(np.mean(np.diff(values, 3) ** 2)) / THIRD_DIFFERENCES
        smooth += n * float(np.mean((values - savgol_filter(values, window, DEGREE)) ** 2)) / left
        samples += n
    low, high = sorted((math.sqrt(rough / samples), math.sqrt(smooth / samples)))
    return math.sqrt((low**2 + high**2) / 2.0), low, high


def noise_floor(records: Sequence[Record], unit: str) -> NoiseFloor:
    """Estimate the noise of what came out, of several channels together in multiples of their own."""
    rate = records[0].rate_hz
    each = np.array([noise_of([r.outputs[i].effort for r in records], rate) for i in range(len(records[0].channels))])
    rms, low, high = np.sqrt(np.mean(each**2, axis=0))
    method = (
        "noise of the recorded motion, between what changes from sample to sample and what a cubic over "
        f"{window_of(rate)} samples leaves"
    )
    return NoiseFloor(float(rms), float(low), float(high), float(rms), float(rms), unit, method)
