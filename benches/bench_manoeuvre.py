"""How long the double lane change's studies take: `python benches/bench_manoeuvre.py [--whole]`.

One optimisation of each manoeuvre (usual effort, the median of three seeds) and what one drive of it costs; beside it a
search that drives one car at a time (`scipy.optimize.differential_evolution`). With `--whole` also the 9 x 9 study
of both manoeuvres: nine optimisations each, every signal on every car, and 357 cars of a finer grid.
"""

from __future__ import annotations

import argparse
import os
import statistics
import time

import numpy as np
from scipy.optimize import differential_evolution

from luztar.manoeuvre import Manoeuvre, manoeuvre, optimise, robust

TASKS = {
    "avoiding": {"length_m": 55.0, "speed_m_s": 15.0},
    "overtaking": {"length_m": 140.0, "speed_m_s": 20.0},
}
SEEDS = (0, 1, 2)
# Enough for a stable time per drive; the peer's whole search takes minutes.
PEER_GENERATIONS = 3


def peer_s_per_drive(task: Manoeuvre) -> float:
    """Return what a drive costs where the optimiser asks for one at a time."""
    box = task.box
    drives = 0

    def one(point: np.ndarray) -> float:
        nonlocal drives
        drives += 1
        return float(task.scores(box.values(point[np.newaxis])).companion[0])

    started = time.perf_counter()
    differential_evolution(one, [(0.0, 1.0)] * 6, maxiter=PEER_GENERATIONS, popsize=8, rng=0, polish=False)
    return (time.perf_counter() - started) / drives


def main() -> None:
    """Measure and print."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--whole", action="store_true", help="the 9 x 9 study of both manoeuvres as well")
    whole = parser.parse_args().whole
    load = os.getloadavg()[0] if hasattr(os, "getloadavg") else float("nan")
    print(f"{os.cpu_count()} processors, load {load:.1f}")
    for name, options in TASKS.items():
        task = manoeuvre(name, **options)
        took, cpu, per_drive, ratios = [], [], [], []
        for seed in SEEDS:
            started, cpu_started = time.perf_counter(), time.process_time()
            found = optimise(task, seed=seed)
            took.append(time.perf_counter() - started)
            cpu.append(time.process_time() - cpu_started)
            per_drive.append(took[-1] / found.evaluations)
            ratios.append(peer_s_per_drive(task) / per_drive[-1])
        print(
            f"{name}: one optimisation {statistics.median(took):.2f} s ({statistics.median(cpu):.2f} s of processor), "
            f"{found.evaluations} drives of {task.duration_s:.1f} s, {1e6 * statistics.median(per_drive):.0f} us each; "
            f"one drive at a time (scipy) {statistics.median(ratios):.1f} times as long each"
        )
    if whole:
        started, cpu_started = time.perf_counter(), time.process_time()
        for name, options in TASKS.items():
            robust(manoeuvre(name, **options))
        print(
            f"9 x 9 study of both manoeuvres: {time.perf_counter() - started:.0f} s "
            f"({time.process_time() - cpu_started:.0f} s of processor)"
        )


if __name__ == "__main__":
    main()
