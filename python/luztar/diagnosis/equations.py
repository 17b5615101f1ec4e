"""The normal equations of a driven fit, one block per stroke.

Everything that follows (fits, held-out errors, intervals) is sums of these blocks, so that a fold costs a small
solve and not a pass over the samples.

The instant at which a reversal starts is known to one step of the sensor only. Each stroke therefore carries a shift
of its reversal as a random effect with that standard deviation; it is eliminated from the block (a ridge of one
column), so that the jump of the torque at a reversal does not drown the rest. What all starts have in common (the
sensor shows them a little late or early on average) is one more coefficient, kept inside the same uncertainty: without
it those few milliseconds would be sold as a delay of the torque channel.
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
        Products of the p columns (the last of them the common shift of the starts) and the measurement (last), each
        stroke's own shift eliminated.
    bound : float
        The common shift's coefficient stays within plus or minus this.
    run : ndarray of int, shape (strokes,)
        The run of each stroke.
    samples : ndarray of int, shape (strokes,)
    """

    gram: np.ndarray
    bound: float
    run: np.ndarray
    samples: np.ndarray

    def solve(self, chosen: np.ndarray | None = None) -> np.ndarray:
        """Return the least-squares coefficients for all strokes or the chosen ones."""
        return solve((self.gram if chosen is None else self.gram[chosen]).sum(axis=0), self.bound)


@dataclass(frozen=True)
class Columns:
    """The columns of a model for every run.

    Attributes
    ----------
    terms : Terms
    matrix : tuple of ndarray, shape (n, p + 1)
        Per run: the effects' columns in order; then what a shift of the starts adds, per second and unit of friction
        level; last the measurement, less what is known beforehand.
    """

    terms: Terms
    matrix: tuple[np.ndarray, ...]

    def having(self, more: Sequence[np.ndarray]) -> Columns:
        """Return the columns with further ones (shape (n, q) per run) after those of the effects."""
        matrix = [np.column_stack([m[:, :-2], c, m[:, -2:]]) for m, c in zip(self.matrix, more, strict=True)]
        return Columns(self.terms, tuple(matrix))

    @property
    def shift(self) -> tuple[np.ndarray, ...]:
        """What a shift of the starts adds, per run."""
        return tuple(m[:, -2] for m in self.matrix)


def columns(runs: Sequence[Prepared], terms: Terms) -> Columns:
    """Ask the core for the columns of all terms."""
    pairs = terms.pairs()
    matrix = []
    for r in runs:
        block = r.recording.columns(pairs, list(range(len(pairs)))).T if pairs else np.empty((r.effort.size, 0))
        shift = r.recording.start_shift(pairs)
        matrix.append(np.column_stack([block, shift, r.effort]))
    return Columns(terms, tuple(matrix))


def blocks(runs: Sequence[Prepared], made: Columns, weights: Weights) -> Blocks:
    """Form the normal equations of every stroke."""
    grams, owners, counts = [], [], []
    for r, matrix in zip(runs, made.matrix, strict=True):
        for stroke in r.strokes:
            part = slice(stroke.first, stroke.last)
            a = matrix[part][r.usable[part]]
            gram = a.T @ a
            cross = gram[:, -2]
            ridge = weights.ridge(r.step_s, stroke.onset_uncertainty_s)
            grams.append(gram - np.outer(cross, cross) / (cross[-2] + ridge))
            owners.append(stroke.run)
            counts.append(len(a))
    bound = weights.level * start_uncertainty_s(runs)
    return Blocks(np.array(grams), bound, np.array(owners), np.array(counts))


def start_uncertainty_s(runs: Sequence[Prepared]) -> float:
    """Return by how much the instant of a start is uncertain, on average."""
    return float(np.mean([s.onset_uncertainty_s for r in runs for s in r.strokes]))


def solve(gram: np.ndarray, bound: float = np.inf) -> np.ndarray:
    """Return the least-squares coefficients of one summed block.

    Columns are scaled to unit length; where two cannot be told apart the shortest solution is taken, and the
    intervals say that the data do not decide between them. The last coefficient stays within plus or minus ``bound``.
    """
    p = gram.shape[0] - 1
    if p == 0:
        return np.empty(0)
    free = _solve(gram[:p, :p], gram[:p, p])
    if abs(free[-1]) <= bound:
        return free
    last = float(np.copysign(bound, free[-1]))
    q = p - 1
    if q == 0:
        # A model without a free coefficient.
        return np.array([last])
    return np.append(_solve(gram[:q, :q], gram[:q, p] - last * gram[:q, q]), last)


def _solve(products: np.ndarray, right: np.ndarray) -> np.ndarray:
    scale = np.sqrt(np.maximum(np.diag(products), np.finfo(float).tiny))
    normal = products / np.outer(scale, scale)
    try:
        factor = np.linalg.cholesky(normal)
        # The square of the factor's smallest diagonal bounds the condition of the scaled equations, which is the square
        # of the columns': 1e-12 leaves four digits.
        if factor.diagonal().min() ** 2 > 1e-12:
            return np.linalg.solve(normal, right / scale) / scale
    except np.linalg.LinAlgError:
        pass
    return np.linalg.lstsq(normal, right / scale, rcond=1e-12)[0] / scale


def loss(gram: np.ndarray, coefficients: np.ndarray) -> np.ndarray:
    """Return the sum of squares that coefficients leave in one block or a stack of blocks."""
    v = np.append(coefficients, -1.0)
    return np.maximum(np.einsum("i,...ij,j->...", v, gram, v), 0.0)
