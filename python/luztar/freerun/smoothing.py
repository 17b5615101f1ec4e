"""Recorded drives as a simulation takes them."""

from __future__ import annotations

import numpy as np

# Encoder steps and noise of the handwheel above this are not passed on by a column whose lowest mode is below 15 Hz.
DRIVE_BAND_HZ = 40.0


def smoothed(drive: np.ndarray, rate_hz: float, band_hz: float = DRIVE_BAND_HZ) -> np.ndarray:
    """Return a drive without what is above its band, where the sample rate allows."""
    if rate_hz < 4.0 * band_hz or float(np.ptp(drive)) == 0.0:
        return drive
    from ..signal import zero_phase

    return np.asarray(zero_phase(drive, sample_rate_hz=rate_hz, cutoff_hz=band_hz, poles=2))
