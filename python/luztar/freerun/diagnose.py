"""One look at a fitted free-run model: is something missing, and if so, what."""

from __future__ import annotations

import functools
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from ..diagnosis.diagnose import Diagnosis, Tried
from ..diagnosis.experiment import Experiment
from ..diagnosis.misfit import rms
from ..diagnosis.where import regimes, residual_map
from .candidates import Candidate, gain, try_all
from .detect import detection
from .experiment import experiment_for
from .fit import FreeFit
from .verdict import judge


@dataclass(frozen=True)
class FreeDiagnosis(Diagnosis):
    """What ``luztar.diagnose`` returns for a free-run model."""

    tried: tuple[Candidate, ...] = ()

    @functools.cached_property
    def next_experiment(self) -> Experiment | None:
        """The test that would tell apart what this measurement could not."""
        fitted = self.fit
        assert isinstance(fitted, FreeFit)
        return experiment_for(fitted.free_problem.plant, self.named, fitted.model)


def diagnose(fitted: FreeFit, *, progress: Callable[[int, int], None] | None = None) -> FreeDiagnosis:
    """Look once at a fitted model; see ``luztar.diagnose``."""
    found = try_all(fitted, progress)
    before = fitted.solution
    tested = detection(fitted, {c.name: before.stroke_losses - c.solution.stroke_losses for c in found})
    judged = judge(fitted, found, tested)
    samples = fitted.free_problem.data.measured.size
    return FreeDiagnosis(
        fit=fitted,
        judgement=judged,
        where=regimes(fitted),
        map=residual_map(fitted),
        candidates=tuple(
            Tried(
                effect=c.name,
                rms=float(np.sqrt(c.solution.loss / samples)),
                held_out_rms=rms(c.solution.unseen),
                gain=gain(before, c.solution)[0],
                gain_errors=gain(before, c.solution)[1],
                p_value=tested.candidates.get(c.name),
                in_set=c.name in judged.equivalent,
                decoy=False,
                same_as=judged.folded.get(c.name),
                parameters=c.values,
            )
            for c in found
        ),
        detection=tested,
        unseen_rms=rms(before.unseen),
        tried=tuple(found),
    )
