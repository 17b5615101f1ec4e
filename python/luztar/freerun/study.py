"""The loop for free runs: compare, diagnose, add, refit, until nothing is missing or nothing helps."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

from ..diagnosis.candidates import PRACTICAL_GAIN, SET_ERRORS
from ..diagnosis.climb import MAX_EFFECTS, needed
from ..diagnosis.floor import NoiseFloor
from ..diagnosis.step import Step
from ..diagnosis.study import Study
from ..model import Model, card
from .candidates import gain
from .diagnose import FreeDiagnosis, diagnose
from .experiment import experiment_for
from .fit import FreeFit, finish
from .floor import noise_floor
from .plants import plant_of
from .record import Record, make_records
from .solve import Problem, Solution, solve, solve_from, solve_with

if TYPE_CHECKING:
    from ..measurement import Run


@dataclass(frozen=True)
class _Loop:
    problem: Problem
    unseen: tuple[Record, ...]
    floor: NoiseFloor
    progress: Callable[[str, int, int], None] | None

    def finish(self, solution: Solution) -> FreeFit:
        return finish(self.problem, solution, self.unseen, self.floor)

    def look(self, fitted: FreeFit, number: int) -> FreeDiagnosis:
        tell = self.progress
        return diagnose(fitted, progress=None if tell is None else lambda done, of: tell(f"look {number}", done, of))


def study(
    model: Model,
    runs: Sequence[Run],
    held_out: Sequence[Run] = (),
    *,
    max_effects: int = MAX_EFFECTS,
    progress: Callable[[str, int, int], None] | None = None,
) -> Study:
    """Compare, diagnose, add and refit until nothing is missing; see ``luztar.study``."""
    plant = plant_of(model)
    plant.require(model)
    records = make_records(runs, plant, model)
    unseen = make_records(held_out, plant, model, records) if len(held_out) else ()
    loop = _Loop(Problem.of(plant, records, model), unseen, noise_floor(records, model.structure.effort_unit), progress)
    base = loop.finish(solve(loop.problem, model))
    fitted, added, offered = base, [], {}
    looks = [loop.look(base, 1)]
    seen = {frozenset(added)}
    while looks[-1].named and len(added) < max_effects:
        name = looks[-1].named[0]
        offered[name] = looks[-1].named
        fitted = loop.finish(next(c.solution for c in looks[-1].tried if c.name == name))
        fitted, added = _without_needless(loop, fitted, [*added, name])
        if frozenset(added) in seen:
            break
        seen.add(frozenset(added))
        looks.append(loop.look(fitted, len(looks) + 1))
    exhausted = bool(looks[-1].named) and len(added) >= MAX_EFFECTS
    provisional = bool(added) and (looks[-1].verdict == "unexplained" or exhausted)
    steps = _ladder(loop, base, fitted, added, offered, provisional)
    return Study(steps, tuple(looks), loop.floor, runs, held_out)


def _without_needless(loop: _Loop, fitted: FreeFit, added: list[str]) -> tuple[FreeFit, list[str]]:
    """Drop every effect without which the unseen error is no worse: it stood in for one that was added later."""
    while len(added) > 1:
        model, found = fitted.model, fitted.solution.found
        trials = [(n, solve_from(loop.problem, model - n, found)) for n in added if not needed(model, n)]
        for name, without in sorted(trials, key=lambda t: t[1].held_out_loss):
            share, errors = gain(without, fitted.solution)
            if share < PRACTICAL_GAIN or errors < SET_ERRORS:
                fitted, added = loop.finish(without), [a for a in added if a != name]
                break
        else:
            return fitted, added
    return fitted, added


def _ladder(
    loop: _Loop,
    base: FreeFit,
    fitted: FreeFit,
    added: Sequence[str],
    offered: dict[str, tuple[str, ...]],
    provisional: bool,
) -> tuple[Step, ...]:
    """Return the steps: at each the effect that takes most off the unseen error, whatever the order of finding."""
    steps = [Step(None, (), False, base, None)]
    left = list(added)
    while left:
        last = steps[-1].fit
        assert isinstance(last, FreeFit)
        ready = [n for n in left if card(n, last.model.structure_name).needs not in left]
        if len(left) == 1:
            name, solved = left[0], fitted.solution
        else:
            trials = {n: solve_with(loop.problem, last.model + n, last.solution.found, n) for n in ready}
            name = min(trials, key=lambda n: trials[n].held_out_loss)
            solved = trials[name]
        after = fitted if len(left) == 1 else loop.finish(solved)
        others = tuple(n for n in offered.get(name, ()) if n != name and n not in after.model.effects)
        members = (name, *others)
        steps.append(Step(name, members, provisional, after, experiment_for(loop.problem.plant, members, last.model)))
        left.remove(name)
    return tuple(steps)
