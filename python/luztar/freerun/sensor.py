"""What a sensor does to a simulated channel."""

from __future__ import annotations

import numpy as np


def late(values: np.ndarray, samples: np.ndarray) -> np.ndarray:
    """Return rows shifted to later by a number of samples each, straight lines between samples."""
    place = np.maximum(np.arange(values.shape[1])[None, :] - samples[:, None], 0.0)
    left = np.minimum(place.astype(np.int64), values.shape[1] - 2)
    share = place - left
    before = np.take_along_axis(values, left, axis=1)
    return before + share * (np.take_along_axis(values, left + 1, axis=1) - before)
