"""Writes the bundled demo data: `PYTHONPATH=tests python -m generators.demo [FOLDER]`."""

from __future__ import annotations

import sys
from pathlib import Path

from generators.rig import RigRun, simulate_rig_set
from generators.write import write_runs

FOLDER = Path(__file__).resolve().parents[2] / "python" / "luztar" / "demo_data"
SEED = 38
ENCODER_DEG = 0.02
BASE = {
    "offset": {"level_nm": 0.05},
    "coulomb": {"level_nm": 0.75},
    "viscous": {"coefficient_nm_s_per_rad": 0.30},
}
# More friction at low speed, and viscous friction that depends on the direction: a mean friction hides both.
HIDDEN = {
    "stribeck": {"extra_nm": 0.35, "speed_rad_s": 0.08},
    "asymmetric_viscous": {"difference_nm_s_per_rad": 0.25},
}
# Strokes start beyond 50 degrees and stay below 40 degrees/s, as TB 038 wants; slow parts make stribeck visible.
MOTION = {"amplitude_deg": 53.0, "overshoot_deg": (0.0, 8.0), "speeds_deg_s": (5.0, 38.0), "strokes": 6}


def demo_runs() -> list[RigRun]:
    """The three runs."""
    return simulate_rig_set(
        HIDDEN, runs=3, seed=SEED, base=BASE, motion=MOTION, sample_rate_hz=250.0, encoder_deg=ENCODER_DEG
    )


def write_demo(folder: str | Path = FOLDER) -> list[Path]:
    """Write them with their truth."""
    more = {"seed": SEED, "sample_rate_hz": 250.0, "encoder_deg": ENCODER_DEG, "white_noise_nm": 0.05}
    return write_runs(folder, demo_runs(), hidden=HIDDEN, base=BASE, angle_decimals=2, more=more)


if __name__ == "__main__":
    for written in write_demo(*sys.argv[1:2]):
        print(f"{written.name}: {written.stat().st_size} bytes")
