"""What each effect of the catalogue would do for a fitted model: refit with it, predict what was not seen.

Naming rests on this and on nothing else. A candidate's inner parameters are chosen on the strokes a fold was trained
on, its loss is counted on the others.
"""

from __future__ import annotations

import os
from collections.abc import Callable, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass

import numpy as np

from ..model import Card, cards
from .fit import Fit
from .profile import Problem, State, state
from .score import Feature
from .search import Search
from .terms import inner_grid

# A candidate within this many standard errors (paired by stroke) of the best is not told apart from it.
SET_ERRORS = 2.0
# A gain that no engineer would act on is none: 1 % of the held-out error (rms).
PRACTICAL_GAIN = 0.01
# A law is an idealisation: of the sum of squares that it takes off it may leave this share in a shape of its own. A
# gap of 2 degrees leaves half of it.
LAW_ACCURACY = 0.01
# What a law leaves has no shape of the catalogue: an effect that takes this share of the rest is more than that.
MUCH_OF_THE_REST = 0.2
# Candidates whose loss on the coarse grid is within this factor of the best are refined before they are compared.
REFINED_WITHIN = 1.6
BENT_WITHIN = 6.0
# Grid points per candidate shown to the score test; more only overlap.
TESTED_POINTS = 5


@dataclass(frozen=True)
class Candidate:
    """One effect tried on top of a model.

    Attributes
    ----------
    card : Card
    search : Search
        Its states and held-out losses.
    """

    card: Card
    search: Search

    @property
    def name(self) -> str:
        """The effect's name."""
        return self.card.name

    @property
    def held_out_loss(self) -> float:
        """Held-out sum of squares."""
        return self.search.held_out_loss


def possible(fitted: Fit) -> list[Card]:
    """Return the cards of what may be missing: not in the model already, and meaningful for it."""
    model = fitted.model
    found = []
    for c in cards(model.structure_name):
        if not c.is_searched_on(model.structure_name):
            continue
        if c.name in model.effects or (c.needs and c.needs not in model.effects):
            continue
        if c.channel and any(not r.has_load for r in fitted.runs):
            continue
        if c.per_turn and model.structure_name == "axis" and "pitch_m" not in model.known:
            continue
        found.append(c)
    return found


def baseline(fitted: Fit) -> Search:
    """Return the fitted model as the candidates meet it: its inner parameters as they are, in every fold."""
    search = Search(fitted.search.folds)
    search.visit(fitted.state)
    return search


def try_all(fitted: Fit, progress: Callable[[int, int], None] | None = None) -> tuple[list[Candidate], list[Feature]]:
    """Refit a model with each possible effect.

    Returns
    -------
    candidates : list of Candidate
        By held-out loss, the best first.
    features : list of Feature
        The same candidates as directions for the score test.
    """
    found, features = [], []
    listed = possible(fitted)
    # The core works outside the interpreter's lock, so that threads share the work; the order stays that of the cards.
    with ThreadPoolExecutor(os.cpu_count() or 1) as pool:
        for done, (candidate, tested) in enumerate(pool.map(lambda c: _try(fitted, c), listed)):
            found.append(candidate)
            features += tested
            if progress is not None:
                progress(done + 1, len(listed))
    found.sort(key=lambda c: c.held_out_loss)
    least = found[0].held_out_loss if found else 0.0
    # Where even the best takes next to nothing off, refining changes no answer.
    worth = least < (1.0 - 0.5 * PRACTICAL_GAIN) ** 2 * baseline(fitted).held_out_loss
    if worth:
        with ThreadPoolExecutor(os.cpu_count() or 1) as pool:
            list(pool.map(lambda c: _refine(fitted, c, least), found))
    found.sort(key=lambda c: c.held_out_loss)
    return found, features


def _refine(fitted: Fit, candidate: Candidate, least: float) -> None:
    # What changes the contact or the delay may have bent the break-away of the model without it: both are refined.
    bends = candidate.card.shapes_others
    if candidate.card.inner and candidate.held_out_loss <= (BENT_WITHIN if bends else REFINED_WITHIN) * least:
        candidate.search.refine(fitted.problem, only=None if bends else candidate.name, rounds=2 if bends else 1)


def _try(fitted: Fit, c: Card) -> tuple[Candidate, list[Feature]]:
    problem, base = fitted.problem, fitted.state
    search = Search(fitted.search.folds)
    points = inner_grid(c.name, problem.model, problem.runs)
    tested = set(np.linspace(0, len(points) - 1, min(TESTED_POINTS, len(points))).round().astype(int).tolist())
    features: list[Feature] = []
    for i, inner in enumerate(points):
        tried = state(problem, base.terms.having(c.name, inner))
        search.visit(tried)
        if i in tested:
            features += _features(problem, base, tried, c)
    return Candidate(c, search), features


def _features(problem: Problem, base: State, tried: State, c: Card) -> list[Feature]:
    more = tried.made.matrix[0].shape[1] - base.made.matrix[0].shape[1]
    if more:
        added = tuple(m[:, -2 - more : -2] for m in tried.made.matrix)
        features = [Feature(c.name, added)]
        # Inertia shows where the speed changes most.
        return [*features, Feature(c.name, added, inside_zones=True)] if c.name == "inertia" else features
    change = tuple(
        ((t[:, :-1] - b[:, :-1]) @ base.coefficients)[:, None]
        for t, b in zip(tried.made.matrix, base.made.matrix, strict=True)
    )
    return [Feature(c.name, change), Feature(c.name, change, inside_zones=True)]


def paired_error(a: Sequence[float] | np.ndarray, b: Sequence[float] | np.ndarray) -> tuple[float, float]:
    """Return the sum of the differences of two losses by stroke and its standard error."""
    difference = np.asarray(a) - np.asarray(b)
    if difference.size < 2:
        # One stroke has no scatter to be judged by.
        return float(difference.sum()), np.inf
    return float(difference.sum()), float(difference.std(ddof=1) * np.sqrt(difference.size))


def gain(base: Search, better: Search) -> tuple[float, float]:
    """Return the share of the held-out error (rms) that a candidate takes away.

    The second value says how many standard errors, paired by stroke, the fall of the loss is.
    """
    total, error = paired_error(base.losses, better.losses)
    left = better.held_out_loss / max(base.held_out_loss, np.finfo(float).tiny)
    return 1.0 - float(np.sqrt(max(left, 0.0))), total / max(error, np.finfo(float).tiny)


def beyond_the_law(base: Search, better: Search, explained: float) -> bool:
    """Whether a candidate takes off more than the laws that are in the model already may have left of their own part.

    Parameters
    ----------
    base, better : Search
        Without and with the candidate.
    explained : float
        The held-out sum of squares that the effects added before have taken off.
    """
    fall = base.held_out_loss - better.held_out_loss
    return fall >= LAW_ACCURACY * explained or fall >= MUCH_OF_THE_REST * base.held_out_loss


def as_good_as_a_law(found: Sequence[Candidate], base: Search) -> list[Candidate]:
    """Return the best candidate and those that take off as much as it does, but for what a law may leave.

    A law that is right leaves a little in a shape of its own: a rival so close behind may be the right one, however
    surely the numbers prefer the best.
    """
    if not found:
        return []
    best = found[0]
    leave = LAW_ACCURACY * max(base.held_out_loss - best.held_out_loss, 0.0)
    return [c for c in found if c.held_out_loss - best.held_out_loss <= leave]


def equivalent(found: Sequence[Candidate]) -> list[Candidate]:
    """Return the best candidate and those that the data cannot tell from it; decoys compete like the others."""
    if not found:
        return []
    best = found[0]
    chosen = [best]
    for other in found[1:]:
        behind, error = paired_error(other.search.losses, best.search.losses)
        if behind <= SET_ERRORS * error:
            chosen.append(other)
    return chosen
