"""Least squares for many starts and many training sets at once: every lane of a batch is one perturbed parameter.

Levenberg and Marquardt with bounds. All starts advance together: one batch simulates the perturbed columns of every
start, a second one the trial points of every start for several dampings.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from .parameters import Parameters, step_of
from .record import Record

# Dampings tried at once, as multiples of the last one that worked.
DAMPINGS = (0.03, 1.0, 30.0, 1000.0)
FIRST_DAMPING = 1e-2
LARGEST_DAMPING = 1e9
# Two columns that are the same to rounding leave the normal equations singular without it.
LEAST_DAMPING = 1e-10
# A step that lowers the loss by less than this share is the last: with 10^4 samples a hundredth of what chance does.
CONVERGED = 1e-6


@dataclass(frozen=True)
class Data:
    """What a fit compares with.

    Attributes
    ----------
    records : tuple of Record
    measured : ndarray, shape (samples,)
        The comparison's samples of all runs, one after the other; the channels of a sample stand side by side.
    keep : tuple of ndarray of bool
        The comparison's samples of every run.
    """

    records: tuple[Record, ...]
    measured: np.ndarray
    keep: tuple[np.ndarray, ...]

    @classmethod
    def of(cls, records: Sequence[Record]) -> Data:
        """Return the data of records."""
        keep = tuple(r.usable for r in records)
        measured = np.concatenate([r.measured[k].ravel() for r, k in zip(records, keep, strict=True)])
        return cls(tuple(records), measured, keep)

    def modelled(self, parameters: Parameters, values: np.ndarray) -> np.ndarray:
        """Return the model at the comparison's samples, shape (lanes, samples)."""
        out = parameters.plant.predict(parameters, self.records, values)
        return np.concatenate(
            [(p[:, k] / r.scales).reshape(len(p), -1) for p, r, k in zip(out, self.records, self.keep, strict=True)],
            axis=1,
        )


def jacobian(data: Data, parameters: Parameters, values: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return residual and derivative for several value sets, shapes (sets, samples) and (sets, free, samples)."""
    sets, count = values.shape
    lanes = np.repeat(values, count + 1, axis=0).reshape(sets, count + 1, count)
    steps = np.array([step_of(parameters, v) for v in values])
    for i in range(count):
        lanes[:, i + 1, i] += steps[:, i]
    out = data.modelled(parameters, lanes.reshape(-1, count)).reshape(sets, count + 1, -1)
    # A column without an answer beside its start leads nowhere: the parameter stays.
    lost = ~np.isfinite(out).all(axis=2)
    out[lost] = 0.0
    derivative = (out[:, 1:] - out[:, :1]) / steps[:, :, None]
    derivative[lost[:, 1:] | lost[:, :1]] = 0.0
    return data.measured - out[:, 0], derivative


def losses(data: Data, parameters: Parameters, values: np.ndarray, weights: np.ndarray | None = None) -> np.ndarray:
    """Return the sum of squares of several value sets, shape (sets,); weights of shape (sets, samples) or none."""
    residual = data.measured - data.modelled(parameters, values)
    lost = ~np.isfinite(residual).all(axis=1)
    residual[lost] = 0.0
    squares = residual**2
    total = squares.sum(axis=1) if weights is None else (squares * weights).sum(axis=1)
    return np.where(lost, np.inf, total)


def minimise(
    data: Data,
    parameters: Parameters,
    values: np.ndarray,
    weights: np.ndarray | None = None,
    *,
    iterations: int = 25,
) -> tuple[np.ndarray, np.ndarray]:
    """Minimise the sum of squares from several starts.

    Parameters
    ----------
    data : Data
    parameters : Parameters
    values : ndarray, shape (sets, free)
    weights : ndarray, shape (sets, samples), optional
        Training set of every start: 0 leaves a sample out.
    iterations : int

    Returns
    -------
    values : ndarray, shape (sets, free)
    losses : ndarray, shape (sets,)
    """
    values = parameters.inside(np.array(values, float))
    sets, count = values.shape
    best = losses(data, parameters, values, weights)
    if count == 0:
        return values, best
    damping = np.full(sets, FIRST_DAMPING)
    active = np.isfinite(best)
    for _ in range(iterations):
        at = np.flatnonzero(active)
        if not at.size:
            break
        residual, derivative = jacobian(data, parameters, values[at])
        trials = np.empty((at.size, len(DAMPINGS), count))
        for k, s in enumerate(at):
            trials[k] = _trials(parameters, values[s], residual[k], derivative[k], _row(weights, s), damping[s])
        several = None if weights is None else np.repeat(weights[at], len(DAMPINGS), axis=0)
        found = losses(data, parameters, trials.reshape(-1, count), several).reshape(at.size, -1)
        for k, s in enumerate(at):
            j = int(np.argmin(found[k]))
            if found[k, j] < best[s]:
                fall = 1.0 - found[k, j] / best[s] if best[s] > 0.0 else 0.0
                best[s], values[s] = found[k, j], trials[k, j]
                damping[s] = max(damping[s] * DAMPINGS[j], 1e-12)
                active[s] = fall > CONVERGED
            else:
                damping[s] *= 1e3
                active[s] = damping[s] < LARGEST_DAMPING
    return values, best


def _row(weights: np.ndarray | None, s: int) -> np.ndarray | None:
    return None if weights is None else weights[s]


def _trials(
    parameters: Parameters,
    values: np.ndarray,
    residual: np.ndarray,
    derivative: np.ndarray,
    weight: np.ndarray | None,
    damping: float,
) -> np.ndarray:
    scaled = derivative * parameters.scale[:, None]
    weighted = scaled if weight is None else scaled * weight
    gram, slope = weighted @ scaled.T, weighted @ residual
    # What stands at a bound and pulls outward stays there.
    free = ~(((values <= parameters.low) & (slope < 0.0)) | ((values >= parameters.high) & (slope > 0.0)))
    out = np.tile(values, (len(DAMPINGS), 1))
    if not free.any():
        return out
    # Every column is brought to length 1, so that the damping means the same for all of them; one without influence
    # keeps a length of nothing and stays.
    length = np.sqrt(np.maximum(np.diag(gram)[free], np.finfo(float).tiny))
    normal = gram[np.ix_(free, free)] / np.outer(length, length)
    for j, factor in enumerate(DAMPINGS):
        step = np.linalg.solve(
            normal + max(damping * factor, LEAST_DAMPING) * np.eye(length.size), slope[free] / length
        )
        out[j, free] += step / length * parameters.scale[free]
    return parameters.inside(out)
