"""The recorded handwheel as a simulation takes it."""

from __future__ import annotations

import numpy as np

# Encoder steps and noise of the handwheel above this are not passed on by a column whose lowest mode is below 15 Hz.
DRIVE_BAND_HZ = 40.0


def smoothed(psi: np.ndarray, rate_hz: float) -> np.ndarray:
    """Return the handwheel's angle without what is above 40 Hz, where the sample rate allows."""
    if rate_hz < 4.0 * DRIVE_BAND_HZ:
        return psi
    from ...signal import zero_phase

    return np.asarray(zero_phase(psi, sample_rate_hz=rate_hz, cutoff_hz=DRIVE_BAND_HZ, poles=2))
