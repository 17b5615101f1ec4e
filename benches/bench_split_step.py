"""What a lane-step of the split kernel costs, by what happens in it: `python benches/bench_split_step.py`.

Million lane-steps per second of processor time, medians of interleaved rounds, for every instruction set. Few numbers
of each lane are kept, so that the memory of the results costs nothing. The cases differ in how often a group of eight
lanes has an event: never, at the usual reversals of lanes side by side, at those of lanes that have nothing in common,
and in every step.
"""

from __future__ import annotations

import math
import statistics
import time
from collections.abc import Callable

import numpy as np

from luztar.dynamics import summarise

ROUNDS = 9
LANES = 256
STEPS = 20_000
RATE_HZ = 10_000.0
WIDTHS = ("baseline", "avx2", "avx512")


def cases() -> dict[str, tuple[dict[str, np.ndarray | float], np.ndarray, np.ndarray | None]]:
    """Return parameters, handwheel angle and load of every case."""
    alike: dict[str, np.ndarray | float] = {
        "steering.inertia_kg_m2": 3.0,
        "steering.ratio": 16.0,
        "steering.stiffness_nm_per_rad": 60.0,
        "freeplay.gap_rad": 0.1,
        "viscous.coefficient_nm_s_per_rad": 40.0,
        "coulomb.level_nm": np.linspace(4.0, 12.0, LANES),
        "stiction.extra_nm": 3.9,
    }
    chance = np.random.default_rng(1)
    unlike = {key: value * chance.uniform(0.5, 1.5, LANES) for key, value in alike.items()}
    unlike["coulomb.level_nm"] = chance.uniform(4.0, 60.0, LANES)
    times = np.arange(STEPS + 1) / RATE_HZ
    still = np.zeros_like(times)
    slow, fast = np.sin(math.pi * times), np.sin(3.0 * math.pi * times)
    flip = np.where(np.arange(times.size) % 2, 5e3, -5e3)
    moving = alike | {"coulomb.level_nm": np.zeros(LANES), "stiction.extra_nm": 0.0}
    return {
        "no event": (moving, slow, None),
        "lanes alike": (alike, slow, None),
        "lanes unlike": (unlike, fast, None),
        "event in every step": (alike, still, flip),
        "alike, Stribeck": (alike | {"stribeck.extra_nm": 2.0, "stribeck.speed_rad_s": 0.05}, slow, None),
    }


def main() -> None:
    """Print one line per case."""
    ways: dict[tuple[str, str], Callable[[], object]] = {}
    for name, (given, psi, load) in cases().items():
        for width in WIDTHS:
            ways[name, width] = lambda g=given, p=psi, q=load, w=width: summarise(
                g, p, sample_rate_hz=RATE_HZ, load_nm=q, width=w
            )
    busy: dict[tuple[str, str], list[float]] = {way: [] for way in ways}
    for call in ways.values():
        call()
    for _ in range(ROUNDS):
        for way, call in ways.items():
            started = time.process_time()
            call()
            busy[way].append(time.process_time() - started)
    print(f"{LANES} lanes, {STEPS} steps; 10^6 lane-steps per second of processor time, medians of {ROUNDS}")
    print(f"{'':<22}" + "".join(f"{width:>10}" for width in WIDTHS))
    for name in cases():
        rates = [LANES * STEPS / statistics.median(busy[name, width]) / 1e6 for width in WIDTHS]
        print(f"{name:<22}" + "".join(f"{rate:>10.0f}" for rate in rates))


if __name__ == "__main__":
    main()
