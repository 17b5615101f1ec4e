"""The normal equations of a driven fit, one block per stroke.

Everything that follows (fits, held-out errors, intervals) is sums of these blocks, so that a fold costs a small
solve and not a pass over the samples.

The instant at which a reversal starts is known to one step of the sensor only. Each stroke therefore carries a shift
of its reversal as a random effect with that standard deviation; it is eliminated from the block (a ridge of one
column), so that the jump of the torque at a reversal does not drown the rest.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from .prepare import Prepared
from .terms import Terms


@dataclass(frozen=True)
class Weights:
    """What the shift of a reversal is weighed against.

    Attributes
    ----------
    noise_rms : float
        Residual of a model that lacks nothing, away from reversals.
    level : float
        Friction level whose reversal is shifted.
    band_hz : float
    """

    noise_rms: float
    level: float
    band_hz: float

    def ridge(self, step_s: float, uncertainty_s: float) -> float:
        """Return the penalty of a shift's column.

        The noise is spread over the band, not over all frequencies: along one smooth column its power is that of
        white noise of the same density, ``rms^2 / (2 band step)``.
        """
        density = self.noise_rms**2 / (2.0 * self.band_hz * step_s)
        return density / max(self.level * uncertainty_s, 1e-12) ** 2


@dataclass(frozen=True)
class Blocks:
    """Normal equations per stroke.

    Attributes
    ----------
    gram : ndarray, shape (strokes, p + 1, p + 1)
        Products of the p columns and the measurement (last), the reversal's shift eliminated.
    run : ndarray of int, shape (strokes,)
        The run of each stroke.
    samples : ndarray of int, shape (strokes,)
    """

    gram: np.ndarray
    run: np.ndarray
    samples: np.ndarray


@dataclass(frozen=True)
class Columns:
    """The columns of a model for every run, with what is needed to form blocks.

    Attributes
    ----------
    terms : Terms
    matrix : tuple of ndarray, shape (n, p + 1)
        Per run; the measurement, less what is known beforehand, is the last column.
    shift : tuple of ndarray, shape (n,)
        Per run: what a shift of the reversals adds, per second and unit of friction level.
    """

    terms: Terms
    matrix: tuple[np.ndarray, ...]
    shift: tuple[np.ndarray, ...]


def columns(runs: Sequence[Prepared], terms: Terms, band_hz: float) -> Columns:
    """Ask the core for the columns of all terms."""
    pairs = terms.pairs()
    matrix = []
    for r in runs:
        block = np.empty((r.effort.size, 0))
        if pairs:
            block = r.recording.columns(pairs, list(range(len(pairs)))).T
        matrix.append(np.column_stack([block, r.effort]))
    return Columns(terms, tuple(matrix), shifts(runs, terms, band_hz))


def shifts(runs: Sequence[Prepared], terms: Terms, band_hz: float) -> tuple[np.ndarray, ...]:
    """Ask the core for the column of the reversals' shift."""
    # Within one period of the band's edge before and two after the start, a reversal is over.
    return tuple(r.recording.reversal_shift(terms.pairs(), 1.0 / band_hz, 2.0 / band_hz) for r in runs)


def blocks(runs: Sequence[Prepared], made: Columns, weights: Weights) -> Blocks:
    """Form the normal equations of every stroke."""
    grams, owners, counts = [], [], []
    for r, matrix, shift in zip(runs, made.matrix, made.shift, strict=True):
        for stroke in r.strokes:
            part = slice(stroke.first, stroke.last)
            keep = r.usable[part]
            a = matrix[part][keep]
            z = shift[part][keep]
            gram = a.T @ a
            cross = a.T @ z
            ridge = weights.ridge(r.step_s, stroke.onset_uncertainty_s)
            grams.append(gram - np.outer(cross, cross) / (z @ z + ridge))
            owners.append(stroke.run)
            counts.append(len(a))
    return Blocks(np.array(grams), np.array(owners), np.array(counts))


def extended(runs: Sequence[Prepared], base: Columns, more: Sequence[np.ndarray]) -> Columns:
    """Return the columns with further ones (one array of shape (n, q) per run) put before the measurement."""
    matrix = tuple(np.column_stack([m[:, :-1], c, m[:, -1]]) for m, c in zip(base.matrix, more, strict=True))
    return Columns(base.terms, matrix, base.shift)


def solve(gram: np.ndarray) -> np.ndarray:
    """Return the least-squares coefficients of one summed block.

    Columns are scaled to unit length; where two cannot be told apart the shortest solution is taken, and the
    intervals say that the data do not decide between them.
    """
    p = gram.shape[0] - 1
    if p == 0:
        return np.empty(0)
    scale = np.sqrt(np.maximum(np.diag(gram)[:p], np.finfo(float).tiny))
    normal = gram[:p, :p] / np.outer(scale, scale)
    right = gram[:p, p] / scale
    try:
        # The condition of the scaled equations is the square of the columns'; 1e-12 leaves four digits.
        if np.linalg.cond(normal) < 1e12:
            return np.linalg.solve(normal, right) / scale
    except np.linalg.LinAlgError:
        pass
    return np.linalg.lstsq(normal, right, rcond=1e-12)[0] / scale


def loss(gram: np.ndarray, coefficients: np.ndarray) -> np.ndarray:
    """Return the sum of squares that coefficients leave in one block or a stack of blocks."""
    v = np.append(coefficients, -1.0)
    return np.maximum(np.einsum("i,...ij,j->...", v, gram, v), 0.0)
