"""What the sensors make of the true signals: encoder steps, noise, hum, rounding."""

from __future__ import annotations

import numpy as np
from scipy.signal import lfilter

# Colours of the slow wander that comes on top of the white noise.
WANDER_TIME_S = {"white": None, "50 ms": 0.05, "0.5 s": 0.5}


def fine_factor(sample_rate_hz: float, fine_rate_hz: float) -> int:
    """Fine steps per sample: at least two, and at least the fine rate."""
    if not sample_rate_hz > 0.0:
        raise ValueError("sample_rate_hz must be above zero")
    return max(2, int(np.ceil(fine_rate_hz / sample_rate_hz - 1e-9)))


def quantised(position: np.ndarray, step: float) -> np.ndarray:
    """Nearest encoder step; step 0 leaves the position as it is."""
    return np.round(position / step) * step if step > 0.0 else position.copy()


def noise_of(
    count: int,
    sample_rate_hz: float,
    rng: np.random.Generator,
    *,
    colour: str,
    white: float,
    wander: float,
    hum: float,
    hum_hz: float = 50.0,
) -> np.ndarray:
    """White noise (standard deviation), AR(1) wander (standard deviation) and hum (amplitude).

    Colour "white" has no wander.
    """
    if colour not in WANDER_TIME_S:
        raise ValueError(f"noise must be one of {', '.join(WANDER_TIME_S)}, got {colour!r}")
    noise = white * rng.standard_normal(count)
    drive = rng.standard_normal(count)
    time_constant_s = WANDER_TIME_S[colour]
    if time_constant_s is not None and wander > 0.0:
        keep = np.exp(-1.0 / (sample_rate_hz * time_constant_s))
        drive[1:] *= np.sqrt(1.0 - keep * keep)  # stationary from the first sample
        noise += wander * lfilter([1.0], [1.0, -keep], drive)
    noise += hum * np.sin(2.0 * np.pi * (hum_hz * np.arange(count) / sample_rate_hz + rng.random()))
    return noise
