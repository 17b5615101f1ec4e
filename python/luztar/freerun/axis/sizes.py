"""What is large for each parameter of an axis, read off the balance of forces along its records."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from ..record import Record


def sizes_of(records: Sequence[Record]) -> Mapping[str, float]:
    """Return a positive size for every parameter there may be."""
    force = np.concatenate([r.drives["force"] for r in records])
    speed = np.concatenate([r.outputs[0].speed for r in records])
    acceleration = np.concatenate([r.outputs[0].acceleration for r in records])
    position = np.concatenate([r.outputs[0].motion for r in records])
    fast = max(float(np.quantile(np.abs(speed), 0.95)), 1e-9)
    quick = max(float(np.quantile(np.abs(acceleration), 0.95)), 1e-9)
    push = max(float(np.quantile(np.abs(force - np.mean(force)), 0.95)), 1e-9)
    reach = max(float(np.ptp(position)), 1e-9)
    columns = np.column_stack([acceleration / quick, speed / fast, np.sign(speed), np.ones(speed.size)])
    moving = np.abs(speed) > 0.05 * fast
    parts = np.linalg.lstsq(columns[moving], force[moving], rcond=None)[0]
    inertia, viscous, friction = (max(float(p), 0.05 * push) for p in parts[:3])
    return {
        "inertia.inertia_kg": inertia / quick,
        "viscous.coefficient_n_s_per_m": viscous / fast,
        "asymmetric_viscous.difference_n_s_per_m": 0.3 * viscous / fast,
        "drag.coefficient_n_s2_per_m2": viscous / fast**2,
        "coulomb.level_n": friction,
        "offset.level_n": 0.3 * friction,
        "stribeck.extra_n": friction,
        "stribeck.speed_m_s": 0.2 * fast,
        "stiction.extra_n": friction,
        "stiffness.stiffness_n_per_m": 0.3 * push / reach,
    }
