"""Two trajectories with a reference that is exact between events: a free decay, and the paper's steering model."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from luztar.dynamics import Signal, exact

# Where errors are looked at: every step length used divides it.
GRID_S = 0.1


@dataclass(frozen=True)
class Problem:
    """One mechanism, its start and its drive, a sine at the handwheel."""

    name: str
    title: str
    parameters: Mapping[str, float]
    start_rad: float
    amplitude_rad: float
    frequency_rad_s: float
    seconds: float
    # What the lanes of a batch differ in, from half to one and a half times the value.
    varied: str

    @cached_property
    def times_s(self) -> np.ndarray:
        """Instants at which errors are looked at."""
        return np.arange(round(self.seconds / GRID_S) + 1) * GRID_S

    @cached_property
    def reference_rad(self) -> np.ndarray:
        """Angle there, to rounding."""
        hand = Signal.sine(self.amplitude_rad, self.frequency_rad_s) if self.amplitude_rad else 0.0
        return exact(self.parameters, hand, self.times_s, start_rad=self.start_rad).roadwheel_rad

    def handwheel_rad(self, step_s: float) -> np.ndarray:
        """Return the drive, sampled at every step."""
        count = round(self.seconds / step_s) + 1
        return self.amplitude_rad * np.sin(self.frequency_rad_s * step_s * np.arange(count))

    def error_rad(self, angles: np.ndarray) -> float:
        """Return the largest difference from the reference on the grid."""
        return float(np.abs(angles - self.reference_rad).max())


# A frequency that fits no step: half periods of whole steps would show an order that is not there.
FREQUENCY_HZ = 1.0618033
STIFFNESS = (2.0 * math.pi * FREQUENCY_HZ) ** 2

DECAY = Problem(
    "decay",
    "free decay with dry friction",
    {
        "steering.inertia_kg_m2": 1.0,
        "steering.ratio": 1.0,
        "steering.stiffness_nm_per_rad": STIFFNESS,
        "coulomb.level_nm": 0.1 * STIFFNESS,
    },
    1.03,
    0.0,
    0.0,
    4.0,
    "coulomb.level_nm",
)
STEERING = Problem(
    "steering",
    "steering: gear, freeplay, static above kinetic friction",
    {
        "steering.inertia_kg_m2": 3.0,
        "steering.ratio": 16.0,
        "steering.stiffness_nm_per_rad": 60.0,
        "freeplay.gap_rad": 0.1,
        "viscous.coefficient_nm_s_per_rad": 40.0,
        "coulomb.level_nm": 8.1,
        "stiction.extra_nm": 3.9,
    },
    0.0,
    1.0,
    math.pi,
    4.0,
    "coulomb.level_nm",
)
