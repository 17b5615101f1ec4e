"""What a workshop does when it follows a test of luztar's list: options of the independent generator's hand."""

from __future__ import annotations

import luztar
from generators.rig import simulate_rig_full

BASE = {
    "offset": {"level_nm": 0.05},
    "coulomb": {"level_nm": 0.75},
    "viscous": {"coefficient_nm_s_per_rad": 0.3},
}
WINDOW = {"amplitude_deg": 50.0, "overshoot_deg": (0.0, 8.0)}
USUAL = [{**WINDOW, "speeds_deg_s": (5.0, 38.0), "strokes": 6}] * 3
# One entry per run.
FOLLOWED = {
    "wide": [{"amplitude_deg": 185.0, "overshoot_deg": (0.0, 10.0), "speeds_deg_s": (10.0, 60.0), "strokes": 6}] * 3,
    "very_wide": [{"amplitude_deg": 545.0, "overshoot_deg": (0.0, 15.0), "speeds_deg_s": (30.0, 120.0), "strokes": 6}]
    * 3,
    "slow_breakaway": [{**WINDOW, "speeds_deg_s": (5.0, 38.0), "strokes": 8, "slow_breakaway": True}] * 3,
    # A hand that is asked for an even speed still varies a little.
    "speed_ladder": [
        {**WINDOW, "speeds_deg_s": speeds, "strokes": 6, "wobble_ratio": (1.05, 1.2)}
        for speeds in ((2.5, 3.5), (10.0, 14.0), (34.0, 46.0))
    ],
    "dwell_ladder": [
        {**WINDOW, "speeds_deg_s": (10.0, 38.0), "strokes": 10, "slow_breakaway": True, "dwell_s": (0.25, 4.0)}
    ]
    * 3,
    "small_reversals": [{"amplitude_deg": 4.0, "overshoot_deg": (0.0, 2.0), "speeds_deg_s": (3.0, 15.0), "strokes": 20}]
    * 3,
    "longer": [{**WINDOW, "speeds_deg_s": (5.0, 38.0), "strokes": 16}] * 3,
}


def measured(hidden, motions, seed):
    """Runs of the generator, one per motion, as luztar reads them."""
    runs = []
    for number, motion in enumerate(motions):
        r = simulate_rig_full(
            hidden, base=BASE, motion=motion, noise="50 ms", wander_nm=0.02, encoder_deg=0.02, seed=[seed, number]
        )
        runs.append(luztar.Run(time=r.time_s, angle=r.angle_rad, torque=r.torque_nm, name=f"run{number + 1}"))
    return runs
