"""The noise floor of a recorded angle: what no model can predict, from the record alone."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from ..diagnosis.floor import NoiseFloor
from .record import Record

# Third differences of white noise have 20 times its variance (1 + 9 + 9 + 1), those of a smooth motion none.
THIRD_DIFFERENCES = 20.0
# A cubic over this many samples follows any motion of a mechanism; what it leaves holds noise of longer memory, too.
WINDOW = 31
DEGREE = 3


def noise_floor(records: Sequence[Record], unit: str) -> NoiseFloor:
    """Estimate the noise of the road wheel's angle.

    Low is the noise that changes from sample to sample; high is what a cubic over 31 samples leaves, which holds
    noise of longer memory and the corners of the motion.
    """
    from scipy.signal import savgol_coeffs, savgol_filter

    rough, smooth, samples = 0.0, 0.0, 0
    coefficients = savgol_coeffs(WINDOW, DEGREE)
    own = float(coefficients[WINDOW // 2])
    # Variance of sample less smoothed sample, for white noise of variance 1.
    left = 1.0 - 2.0 * own + float(np.sum(coefficients**2))
    for r in records:
        phi = r.prepared.effort
        n = phi.size
        rough += n * float(np.mean(np.diff(phi, 3) ** 2)) / THIRD_DIFFERENCES
        smooth += n * float(np.mean((phi - savgol_filter(phi, WINDOW, DEGREE)) ** 2)) / left
        samples += n
    low, high = sorted((np.sqrt(rough / samples), np.sqrt(smooth / samples)))
    rms = float(np.sqrt((low**2 + high**2) / 2.0))
    method = (
        "noise of the recorded angle, between what changes from sample to sample and what a cubic over "
        f"{WINDOW} samples leaves"
    )
    return NoiseFloor(rms, float(low), float(high), rms, rms, unit, method)
