"""How long one study takes, part by part: `PYTHONPATH=tests python benches/bench_study.py`.

Three runs of 40 s at 1 kHz from the generators of the tests, two effects hidden in them. Medians over repetitions.
"""

from __future__ import annotations

import statistics
import time
from collections.abc import Callable

import luztar
from generators.rig import simulate_rig_set
from luztar.diagnosis.fit import fit_prepared
from luztar.diagnosis.floor import noise_floor
from luztar.diagnosis.prepare import prepare

REPETITIONS = 5
HIDDEN = {
    "stribeck": {"extra_nm": 0.35, "speed_rad_s": 0.08},
    "asymmetric_viscous": {"difference_nm_s_per_rad": 0.25},
}


def timed(name: str, call: Callable[[], object]) -> None:
    """Print the median time of a call."""
    seconds = []
    for _ in range(REPETITIONS):
        started = time.perf_counter()
        call()
        seconds.append(time.perf_counter() - started)
    print(f"{name:<14} {1e3 * statistics.median(seconds):8.1f} ms  (least {1e3 * min(seconds):.1f})")


def main() -> None:
    """Print one line per part."""
    made = simulate_rig_set(HIDDEN, runs=3, seed=1, sample_rate_hz=1000.0, duration_s=40.0)
    runs = luztar.measurement.Runs(
        luztar.Run(time=r.time_s, angle=r.angle_rad, torque=r.torque_nm, name=f"run{i}") for i, r in enumerate(made, 1)
    )
    model = luztar.Model.rig()
    prepared = prepare(runs, model)
    fitted = fit_prepared(model, prepared)
    found = luztar.study(model, runs)
    strokes = sum(len(r.strokes) for r in prepared)
    print(f"{sum(map(len, runs))} samples, {strokes} strokes; found: {', '.join(found.named)}; {found.verdict}")
    timed("prepare", lambda: prepare(runs, model))
    timed("noise floor", lambda: noise_floor(prepared, "Nm"))
    timed("fit", lambda: fit_prepared(model, prepared))
    timed("one look", lambda: luztar.diagnose(fitted))
    timed("whole study", lambda: luztar.study(model, runs))
    timed("tb038", lambda: luztar.tb038.evaluate(runs))


if __name__ == "__main__":
    main()
