"""Trying every effect of the catalogue in a free-run model: refitted, folds included."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from ..model import Card, cards
from .fit import FreeFit
from .parameters import are_apart
from .solve import Solution, solve_with

# A Stribeck speed below this share of the road wheel's top speed is felt at rest only: it is stiction.
SLOW_SHARE = 0.03
# Over less than a turn of the handwheel a wave per turn and a spring are the same curve.
WHOLE_TURN_RAD = 2.0 * np.pi
# Static friction that has grown after this share of a usual rest does not show its growth: it is stiction.
SHORT_SHARE = 0.2


@dataclass(frozen=True)
class Candidate:
    """One effect tried.

    Attributes
    ----------
    card : Card
    solution : Solution
    same_as : str or None
        The simpler effect it came out as.
    """

    card: Card
    solution: Solution
    same_as: str | None

    @property
    def name(self) -> str:
        """The effect's name."""
        return self.card.name

    @property
    def values(self) -> dict[str, float]:
        """The best values of its own parameters."""
        own = f"{self.name}."
        return {k.removeprefix(own): v for k, v in self.solution.found.items() if k.startswith(own)}


def try_all(fitted: FreeFit, progress: Callable[[int, int], None] | None = None) -> list[Candidate]:
    """Return every candidate by its unseen loss, the best first."""
    model = fitted.model
    turned = max(float(np.ptp(r.motion)) for r in fitted.runs)
    wanted = [
        c
        for c in cards(model.structure_name)
        if c.name not in model.effects
        and (turned >= WHOLE_TURN_RAD or not c.per_turn)
        and c.is_searched_on(model.structure_name)
        and (c.needs is None or c.needs in model.effects)
        and not are_apart((*model.effects, c.name))
    ]
    found = []
    for i, c in enumerate(wanted):
        if progress is not None:
            progress(i, len(wanted))
        solved = solve_with(fitted.free_problem, model + c.name, fitted.solution.found, c.name)
        found.append(Candidate(c, solved, _same_as(fitted, c, solved)))
    if progress is not None:
        progress(len(wanted), len(wanted))
    return sorted(found, key=lambda c: c.solution.held_out_loss)


def _same_as(fitted: FreeFit, c: Card, solved: Solution) -> str | None:
    if c.name == "asymmetric_coulomb":
        return c.becomes
    if c.name == "stribeck":
        pairs = zip(fitted.predicted, fitted.runs, strict=True)
        top = max(float(np.abs(np.gradient(p, r.step_s)).max()) for p, r in pairs)
        if solved.found["stribeck.speed_rad_s"] < SLOW_SHARE * top:
            return c.becomes
    if c.name == "dwell":
        rest = typical_rest_s(fitted)
        if rest is None or solved.found["dwell.time_s"] < SHORT_SHARE * rest:
            return "stiction"
    return None


def typical_rest_s(fitted: FreeFit) -> float | None:
    """Return the median time for which the modelled road wheel stands, None where it never does."""
    rests: list[float] = []
    for predicted, run in zip(fitted.predicted, fitted.runs, strict=True):
        # At rest the model's angle is the same to the last bit.
        edges = np.flatnonzero(np.diff(np.concatenate(([0], np.diff(predicted) == 0.0, [0])).astype(int)))
        rests.extend((edges[1::2] - edges[::2]) * run.step_s)
    return float(np.median(rests)) if rests else None


def gain(before: Solution, after: Solution) -> tuple[float, float]:
    """Return the share of the unseen error that a solution takes off, and the fall of its loss in standard errors."""
    share = 1.0 - float(np.sqrt(after.held_out_loss / max(before.held_out_loss, np.finfo(float).tiny)))
    fall, error = paired(before, after)
    return share, fall / error if error > 0.0 else 0.0


def paired(before: Solution, after: Solution) -> tuple[float, float]:
    """Return the fall of the unseen loss and its standard error, paired by stroke."""
    falls = before.stroke_losses - after.stroke_losses
    return float(falls.sum()), float(np.sqrt(falls.size) * falls.std(ddof=1)) if falls.size > 1 else 0.0
