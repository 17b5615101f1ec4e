"""The whole search: a first sample, evolution, refinement of the best and of the best elsewhere; what it has seen."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np

from .covariance_adaptation import refine
from .differential_evolution import evolve

# Two points are of different kinds when some parameter differs by this share of its range.
ELSEWHERE = 0.15
# Levels within this share of the optimum count as flat.
FLAT_SHARE = 0.01
FLAT_ROUNDS = 6


@dataclass(frozen=True)
class Effort:
    """How hard is searched, in points evaluated.

    Parameters
    ----------
    first : int
        Of the first sample.
    population, generations : int
        Of the evolution.
    refinement, refinements : int
        Points of a generation of the refinement, and generations at most.
    flat : int
        Points of a round that looks how flat the optimum is; 0: none.
    """

    first: int = 2048
    population: int = 96
    generations: int = 60
    refinement: int = 32
    refinements: int = 90
    flat: int = 256


@dataclass(frozen=True)
class Step:
    """A generation of the search."""

    stage: str
    evaluations: int
    best: float

    def to_dict(self) -> dict[str, Any]:
        """Return the step as plain JSON values."""
        return {"stage": self.stage, "evaluations": self.evaluations, "best": self.best}


@dataclass(frozen=True)
class Found:
    """What a search has found; points of the unit cube.

    Attributes
    ----------
    point, value
        The best.
    other, other_value
        The best that differs by at least 0.15 of the range in some parameter; None where there was none.
    flat : ndarray or None
        The points of its kind that are at most 1 % worse than the best.
    history : tuple of Step
    """

    point: np.ndarray
    value: float
    other: np.ndarray | None
    other_value: float | None
    flat: np.ndarray | None
    history: tuple[Step, ...]


class _Memory:
    """Evaluates points and keeps all of them."""

    def __init__(self, evaluate: Callable[[np.ndarray], np.ndarray], told: Callable[[Step], None]) -> None:
        self.of = evaluate
        self.told = told
        self.points: list[np.ndarray] = []
        self.values: list[np.ndarray] = []
        self.count = 0
        self.least = float("inf")
        self.stage = ""
        self.history: list[Step] = []

    def __call__(self, points: np.ndarray) -> np.ndarray:
        values = self.of(points)
        self.points.append(points.copy())
        self.values.append(values)
        self.count += len(points)
        self.least = min(self.least, float(values.min()))
        return values

    def tell(self, _best_of_stage: float) -> None:
        step = Step(self.stage, self.count, self.least)
        self.history.append(step)
        self.told(step)

    def all(self) -> tuple[np.ndarray, np.ndarray]:
        return np.concatenate(self.points), np.concatenate(self.values)


def search(
    evaluate: Callable[[np.ndarray], np.ndarray],
    dimension: int,
    *,
    seed: int,
    effort: Effort,
    known: np.ndarray | None = None,
    told: Callable[[Step], None] = lambda step: None,
) -> Found:
    """Find the least value in the unit cube; the same for the same seed, whatever the number of threads.

    Parameters
    ----------
    evaluate : callable
        Of points, shape (n, dimension); returns values, shape (n,), finite.
    dimension : int
    seed : int
    effort : Effort
    known : ndarray, shape (k, dimension), optional
        Points that are worth a try, put into the first sample.
    told : callable
        Given every step of the history.
    """
    random = np.random.default_rng(seed)
    memory = _Memory(evaluate, told)
    memory.stage = "sample"
    first = _spread(random, effort.first, dimension)
    if known is not None:
        first = np.concatenate([known, first])
    values = memory(first)
    memory.tell(float(values.min()))
    order = np.argsort(values, kind="stable")[: effort.population]
    memory.stage = "evolution"
    points, values = evolve(
        memory, first[order], values[order], generations=effort.generations, random=random, told=memory.tell
    )
    memory.stage = "refinement"
    at = int(np.argmin(values))
    point, value = points[at], float(values[at])
    point, value = _refined(memory, point, value, effort, random)
    memory.stage = "elsewhere"
    other, other_value = _elsewhere(memory, point, effort, random)
    if other is not None and other_value is not None and other_value < value:
        point, value, other, other_value = other, other_value, point, value
    flat = None
    if effort.flat:
        memory.stage = "flatness"
        flat = _flat(memory, point, value, effort, random)
    return Found(point, value, other, other_value, flat, tuple(memory.history))


def _spread(random: np.random.Generator, size: int, dimension: int) -> np.ndarray:
    """Draw a Latin hypercube."""
    cells = np.stack([random.permutation(size) for _ in range(dimension)], axis=1)
    return (cells + random.random((size, dimension))) / size


def _refined(
    memory: _Memory, point: np.ndarray, value: float, effort: Effort, random: np.random.Generator
) -> tuple[np.ndarray, float]:
    # Twice: the first ends where its distribution has shrunk, the second looks around from there once more.
    for step in (0.03, 0.01):
        tried, found = refine(
            memory,
            point,
            step=step,
            size=effort.refinement,
            generations=effort.refinements,
            random=random,
            told=memory.tell,
        )
        if found < value:
            point, value = tried, found
    return point, value


def _elsewhere(
    memory: _Memory, best: np.ndarray, effort: Effort, random: np.random.Generator
) -> tuple[np.ndarray | None, float | None]:
    """Return the best point of another kind, refined as long as it stays there."""
    points, values = memory.all()
    far = np.abs(points - best).max(axis=1) >= ELSEWHERE
    if not far.any():
        return None, None
    start = points[far][np.argmin(values[far])]
    refine(
        memory,
        start,
        step=0.03,
        size=effort.refinement,
        generations=effort.refinements,
        random=random,
        told=memory.tell,
    )
    points, values = memory.all()
    far = np.abs(points - best).max(axis=1) >= ELSEWHERE
    at = int(np.argmin(np.where(far, values, np.inf)))
    return points[at], float(values[at])


def _flat(memory: _Memory, best: np.ndarray, value: float, effort: Effort, random: np.random.Generator) -> np.ndarray:
    """Return the points within 1 %, looked for by a cloud that grows where points were good."""
    limit = value + FLAT_SHARE * abs(value)
    for _ in range(FLAT_ROUNDS):
        points, values = memory.all()
        good = points[(values <= limit) & (np.abs(points - best).max(axis=1) < ELSEWHERE)]
        d = len(best)
        spread = np.cov(good.T) if len(good) > d + 1 else 1e-6 * np.eye(d)
        # Twice as wide as what was good, so that the next round meets the border from outside.
        lengths, axes = np.linalg.eigh(4.0 * spread + 1e-10 * np.eye(d))
        cloud = (random.standard_normal((effort.flat, d)) * np.sqrt(np.maximum(lengths, 0.0))) @ axes.T
        memory(np.clip(best + cloud, 0.0, 1.0))
        memory.tell(value)
    points, values = memory.all()
    return points[(values <= limit) & (np.abs(points - best).max(axis=1) < ELSEWHERE)]
