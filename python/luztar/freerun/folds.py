"""Which samples are predicted from which: each run from the others, the strokes of a single run in folds."""

from __future__ import annotations

import numpy as np

from .intervals import stroke_slices
from .least_squares import Data

# Folds of a single run, as for driven fits: neighbouring strokes in different folds.
STROKE_FOLDS = 5


def folds_of(data: Data) -> np.ndarray:
    """Return the fold of every sample of the comparison."""
    if len(data.records) > 1:
        return np.concatenate([np.full(len(r.channels) * int(r.usable.sum()), i) for i, r in enumerate(data.records)])
    fold = np.zeros(data.measured.size, np.int64)
    for i, s in enumerate(stroke_slices(data)):
        fold[s] = i % STROKE_FOLDS
    return fold


def training(fold: np.ndarray) -> np.ndarray:
    """Return weights, shape (folds, samples): 1 where a fold's model is fitted, 0 where it is tested."""
    numbers = np.unique(fold)
    return (fold[None, :] != numbers[:, None]).astype(float)
