"""Solving for the parameters of a model, and of every fold: global search over what moves events, then local."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from ..model import Model, card
from ..model.cards import own_cards
from .folds import folds_of, training
from .intervals import stroke_slices
from .least_squares import Data, minimise
from .parameters import Parameters, parameters_of
from .plant import Plant
from .record import Record
from .starts import first_starts, starts_with

# Iterations of the search from every start, and how many of the starts go on to the end.
SHORT_SEARCH = 3
FINALISTS = 2
# A start that ends where another one does is not followed twice.
SAME_LOSS = 1e-4


@dataclass(frozen=True)
class Problem:
    """The records of a fit, made ready once.

    Attributes
    ----------
    plant : Plant
    data : Data
    sizes : mapping
        What is large for each parameter.
    fold : ndarray, shape (samples,)
    strokes : list of slice
        The comparison's samples of every stroke.
    """

    plant: Plant
    data: Data
    sizes: Mapping[str, float]
    fold: np.ndarray
    strokes: list[slice]

    @classmethod
    def of(cls, plant: Plant, records: Sequence[Record], model: Model) -> Problem:
        """Return the problem of records; the model gives what is known."""
        data = Data.of(records)
        return cls(plant, data, plant.sizes(records, model), folds_of(data), stroke_slices(data))


@dataclass(frozen=True)
class Solution:
    """A solved model.

    Attributes
    ----------
    parameters : Parameters
    values : ndarray, shape (free,)
    loss : float
    fold_values : ndarray, shape (folds, free)
        Fitted without the fold.
    unseen : ndarray, shape (samples,)
        Measured less modelled, every sample from a fit that has not seen it.
    stroke_losses : ndarray, shape (strokes,)
        Sum of squares of ``unseen`` by stroke.
    """

    parameters: Parameters
    values: np.ndarray
    loss: float
    fold_values: np.ndarray
    unseen: np.ndarray
    stroke_losses: np.ndarray

    @property
    def found(self) -> dict[str, float]:
        """The values by key."""
        return self.parameters.values_of(self.values)

    @property
    def held_out_loss(self) -> float:
        """Sum of squares of what was not seen."""
        return float(self.stroke_losses.sum())


def solve(problem: Problem, model: Model) -> Solution:
    """Fit a model from nothing: the mechanism first, then its effects one after the other."""
    bare = _only(model, [e for e in model.effects if e in problem.plant.first])
    parameters = parameters_of(problem.plant, bare, problem.sizes)
    values, loss = _search(problem, parameters, first_starts(parameters))
    for effect in (e for e in _in_order(model) if e not in bare.effects):
        found = parameters.values_of(values)
        bare = _only(model, [*bare.effects, effect])
        parameters = parameters_of(problem.plant, bare, problem.sizes)
        values, loss = _search(problem, parameters, starts_with(parameters, found, effect))
    # The effects stand in the model's own order.
    own = parameters_of(problem.plant, model, problem.sizes)
    values = np.array([parameters.values_of(values)[key] for key in own.free])
    return complete(problem, own, values, loss)


def solve_with(problem: Problem, model: Model, found: Mapping[str, float], effect: str) -> Solution:
    """Fit a model in which one effect is new and the others start from what was found."""
    parameters = parameters_of(problem.plant, model, problem.sizes)
    values, loss = _search(problem, parameters, starts_with(parameters, found, effect))
    return complete(problem, parameters, values, loss)


def solve_from(problem: Problem, model: Model, found: Mapping[str, float]) -> Solution:
    """Fit a model from what was found for a larger or equal one."""
    parameters = parameters_of(problem.plant, model, problem.sizes)
    start = np.array([[found.get(key, 0.0) for key in parameters.free]])
    values, loss = minimise(problem.data, parameters, start)
    return complete(problem, parameters, values[0], float(loss[0]))


def _search(problem: Problem, parameters: Parameters, starts: np.ndarray) -> tuple[np.ndarray, float]:
    values, loss = minimise(problem.data, parameters, starts, iterations=SHORT_SEARCH)
    order = np.argsort(loss)
    best = [int(order[0])]
    for i in map(int, order[1:]):
        if len(best) < FINALISTS and loss[i] > loss[best[-1]] * (1.0 + SAME_LOSS):
            best.append(i)
    values, loss = minimise(problem.data, parameters, values[best])
    at = int(np.argmin(loss))
    return values[at], float(loss[at])


def complete(problem: Problem, parameters: Parameters, values: np.ndarray, loss: float) -> Solution:
    """Fit every fold from the common solution and predict what it has not seen."""
    data = problem.data
    numbers = np.unique(problem.fold)
    if len(numbers) > 1 and values.size:
        starts = np.repeat(values[None, :], len(numbers), axis=0)
        fold_values, _ = minimise(data, parameters, starts, training(problem.fold), iterations=12)
    else:
        fold_values = np.repeat(values[None, :], len(numbers), axis=0)
    modelled = data.modelled(parameters, fold_values)
    # A fold whose parameters have no answer for what it has not seen predicts nothing.
    modelled[~np.isfinite(modelled)] = 0.0
    unseen = data.measured - modelled[np.searchsorted(numbers, problem.fold), np.arange(data.measured.size)]
    by_stroke = np.array([float(np.sum(unseen[s] ** 2)) for s in problem.strokes])
    return Solution(parameters, values, loss, fold_values, unseen, by_stroke)


def _only(model: Model, effects: Sequence[str]) -> Model:
    names = (*effects, *(c.name for c in own_cards(model.structure_name)))
    return replace(
        model,
        effects=tuple(effects),
        known={k: v for k, v in model.known.items() if _kept(k, names)},
        start={k: v for k, v in model.start.items() if _kept(k, names)},
    )


def _kept(key: str, names: Sequence[str]) -> bool:
    """Whether a key belongs to one of these cards, or to the model as a whole."""
    return "." not in key or key.partition(".")[0] in names


def _in_order(model: Model) -> list[str]:
    """Return the effects with those first that others stand on, and freeplay before friction."""
    needed = {card(e, model.structure_name).needs for e in model.effects}
    return sorted(model.effects, key=lambda e: (e != "freeplay", e not in needed))
