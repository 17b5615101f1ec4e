"""Inner parameters by profile: searched on a grid, then refined one at a time with everything linear refitted."""

from __future__ import annotations

import functools
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from ..model import Model, card
from .equations import Blocks, Columns, Weights, blocks, columns, loss
from .grids import is_continuous, is_geometric, limits, points
from .prepare import Prepared
from .terms import Terms

# Rounds over all inner parameters, and the relative fall of the loss below which another round is not worth it.
ROUNDS = 3
WORTH = 1e-4
# Width to which one parameter is located, as a share of its grid's spacing: far below its standard error.
LOCATED = 0.02


@dataclass(frozen=True)
class Problem:
    """What stays the same while parameters vary.

    Attributes
    ----------
    runs : tuple of Prepared
    model : Model
        Its structure, band and known values.
    weights : Weights
    fixed : mapping of (effect, column) to float
        Coefficients that are given beforehand.
    """

    runs: Sequence[Prepared]
    model: Model
    weights: Weights
    fixed: Mapping[tuple[str, int], float]


@dataclass(frozen=True)
class State:
    """Terms with their columns and blocks."""

    terms: Terms
    made: Columns
    blocks: Blocks

    @functools.cached_property
    def coefficients(self) -> np.ndarray:
        """The coefficients with the least sum of squares; the last is the common shift of the starts."""
        return self.blocks.solve()

    @functools.cached_property
    def loss(self) -> float:
        """The least sum of squares."""
        return float(loss(self.blocks.gram, self.coefficients).sum())


def _shapes_others(problem: Problem, name: str) -> bool:
    return card(name, problem.model.structure_name).shapes_others


def owners(terms: Terms, model: Model) -> list[tuple[str, int]]:
    """Return (effect, number of its column) for every column of the terms."""
    return [(name, i) for name in terms.effects for i in range(len(card(name, model.structure_name).linear))]


def state(problem: Problem, terms: Terms, like: State | None = None, changed: str | None = None) -> State:
    """Build columns and blocks; with ``like`` and ``changed`` only the columns of one effect are made anew."""
    if like is None or changed is None or _shapes_others(problem, changed) or like.terms.effects != terms.effects:
        made = _known_removed(problem, terms, columns(problem.runs, terms))
    else:
        made = _replaced(problem, terms, like.made, changed)
    return State(terms, made, blocks(problem.runs, made, problem.weights))


def _free(problem: Problem, terms: Terms) -> list[int]:
    return [i for i, owner in enumerate(owners(terms, problem.model)) if owner not in problem.fixed]


def _known_removed(problem: Problem, terms: Terms, made: Columns) -> Columns:
    if not problem.fixed:
        return made
    all_owners = owners(terms, problem.model)
    free = _free(problem, terms)
    matrix = []
    for m in made.matrix:
        known = sum(problem.fixed[o] * m[:, i] for i, o in enumerate(all_owners) if o in problem.fixed)
        matrix.append(np.column_stack([m[:, free], m[:, -2], m[:, -1] - known]))
    return Columns(terms, tuple(matrix))


def _replaced(problem: Problem, terms: Terms, made: Columns, changed: str) -> Columns:
    index = terms.effects.index(changed)
    free = [o for o in owners(terms, problem.model) if o not in problem.fixed]
    places = [k for k, (name, _) in enumerate(free) if name == changed]
    matrix = []
    for r, m in zip(problem.runs, made.matrix, strict=True):
        m = m.copy()
        m[:, places] = r.recording.columns(terms.pairs(), [index]).T
        matrix.append(m)
    return Columns(terms, tuple(matrix))


def with_effect(problem: Problem, base: State, name: str, inner: tuple[float, ...]) -> State:
    """Return the state with one effect more."""
    terms = base.terms.having(name, inner)
    if _shapes_others(problem, name):
        return state(problem, terms)
    index = terms.effects.index(name)
    more = [r.recording.columns(terms.pairs(), [index]).T for r in problem.runs]
    made = Columns(terms, base.made.having(more).matrix)
    return State(terms, made, blocks(problem.runs, made, problem.weights))


def refine(
    problem: Problem,
    start: State,
    only: str | None = None,
    rounds: int = ROUNDS,
    visit: Callable[[State], None] | None = None,
) -> State:
    """Locate every inner parameter (or those of one effect) at the least sum of squares.

    Parameters
    ----------
    problem : Problem
    start : State
        From a grid search; each parameter is looked for between the neighbours of its grid point, and further if the
        least lies at an end.
    only : str, optional
        Refine this effect's parameters alone.
    rounds : int
        Passes over the parameters.
    visit : callable, optional
        Is shown every state tried.
    """
    best = start
    for _ in range(rounds):
        before, since = best.loss, best.terms
        for name in best.terms.effects:
            if only is not None and name != only:
                continue
            for i, p in enumerate(card(name, problem.model.structure_name).inner):
                if f"{name}.{p.key}" in problem.model.known:
                    continue
                best = _refine_one(problem, best, name, i, visit)
        best = _along(problem, best, since, visit)
        if best.loss > before * (1.0 - WORTH):
            break
    return best


def _along(problem: Problem, best: State, since: Terms, visit: Callable[[State], None] | None) -> State:
    """Go on in the direction in which a round has moved all inner parameters together.

    Two parameters that do nearly the same (a break-away and a delay) lie along a valley; one at a time crosses it in
    steps that grow ever smaller.
    """
    moved = [n for n, values in best.terms.inner.items() if since.inner.get(n) not in (None, values)]
    if len(moved) < 2:
        return best
    tried = [best]

    def at(share: float) -> float:
        inner = dict(best.terms.inner)
        for n in moved:
            inside = card(n, problem.model.structure_name).inner
            bounds = [limits(p, problem.runs) for p in inside]
            inner[n] = tuple(
                float(np.clip(a + share * (b - a), *limit))
                for a, b, limit in zip(since.inner[n], inner[n], bounds, strict=True)
            )
        tried.append(state(problem, Terms(best.terms.effects, inner)))
        if visit is not None:
            visit(tried[-1])
        return tried[-1].loss

    share, step = 1.0, 1.0
    while step < 20.0 and at(share + step) < min(s.loss for s in tried[:-1]):
        share, step = share + step, 2.0 * step
    return min(tried, key=lambda s: s.loss)


def _refine_one(problem: Problem, best: State, name: str, i: int, visit: Callable[[State], None] | None) -> State:
    p = card(name, problem.model.structure_name).inner[i]
    grid = points(p, problem.runs)
    low, high = limits(p, problem.runs)
    tried: dict[float, State] = {best.terms.inner[name][i]: best}

    def at(value: float) -> float:
        value = float(np.clip(value, low, high))
        if value not in tried:
            inner = list(best.terms.inner[name])
            inner[i] = value
            tried[value] = state(problem, best.terms.having(name, tuple(inner)), best, name)
            if visit is not None:
                visit(tried[value])
        return tried[value].loss

    if not is_continuous(p):
        for value in grid:
            at(float(value))
    elif len(grid) > 1:
        to, back = (np.log, np.exp) if is_geometric(p) else (lambda v: v, lambda v: v)
        spacing = float(to(grid[1]) - to(grid[0]))
        centre = float(to(best.terms.inner[name][i]))
        golden(lambda v: at(float(back(v))), centre, spacing)
    return min(tried.values(), key=lambda s: s.loss)


def golden(f: Callable[[float], float], centre: float, spacing: float) -> float:
    """Find a minimum near ``centre`` by golden section, walking on while it lies at an end of the bracket.

    Derivatives are of no use here: the loss over a gap or a break-away has corners at the steps of the sensor.
    """
    low, high = centre - spacing, centre + spacing
    f_low, f_centre, f_high = f(low), f(centre), f(high)
    for _ in range(6):
        if f_low < f_centre and f_low <= f_high:
            low, centre, high = low - spacing, low, centre
            f_low, f_centre, f_high = f(low), f_low, f_centre
        elif f_high < f_centre:
            low, centre, high = centre, high, high + spacing
            f_low, f_centre, f_high = f_centre, f_high, f(high)
        else:
            break
    ratio = (np.sqrt(5.0) - 1.0) / 2.0
    a, b = high - ratio * (high - low), low + ratio * (high - low)
    f_a, f_b = f(a), f(b)
    while high - low > LOCATED * spacing:
        if f_a <= f_b:
            high, b, f_b = b, a, f_a
            a = high - ratio * (high - low)
            f_a = f(a)
        else:
            low, a, f_a = a, b, f_b
            b = low + ratio * (high - low)
            f_b = f(b)
    return (low + high) / 2.0
