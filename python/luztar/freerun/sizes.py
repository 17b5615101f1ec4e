"""What is large for each parameter of a steering mechanism, read off its records: scales, and where searches start."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence

import numpy as np

from ..model import Model
from .record import Record

# The lowest oscillation of a steering mechanism on its column lies between 2 and 15 Hz; its damping is below critical.
TYPICAL_HZ = 6.0
TYPICAL_DAMPING = 0.2
# A body that is turned to and fro rests for a part of a second at each end.
TYPICAL_REST_S = 0.3


def sizes_of(records: Sequence[Record], model: Model) -> Mapping[str, float]:
    """Return a positive size for every parameter there may be."""
    psi = np.concatenate([r.drive_rad for r in records])
    phi = np.concatenate([r.prepared.effort for r in records])
    known = model.known
    ratio = known.get("steering.ratio", 16.0)
    # Least squares of phi on psi: the static gain g = p K / (p^2 K + c).
    gain = float(np.dot(psi - psi.mean(), phi - phi.mean()) / np.dot(psi - psi.mean(), psi - psi.mean()))
    gain = gain if 0.0 < gain else 1.0 / ratio
    # c = p K (1 / g - p); where the column hardly gives way, at least a hundredth of it.
    give = max(1.0 / gain - ratio, 0.01 * ratio)
    stiffness = known.get("steering.stiffness_nm_per_rad")
    circular = 2.0 * math.pi * TYPICAL_HZ
    if stiffness is None and "steering.aligning_nm_per_rad" in known:
        stiffness = known["steering.aligning_nm_per_rad"] / (ratio * give)
    if stiffness is None:
        inertia = known.get("steering.inertia_kg_m2", 2.5)
        stiffness = inertia * circular**2 / (ratio**2 + ratio * give)
    stiffness = max(stiffness, 1e-9)
    aligning = ratio * stiffness * give
    total = ratio**2 * stiffness + aligning
    inertia = known.get("steering.inertia_kg_m2", total / circular**2)
    inertia = max(inertia, 1e-12)
    viscous = 2.0 * TYPICAL_DAMPING * math.sqrt(total * inertia)
    speeds = np.concatenate([np.gradient(r.drive_rad, 1.0 / r.rate_hz) for r in records])
    fast = float(np.quantile(np.abs(speeds), 0.95)) * gain
    fast = max(fast, 1e-9)
    reach = float(np.quantile(np.abs(psi), 0.95))
    torque = (
        ratio * stiffness * reach * (1.0 - ratio * gain) if ratio * gain < 0.99 else 0.01 * ratio * stiffness * reach
    )
    wound = torque / (ratio * stiffness)
    friction = 0.3 * torque
    return {
        "steering.inertia_kg_m2": inertia,
        "steering.ratio": ratio,
        "steering.stiffness_nm_per_rad": stiffness,
        "steering.aligning_nm_per_rad": aligning,
        "freeplay.gap_rad": 0.1 * reach,
        "hardening.coefficient_nm_per_rad3": stiffness / wound**2,
        "viscous.coefficient_nm_s_per_rad": viscous,
        "asymmetric_viscous.difference_nm_s_per_rad": 0.3 * viscous,
        "drag.coefficient_nm_s2_per_rad2": viscous / fast,
        "coulomb.level_nm": friction,
        "asymmetric_coulomb.difference_nm": 0.3 * friction,
        "stribeck.extra_nm": friction,
        "stribeck.speed_rad_s": 0.2 * fast,
        "stiction.extra_nm": friction,
        "end_stop.stiffness_nm_per_rad": total,
        "end_stop.limit_rad": float(np.abs(phi).max()),
        "dead_zone.stiffness_nm_per_rad": 0.1 * total,
        "dead_zone.half_width_rad": 0.3 * float(np.abs(phi).max()),
        "once_per_rev.amplitude_nm": 0.3 * torque / ratio,
        "twice_per_rev.amplitude_nm": 0.3 * torque / ratio,
        "cogging.amplitude_nm": 0.1 * torque / ratio,
        "once_per_rev.phase_rad": 1.0,
        "twice_per_rev.phase_rad": 1.0,
        "cogging.phase_rad": 1.0,
        "cogging.per_turn": 3.0,
        "position_coulomb.slope_nm_per_rad": friction / float(np.abs(phi).max()),
        "tight_spot.extra_nm": friction,
        "tight_spot.angle_rad": float(np.abs(phi).max()),
        "tight_spot.width_rad": 0.1 * float(np.abs(phi).max()),
        "load.coefficient": 0.3,
        "dwell.extra_nm": friction,
        "dwell.time_s": TYPICAL_REST_S,
        "presliding.breakaway_rad": 0.05 * float(np.abs(phi).max()),
        "presliding.shape": 1.0,
        "delay.time_s": 0.01,
        "offset.level_rad": 0.02 * float(np.ptp(phi)),
    }
