"""Trying every effect of the catalogue in a free-run model: refitted, folds included."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from ..model import Card
from .fit import FreeFit
from .plant import Motion
from .solve import Solution, solve_with


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
    plant = fitted.free_problem.plant
    records = fitted.free_problem.data.records
    wanted = plant.candidates(model, records)
    moved = Motion(model, records, fitted.simulated)
    found = []
    for i, c in enumerate(wanted):
        if progress is not None:
            progress(i, len(wanted))
        solved = solve_with(fitted.free_problem, model + c.name, fitted.solution.found, c.name)
        found.append(Candidate(c, solved, plant.same_as(c, solved.found, moved)))
    if progress is not None:
        progress(len(wanted), len(wanted))
    return sorted(found, key=lambda c: c.solution.held_out_loss)


def gain(before: Solution, after: Solution) -> tuple[float, float]:
    """Return the share of the unseen error that a solution takes off, and the fall of its loss in standard errors."""
    share = 1.0 - float(np.sqrt(after.held_out_loss / max(before.held_out_loss, np.finfo(float).tiny)))
    fall, error = paired(before, after)
    return share, fall / error if error > 0.0 else 0.0


def paired(before: Solution, after: Solution) -> tuple[float, float]:
    """Return the fall of the unseen loss and its standard error, paired by stroke."""
    falls = before.stroke_losses - after.stroke_losses
    return float(falls.sum()), float(np.sqrt(falls.size) * falls.std(ddof=1)) if falls.size > 1 else 0.0
