"""One mass in short words: parameters for `simulate`, `trace` and `exact`."""

from __future__ import annotations

NAMES = {
    "inertia": "steering.inertia_kg_m2",
    "ratio": "steering.ratio",
    "stiffness": "steering.stiffness_nm_per_rad",
    "aligning": "steering.aligning_nm_per_rad",
    "gap": "freeplay.gap_rad",
    "viscous": "viscous.coefficient_nm_s_per_rad",
    "asymmetric_viscous": "asymmetric_viscous.difference_nm_s_per_rad",
    "coulomb": "coulomb.level_nm",
    "asymmetric_coulomb": "asymmetric_coulomb.difference_nm",
    "stiction": "stiction.extra_nm",
    "drag": "drag.coefficient_nm_s2_per_rad2",
    "stribeck": "stribeck.extra_nm",
    "stribeck_speed": "stribeck.speed_rad_s",
    "hardening": "hardening.coefficient_nm_per_rad3",
}


def body(**parameters: float) -> dict[str, float]:
    """One mass with the handwheel as the end of its spring (ratio 1)."""
    given = {"inertia": 1.0, "ratio": 1.0, "stiffness": 0.0, **parameters}
    return {NAMES[k]: v for k, v in given.items()}
