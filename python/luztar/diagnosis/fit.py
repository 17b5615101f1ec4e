"""Fitting a model to runs: coefficients by least squares, inner parameters by profile, held-out prediction."""

from __future__ import annotations

import functools
import math
from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, Any

import numpy as np

from ..errors import ModelError
from ..model import Model, card
from .equations import Weights
from .flags import Flag, flags_of
from .floor import NoiseFloor, friction_level, noise_floor
from .folds import Folds
from .given import given_model, given_runs
from .intervals import Estimate, estimates
from .misfit import Misfit, misfit
from .own_sensors import levelled
from .plausible import prepare_measured
from .prepare import Prepared
from .profile import Problem, State, owners, state
from .search import Search
from .terms import inner_grid, start_terms

if TYPE_CHECKING:
    from ..measurement import Run


@dataclass(frozen=True)
class Fit:
    """A fitted model with its error, as ``luztar.fit`` returns it.

    Attributes
    ----------
    model : Model
    run_names, held_out_names : tuple of str
    parameters : dict of str to Estimate
        Keyed ``effect.parameter``, 95 % intervals clustered by stroke.
    error : Misfit
    noise_floor : NoiseFloor
    runs, held_out : tuple of Prepared
        The prepared runs.
    predicted, held_out_predicted : tuple of ndarray
        The model's torque or force at the kept samples: of every run as fitted, and of every held-out run, or of
        every run from the others.
    """

    model: Model
    run_names: tuple[str, ...]
    held_out_names: tuple[str, ...]
    parameters: dict[str, Estimate]
    error: Misfit
    noise_floor: NoiseFloor
    runs: tuple[Prepared, ...] = field(repr=False)
    held_out: tuple[Prepared, ...] = field(repr=False)
    predicted: tuple[np.ndarray, ...] = field(repr=False)
    held_out_predicted: tuple[np.ndarray, ...] = field(repr=False)
    problem: Problem = field(repr=False)
    search: Search = field(repr=False)

    @property
    def state(self) -> State:
        """The fitted state: terms, columns, normal equations."""
        assert self.search.best is not None
        return self.search.best

    @functools.cached_property
    def whitened(self) -> Fit:
        """The same model fitted after whitening: what a look decides by.

        Coefficients that are shown come from plain least squares: of a model that lacks something they are means over
        the record, where those of a whitened fit are what suits its quick part. What is missing shows, and two
        candidates are told apart, best where the noise is white.
        """
        if self.noise_floor.colour.whitening is None:
            return self
        weights = replace(self.problem.weights, colour=self.noise_floor.colour)
        problem = replace(self.problem, weights=weights)
        search = Search(self.search.folds)
        search.visit(state(problem, self.state.terms))
        search.refine(problem)
        search.polish(problem)
        return replace(self, problem=problem, search=search)

    @property
    def residual(self) -> tuple[np.ndarray, ...]:
        """Measured less modelled, per run, at the kept samples."""
        return tuple(r.effort - p for r, p in zip(self.runs, self.predicted, strict=True))

    @functools.cached_property
    def flags(self) -> tuple[Flag, ...]:
        """What is odd about the parameters: at a bound, without influence, or friction that drives the motion."""
        return flags_of(self)

    def to_dict(self) -> dict[str, Any]:
        """Return the fit as the JSON interface prints it."""
        return {
            "schema": 1,
            "structure": self.model.structure_name,
            "effects": list(self.model.effects),
            "band_hz": self.model.band_hz,
            "noise_floor": self.noise_floor.to_dict(),
            "error": self.error.to_dict(),
            "parameters": {k: v.to_dict() for k, v in self.parameters.items()},
            "flags": [f.to_dict() for f in self.flags],
        }

    def __str__(self) -> str:
        from .words import fit_text

        return fit_text(self)

    __repr__ = __str__

    def _repr_html_(self) -> str:
        from html import escape

        return f"<pre>{escape(str(self))}</pre>"

    def figure(self) -> Any:
        """Return a plotly figure: measured and modelled torque over the motion."""
        from ..report.figures import loops

        return loops(self)


def fit(model: Model, runs: Run | Sequence[Run], held_out: Run | Sequence[Run] = ()) -> Fit:
    """Fit a model to runs.

    Parameters
    ----------
    model : Model
    runs : Run or sequence of Run
        What coefficients and inner parameters are fitted to.
    held_out : Run or sequence of Run
        Only predicted. Without any, each run is predicted from the others, a single run by its strokes in folds.

    Returns
    -------
    Fit

    Raises
    ------
    MeasurementError, ModelError
        Data that cannot be used, or a model that does not fit the structure of the data.
    """
    model, fitted = given_model(model), given_runs("runs", runs)
    left_out = given_runs("held_out", held_out)
    if model.structure.is_free:
        from ..freerun import fit as fit_free

        return fit_free(model, not_held_out(fitted, left_out), left_out)
    unseen = prepare_measured(left_out, model) if left_out else ()
    prepared = levelled(prepare_measured(not_held_out(fitted, left_out), model), model)
    return fit_prepared(model, prepared, unseen)


def not_held_out(runs: Sequence[Run], held_out: Sequence[Run]) -> list[Run]:
    """Return the runs that are not held out: what is only predicted must not be fitted as well."""
    digests = {r.sha256 for r in held_out if r.sha256}
    return [r for r in runs if r.sha256 not in digests and not any(r is h for h in held_out)]


def fit_prepared(
    model: Model,
    runs: tuple[Prepared, ...],
    unseen: tuple[Prepared, ...] = (),
    floor: NoiseFloor | None = None,
    *,
    located: bool = False,
) -> Fit:
    """Fit a model to prepared runs; see :func:`fit`.

    Parameters
    ----------
    model : Model
    runs, unseen : tuple of Prepared
    floor : NoiseFloor, optional
    located : bool
        Whether the start values in the model come from a search of these runs, which need not be repeated.
    """
    floor = floor or noise_floor(runs, model)
    level = max(friction_level(runs), 1e-12)
    problem = Problem(runs, model, Weights(floor.moving_rms, level, model.band_hz), fixed_coefficients(model))
    first = state(problem, start_terms(model, runs))
    search = Search(Folds.of(first.blocks))
    search.visit(first)
    for name in model.effects:
        if not (located and _is_started(model, name)):
            _search_grid(problem, search, name)
    search.refine(problem)
    search.polish(problem)
    return finish(problem, search, unseen, floor)


def _is_started(model: Model, name: str) -> bool:
    return any(f"{name}.{p.key}" in model.start for p in card(name, model.structure_name).inner)


def _search_grid(problem: Problem, search: Search, name: str) -> None:
    """Try the grid of an effect's inner parameters, with the start values that the user gives among them.

    A local search would stay where it starts: the loss over a gap is flat or has several valleys.
    """
    model = problem.model
    if not card(name, model.structure_name).inner:
        return
    assert search.best is not None
    for values in inner_grid(name, model, problem.runs):
        search.visit(state(problem, search.best.terms.having(name, values)))


def finish(problem: Problem, search: Search, unseen: tuple[Prepared, ...], floor: NoiseFloor) -> Fit:
    """Turn a finished search into a :class:`Fit`: predictions, error, parameters."""
    best = search.best
    assert best is not None
    model, runs = problem.model, tuple(problem.runs)
    predicted = tuple(predict(r, m, best.coefficients) for r, m in zip(runs, best.made.matrix, strict=True))
    if unseen:
        elsewhere = replace(problem, runs=unseen)
        there = state(elsewhere, best.terms)
        held = tuple(predict(r, m, best.coefficients) for r, m in zip(unseen, there.made.matrix, strict=True))
        held_runs = unseen
    else:
        held, held_runs = predict_folds(problem, search), runs
    error = misfit(
        runs,
        [r.effort - p for r, p in zip(runs, predicted, strict=True)],
        held_runs,
        [r.effort - p for r, p in zip(held_runs, held, strict=True)],
        floor,
    )
    return Fit(
        model=model,
        run_names=tuple(r.name for r in runs),
        held_out_names=tuple(r.name for r in unseen),
        parameters=estimates(problem, best),
        error=error,
        noise_floor=floor,
        runs=runs,
        held_out=unseen,
        predicted=predicted,
        held_out_predicted=held,
        problem=problem,
        search=search,
    )


def predict(r: Prepared, matrix: np.ndarray, coefficients: np.ndarray) -> np.ndarray:
    """Return the modelled torque or force of one run."""
    # The last column is the measurement less what is known beforehand, so that the difference puts it back. The common
    # shift of the starts belongs to the sensor: the error is that of the model without it.
    return matrix[:, :-2] @ coefficients[:-1] + (r.effort - matrix[:, -1])


def predict_folds(problem: Problem, search: Search) -> tuple[np.ndarray, ...]:
    """Predict every stroke with coefficients that have not seen its fold, weighed as the problem says."""
    predicted = [r.effort.copy() for r in problem.runs]
    strokes = [s for r in problem.runs for s in r.strokes]
    for k, chosen in enumerate(search.fold_states):
        if chosen is None:
            continue
        inside = search.folds.of_stroke == k
        weighed = chosen if chosen.problem is problem else state(problem, chosen.terms)
        coefficients = weighed.blocks.solve(~inside)
        for s, here in zip(strokes, inside, strict=True):
            if here:
                r, m = problem.runs[s.run], chosen.made.matrix[s.run]
                predicted[s.run][s.first : s.last] = predict(r, m, coefficients)[s.first : s.last]
    return tuple(predicted)


def fixed_coefficients(model: Model) -> dict[tuple[str, int], float]:
    """Return the coefficients of columns that ``known`` gives.

    Raises
    ------
    ModelError
        Where of an amplitude and its phase only one is given.
    """
    fixed: dict[tuple[str, int], float] = {}
    for name in model.effects:
        linear = card(name, model.structure_name).linear
        given = [model.known.get(f"{name}.{p.key}") for p in linear]
        if linear and linear[0].role == "amplitude":
            amplitude, phase = given
            if amplitude is None and phase is None:
                continue
            if amplitude is None or phase is None:
                remedy = f"Give both {name}.{linear[0].key} and {name}.{linear[1].key}, or neither."
                raise ModelError(f"only one of amplitude and phase of {name} is known", "known", remedy)
            fixed[(name, 0)], fixed[(name, 1)] = amplitude * math.cos(phase), amplitude * math.sin(phase)
        else:
            fixed |= {(name, i): v for i, v in enumerate(given) if v is not None}
    return fixed


def columns_of(fitted: Fit) -> list[tuple[str, int]]:
    """Return (effect, number) for each fitted coefficient."""
    return [o for o in owners(fitted.state.terms, fitted.model) if o not in fitted.problem.fixed]
