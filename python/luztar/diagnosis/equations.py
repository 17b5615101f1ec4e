"""The normal equations of a driven fit, one block per stroke; the core forms, sums and solves them.

Everything that follows (fits, held-out errors, intervals) is sums of these blocks, so that a fold costs a small
solve and not a pass over the samples.

The instant at which a reversal starts is known to one step of the sensor only. Each stroke therefore carries a shift
of its reversal as a random effect with that standard deviation; it is eliminated from the block (a ridge of one
column), so that the jump of the torque at a reversal does not drown the rest. What all starts have in common (the
sensor shows them a little late or early on average) is one more coefficient, kept inside the same uncertainty: without
it those few milliseconds would be sold as a delay of the torque channel.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from .. import _core
from .colour import WHITE, Colour
from .prepare import Prepared
from .terms import Terms

if TYPE_CHECKING:
    from .folds import Folds


@dataclass(frozen=True)
class Weights:
    """What the residual is weighed with, and what the shift of a reversal is weighed against.

    Attributes
    ----------
    noise_rms : float
        Residual of a model that lacks nothing, away from reversals.
    level : float
        Friction level whose reversal is shifted.
    band_hz : float
    colour : Colour
        Of the noise; the normal equations are those of whitened columns.
    """

    noise_rms: float
    level: float
    band_hz: float
    colour: Colour = WHITE

    def ridge(self, step_s: float, uncertainty_s: float) -> float:
        """Return the penalty of a shift's column.

        The noise is spread over the band, not over all frequencies: along one smooth column its power is that of
        white noise of the same density, ``rms^2 / (2 band step)``. Whitening leaves the flat part of its spectrum.
        """
        density = self.noise_rms**2 * self.colour.flat_share(self.band_hz) / (2.0 * self.band_hz * step_s)
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
        """Return the least-squares coefficients for all strokes or the chosen ones.

        Columns are scaled to unit length; where two cannot be told apart the shortest solution is taken, and the
        intervals say that the data do not decide between them. The last coefficient stays within plus or minus
        ``bound``.
        """
        return _core.solve_block((self.gram if chosen is None else self.gram[chosen]).sum(axis=0), self.bound)

    def held_out(self, folds: Folds) -> tuple[np.ndarray, np.ndarray]:
        """Predict every fold from the others.

        Returns
        -------
        losses : ndarray, shape (strokes,)
            Sum of squares left in each stroke by coefficients that have not seen its fold.
        training : ndarray, shape (folds,)
            Sum of squares left in the strokes each fold was trained on: what inner parameters are chosen by.
        """
        return _core.held_out(self.gram, folds.of_stroke.tolist(), folds.count, self.bound)


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


def columns(runs: Sequence[Prepared], terms: Terms, given: Mapping[int, float] | None = None) -> Columns:
    """Ask the core for the columns of all terms.

    Parameters
    ----------
    runs : sequence of Prepared
    terms : Terms
    given : mapping of int to float, optional
        Coefficients known beforehand, by the place of their column: it is left out, its part taken off the measurement.
    """
    given = given or {}
    pairs = terms.pairs()
    matrix = []
    for r in runs:
        made = r.recording.columns(pairs, list(range(len(pairs)))) if pairs else np.empty((0, r.effort.size))
        left = r.effort - sum(made[place] * value for place, value in given.items())
        free = [i for i in range(len(made)) if i not in given]
        matrix.append(np.vstack([made[free], r.recording.start_shift(pairs), left]).T)
    return Columns(terms, tuple(matrix))


def fitted_blocks(runs: Sequence[Prepared], terms: Terms, given: Mapping[int, float], weights: Weights) -> Blocks:
    """Form the normal equations of a model; its columns stay in the core."""
    pairs, places = terms.pairs(), list(given.items())
    whitening = weights.colour.whitening
    grams = [r.recording.normal_equations(pairs, places, r.effort, _rows(r, weights), whitening) for r in runs]
    return _joined(runs, grams, weights)


def blocks(runs: Sequence[Prepared], made: Columns, weights: Weights, moving: bool = False) -> Blocks:
    """Form the normal equations of columns that are at hand; ``moving`` leaves the reversal zones out."""
    grams = []
    for r, m in zip(runs, made.matrix, strict=True):
        table = weights.colour.whitened(m, r.step_s)
        if moving:
            table = table * ~r.zone[:, None]
        grams.append(_core.normal_equations(np.ascontiguousarray(table.T), _rows(r, weights)))
    return _joined(runs, grams, weights)


def _rows(r: Prepared, weights: Weights) -> list[tuple[int, int, float]]:
    return [
        (first, last, weights.ridge(r.step_s, s.onset_uncertainty_s))
        for s, (first, last) in zip(r.strokes, r.used, strict=True)
    ]


def _joined(runs: Sequence[Prepared], grams: Sequence[np.ndarray], weights: Weights) -> Blocks:
    owners = np.array([s.run for r in runs for s in r.strokes])
    counts = np.array([last - first for r in runs for first, last in r.used])
    return Blocks(np.concatenate(grams), weights.level * start_uncertainty_s(runs), owners, counts)


def start_uncertainty_s(runs: Sequence[Prepared]) -> float:
    """Return by how much the instant of a start is uncertain, on average."""
    return float(np.mean([s.onset_uncertainty_s for r in runs for s in r.strokes]))


def loss(gram: np.ndarray, coefficients: np.ndarray) -> np.ndarray:
    """Return the sum of squares that coefficients leave in one block or a stack of blocks."""
    v = np.append(coefficients, -1.0)
    return np.maximum(np.einsum("i,...ij,j->...", v, gram, v), 0.0)
