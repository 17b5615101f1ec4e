"""Adaptive differential evolution: a population that searches the whole box, one batch per generation."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

# Zhang and Sanderson, JADE: Adaptive Differential Evolution With Optional External Archive, IEEE Trans. Evol. Comput.
# 13(5), 2009: share of the best that lead, and the rate at which the means of F and CR learn.
LEADING_SHARE = 0.1
LEARNING = 0.1
SPREAD = 0.1


def evolve(
    evaluate: Callable[[np.ndarray], np.ndarray],
    points: np.ndarray,
    values: np.ndarray,
    *,
    generations: int,
    random: np.random.Generator,
    told: Callable[[float], None],
) -> tuple[np.ndarray, np.ndarray]:
    """Improve a population by JADE (current-to-pbest/1/bin with an archive) inside the unit cube.

    Parameters
    ----------
    evaluate : callable
        Of points, shape (n, d); returns values, shape (n,), finite.
    points, values : ndarray
        The first population.
    generations : int
    random : Generator
    told : callable
        Given the least value after every generation.

    Returns
    -------
    points, values : ndarray
        The last population.
    """
    points, values = points.copy(), values.copy()
    size, dimension = points.shape
    left_behind = np.empty((0, dimension))
    mean_f, mean_cr = 0.5, 0.5
    for _ in range(generations):
        crossing = np.clip(random.normal(mean_cr, SPREAD, size), 0.0, 1.0)
        # Cauchy's heavy tail keeps some steps long; what is not above 0 becomes short.
        scale = np.clip(mean_f + SPREAD * random.standard_cauchy(size), 0.05, 1.0)
        order = np.argsort(values, kind="stable")
        leaders = points[order[random.integers(0, max(2, round(LEADING_SHARE * size)), size)]]
        first = _others(random, size, size)
        pool = np.concatenate([points, left_behind])
        second = _others(random, size, len(pool))
        step = leaders - points + points[first] - pool[second]
        moved = _bounced(points + scale[:, np.newaxis] * step, points)
        taken = random.random((size, dimension)) < crossing[:, np.newaxis]
        taken[np.arange(size), random.integers(0, dimension, size)] = True
        trial = np.where(taken, moved, points)
        found = evaluate(trial)
        better = found < values
        if better.any():
            left_behind = np.concatenate([left_behind, points[better]])
            if len(left_behind) > size:
                left_behind = left_behind[np.sort(random.permutation(len(left_behind))[:size])]
            gain = scale[better]
            mean_f = (1.0 - LEARNING) * mean_f + LEARNING * float((gain**2).sum() / gain.sum())
            mean_cr = (1.0 - LEARNING) * mean_cr + LEARNING * float(crossing[better].mean())
        points[better], values[better] = trial[better], found[better]
        told(float(values.min()))
    return points, values


def _others(random: np.random.Generator, size: int, among: int) -> np.ndarray:
    """One index below ``among`` for each of ``size``, never its own."""
    drawn = random.integers(0, among - 1, size)
    return drawn + (drawn >= np.arange(size))


def _bounced(moved: np.ndarray, from_: np.ndarray) -> np.ndarray:
    """Send what left the cube half the way to its wall instead."""
    moved = np.where(moved < 0.0, 0.5 * from_, moved)
    return np.where(moved > 1.0, 0.5 * (1.0 + from_), moved)
