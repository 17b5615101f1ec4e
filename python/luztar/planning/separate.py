"""How well a test tells two effects apart: the truth is simulated on its motion, the rival refitted to that.

What the rival cannot imitate, over the noise, is the number of standard errors by which the test tells them apart. It
grows with the square root of the time, so tests are ranked by its square per minute, and by time alone where it is
more than enough.
"""

from __future__ import annotations

import functools
import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from ..diagnosis.equations import Weights, columns
from ..diagnosis.prepare import Prepared
from ..diagnosis.profile import Problem, State, owners, refine, state
from ..diagnosis.terms import Terms, inner_grid
from ..model import Model, card
from .rehearse import Sensor, minutes, rehearse, with_effort
from .trials import Trial

# A rival is tried at this many points of its grid at most before it is refined.
COARSE_POINTS = 10
# Beyond this many standard errors a test decides whatever else happens; it need not be longer or wider than that.
ENOUGH = 20.0


@dataclass(frozen=True)
class Truth:
    """What is taken to be at work.

    Attributes
    ----------
    model : Model
        Without the effect in question.
    terms : Terms
        With it.
    coefficients : mapping of (effect, number of its column) to float
    """

    model: Model
    terms: Terms
    coefficients: Mapping[tuple[str, int], float]

    @classmethod
    def of(cls, problem: Problem, fitted: State, effect: str) -> Truth:
        """Return what a fit came to, with the effect that is to be told from others."""
        free = [o for o in owners(fitted.terms, problem.model) if o not in problem.fixed]
        values = dict(problem.fixed) | {o: float(v) for o, v in zip(free, fitted.coefficients[:-1], strict=True)}
        model = problem.model
        if effect in model.effects:
            model = model - effect
        # What is known of a parameter stays known; start values would keep the rival's grid from being searched.
        return cls(replace(model, start={}), fitted.terms, values)

    @property
    def effect(self) -> str:
        """The effect in question."""
        return next(e for e in self.terms.effects if e not in self.model.effects)

    def effort(self, runs: Sequence[Prepared]) -> tuple[np.ndarray, ...]:
        """Return the torque (or force) on other runs."""
        made = columns(runs, self.terms)
        values = np.array([self.coefficients[o] for o in owners(self.terms, self.model)])
        return tuple(m[:, :-2] @ values for m in made.matrix)

    def base_terms(self) -> Terms:
        """Return the terms without the effect."""
        effects = tuple(e for e in self.terms.effects if e != self.effect)
        return Terms(effects, {k: v for k, v in self.terms.inner.items() if k != self.effect})

    @property
    def friction_level(self) -> float:
        """The level of friction whose reversal is shifted where a start is uncertain."""
        return abs(self.coefficients.get(("coulomb", 0), 0.0))


@dataclass(frozen=True)
class Rehearsal:
    """A truth simulated on one motion.

    Attributes
    ----------
    runs : tuple of Prepared
    problem : Problem
    base : State
        The model without the effect, fitted to what the truth gives.
    variance : float
        Of one kept sample, were the noise white with its density.
    """

    runs: tuple[Prepared, ...]
    problem: Problem
    base: State
    variance: float

    @classmethod
    def of(cls, positions: Sequence[np.ndarray], sensor: Sensor, truth: Truth) -> Rehearsal:
        """Simulate a truth on a motion."""
        runs = rehearse(positions, sensor, truth.model)
        runs = with_effort(runs, truth.effort(runs))
        weights = Weights(sensor.noise_rms, max(truth.friction_level, 1e-9), truth.model.band_hz)
        problem = Problem(runs, truth.model, weights, {})
        variance = sensor.density(truth.model.band_hz) / runs[0].step_s
        return cls(runs, problem, state(problem, truth.base_terms()), variance)

    @property
    def strength(self) -> float:
        """Standard errors by which the truth differs from a model that lacks it."""
        return math.sqrt(self.base.loss / self.variance)

    def coarse(self, rival: str) -> State:
        """Return the best of a rival's grid."""
        points = inner_grid(rival, self.problem.model, self.runs)
        if len(points) > COARSE_POINTS:
            chosen = np.unique(np.linspace(0, len(points) - 1, COARSE_POINTS).round().astype(int))
            points = [points[i] for i in chosen]
        return min((state(self.problem, self.base.terms.having(rival, p)) for p in points), key=lambda s: s.loss)

    def refined(self, rival: str, near: State) -> State:
        """Return a rival's best imitation."""
        if not card(rival, self.problem.model.structure_name).inner:
            return near
        return refine(self.problem, near, only=rival, rounds=1)

    def apart(self, imitation: State) -> float:
        """Return the standard errors by which the truth differs from an imitation."""
        return math.sqrt(imitation.loss / self.variance)

    def cosine(self, rival: str) -> float:
        """Return how well a rival can imitate the truth: 1 where it leaves nothing of it."""
        if self.base.loss <= 0.0:
            return 0.0
        left = self.refined(rival, self.coarse(rival)).loss / self.base.loss
        return math.sqrt(max(0.0, 1.0 - left))


@dataclass(frozen=True)
class Ranked:
    """A test and how well it tells a truth from its rivals.

    Attributes
    ----------
    trial : Trial
    minutes : float
        Of one run.
    apart : float
        Standard errors between the truth and the rival that comes nearest, in one run.
    """

    trial: Trial
    minutes: float
    apart: float

    @property
    def per_minute(self) -> float:
        """The square of the standard errors per minute; what is more than enough counts as enough."""
        return min(self.apart, ENOUGH) ** 2 / self.minutes


def separation(truth: Truth, rivals: Sequence[str], positions: Sequence[np.ndarray], sensor: Sensor) -> float:
    """Return the standard errors between a truth and the rival that comes nearest, on motions as they are.

    Parameters
    ----------
    truth : Truth
    rivals : sequence of str
    positions : sequence of ndarray
        One per run, sampled at ``sensor.rate_hz``.
    sensor : Sensor
    """
    rehearsal = Rehearsal.of(positions, sensor, truth)
    return min(rehearsal.apart(rehearsal.refined(n, rehearsal.coarse(n))) for n in rivals)


def rank(
    truth: Truth,
    rivals: Sequence[str],
    trials: Sequence[Trial],
    sensor: Sensor,
    seed: int = 1,
    *,
    above: float = 0.0,
) -> tuple[Ranked, ...]:
    """Rank tests by how well they tell a truth from its rivals, per minute; the best first.

    Parameters
    ----------
    truth : Truth
    rivals : sequence of str
        The nearest of them counts.
    trials : sequence of Trial
    sensor : Sensor
        What would record the test.
    seed : int
        Of the hand that turns.
    above : float
        Tests whose one run sets them no more than this many standard errors apart come last, however short they are.

    Notes
    -----
    A grid can only overrate a test, so the tests are refined from the top until none below can overtake.
    """

    def worth(found: Ranked) -> float:
        return found.per_minute if found.apart > above else 0.0

    def judged(trial: Trial) -> tuple[Callable[[bool], Ranked], Ranked]:
        rehearsal = Rehearsal.of([trial.make(1.0 / sensor.rate_hz, seed)], sensor, truth)
        coarse = {name: rehearsal.coarse(name) for name in rivals}

        @functools.cache
        def result(fine: bool) -> Ranked:
            found = [rehearsal.refined(n, s) if fine else s for n, s in coarse.items()]
            return Ranked(trial, minutes(rehearsal.runs), min(rehearsal.apart(s) for s in found))

        return result, result(False)

    made = [judged(trial) for trial in trials]
    best = 0.0
    out = []
    for result, rough in sorted(made, key=lambda m: -worth(m[1])):
        found = result(True) if worth(rough) > best else rough
        best = max(best, worth(found))
        out.append(found)
    return tuple(sorted(out, key=lambda r: (-worth(r), -r.per_minute)))
