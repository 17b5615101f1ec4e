"""What is large for each parameter of a car, from what is known of it and from its records."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence

import numpy as np

from ...model import Model
from ..record import Record

# As the core takes it.
GRAVITY = 9.80665
# Cornering stiffness over load of a passenger car's axle: 10 to 25 per rad.
STIFFNESS_PER_LOAD = 15.0
# The oscillation of the front wheels on the column, and its damping, where stiffness or inertia are not known.
TYPICAL_HZ = 10.0
TYPICAL_DAMPING = 0.2
# Friction and gap that are plainly felt: this share of the handwheel's amplitude is lost in them.
FELT_SHARE = 0.1


def sizes_of(records: Sequence[Record], model: Model) -> Mapping[str, float]:
    """Return a positive size for every parameter there may be."""
    given = {**model.start, **model.known}
    psi = np.concatenate([r.drives["handwheel"] for r in records])
    reach = max(float(np.quantile(np.abs(psi), 0.95)), 1e-6)
    rates = np.concatenate([np.gradient(r.drives["handwheel"], 1.0 / r.rate_hz) for r in records])
    mass, front, rear = (given[f"body.{k}"] for k in ("mass_kg", "front_axle_m", "rear_axle_m"))
    ratio = given["steering.ratio"]
    load = mass * GRAVITY / (front + rear)
    circular = 2.0 * math.pi * TYPICAL_HZ
    inertia = given.get("steering.inertia_kg_m2", 3.0)
    stiffness = given.get("steering.stiffness_nm_per_rad", inertia * circular**2 / ratio**2)
    # At the king-pins: what the column gives on the handwheel's amplitude.
    torque = ratio * stiffness * reach
    viscous = 2.0 * TYPICAL_DAMPING * ratio * math.sqrt(stiffness * inertia)
    sizes = {
        "body.mass_kg": mass,
        "body.yaw_inertia_kg_m2": mass * front * rear,
        "body.front_axle_m": front,
        "body.rear_axle_m": rear,
        "body.sprung_mass_kg": mass,
        "body.roll_arm_m": 0.5,
        "body.roll_inertia_kg_m2": 0.5 * mass,
        "front.cornering_n_per_rad": STIFFNESS_PER_LOAD * load * rear,
        "rear.cornering_n_per_rad": STIFFNESS_PER_LOAD * load * front,
        "front.pneumatic_trail_m": 0.03,
        "front.caster_trail_m": 0.03,
        "steering.inertia_kg_m2": inertia,
        "steering.ratio": ratio,
        "steering.stiffness_nm_per_rad": stiffness,
        "steering.aligning_nm_per_rad": 0.1 * ratio**2 * stiffness,
        "viscous.coefficient_nm_s_per_rad": viscous,
        "freeplay.gap_rad": FELT_SHARE * reach,
        "coulomb.level_nm": FELT_SHARE * torque,
        "stiction.extra_nm": FELT_SHARE * torque,
        "stribeck.extra_nm": FELT_SHARE * torque,
        "stribeck.speed_rad_s": max(0.2 * float(np.quantile(np.abs(rates), 0.95)) / ratio, 1e-9),
        "delay.time_s": 0.01,
        "offset.handwheel_rad": 0.05 * reach,
        "tyre_saturation.friction": 1.0,
        "tyre_relaxation.length_m": 0.5,
        "roll_steer.front_rad_per_rad": 0.05,
        "roll_steer.rear_rad_per_rad": 0.05,
    }
    for axle in ("front", "rear"):
        sizes |= {
            f"{axle}.track_m": 1.5,
            f"{axle}.roll_stiffness_nm_per_rad": 20.0 * mass,
            f"{axle}.roll_damping_nm_s_per_rad": 1.5 * mass,
            f"{axle}.roll_centre_m": 0.1,
            f"{axle}.load_ratio": 0.5,
            f"{axle}.relaxation_m": 0.5,
            f"{axle}.roll_steer": 0.05,
        }
    return sizes
