"""What chance alone does: random signs for whole strokes (the score wild bootstrap).

If nothing is missing, the residual of a stroke is as likely as its negative. A statistic is compared with what it
becomes under random signs; several are compared through the largest of them (Westfall and Young), so that one level
covers them all.

Source: Kline and Santos 2012, A Score Based Approach to Wild Bootstrap Inference, J. Econometric Methods 1:23.
"""

from __future__ import annotations

import numpy as np

DRAWS = 1999
# Fixed, so that the same data give the same verdict.
SEED = 38


def signs(strokes: int) -> np.ndarray:
    """Return random signs, shape (draws, strokes): all of them where there are few strokes, else a fixed sample.

    The first stroke keeps its sign: reversing all signs changes no statistic.
    """
    if strokes <= 11:
        bits = np.arange(2 ** max(strokes - 1, 0))[:, None] >> np.arange(max(strokes - 1, 0))
        return np.hstack([np.ones((len(bits), 1)), 1.0 - 2.0 * (bits & 1)])[:, :strokes]
    drawn = np.random.default_rng(SEED).integers(0, 2, (DRAWS, strokes))
    return np.vstack([np.ones(strokes), 1.0 - 2.0 * drawn])


def p_value_floor(strokes: int) -> float:
    """Return the smallest p-value that so many strokes can give."""
    return max(2.0 ** -max(strokes - 1, 0), 1.0 / (DRAWS + 1))


def studentised(scores: np.ndarray, flips: np.ndarray) -> np.ndarray:
    """Return squared studentised sums, shape (draws, features).

    Parameters
    ----------
    scores : ndarray, shape (strokes, features)
        Score of every stroke.
    flips : ndarray, shape (draws, strokes)
    """
    scale = np.sum(scores**2, axis=0)
    sums = flips @ scores
    return np.divide(sums**2, scale, out=np.zeros_like(sums), where=scale > 0)


def studentised_pairs(scores: np.ndarray, flips: np.ndarray) -> np.ndarray:
    """Return the same for pairs of neighbouring columns taken together (sine and cosine), shape (draws, pairs)."""
    scale = np.sum(scores**2, axis=0)
    squares = (flips @ scores) ** 2
    pairs, scales = (v[..., 0::2] + v[..., 1::2] for v in (squares, scale))
    return np.divide(pairs, scales, out=np.zeros_like(pairs), where=scales > 0)


def one_sided(gains: np.ndarray, flips: np.ndarray) -> np.ndarray:
    """Return squared studentised sums of what may only count when it is positive, shape (draws, features)."""
    scale = np.sum(gains**2, axis=0)
    sums = np.maximum(flips @ gains, 0.0)
    return np.divide(sums**2, scale, out=np.zeros_like(sums), where=scale > 0)


def p_values(drawn: np.ndarray) -> np.ndarray:
    """Return one p-value per statistic and draw, each draw taken as if it were the data; shape as ``drawn``."""
    count = len(drawn)
    # The share of draws at least as large, itself included: never zero. Ties of rounding count as equal.
    rounded = np.round(drawn, 12)
    ranks = np.empty_like(drawn)
    for j in range(drawn.shape[1]):
        ordered = np.sort(rounded[:, j])
        ranks[:, j] = (count - np.searchsorted(ordered, rounded[:, j], side="left")) / count
    return ranks
