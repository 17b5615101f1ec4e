"""What to measure next where the data do not decide."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

from .fit import Fit
from .verdict import Judgement


@dataclass(frozen=True)
class Experiment:
    """A test that would separate effects.

    Attributes
    ----------
    text : str
        What to do, in the words of the workshop.
    separates : tuple of str
    """

    text: str
    separates: tuple[str, ...]

    def to_dict(self) -> dict[str, Any]:
        """Return the experiment as the JSON interface prints it."""
        return {"text": self.text, "separates": list(self.separates)}


def next_experiment(fitted: Fit, judged: Judgement) -> Experiment | None:
    """Return the test to do after a look; None where there is nothing to tell apart."""
    if judged.verdict == "too_few_strokes":
        return Experiment(
            "Record three runs of at least six strokes each, from beyond one end to beyond the other.", ()
        )
    return experiment_for(fitted, judged.named) if judged.named else None


def experiment_for(fitted: Fit, named: tuple[str, ...]) -> Experiment | None:
    """Return the test that would tell the effects of a set apart, or confirm one that looks like another."""
    rig = fitted.model.structure_name == "rig"
    reach = max(r.recording.range for r in fitted.runs)
    rivals = tuple(named)
    turns = {"stiffness", "once_per_rev"}
    if rig and turns & set(rivals) and reach < 1.5 * math.pi:
        pair = tuple(dict.fromkeys((*rivals, *sorted(turns))))
        return Experiment(
            "Turn from beyond -180 to beyond +180 degrees and back, slowly, three times: a spring keeps rising where a "
            "once-per-turn torque comes back.",
            pair,
        )
    if len(rivals) < 2:
        return None
    if "delay" in rivals:
        return Experiment(
            "Turn the same strokes once slowly and once fast: a delay grows with speed, an elastic or loose "
            "connection keeps its angle.",
            rivals,
        )
    if {"presliding", "freeplay"} & set(rivals):
        return Experiment(
            "Rock the wheel by a few degrees about one angle, as slowly as the hand allows, ten times: a gap shows as "
            "torque without friction, an elastic contact as a slope.",
            rivals,
        )
    if {"stribeck", "viscous", "asymmetric_viscous", "offset"} & set(rivals):
        return Experiment(
            "Turn the same strokes at three even speeds, the slowest as slow as the hand allows, the fastest near "
            "40 degrees per second.",
            rivals,
        )
    return Experiment("Record a longer run with strokes of different speed and length.", rivals)
