"""The loop: compare, diagnose, add, refit, until nothing is missing or nothing in the catalogue helps."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from ..model import Model
from .diagnose import Diagnosis, diagnose
from .experiment import Experiment
from .fit import Fit, fit_prepared
from .floor import NoiseFloor, noise_floor
from .prepare import Prepared, prepare

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
    fit: Fit
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
        """The verdict of the last look; ``named`` cannot stand at the end of a loop that stops at a limit."""
        return self.last.verdict

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
    runs: Sequence[Run],
    held_out: Sequence[Run] = (),
    *,
    max_effects: int = MAX_EFFECTS,
    progress: Callable[[str, int, int], None] | None = None,
) -> Study:
    """Compare, diagnose, add and refit until nothing is missing.

    Parameters
    ----------
    model : Model
        Where to start.
    runs : sequence of Run
    held_out : sequence of Run
        Only predicted: never influences a coefficient, an inner parameter, a name, an order or the stop.
    max_effects : int
        Add at most this many.
    progress : callable, optional
        Called with (what is being done, done, total).
    """
    prepared = prepare(runs, model)
    unseen = prepare(held_out, model) if len(held_out) else ()
    floor = noise_floor(prepared, model.structure.effort_unit)
    steps, looks = climb(model, prepared, unseen, floor, max_effects, progress)
    return Study(tuple(steps), tuple(looks), floor, runs, held_out)


def climb(
    model: Model,
    prepared: tuple[Prepared, ...],
    unseen: tuple[Prepared, ...],
    floor: NoiseFloor,
    max_effects: int,
    progress: Callable[[str, int, int], None] | None,
) -> tuple[list[Step], list[Diagnosis]]:
    """Run the loop on prepared runs."""

    def tell(what: str) -> Callable[[int, int], None] | None:
        return None if progress is None else lambda done, total: progress(what, done, total)

    fitted = fit_prepared(model, prepared, unseen, floor)
    steps = [Step(None, (), False, fitted, None)]
    looks: list[Diagnosis] = []
    while True:
        look = diagnose(fitted, progress=tell(f"look {len(looks) + 1}"))
        looks.append(look)
        if not look.named or len(steps) > max_effects:
            break
        added = look.named[0]
        fitted = fit_prepared(_with(fitted, look, added), prepared, unseen, floor)
        members = look.named if look.verdict == "one_of" else (added,)
        steps.append(Step(added, members, False, fitted, look.next_experiment))
    if looks[-1].verdict == "unexplained" or (looks[-1].named and len(steps) > max_effects):
        steps = [Step(s.added, s.set, s.added is not None, s.fit, s.next_experiment) for s in steps]
    return steps, looks


def _with(fitted: Fit, look: Diagnosis, added: str) -> Model:
    """Return the model with the effect, started from the values just found for everything."""
    best = next(c for c in look.found if c.name == added).search.best
    assert best is not None
    model = fitted.model + added
    from dataclasses import replace

    from ..model import card

    start = {
        f"{name}.{p.key}": value
        for name, values in best.terms.inner.items()
        for p, value in zip(card(name, model.structure_name).inner, values, strict=True)
    }
    return replace(model, start=start)
