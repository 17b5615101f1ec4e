"""Fitting a model to free runs."""

from __future__ import annotations

import functools
from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

import numpy as np

from ..diagnosis.fit import Fit
from ..diagnosis.flags import Flag
from ..diagnosis.floor import NoiseFloor
from ..diagnosis.misfit import misfit
from ..model import Model
from .channels import ChannelError, channel_errors
from .floor import noise_floor
from .intervals import estimates
from .least_squares import Data
from .parameters import Parameters
from .plants import plant_of
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
    simulated : tuple of ndarray, shape (n, outputs)
        Of every run, in SI units.
    """

    free_problem: Problem = field(repr=False)
    solution: Solution = field(repr=False)
    simulated: tuple[np.ndarray, ...] = field(repr=False)

    @functools.cached_property
    def channels(self) -> tuple[ChannelError, ...]:
        """The error by channel, where the structure explains several; else nothing."""
        return channel_errors(self) if self.model.structure.outputs else ()

    def to_dict(self) -> dict[str, Any]:
        """Return the fit as the JSON interface prints it, with the error of every channel where there are several."""
        made = super().to_dict()
        if self.channels:
            made["channels"] = {c.channel: c.to_dict() for c in self.channels}
        return made

    def __str__(self) -> str:
        return "\n".join([super().__str__(), *map(str, self.channels)])

    __repr__ = __str__

    @functools.cached_property
    def flags(self) -> tuple[Flag, ...]:
        """What is odd about the parameters: those at a bound."""
        return tuple(
            Flag("at_bound", key, f"{key} is {e.value:.4g} {e.unit}: the search stopped at its bound.")
            for key, e in self.parameters.items()
            if e.note == "the search stopped at its bound"
        )


def fit(model: Model, runs: Sequence[Run], held_out: Sequence[Run] = ()) -> FreeFit:
    """Fit a model to free runs; see ``luztar.fit``."""
    plant = plant_of(model)
    plant.require(model)
    records = make_records(runs, plant, model)
    unseen = make_records(held_out, plant, model, records) if len(held_out) else ()
    problem = Problem.of(plant, records, model)
    return finish(problem, solve(problem, model), unseen, noise_floor(records, model.structure.effort_unit))


def finish(problem: Problem, solution: Solution, unseen: Sequence[Record], floor: NoiseFloor) -> FreeFit:
    """Turn a solution into a fit: predictions, error, parameters."""
    parameters, data = solution.parameters, problem.data
    runs = tuple(p for r in data.records for p in r.outputs)
    simulated = _simulated(parameters, data.records, solution.values)
    predicted = _by_channel(simulated, data.records)
    if unseen:
        held = _by_channel(_simulated(parameters, unseen, solution.values), unseen)
        held_runs = tuple(p for r in unseen for p in r.outputs)
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
        run_names=tuple(r.name for r in data.records),
        held_out_names=tuple(r.name for r in unseen),
        parameters=estimates(data, parameters, solution.values),
        error=error,
        noise_floor=floor,
        runs=runs,
        held_out=tuple(p for r in unseen for p in r.outputs),
        predicted=predicted,
        held_out_predicted=held,
        problem=None,  # type: ignore[arg-type]
        search=None,  # type: ignore[arg-type]
        free_problem=problem,
        solution=solution,
        simulated=simulated,
    )


def _simulated(parameters: Parameters, records: Sequence[Record], values: np.ndarray) -> tuple[np.ndarray, ...]:
    return tuple(p[0] for p in parameters.plant.predict(parameters, records, values[None, :]))


def _by_channel(simulated: Sequence[np.ndarray], records: Sequence[Record]) -> tuple[np.ndarray, ...]:
    of = zip(simulated, records, strict=True)
    return tuple(column for p, r in of for column in np.ascontiguousarray((p / r.scales).T))


def _unseen(data: Data, solution: Solution) -> tuple[np.ndarray, ...]:
    out, begin = [], 0
    for record, keep in zip(data.records, data.keep, strict=True):
        values = record.measured.copy()
        count = values[keep].size
        values[keep] -= solution.unseen[begin : begin + count].reshape(-1, len(record.channels))
        out.extend(np.ascontiguousarray(values.T))
        begin += count
    return tuple(out)
