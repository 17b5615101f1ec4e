"""Typical inner parameters of the effects: where a law is looked at before anybody has fitted it."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ..diagnosis.prepare import Prepared
from ..model import Card, Model

# The level of friction and the viscous coefficient of a sound mechanism: TB 038 allows 1.5 Nm; a ball screw of the
# size of the public EMPS axis.
SOUND = {"rig": {"coulomb": 0.75, "viscous": 0.3}, "axis": {"coulomb": 20.0, "viscous": 200.0}}


@dataclass(frozen=True)
class Reach:
    """What the runs of a test cover.

    Attributes
    ----------
    low, high : float
        Ends of the motion, in its unit.
    top_speed : float
    duration_s : float
        Of the longest run.
    """

    low: float
    high: float
    top_speed: float
    duration_s: float

    @classmethod
    def of(cls, runs: Sequence[Prepared]) -> Reach:
        """Return what runs cover."""
        return cls(
            min(float(r.motion.min()) for r in runs),
            max(float(r.motion.max()) for r in runs),
            max(float(np.abs(r.speed).max()) for r in runs),
            max(r.duration_s for r in runs),
        )

    @property
    def span(self) -> float:
        """From one end to the other."""
        return self.high - self.low


def typical_inner(effect: Card, model: Model, reach: Reach) -> tuple[float, ...]:
    """Return typical values of an effect's inner parameters.

    Speeds, places and widths of a rig are those of a steering robot in the TB 038 window, so that they are the same
    whatever test is planned; those of an axis are shares of what it covers.
    """
    rig = model.structure_name == "rig"
    far = max(abs(reach.low), abs(reach.high))
    table: dict[str, tuple[float, ...]] = {
        # 4.6 degrees per second, an eighth of the fastest speed that TB 038 allows
        "stribeck": (0.08 if rig else 0.12 * reach.top_speed,),
        "presliding": (math.radians(2.0) if rig else 0.002 * reach.span, 1.0),
        "freeplay": (math.radians(2.0) if rig else 0.002 * reach.span,),
        "dead_zone": (0.4 if rig else 0.4 * far,),
        "end_stop": (0.85 * far,),
        "cogging": (4.0,),
        "tight_spot": (
            (math.radians(15.0), math.radians(6.0)) if rig else (reach.low + 0.6 * reach.span, 0.05 * reach.span)
        ),
        "delay": (0.03 if rig else 0.003,),
        "lead": (0.03 if rig else 0.002,),
        "warmup": (0.25 * reach.duration_s,),
        "dwell": (0.4,),
    }
    return table.get(effect.name, ())
