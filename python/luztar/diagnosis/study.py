"""The loop as a user calls it: compare, diagnose, add, refit, until nothing is missing or nothing helps."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from ..errors import ParameterError
from ..model import Model
from .climb import MAX_EFFECTS, Loop, climb
from .clipped import require_trustworthy
from .diagnose import Diagnosis
from .fit import not_held_out
from .floor import NoiseFloor, noise_floor
from .given import given_model, given_runs
from .own_sensors import levelled
from .plausible import prepare_measured
from .step import Step as Step

if TYPE_CHECKING:
    import os

    from ..measurement import Run


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
    DoubtfulError
        As :func:`luztar.diagnose`.
    """
    if not isinstance(max_effects, int) or isinstance(max_effects, bool) or max_effects < 0:
        raise ParameterError(f"max_effects is {max_effects!r}", "max_effects", "Give a whole number from 0.")
    model, runs, held_out = given_model(model), given_runs("runs", runs), given_runs("held_out", held_out)
    if model.structure.is_free:
        from ..freerun import study as study_free

        left = not_held_out(runs, held_out)
        return study_free(model, left, held_out, max_effects=max_effects, progress=progress)
    prepared = levelled(prepare_measured(not_held_out(runs, held_out), model), model)
    unseen = prepare_measured(held_out, model) if len(held_out) else ()
    require_trustworthy(prepared)
    floor = noise_floor(prepared, model)
    steps, looks = climb(Loop(model, prepared, unseen, floor, progress), max_effects)
    return Study(tuple(steps), tuple(looks), floor, runs, held_out)
