"""The test that would tell apart what free runs could not, in words."""

from __future__ import annotations

from collections.abc import Sequence

from ..diagnosis.experiment import Experiment
from ..model import card

# What separates a pair: the property of the drive in which their motions differ.
_PAIRS: dict[frozenset[str], str] = {
    frozenset({"stiction", "stribeck"}): "Turn the handwheel very slowly and at three even speeds: stiction shows at "
    "starts only, Stribeck friction also while creeping.",
    frozenset({"freeplay", "coulomb"}): "Repeat slowly with the road wheels on turn-plates and with the full load on "
    "the tyres: friction grows with the load, a gap does not.",
    frozenset({"drag", "hardening"}): "Turn to the same angles slowly and fast: drag grows with speed, a hardening "
    "spring with the angle of wind-up only.",
    frozenset({"delay", "viscous"}): "Repeat at two clearly different speeds with steps in between: a delay shifts by "
    "the same time, viscous friction rounds the corners.",
}


def experiment_for(members: Sequence[str]) -> Experiment | None:
    """Return the test that tells a set apart; None for one member."""
    if len(members) < 2:
        return None
    pair = frozenset(members[:2])
    if pair in _PAIRS:
        return Experiment(_PAIRS[pair], tuple(members))
    titles = " from ".join(card(n, "steering").title for n in members[:2])
    text = f"Repeat with slow even turns, fast even turns and several stops, to tell {titles}."
    return Experiment(text, tuple(members))
