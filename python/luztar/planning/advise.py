"""The test to do next where a measurement does not decide between effects."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ..diagnosis.fit import Fit
from ..diagnosis.profile import State
from ..model import card
from .rehearse import Sensor, planning_rate_hz
from .separate import Ranked, Rehearsal, Truth, rank, separation
from .trials import Trial, axis_trials, rig_trials

# A rival that imitates this much of an effect on the strokes recorded (cosine) is worth a test of its own.
ALIKE = 0.9
# Fewer standard errors than this in three runs is no separation.
TOLD_APART = 3.3
RUNS = 3
# More repeats than this are no advice.
MOST_REPEATS = 12
# The strokes recorded so far are simulated for so many of the runs at most; the others count by their time.
MOST_REHEARSED = 3
# An effect that was named alone, and that the strokes recorded set this far apart from its rivals, needs no other test.
SETTLED = 50.0
# The rivals looked at beside the named effect; more are an unclear set, not a question of one test.
MOST_RIVALS = 2

# Effects that resemble each other somewhere: what a single named effect is checked against where no candidates are at
# hand. Which of them resemble it on these strokes is computed.
LOOKALIKES: dict[str, tuple[str, ...]] = {
    "stiffness": ("once_per_rev", "drift"),
    "once_per_rev": ("stiffness", "twice_per_rev", "asymmetric_viscous"),
    "twice_per_rev": ("once_per_rev",),
    "hardening": ("stiffness", "once_per_rev"),
    "stribeck": ("drag", "presliding"),
    "drag": ("stribeck",),
    "asymmetric_viscous": ("once_per_rev", "offset"),
    "presliding": ("freeplay", "delay"),
    "freeplay": ("presliding", "delay"),
    "delay": ("presliding", "inertia"),
    "lead": ("inertia", "presliding"),
    "inertia": ("delay",),
    "warmup": ("drift",),
    "drift": ("warmup",),
}


@dataclass(frozen=True)
class Advice:
    """The best test for telling an effect from its rivals.

    Attributes
    ----------
    effect : str
    rivals : tuple of str
    ranking : tuple of Ranked
        Tests, the best first.
    now : float
        Standard errors between them on all strokes recorded so far.
    runs : int
        Runs recorded so far.
    """

    effect: str
    rivals: tuple[str, ...]
    ranking: tuple[Ranked, ...]
    now: float
    runs: int

    @property
    def best(self) -> Ranked:
        """The test to do, where it is better than what was recorded."""
        return self.ranking[0]

    @property
    def apart(self) -> float:
        """Standard errors between them in three runs of the best test."""
        return self.best.apart * math.sqrt(RUNS)

    @property
    def better(self) -> bool:
        """Whether three runs of the best test would tell more than what was recorded."""
        return self.apart > self.now

    @property
    def decides(self) -> bool:
        """Whether three runs of the best test would tell them apart, and better than what was recorded."""
        return self.better and self.apart >= TOLD_APART

    @property
    def repeats(self) -> int | None:
        """How many more runs like those recorded would tell them apart, or twice as well; None where too many.

        Standard errors grow with the root of the number of runs.
        """
        if self.now <= 0.0:
            return None
        wanted = TOLD_APART if self.now < TOLD_APART else 2.0 * self.now
        more = math.ceil(self.runs * ((wanted / self.now) ** 2 - 1.0))
        return more if more <= MOST_REPEATS else None

    def text(self, structure: str) -> str:
        """Return the advice in the words of the workshop."""
        names = " and ".join(card(n, structure).title for n in self.rivals)
        mine = card(self.effect, structure).title
        if self.decides:
            unit = "minute" if _short(self.best.minutes) == "1.0" else "minutes"
            return (
                f"{self.best.trial.text}. That tells {mine} from {names}: three runs of {_short(self.best.minutes)} "
                f"{unit} set them {_standard_errors(self.apart)} apart, the strokes recorded so far {_short(self.now)}."
            )
        check = card(self.effect, structure).check
        if self.better:
            return f"No test of the list tells {mine} from {names} at this size: {check}"
        none = (
            f"No test of the list would tell {mine} from {names} better than the strokes recorded so far, which set "
            f"them {_standard_errors(self.now)} apart"
        )
        if self.repeats is None:
            return f"{none}: {check}"
        reached = self.now * math.sqrt(1.0 + self.repeats / self.runs)
        runs = "one more run" if self.repeats == 1 else f"{self.repeats} more runs"
        return f"{none}. Repeat those: {runs} like them make it {_short(reached)}."


def _short(value: float) -> str:
    return f"{value:.1f}" if value < 9.5 else f"{min(value, 100.0):.0f}" if value < 100.0 else "over 100"


def _standard_errors(value: float) -> str:
    return f"{_short(value)} standard errors"


def advice(fitted: Fit, state: State, effect: str, rivals: Sequence[str]) -> Advice | None:
    """Return the best test for a fitted effect and its rivals; None where none can be simulated.

    Parameters
    ----------
    fitted : Fit
        Whose runs show what the mechanism does and how it was recorded.
    state : State
        Fitted with the effect.
    effect : str
    rivals : sequence of str
        The nearest first.
    """
    truth, sensor = _taken(fitted, state, effect)
    chosen = tuple(rivals)[:MOST_RIVALS]
    if any(card(n, fitted.model.structure_name).channel for n in (*truth.terms.effects, *chosen)):
        # Nobody knows beforehand what the load channel would do.
        return None
    recorded, share = _as_recorded(fitted, sensor.rate_hz)
    now = separation(truth, chosen, recorded, sensor) / math.sqrt(share)
    # Three runs of a test must tell more than what is there.
    ranking = rank(truth, chosen, _trials(fitted), sensor, above=now / math.sqrt(RUNS))
    return Advice(effect, chosen, ranking, now, len(fitted.runs))


def lookalikes(fitted: Fit, state: State, effect: str) -> tuple[str, ...]:
    """Return the rivals that a fitted effect resembles on the strokes recorded, the nearest first."""
    known = state.terms.effects
    if any(card(n, fitted.model.structure_name).channel for n in known):
        return ()
    possible = [n for n in LOOKALIKES.get(effect, ()) if n not in known and _has_meaning(n, fitted)]
    if not possible:
        return ()
    truth, sensor = _taken(fitted, state, effect)
    rehearsal = Rehearsal.of(_as_recorded(fitted, sensor.rate_hz)[0], sensor, truth)
    found = {n: rehearsal.cosine(n) for n in possible}
    return tuple(sorted((n for n in found if found[n] > ALIKE), key=lambda n: -found[n]))


def _has_meaning(name: str, fitted: Fit) -> bool:
    c = card(name, fitted.model.structure_name)
    if c.per_turn and fitted.model.structure_name == "axis" and "pitch_m" not in fitted.model.known:
        return False
    return not c.needs or c.needs in fitted.model.effects


def _taken(fitted: Fit, state: State, effect: str) -> tuple[Truth, Sensor]:
    truth = Truth.of(fitted.problem, state, effect)
    first = fitted.runs[0].recording
    rate = first.decimate / fitted.runs[0].step_s
    if truth.model.comparison.decimate is None:
        rate = planning_rate_hz(rate, truth.model.band_hz)
    step = max(r.recording.resolution for r in fitted.runs)
    return truth, Sensor(step, rate, fitted.noise_floor.moving_rms)


def _trials(fitted: Fit) -> tuple[Trial, ...]:
    if fitted.model.structure_name == "rig":
        return rig_trials()
    low = min(float(r.motion.min()) for r in fitted.runs)
    high = max(float(r.motion.max()) for r in fitted.runs)
    return axis_trials(low, high, max(float(np.abs(r.speed).max()) for r in fitted.runs))


def _as_recorded(fitted: Fit, rate_hz: float) -> tuple[list[np.ndarray], float]:
    """Return the motion of the longest runs as the test would sample it, and their share of the time of all runs."""
    longest = sorted(fitted.runs, key=lambda r: -r.duration_s)[:MOST_REHEARSED]
    share = sum(r.duration_s for r in longest) / sum(r.duration_s for r in fitted.runs)
    return [np.interp(np.arange(0.0, r.time_s[-1], 1.0 / rate_hz), r.time_s, r.motion) for r in longest], share
