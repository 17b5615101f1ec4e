"""Inner parameters by profile: searched on a grid, then refined one at a time with everything linear refitted."""

from __future__ import annotations

import functools
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from ..model import Model, card
from .colour import WHITE
from .equations import Blocks, Columns, Weights, columns, fitted_blocks, loss
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
    """Terms with their normal equations.

    Attributes
    ----------
    problem : Problem
    terms : Terms
    blocks : Blocks
    """

    problem: Problem
    terms: Terms
    blocks: Blocks

    @functools.cached_property
    def coefficients(self) -> np.ndarray:
        """The coefficients with the least sum of squares; the last is the common shift of the starts."""
        return self.blocks.solve()

    @functools.cached_property
    def loss(self) -> float:
        """The least sum of squares."""
        return float(loss(self.blocks.gram, self.coefficients).sum())

    @functools.cached_property
    def made(self) -> Columns:
        """The columns."""
        return columns(self.problem.runs, self.terms, given(self.problem, self.terms))


def plain(problem: Problem) -> Problem:
    """Return the problem without whitening: what is shown is the error that people know."""
    if problem.weights.colour == WHITE:
        return problem
    return replace(problem, weights=replace(problem.weights, colour=WHITE))


def plain_coefficients(problem: Problem, fitted: State) -> np.ndarray:
    """Return what plain least squares give for a state's terms."""
    unweighted = plain(problem)
    return fitted.coefficients if unweighted is problem else state(unweighted, fitted.terms).coefficients


def owners(terms: Terms, model: Model) -> list[tuple[str, int]]:
    """Return (effect, number of its column) for every column of the terms."""
    return [(name, i) for name in terms.effects for i in range(len(card(name, model.structure_name).linear))]


def given(problem: Problem, terms: Terms) -> dict[int, float]:
    """Return the coefficients known beforehand, by the place of their column."""
    if not problem.fixed:
        return {}
    return {i: problem.fixed[o] for i, o in enumerate(owners(terms, problem.model)) if o in problem.fixed}


def state(problem: Problem, terms: Terms) -> State:
    """Form the normal equations of terms; columns that an earlier state had are not made again."""
    return State(problem, terms, fitted_blocks(problem.runs, terms, given(problem, terms), problem.weights))


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
            tried[value] = state(problem, best.terms.having(name, tuple(inner)))
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
