"""How fast free runs are: `python -m benches.bench_dynamics [--quick] [--million]`.

One interleaved run of lane-steps per second of both kernels with every instruction set, of the same split step as a
numba loop over all cores, of MuJoCo's joint with friction loss, and of trajectories by SciPy's events. Printed are
medians of the rounds, per second of wall time and per second of processor time, which is what counts on a machine that
does other work as well. Errors against cost: `python -m benches.work_precision`. `--million` runs 10^6 trajectories of
8 s and prints time and peak memory, and how long an interrupt takes to be answered. numba and MuJoCo are left out where
they are not installed.
"""

from __future__ import annotations

import _thread
import argparse
import os
import statistics
import subprocess
import sys
import threading
import time
from collections.abc import Callable
from dataclasses import replace

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

import numpy as np

from benches.work_precision import mujoco_joint, numba_loops, scipy_events
from benches.work_precision.problems import DECAY, STEERING
from luztar.dynamics import Normal, Uniform, sample, summarise
from luztar.errors import Interrupted

ROUNDS, QUICK_ROUNDS = 9, 3
LANES = 256
STEP_S = 1e-4
# Every tenth step is a sample; a few numbers of each lane are kept: what is measured is the step, not the memory.
SUBSTEPS = 10
WIDTHS = ("baseline", "avx2", "avx512")
MILLION, MILLION_SECONDS, MILLION_STEP_S = 1_000_000, 8.0, 1e-3


def ways() -> tuple[dict[str, Callable[[], object]], dict[str, int]]:
    """Return the calls and how many lane-steps each makes."""
    p = STEERING
    levels = np.linspace(4.0, 12.0, LANES)
    given = {**p.parameters, p.varied: levels}
    psi = p.handwheel_rad(STEP_S * SUBSTEPS)
    steps = round(p.seconds / STEP_S)
    made: dict[str, Callable[[], object]] = {}
    counts: dict[str, int] = {}
    for method in ("split", "moreau_jean"):
        for width in WIDTHS:
            made[f"{method}, {width}"] = lambda m=method, w=width: summarise(
                given, psi, sample_rate_hz=1.0 / (STEP_S * SUBSTEPS), substeps=SUBSTEPS, method=m, width=w, keep="last"
            )
    loop = numba_loops.split_loop()
    if loop is None:
        print("numba is not installed: without the loop by hand")
    else:
        out = np.empty((LANES, psi.size))
        fine, constants = numba_loops.half_steps(p, STEP_S), numba_loops.constants(p)
        made["split, numba parallel"] = lambda: loop(constants, levels, 0.0, fine, STEP_S, SUBSTEPS, out)
    counts |= dict.fromkeys(made, LANES * steps)
    if mujoco_joint.available():
        short = replace(DECAY, seconds=1.0)
        made["MuJoCo, free decay"] = mujoco_joint.joint(short, STEP_S, tuned=True)
        counts["MuJoCo, free decay"] = round(short.seconds / STEP_S)
    else:
        print("MuJoCo is not installed: without its joint")
    return made, counts


def speeds(rounds: int) -> None:
    """Print one line per way."""
    made, counts = ways()
    made["scipy DOP853, 1e-8"] = lambda: scipy_events.run(STEERING, "DOP853", 1e-8)
    wall: dict[str, list[float]] = {name: [] for name in made}
    busy: dict[str, list[float]] = {name: [] for name in made}
    for call in made.values():
        call()
    for _ in range(rounds):
        for name, call in made.items():
            started, worked = time.perf_counter(), time.process_time()
            call()
            wall[name].append(time.perf_counter() - started)
            busy[name].append(time.process_time() - worked)
    print(f"{LANES} lanes, steps of {STEP_S:g} s; 10^6 lane-steps/s, medians of {rounds}")
    print(f"{'':<24}{'wall':>10}{'processor':>12}")
    for name, count in counts.items():
        shown = [count / statistics.median(s[name]) / 1e6 for s in (wall, busy)]
        print(f"{name:<24}{shown[0]:>10.3g}{shown[1]:>12.3g}")
    if "split, numba parallel" in made:
        for kind, taken in (("wall", wall), ("processor", busy)):
            pairs = zip(taken["split, numba parallel"], taken["split, avx512"], strict=True)
            print(f"numba over luztar, {kind}, median of ratios: {statistics.median(a / b for a, b in pairs):.1f}")
    error = STEERING.error_rad(scipy_events.run(STEERING, "DOP853", 1e-8))
    each = 1e3 * statistics.median(busy["scipy DOP853, 1e-8"]) / STEERING.seconds
    print(f"scipy DOP853 with events, 1e-8: {each:.2f} ms per simulated s, error {error:.1e} rad")


def million(lanes: int) -> None:
    """Run many trajectories and print time and peak memory of this process."""
    import resource

    psi = np.sin(np.pi * MILLION_STEP_S * np.arange(round(MILLION_SECONDS / MILLION_STEP_S) + 1))
    drawn = sample(
        {
            **STEERING.parameters,
            "coulomb.level_nm": Uniform(4.0, 12.0),
            "stiction.extra_nm": Uniform(0.0, 4.0),
            "freeplay.gap_rad": Normal(0.1, 0.03, low=0.0),
        },
        lanes,
        seed=1,
    )
    started, worked = time.perf_counter(), time.process_time()
    made = summarise(drawn, psi, sample_rate_hz=1.0 / MILLION_STEP_S)
    taken, busy = time.perf_counter() - started, time.process_time() - worked
    peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024.0
    print(f"{lanes} trajectories of {MILLION_SECONDS:g} s at {MILLION_STEP_S:g} s: {taken:.1f} s ({busy:.1f} s of all")
    print(f"processors), peak memory of the process {peak:.0f} MiB; peak angle {np.median(made['peak_rad']):.4f} rad")
    came: list[float] = []

    def interrupt() -> None:
        came.append(time.perf_counter())
        _thread.interrupt_main()

    threading.Timer(0.3 * taken, interrupt).start()
    try:
        summarise(drawn, psi, sample_rate_hz=1.0 / MILLION_STEP_S)
    except Interrupted as stopped:
        print(f"an interrupt was answered after {1e3 * (time.perf_counter() - came[0]):.0f} ms: {stopped}")


def main() -> None:
    """Print what was asked for."""
    parser = argparse.ArgumentParser(prog="python -m benches.bench_dynamics", description=__doc__)
    parser.add_argument("--quick", action="store_true", help="few rounds")
    parser.add_argument("--million", action="store_true", help="10^6 trajectories too, in a process of their own")
    parser.add_argument("--lanes", type=int, help="only that many trajectories, in this process")
    options = parser.parse_args()
    if options.lanes is not None:
        million(options.lanes)
        return
    speeds(QUICK_ROUNDS if options.quick else ROUNDS)
    if options.million:
        # Memory is that of a fresh process.
        subprocess.run([sys.executable, "-m", "benches.bench_dynamics", "--lanes", str(MILLION)], check=True)


if __name__ == "__main__":
    main()
