"""Error against cost: `python -m benches.work_precision [--quick] [--draw docs/pictures/work_precision.png]`.

Every way to run a trajectory takes turns with all others at all of its settings. Printed are the largest error against
the exact solution and the processor time per simulated second of one trajectory (medians of the rounds), and what
SciPy's events cost over the split step at the same error. numba and MuJoCo are left out where they are not installed.
"""

from __future__ import annotations

import argparse
import os
import statistics

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

import numpy as np

from benches.interleaved import measure

from . import mujoco_joint, numba_loops
from .contenders import LANES, Entry, entries
from .problems import DECAY, STEERING, Problem

# (way, setting, processor seconds per simulated second, error in rad)
Point = tuple[str, str, float, float]
ROUNDS, QUICK_ROUNDS = 5, 3
SPLIT = f"luztar split, {LANES} lanes"
ALONE = "luztar split, one alone"


def points(p: Problem, *, quick: bool) -> list[Point]:
    """Return cost and error of every way at every setting."""
    given: dict[str, Entry] = {f"{e.way}, {e.setting}": e for e in entries(p, quick=quick)}
    errors = {name: p.error_rad(e.call()) for name, e in given.items()}
    timed = measure({name: e.call for name, e in given.items()}, QUICK_ROUNDS if quick else ROUNDS, least_round_s=0.01)
    return [
        (e.way, e.setting, timed[name].cpu_s / (e.trajectories * p.seconds), errors[name]) for name, e in given.items()
    ]


def cost_at(found: list[Point], way: str, error: float) -> float | None:
    """Return what a way costs at an error, between its settings on logarithmic scales; None outside of them."""
    curve = sorted((e, c) for w, _, c, e in found if w == way)
    errors, costs = np.log([e for e, _ in curve]), np.log([c for _, c in curve])
    if not errors[0] <= np.log(error) <= errors[-1]:
        return None
    return float(np.exp(np.interp(np.log(error), errors, costs)))


def main() -> None:
    """Measure, print, draw."""
    parser = argparse.ArgumentParser(prog="python -m benches.work_precision", description=__doc__)
    parser.add_argument("--quick", action="store_true", help="a third of the settings, few rounds")
    parser.add_argument("--draw", metavar="FILE", help="draw the diagram; needs matplotlib")
    options = parser.parse_args()
    if numba_loops.split_loop() is None:
        print("numba is not installed: without the loops by hand")
    if not mujoco_joint.available():
        print("MuJoCo is not installed: without its joint")
    found = {}
    for p in (DECAY, STEERING):
        found[p.name] = points(p, quick=options.quick)
        print(f"\n{p.title}, {p.seconds:g} s: processor us per simulated second of one trajectory, largest error")
        for way, setting, cost, error in found[p.name]:
            print(f"{way:<36}{setting:>10}{1e6 * cost:>12.3g}{error:>12.1e}")
        for reference in (SPLIT, ALONE):
            ratios = {}
            for way, _, cost, error in found[p.name]:
                same = cost_at(found[p.name], reference, error)
                if way.startswith("scipy") and same is not None:
                    ratios.setdefault(way, []).append(cost / same)
            for way, values in ratios.items():
                told = f"{min(values):.0f} to {max(values):.0f}, median {statistics.median(values):.0f}"
                print(f"{way} over {reference}, at equal error ({len(values)} settings): {told}")
    if options.draw:
        from .picture import draw

        draw({p.title: found[p.name] for p in (DECAY, STEERING)}, options.draw)
        print(f"drawn: {options.draw}")


if __name__ == "__main__":
    main()
