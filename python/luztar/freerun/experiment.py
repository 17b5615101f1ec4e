"""The test that would tell apart what free runs could not, in words."""

from __future__ import annotations

from collections.abc import Sequence

from ..diagnosis.experiment import Experiment
from ..model import Model, card
from .plant import Plant


def experiment_for(plant: Plant, members: Sequence[str], model: Model) -> Experiment | None:
    """Return the test that tells a set apart; None for one member."""
    if len(members) < 2:
        return None
    pair = frozenset(members[:2])
    if pair in plant.pairs:
        return Experiment(plant.pairs[pair], tuple(members))
    titles = " from ".join(card(n, model.structure_name).title for n in members[:2])
    text = f"Repeat with slow even motion, fast even motion and several stops, to tell {titles}."
    return Experiment(text, tuple(members))
