"""Covariance matrix adaptation: the local refinement, at home in bent and kinked valleys."""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np

# A step below this share of the box moves no parameter in its fourth digit.
LEAST_STEP = 1e-5
# A population whose values agree to this has nothing left to gain.
LEAST_SPREAD = 1e-8


def refine(
    evaluate: Callable[[np.ndarray], np.ndarray],
    start: np.ndarray,
    *,
    step: float,
    size: int,
    generations: int,
    random: np.random.Generator,
    told: Callable[[float], None],
) -> tuple[np.ndarray, float]:
    """Improve a point by CMA-ES inside the unit cube.

    Parameters
    ----------
    evaluate : callable
        Of points, shape (n, d); returns values, shape (n,), finite.
    start : ndarray, shape (d,)
    step : float
        First standard deviation, as a share of the box.
    size : int
        Points of a generation.
    generations : int
        At most.
    random : Generator
    told : callable
        Given the least value so far after every generation.

    Returns
    -------
    point : ndarray, shape (d,)
    value : float
        The best that was evaluated.

    Notes
    -----
    Strategy parameters are the defaults of Hansen, The CMA Evolution Strategy: A Tutorial, arXiv:1604.00772, table 1
    (without negative weights). Points outside the cube are folded back at its walls.
    """
    d = len(start)
    parents = size // 2
    weights = math.log((size + 1) / 2) - np.log(np.arange(1, parents + 1))
    weights /= weights.sum()
    mass = 1.0 / float((weights**2).sum())
    path_rate = (4 + mass / d) / (d + 4 + 2 * mass / d)
    step_rate = (mass + 2) / (d + mass + 5)
    one = 2 / ((d + 1.3) ** 2 + mass)
    many = min(1 - one, 2 * (0.25 + mass + 1 / mass - 2) / ((d + 2) ** 2 + mass))
    damping = 1 + 2 * max(0.0, math.sqrt((mass - 1) / (d + 1)) - 1) + step_rate
    usual = math.sqrt(d) * (1 - 1 / (4 * d) + 1 / (21 * d * d))

    mean, sigma = start.copy(), step
    matrix = np.eye(d)
    path, step_path = np.zeros(d), np.zeros(d)
    best, least = start.copy(), math.inf
    for generation in range(1, generations + 1):
        lengths, axes = np.linalg.eigh(matrix)
        lengths = np.sqrt(np.maximum(lengths, 1e-20))
        drawn = (random.standard_normal((size, d)) * lengths) @ axes.T
        inside = folded(mean + sigma * drawn)
        found = evaluate(inside)
        order = np.argsort(found, kind="stable")
        if found[order[0]] < least:
            best, least = inside[order[0]].copy(), float(found[order[0]])
        told(least)
        # The points as they were evaluated, so that the distribution learns what was seen.
        chosen = (inside[order[:parents]] - mean) / sigma
        shift = weights @ chosen
        mean = mean + sigma * shift
        whitened = axes @ ((axes.T @ shift) / lengths)
        step_path = (1 - step_rate) * step_path + math.sqrt(step_rate * (2 - step_rate) * mass) * whitened
        length = float(np.linalg.norm(step_path))
        early = length / math.sqrt(1 - (1 - step_rate) ** (2 * generation)) < (1.4 + 2 / (d + 1)) * usual
        path = (1 - path_rate) * path + (math.sqrt(path_rate * (2 - path_rate) * mass) * shift if early else 0.0)
        lost = 0.0 if early else one * path_rate * (2 - path_rate)
        matrix = (1 - one - many + lost) * matrix + one * np.outer(path, path) + many * (chosen.T * weights) @ chosen
        matrix = 0.5 * (matrix + matrix.T)
        sigma = min(sigma * math.exp((step_rate / damping) * (length / usual - 1)), 0.5)
        spread = float(found[order[parents]] - found[order[0]])
        if sigma * float(lengths.max()) < LEAST_STEP or spread <= LEAST_SPREAD * abs(least):
            break
    return best, least


def folded(points: np.ndarray) -> np.ndarray:
    """Return points with what lies outside the unit cube mirrored at its walls."""
    around = np.mod(points, 2.0)
    return np.where(around > 1.0, 2.0 - around, around)
