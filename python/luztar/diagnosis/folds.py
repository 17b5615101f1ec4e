"""Held-out prediction: every run from the others, or, with one run, its strokes in folds."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from .equations import Blocks

# With a single run its strokes are dealt into this many folds of neighbouring pairs (one stroke each way), so that
# every fold sees both directions.
SINGLE_RUN_FOLDS = 4


@dataclass(frozen=True)
class Folds:
    """Which fold each stroke is predicted in.

    Attributes
    ----------
    of_stroke : ndarray of int, shape (strokes,)
    count : int
    """

    of_stroke: np.ndarray
    count: int

    @classmethod
    def of(cls, blocks: Blocks) -> Folds:
        """Deal strokes: by run where there are several, else in neighbouring pairs."""
        runs = np.unique(blocks.run)
        if runs.size > 1:
            return cls(np.searchsorted(runs, blocks.run), runs.size)
        pairs = np.arange(blocks.run.size) // 2
        count = min(SINGLE_RUN_FOLDS, int(pairs.max()) + 1) if blocks.run.size else 0
        return cls(pairs % max(count, 1), count)
