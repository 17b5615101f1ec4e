"""Runs whose sensors differ: an offset or a delay that one run has and the others have not.

A load cell zeroed anew, another trigger: what belongs to the sensor of one run says nothing about the mechanism. Left
in, it would be noise of the worst kind, the same in a whole run. Where runs differ clearly the difference is taken off
before anything is compared, and the fit says so.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from ..model import Model
from .equations import columns
from .floor import friction_level, saturated
from .prepare import Prepared, stroke_of_samples, stroke_offsets
from .terms import start_terms

# A difference counts from so many standard errors on, clustered by stroke: six strokes of a run give a t-distribution
# with a heavy tail, and a needless correction does no harm.
CLEAR = 4.0
# Of what the saturated model leaves: a smaller offset changes the error by less than 1 %.
LEAST_OFFSET = 0.15
# The clustered error of a coefficient that rests on one stroke or two is next to nothing: such a run is not judged.
LEAST_STROKES = 4
# The longest delay that is searched for anywhere; what looks like more is something else.
LONGEST_DELAY_S = 0.1
# Passes of the linear estimate of a delay; the second one corrects what the first one's straight line missed.
PASSES = 3


def levelled(runs: tuple[Prepared, ...], model: Model) -> tuple[Prepared, ...]:
    """Return runs without what only the sensor of one run has; those that agree are returned as they are.

    Parameters
    ----------
    runs : tuple of Prepared
    model : Model
        Delays of the effort are looked for where it has Coulomb friction: nothing else shows the instant.
    """
    if int(_judged(runs).sum()) < 2 or any(not r.strokes for r in runs):
        return runs
    runs = _without_own_offsets(runs)
    return _without_own_delays(runs, model) if "coulomb" in model.effects else runs


def _judged(runs: Sequence[Prepared]) -> np.ndarray:
    """Return which runs have strokes enough, in both directions: one way an offset is friction."""
    return np.array([len(r.strokes) >= LEAST_STROKES and len({s.direction for s in r.strokes}) > 1 for r in runs])


def _without_own_offsets(runs: tuple[Prepared, ...]) -> tuple[Prepared, ...]:
    """Take off what one run lies above the others, at the same place, speed, direction and time."""
    keep = [r.usable & ~r.zone for r in runs]
    made = [m[k] for m, k in zip(saturated(runs), keep, strict=True)]
    effort = [r.effort[k] for r, k in zip(runs, keep, strict=True)]
    own, error, rest = _own(made, [np.ones((len(m), 1)) for m in made], effort, _owners(runs, keep))
    judged = _judged(runs)
    apart = own - np.median(own[judged])
    clear = judged & (np.abs(apart) > CLEAR * error) & (np.abs(apart) > LEAST_OFFSET * rest)
    return tuple(
        replace(r, effort=r.effort - d, own_offset=float(d)) if c else r
        for r, d, c in zip(runs, apart, clear, strict=True)
    )


def _without_own_delays(runs: tuple[Prepared, ...], model: Model) -> tuple[Prepared, ...]:
    """Shift the effort of a run whose reversals come later or earlier than those of the others."""
    terms = start_terms(model, runs)
    level = friction_level(runs)
    least = float(np.mean([s.onset_uncertainty_s for r in runs for s in r.strokes]))
    if level <= 0.0:
        return runs
    shifted, judged = np.zeros(len(runs)), _judged(runs)
    at = runs
    for turn in range(PASSES):
        matrix = columns(at, terms).matrix
        keep = [r.usable for r in at]
        made = [m[k, :-2] for m, k in zip(matrix, keep, strict=True)]
        early = [m[k, -2:-1] for m, k in zip(matrix, keep, strict=True)]
        own, error, _ = _own(made, early, [m[k, -1] for m, k in zip(matrix, keep, strict=True)], _owners(at, keep))
        # The column is what an earlier start adds, per second and unit of friction.
        late, error = -own / level, error / level
        apart = late - np.median(late[judged])
        clear = judged & (np.abs(apart) > CLEAR * error) & (np.abs(apart) > least) & (np.abs(apart) <= LONGEST_DELAY_S)
        if turn == 0:
            moved = clear
        if not np.any(moved):
            return runs
        shifted = shifted + np.where(moved, apart, 0.0)
        at = tuple(
            replace(r, effort=_earlier(r.effort, d / r.step_s), own_delay_s=float(d)) if m else r
            for r, d, m in zip(runs, shifted, moved, strict=True)
        )
    return at


def _earlier(effort: np.ndarray, samples: float) -> np.ndarray:
    """Read an effort later by a number of samples: 8 of them to a period of the band, a line would be too coarse."""
    from scipy.interpolate import CubicSpline

    last = effort.size - 1
    return CubicSpline(np.arange(effort.size), effort)(np.clip(np.arange(effort.size) + samples, 0.0, last))


def _owners(runs: Sequence[Prepared], keep: Sequence[np.ndarray]) -> list[np.ndarray]:
    """Return the stroke of every kept sample, counted over all runs."""
    return [stroke_of_samples(r, o)[k] for (r, o), k in zip(stroke_offsets(runs), keep, strict=True)]


def _own(
    made: Sequence[np.ndarray], own: Sequence[np.ndarray], effort: Sequence[np.ndarray], owners: Sequence[np.ndarray]
) -> tuple[np.ndarray, np.ndarray, float]:
    """Fit common columns and one coefficient per run; return these, their clustered errors, and the rms left.

    What the common columns cannot tell from a coefficient of all runs leaves only differences, which are what counts.
    """
    count = len(made)
    wide = []
    for number, column in enumerate(own):
        block = np.zeros((len(column), count))
        block[:, number] = column[:, 0]
        wide.append(block)
    common = np.concatenate(made)
    scale = np.linalg.norm(common, axis=0)
    table = np.hstack([common[:, scale > 0.0] / scale[scale > 0.0], np.concatenate(wide)])
    response, owner = np.concatenate(effort), np.concatenate(owners)
    gram = table.T @ table
    # A little less than nothing: hats that no sample touches, and the sum of all hats, which is a constant.
    inverse = np.linalg.pinv(gram, rcond=1e-9, hermitian=True)
    coefficients = inverse @ (table.T @ response)
    residual = response - table @ coefficients
    belongs = (owner == np.arange(owner.max(initial=-1) + 1)[:, None]).astype(float)
    scores = belongs @ (table * residual[:, None])
    # Each run against the mean of the others, whose clustered variance is that of the same contrast.
    contrast = np.zeros((count, len(coefficients)))
    contrast[:, -count:] = np.eye(count) - (1.0 - np.eye(count)) / (count - 1)
    spread = (contrast @ inverse) @ scores.T
    error = np.sqrt(np.sum(spread**2, axis=1))
    return coefficients[-count:], error, float(np.sqrt(np.mean(residual**2)))
