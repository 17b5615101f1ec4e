"""The loop: compare, diagnose, add, refit, until nothing is missing or nothing in the catalogue helps."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, Any

from ..errors import ParameterError
from ..model import Model, card
from .candidates import PRACTICAL_GAIN, SET_ERRORS, gain, paired_error
from .diagnose import Diagnosis, diagnose
from .experiment import Experiment, experiment_for
from .fit import Fit, fit_prepared, not_held_out
from .floor import NoiseFloor, noise_floor
from .given import given_model, given_runs
from .plausible import prepare_measured
from .prepare import Prepared

if TYPE_CHECKING:
    import os

    from ..measurement import Run

MAX_EFFECTS = 4


@dataclass(frozen=True)
class Step:
    """One step of the ladder.

    Attributes
    ----------
    added : str or None
        The effect added; None for the model as given.
    set : tuple of str
        What this step could not tell apart, the added one included.
    provisional : bool
        True where the study ended without an explanation.
    fit : Fit
    next_experiment : Experiment or None
        The test that would tell the set apart.
    """

    added: str | None
    set: tuple[str, ...]
    provisional: bool
    fit: Fit = field(repr=False)
    next_experiment: Experiment | None

    def to_dict(self) -> dict[str, Any]:
        """Return the step as the JSON interface prints it."""
        return {
            "added": self.added,
            "set": list(self.set),
            "provisional": self.provisional,
            "effects": list(self.fit.model.effects),
            "error": self.fit.error.to_dict(),
            "parameters": {k: v.to_dict() for k, v in self.fit.parameters.items()},
            "next_experiment": self.next_experiment.to_dict() if self.next_experiment else None,
        }


@dataclass(frozen=True)
class Study:
    """What ``luztar.study`` returns.

    Attributes
    ----------
    steps : tuple of Step
        The model as given, then one step per effect added.
    first, last : Diagnosis
        The look at the model as given, and the last one.
    looks : tuple of Diagnosis
        Every look.
    runs : sequence of Run
        The measurements.
    """

    steps: tuple[Step, ...]
    looks: tuple[Diagnosis, ...]
    noise_floor: NoiseFloor
    runs: Sequence[Run]
    held_out: Sequence[Run] = ()

    @property
    def last(self) -> Diagnosis:
        """The last look."""
        return self.looks[-1]

    @property
    def first(self) -> Diagnosis:
        """The look at the model as given."""
        return self.looks[0]

    @property
    def verdict(self) -> str:
        """The verdict of the last look; ``unexplained`` where four effects were added and more are called for."""
        return "unexplained" if any(s.provisional for s in self.steps) else self.last.verdict

    @property
    def named(self) -> tuple[str, ...]:
        """The effects added, in order; none where the study ended unexplained."""
        return tuple(s.added for s in self.steps if s.added and not s.provisional)

    @property
    def model(self) -> Model:
        """The model after the last step."""
        return self.steps[-1].fit.model

    def to_dict(self) -> dict[str, Any]:
        """Return the study as the JSON interface prints it."""
        return {
            "schema": 1,
            "verdict": self.verdict,
            "named": list(self.named),
            "noise_floor": self.noise_floor.to_dict(),
            "steps": [s.to_dict() for s in self.steps],
            "last": self.last.to_dict(),
        }

    def __str__(self) -> str:
        from .words import study_text

        return study_text(self)

    __repr__ = __str__

    def _repr_html_(self) -> str:
        from html import escape

        return f"<pre>{escape(str(self))}</pre>"

    def figure(self) -> Any:
        """Return a plotly figure: the ladder of errors with the noise floor."""
        from ..report.figures import ladder

        return ladder(self)

    def report(self, path: str | os.PathLike[str]) -> None:
        """Write the study as one self-contained HTML file, with the TB 038 check of the runs where they are a rig's."""
        from ..report import write_report

        write_report(path, study=self)


def study(
    model: Model,
    runs: Run | Sequence[Run],
    held_out: Run | Sequence[Run] = (),
    *,
    max_effects: int = MAX_EFFECTS,
    progress: Callable[[str, int, int], None] | None = None,
) -> Study:
    """Compare, diagnose, add and refit until nothing is missing.

    Parameters
    ----------
    model : Model
        Where to start.
    runs : Run or sequence of Run
    held_out : Run or sequence of Run
        Only predicted: never influences a coefficient, an inner parameter, a name, an order or the stop.
    max_effects : int
        Add at most this many.
    progress : callable, optional
        Called with (what is being done, done, total).

    Raises
    ------
    MeasurementError, ModelError, ParameterError
        As :func:`luztar.fit`; or a negative number of effects.
    """
    if not isinstance(max_effects, int) or isinstance(max_effects, bool) or max_effects < 0:
        raise ParameterError(f"max_effects is {max_effects!r}", "max_effects", "Give a whole number from 0.")
    model, runs, held_out = given_model(model), given_runs("runs", runs), given_runs("held_out", held_out)
    if model.structure.is_free:
        from ..freerun import study as study_free

        left = not_held_out(runs, held_out)
        return study_free(model, left, held_out, max_effects=max_effects, progress=progress)
    prepared = prepare_measured(not_held_out(runs, held_out), model)
    unseen = prepare_measured(held_out, model) if len(held_out) else ()
    floor = noise_floor(prepared, model.structure.effort_unit)
    steps, looks = climb(_Loop(model, prepared, unseen, floor, progress), max_effects)
    return Study(tuple(steps), tuple(looks), floor, runs, held_out)


@dataclass(frozen=True)
class _Loop:
    """What stays the same during a study."""

    base: Model
    prepared: tuple[Prepared, ...]
    unseen: tuple[Prepared, ...]
    floor: NoiseFloor
    progress: Callable[[str, int, int], None] | None

    def fit(self, model: Model) -> Fit:
        # Later models start from what the first ones have found.
        return fit_prepared(model, self.prepared, self.unseen, self.floor, located=model is not self.base)

    def look(self, fitted: Fit, what: str) -> Diagnosis:
        progress = self.progress
        return diagnose(fitted, progress=None if progress is None else lambda done, of: progress(what, done, of))


def climb(loop: _Loop, max_effects: int) -> tuple[list[Step], list[Diagnosis]]:
    """Add effects until nothing is missing, drop what later ones made needless, and order the ladder."""
    fitted = loop.fit(loop.base)
    looks = [loop.look(fitted, "look 1")]
    added: list[str] = []
    offered: dict[str, tuple[str, ...]] = {}
    seen = {frozenset(added)}
    while True:
        while looks[-1].named and len(added) < max_effects:
            name = looks[-1].named[0]
            offered[name] = looks[-1].named
            added.append(name)
            fitted = loop.fit(_with(fitted, looks[-1], name))
            fitted, added = _without_needless(loop, fitted, added)
            if frozenset(added) in seen:
                break
            seen.add(frozenset(added))
            looks.append(loop.look(fitted, f"look {len(looks) + 1}"))
        # A mechanism that calls for a fifth effect is one that the catalogue does not describe: its curves are being
        # pieced together from those of others. A smaller limit is the user's, and what was added until then stands.
        exhausted = bool(looks[-1].named) and len(added) >= MAX_EFFECTS
        unexplained = looks[-1].verdict == "unexplained" or exhausted
        if unexplained or looks[-1].named or len(added) < 2:
            break
        before = frozenset(added)
        fitted, added, offered = _simplest(loop, fitted, added, offered)
        if frozenset(added) == before:
            fitted, added, offered = _each_in_its_place(loop, fitted, added, looks)
            break
        if frozenset(added) in seen:
            break
        seen.add(frozenset(added))
        looks.append(loop.look(fitted, f"look {len(looks) + 1}"))
    return _ladder(loop, fitted, added, offered, unexplained), looks


def _without_needless(loop: _Loop, fitted: Fit, added: list[str]) -> tuple[Fit, list[str]]:
    """Drop every effect without which the unseen error is no worse.

    An effect may have stood in for others that were added later; what is left must each earn its place.
    """
    while len(added) > 1:
        trials = [(name, loop.fit(fitted.model - name)) for name in added if not _needed(fitted.model, name)]
        for name, without in sorted(trials, key=lambda t: t[1].search.held_out_loss):
            share, errors = gain(without.search, fitted.search)
            if share < PRACTICAL_GAIN or errors < SET_ERRORS:
                fitted, added = without, [a for a in added if a != name]
                break
        else:
            return fitted, added
    return fitted, added


def _simplest(
    loop: _Loop, fitted: Fit, added: list[str], offered: dict[str, tuple[str, ...]]
) -> tuple[Fit, list[str], dict[str, tuple[str, ...]]]:
    """Try the other members of each set in the place of the one that was added.

    Where the first of two effects could not be told from a third, the wrong one leaves a rest that calls for another
    effect; the right one does not. Fewer effects that predict as well win, then a lower unseen error.
    """
    improved = len(added) > 1
    while improved:
        improved = False
        for name in (n for n in added if not _needed(fitted.model, n)):
            for other in offered.get(name, ()):
                if other == name or other in fitted.model.effects:
                    continue
                trial = loop.fit(_started(fitted.model - name + other, {}, fitted))
                trial, left = _without_needless(loop, trial, [other if a == name else a for a in added])
                behind, error = paired_error(trial.search.losses, fitted.search.losses)
                fewer = len(left) < len(added) and behind <= SET_ERRORS * error
                if fewer or (len(left) == len(added) and behind < 0.0 and -behind > SET_ERRORS * error):
                    offered = {**offered, other: offered[name]}
                    fitted, added, improved = trial, left, True
                    break
            if improved:
                break
    return fitted, added, offered


def _each_in_its_place(
    loop: _Loop, fitted: Fit, added: list[str], looks: list[Diagnosis]
) -> tuple[Fit, list[str], dict[str, tuple[str, ...]]]:
    """Look again for every effect with the others in place: a better one replaces it, equal ones join its set."""
    offered: dict[str, tuple[str, ...]] = {}
    for name in list(added):
        if _needed(fitted.model, name):
            offered[name] = (name,)
            continue
        without = loop.fit(fitted.model - name)
        look = loop.look(without, f"in the place of {name}")
        if look.named and look.named[0] != name and name not in look.named:
            better = loop.fit(_with(without, look, look.named[0]))
            if better.search.held_out_loss < fitted.search.held_out_loss:
                fitted, added = better, [look.named[0] if a == name else a for a in added]
                looks.append(loop.look(fitted, f"look {len(looks) + 1}"))
                offered[look.named[0]] = look.named
                continue
        offered[name] = look.named if name in look.named else (name,)
    return fitted, added, offered


def _ladder(
    loop: _Loop, fitted: Fit, added: list[str], offered: dict[str, tuple[str, ...]], provisional: bool
) -> list[Step]:
    """Return the steps: at each the effect that takes most off the unseen error, whatever the order of finding."""
    start = dict(fitted.model.start)
    steps = [Step(None, (), False, loop.fit(loop.base), None)]
    left = list(added)
    while left:
        model = steps[-1].fit.model
        # What stands on an effect that is still to be added waits for it.
        ready = [n for n in left if card(n, model.structure_name).needs not in left]
        trials = {name: loop.fit(_started(model + name, start, fitted)) for name in ready} if len(left) > 1 else {}
        name = min(trials, key=lambda n: trials[n].search.held_out_loss) if trials else left[0]
        step_fit = trials.get(name) or fitted
        members = offered.get(name, (name,))
        # What stands in the model already is no alternative.
        others = tuple(n for n in members if n != name and n not in step_fit.model.effects)
        members = (name, *others)
        steps.append(Step(name, members, provisional, step_fit, experiment_for(step_fit, members)))
        left.remove(name)
    return steps


def _needed(model: Model, name: str) -> bool:
    """Whether another effect of the model makes no sense without this one."""
    return any(card(e, model.structure_name).needs == name for e in model.effects)


def _started(model: Model, start: dict[str, float], fitted: Fit) -> Model:
    values = {**_inner_values(fitted.model, fitted.state.terms.inner), **start}
    return replace(model, start={k: v for k, v in values.items() if k.partition(".")[0] in model.effects})


def _with(fitted: Fit, look: Diagnosis, added: str) -> Model:
    """Return the model with the effect, started from the values just found for everything."""
    best = next(c for c in look.found if c.name == added).search.best
    assert best is not None
    model = fitted.model + added
    return replace(model, start=_inner_values(model, best.terms.inner))


def _inner_values(model: Model, inner: Mapping[str, tuple[float, ...]]) -> dict[str, float]:
    return {
        f"{name}.{p.key}": value
        for name, values in inner.items()
        for p, value in zip(card(name, model.structure_name).inner, values, strict=True)
        if f"{name}.{p.key}" not in model.known
    }
