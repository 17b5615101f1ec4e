"""Fitting a steering model to free runs."""

from __future__ import annotations

import functools
from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

import numpy as np

from ..diagnosis.fit import Fit
from ..diagnosis.flags import Flag
from ..diagnosis.floor import NoiseFloor
from ..diagnosis.misfit import misfit
from ..model import Model
from .floor import noise_floor
from .intervals import estimates
from .least_squares import Data
from .predict import predict
from .record import Record, make_records
from .solve import Problem, Solution, solve

if TYPE_CHECKING:
    from ..measurement import Run


@dataclass(frozen=True)
class FreeFit(Fit):
    """A model fitted to free runs: as :class:`luztar.diagnosis.Fit`, solved by simulation.

    Attributes
    ----------
    free_problem : Problem
    solution : Solution
    """

    free_problem: Problem = field(repr=False)
    solution: Solution = field(repr=False)

    @functools.cached_property
    def flags(self) -> tuple[Flag, ...]:
        """What is odd about the parameters: those at a bound."""
        return tuple(
            Flag("at_bound", key, f"{key} is {e.value:.4g} {e.unit}: the search stopped at its bound.")
            for key, e in self.parameters.items()
            if e.note == "the search stopped at its bound"
        )


def fit(model: Model, runs: Sequence[Run], held_out: Sequence[Run] = ()) -> FreeFit:
    """Fit a steering model to runs; see ``luztar.fit``."""
    records = make_records(runs, model)
    unseen = make_records(held_out, model) if len(held_out) else ()
    problem = Problem.of(records, model)
    return finish(problem, solve(problem, model), unseen, noise_floor(records, model.structure.effort_unit))


def finish(problem: Problem, solution: Solution, unseen: Sequence[Record], floor: NoiseFloor) -> FreeFit:
    """Turn a solution into a fit: predictions, error, parameters."""
    parameters, data = solution.parameters, problem.data
    runs = tuple(r.prepared for r in data.records)
    predicted = tuple(p[0] for p in predict(parameters, data.records, solution.values))
    if unseen:
        held = tuple(p[0] for p in predict(parameters, unseen, solution.values))
        held_runs = tuple(r.prepared for r in unseen)
    else:
        held, held_runs = _unseen(data, solution), runs
    error = misfit(
        runs,
        [r.effort - p for r, p in zip(runs, predicted, strict=True)],
        held_runs,
        [r.effort - p for r, p in zip(held_runs, held, strict=True)],
        floor,
    )
    return FreeFit(
        model=parameters.model,
        run_names=tuple(r.name for r in runs),
        held_out_names=tuple(r.prepared.name for r in unseen),
        parameters=estimates(data, parameters, solution.values),
        error=error,
        noise_floor=floor,
        runs=runs,
        held_out=tuple(r.prepared for r in unseen),
        predicted=predicted,
        held_out_predicted=held,
        problem=None,  # type: ignore[arg-type]
        search=None,  # type: ignore[arg-type]
        free_problem=problem,
        solution=solution,
    )


def _unseen(data: Data, solution: Solution) -> tuple[np.ndarray, ...]:
    out, begin = [], 0
    for record, keep in zip(data.records, data.keep, strict=True):
        count = int(keep.sum())
        values = record.prepared.effort.copy()
        values[keep] -= solution.unseen[begin : begin + count]
        out.append(values)
        begin += count
    return tuple(out)
