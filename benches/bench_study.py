"""How long a study takes, how that grows with the records, and what its peers take: `python benches/bench_study.py`.

Three runs of 40 s at 1 kHz from the generators of the tests, two effects hidden in them. The aims are those of a
machine with two cores: a whole study under 2 s, one effect added and refitted under 150 ms, cost linear in samples.

PySINDy and lmfit are optional (`pip install pysindy lmfit`): they get the same records, prepared and searched as the
calibration does it (`benches/hidden_effects/peers.py`). Every table times its calls interleaved and prints medians;
"least" and "CPU" tell how quiet the machine was. `--short` leaves out the long records.
"""

from __future__ import annotations

import math
import os
import statistics
import sys
import warnings
from collections.abc import Callable, Sequence
from dataclasses import replace

# The threads of a look share the cores already. Before NumPy is loaded.
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

from hidden_effects.cases import Measured, RigRun, simulate_rig_set
from hidden_effects.peers import PROGRAMS, installed, lmfit_best, pysindy_terms, samples
from interleaved import Timings, measure

import luztar
from luztar.diagnosis import Diagnosis
from luztar.diagnosis.climb import Loop
from luztar.diagnosis.fit import fit_prepared
from luztar.diagnosis.floor import noise_floor
from luztar.diagnosis.prepare import prepare
from luztar.model import card

ROUNDS = 7
HIDDEN = {
    "stribeck": {"extra_nm": 0.35, "speed_rad_s": 0.08},
    "asymmetric_viscous": {"difference_nm_s_per_rad": 0.25},
}
RUNS, RATE_HZ, DURATION_S = 3, 1000.0, 40.0
LENGTHS_S, RATES_HZ = (20.0, 40.0, 80.0, 160.0), (500.0, 1000.0, 2000.0)
AIM_STUDY_S, AIM_REFIT_S = 2.0, 0.15
MODEL = luztar.Model.rig()

Calls = dict[str, Callable[[], object]]


def simulated(rate_hz: float, duration_s: float) -> list[RigRun]:
    """Return the records of one rig and one hand."""
    return simulate_rig_set(HIDDEN, runs=RUNS, seed=1, sample_rate_hz=rate_hz, duration_s=duration_s)


def as_runs(made: Sequence[RigRun], until_s: float = math.inf) -> list[luztar.Run]:
    """Return records as luztar takes them, up to an instant."""
    return [
        luztar.Run(
            time=r.time_s[r.time_s < until_s],
            angle=r.angle_rad[r.time_s < until_s],
            torque=r.torque_nm[r.time_s < until_s],
            units={"angle": "rad", "torque": "Nm"},
            name=f"run{i}",
        )
        for i, r in enumerate(made, 1)
    ]


def line(name: str, timings: Timings, aim_s: float | None = None) -> None:
    """Print one row in milliseconds."""
    t = timings[name]
    said = ""
    if aim_s is not None:
        met = ["met" if seconds <= aim_s else "missed" for seconds in (t.median_s, t.least_s)]
        said = f"   aim {1e3 * aim_s:.0f}: {met[0]} by the median, {met[1]} by the least"
    print(f"  {name:<46}{1e3 * t.median_s:9.1f}{1e3 * t.least_s:9.1f}{1e3 * t.cpu_s:9.1f}{said}")


def with_best(look: Diagnosis) -> luztar.Model:
    """Return the model with the effect that a look names, started from what the look has found, as a study does."""
    best = next(c for c in look.found if c.name == look.named[0]).search.best
    model = look.fit.model + look.named[0]
    start = {
        f"{name}.{p.key}": value
        for name, values in best.terms.inner.items()
        for p, value in zip(card(name, "rig").inner, values, strict=True)
    }
    return replace(model, start=start)


def parts(runs: list[luztar.Run]) -> None:
    """Print what a study takes, part by part.

    A prepared run keeps columns it has made, so that every part starts from runs prepared anew.
    """
    at: dict[str, object] = {}

    def prepared() -> None:
        at["runs"] = prepare(runs, MODEL)

    def floored() -> None:
        prepared()
        at["floor"] = noise_floor(at["runs"], MODEL)

    def fitted() -> None:
        floored()
        at["fit"] = fit_prepared(MODEL, at["runs"], (), at["floor"])

    def looked() -> None:
        fitted()
        look = luztar.diagnose(at["fit"])
        at["loop"] = Loop(MODEL, at["runs"], (), at["floor"], None)
        at["more"] = with_best(look)

    calls: Calls = {
        "prepare": prepared,
        "noise floor": lambda: noise_floor(at["runs"], MODEL),
        "fit": lambda: fit_prepared(MODEL, at["runs"], (), at["floor"]),
        "one look": lambda: luztar.diagnose(at["fit"]),
        "one effect added and refitted": lambda: at["loop"].fit(at["more"]),
        "the same from the records, nothing known": lambda: luztar.fit(MODEL + "stribeck", runs),
        "whole study": lambda: luztar.study(MODEL, runs),
        "tb038": lambda: luztar.tb038.evaluate(runs),
    }
    before: Calls = {
        "noise floor": prepared,
        "fit": floored,
        "one look": fitted,
        "one effect added and refitted": looked,
    }
    timings = measure(calls, ROUNDS, before=before)
    print(f"\n{'ms':<48}{'median':>9}{'least':>9}{'CPU':>9}")
    aims = {"whole study": AIM_STUDY_S, "one effect added and refitted": AIM_REFIT_S}
    for name in calls:
        line(name, timings, aims.get(name))


def growth(title: str, records: dict[str, list[luztar.Run]], rounds: int) -> None:
    """Print the cost per sample of records of several sizes and the exponent of the growth."""
    sizes = {name: sum(map(len, runs)) for name, runs in records.items()}
    jobs: dict[str, Callable[[list[luztar.Run]], object]] = {
        "prepare": lambda runs: prepare(runs, MODEL),
        "fit": lambda runs: luztar.fit(MODEL, runs),
        "fit and look": lambda runs: luztar.diagnose(luztar.fit(MODEL, runs)),
        "whole study": lambda runs: luztar.study(MODEL, runs),
    }
    print(f"\n{title + ', ns per sample':<26}" + "".join(f"{name:>18}" for name in records) + f"{'exponent':>10}")
    print(f"  {'samples':<24}" + "".join(f"{n:18d}" for n in sizes.values()))
    for job, call in jobs.items():
        timings = measure({n: lambda r=r, call=call: call(r) for n, r in records.items()}, rounds)
        cells = [f"{1e9 * timings[n].median_s / s:.0f} ({1e9 * timings[n].least_s / s:.0f})" for n, s in sizes.items()]
        exponents = [
            slope([math.log(s) for s in sizes.values()], [math.log(timings[n].rounds[k]) for n in sizes])
            for k in range(rounds)
        ]
        print(f"  {job:<24}" + "".join(f"{c:>18}" for c in cells) + f"{statistics.median(exponents):10.2f}")
    print("  found: " + "; ".join(f"{name} {', '.join(luztar.study(MODEL, r).named)}" for name, r in records.items()))


def slope(x: Sequence[float], y: Sequence[float]) -> float:
    """Return the slope of the least-squares line."""
    return luztar.regression.line(x, y).slope


def peers(made: list[RigRun], runs: list[luztar.Run]) -> None:
    """Print what other programs take for one look at the same records, and what they find."""
    measured = Measured(runs, [], made, HIDDEN, {})
    theirs: dict[str, Callable[[], list[str]]] = {
        "PySINDy": lambda: pysindy_terms(samples(measured)),
        "lmfit + BIC": lambda: lmfit_best(samples(measured)),
    }
    calls: dict[str, Callable[[], Sequence[str]]] = {
        "luztar, one look": lambda: luztar.diagnose(luztar.fit(MODEL, runs)).named,
        "luztar, whole study": lambda: luztar.study(MODEL, runs).named,
    }
    for name, call in theirs.items():
        if installed(name):
            calls[name] = call
        else:
            print(f"\n{name} is left out: pip install {PROGRAMS[name]}")
    if len(calls) == 2:
        return
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        found = {name: call() for name, call in calls.items()}
        timings = measure(calls, ROUNDS)
    print(f"\n{'from the same records, ms':<28}{'median':>9}{'least':>9}{'CPU':>9}{'to one look':>13}   found")
    for name in calls:
        t = timings[name]
        ratio = timings.ratio(name, "luztar, one look")
        times = f"{1e3 * t.median_s:9.1f}{1e3 * t.least_s:9.1f}{1e3 * t.cpu_s:9.1f}"
        print(f"  {name:<26}{times}{ratio:12.2f}x   {', '.join(found[name]) or 'nothing'}")


def main() -> None:
    """Print all tables."""
    made = simulated(RATE_HZ, DURATION_S)
    runs = as_runs(made)
    found = luztar.study(MODEL, runs)
    prepared = prepare(runs, MODEL)
    strokes, compared = sum(len(r.strokes) for r in prepared), sum(r.motion.size for r in prepared)
    print(f"{sum(map(len, runs))} samples, {compared} compared, {strokes} strokes, {os.cpu_count()} cores")
    print(f"found: {', '.join(found.named)} in {len(found.looks)} looks; {found.verdict}")
    parts(runs)
    peers(made, runs)
    if "--short" in sys.argv[1:]:
        return
    longest = simulated(RATE_HZ, max(LENGTHS_S))
    growth("length", {f"{s:.0f} s": as_runs(longest, s) for s in LENGTHS_S}, 5)
    growth("sample rate", {f"{f:.0f} Hz": as_runs(simulated(f, DURATION_S)) for f in RATES_HZ}, 5)


if __name__ == "__main__":
    main()
