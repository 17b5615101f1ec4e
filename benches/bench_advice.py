"""Does the advised test decide? `PYTHONPATH=tests python -m benches.bench_advice --each 40`.

For every pair of effects that the usual strokes confuse: the test that is advised is turned with the independent
generator, the truth hidden in it, and studied. Counted is how often the truth is named, alone and without its
rival in the set. Prints the rate with its
95 % interval (Wilson), beside how often the usual strokes name it.
"""

from __future__ import annotations

import os

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

import argparse
import math
from concurrent.futures import ProcessPoolExecutor

import luztar
from advised_trials import FOLLOWED, USUAL, measured
from benches.hidden_effects.tally import Rate
from luztar.planning.advise import advice

# (rival, what is hidden, its parameters): sizes at which the usual strokes leave a doubt, or nearly so.
PAIRS = (
    ("once_per_rev", "stiffness", {"stiffness_nm_per_rad": 0.03}),
    ("stiffness", "once_per_rev", {"amplitude_nm": 0.04, "phase_rad": 0.0}),
    ("drag", "stribeck", {"extra_nm": 0.06, "speed_rad_s": 0.2}),
    ("stribeck", "drag", {"coefficient_nm_s2_per_rad2": 0.2}),
    ("asymmetric_viscous", "once_per_rev", {"amplitude_nm": 0.04, "phase_rad": math.pi / 2.0}),
    ("once_per_rev", "asymmetric_viscous", {"difference_nm_s_per_rad": 0.03}),
    ("presliding", "stribeck", {"extra_nm": 0.06, "speed_rad_s": 0.05}),
    ("stribeck", "presliding", {"breakaway_rad": math.radians(0.15), "shape": "exponential"}),
    ("presliding", "freeplay", {"gap_rad": math.radians(0.15)}),
    ("freeplay", "presliding", {"breakaway_rad": math.radians(0.15), "shape": "exponential"}),
)


def named(case: tuple[str, dict[str, object], str, str, int]) -> bool:
    """Whether a study of one test names what is hidden in it, and not its rival with it."""
    truth, values, rival, trial, seed = case
    options = USUAL if trial == "usual strokes" else FOLLOWED[trial]
    found = luztar.study(luztar.Model.rig(), measured({truth: values}, options, seed=seed))
    return found.named == (truth,) and rival not in found.steps[-1].set


def advised(rival: str, truth: str, values: dict[str, object]) -> str:
    """Return the name of the test that is advised after the usual strokes."""
    fitted = luztar.fit(luztar.Model.rig(), measured({truth: values}, USUAL, seed=5))
    look = luztar.diagnose(fitted)
    state = next(c.search.best for c in look.found if c.name == truth)
    return advice(fitted, state, truth, (rival,)).best.trial.name


def main() -> None:
    """Print one line per pair."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--each", type=int, default=40, help="tests per pair")
    parser.add_argument("--workers", type=int, default=os.cpu_count() or 1)
    options = parser.parse_args()
    print(f"{'hidden':<20}{'rival':<20}{'advised test':<28}{'named there':<30}named by the usual strokes")
    with ProcessPoolExecutor(options.workers) as pool:
        for rival, truth, values in PAIRS:
            trial = advised(rival, truth, values)
            rates = []
            for name in (trial, "usual strokes"):
                cases = [(truth, values, rival, name, 100 + i) for i in range(options.each)]
                rates.append(Rate(sum(pool.map(named, cases)), options.each))
            print(f"{truth:<20}{rival:<20}{trial:<28}{rates[0]!s:<30}{rates[1]}", flush=True)


if __name__ == "__main__":
    main()
