"""Hidden effects from the independent generator: the study names them, and nothing where nothing is hidden.

The generator shares no code with the engine; sizes are those of ``generators.typical``.
"""

import math

import numpy as np
import pytest
from generators.rig import simulate_rig_set

import luztar
from luztar.model import cards

BASE = {"coulomb": 0.75, "viscous": 0.3, "offset": 0.05}

EFFECTS = {
    "offset": ({}, {"offset"}),
    "asymmetric_viscous": ({"difference_nm_s_per_rad": 0.35}, None),
    "stribeck": ({"extra_nm": 0.35, "speed_rad_s": 0.08}, None),
    "presliding": ({"breakaway_rad": math.radians(2.0), "shape": "exponential"}, None),
    "freeplay": ({"gap_rad": 0.06}, None),
    "stiffness": ({"stiffness_nm_per_rad": 0.19}, None),
    "once_per_rev": ({"amplitude_nm": 0.2, "phase_rad": 2.0}, None),
    "inertia": ({"inertia_kg_m2": 0.12}, None),
    "delay": ({"time_s": 0.04}, None),
    "drift": ({"rate_nm_per_s": 0.018}, None),
}
