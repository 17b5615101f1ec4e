"""Statistics and regression against their peers and against the machine: `python benches/bench_statistics.py`.

Needs scipy and pandas; river and runstats where installed. Every row times its calls interleaved and prints medians of
the rounds' ratios. "x copy" is the multiple of a plain memory copy of the same samples (read and write), "least" and
"CPU" tell how quiet the machine was: on a quiet one they equal the median.
"""

from __future__ import annotations

import importlib.util
import os
from collections.abc import Callable

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

import numpy as np
import pandas as pd
from interleaved import Timings, measure
from scipy.stats import linregress

from luztar import regression, stats

OURS, COPY = "luztar", "copy"


def head(title: str) -> None:
    """Print the head of a table."""
    print(f"\n{title}")
    print(f"{'work':<44}{'against':<24}{'theirs ns':>10}{'ours ns':>9}{'ratio':>8}{'least':>8}{'CPU':>8}{'x copy':>8}")


def row(work: str, samples: int, timings: Timings, peers: dict[str, str], copy: bool = True) -> None:
    """Print one line per peer; times are per sample."""
    ours = timings[OURS]
    for peer, title in peers.items():
        of_copy = f"{timings.ratio(OURS, COPY):8.1f}" if copy else f"{'':8}"
        print(
            f"{work:<44}{title:<24}{1e9 * timings[peer].median_s / samples:10.3f}{1e9 * ours.median_s / samples:9.3f}"
            f"{timings.ratio(peer, OURS):7.1f}x{1e9 * ours.least_s / samples:8.3f}"
            f"{1e9 * ours.cpu_s / samples:8.3f}{of_copy}"
        )


def whole_records(rng: np.random.Generator) -> None:
    """Print what one call on a whole record costs."""
    head("whole records, ns per sample")
    for n in (10_000, 1_000_000, 10_000_000):
        x, out = rng.standard_normal(n), np.empty(n)

        def separate(x: np.ndarray = x) -> tuple:
            return x.mean(), x.std(), x.min(), x.max()

        rounds = 15 if n < 10_000_000 else 9
        calls: dict[str, Callable[[], object]] = {
            "numpy": separate,
            OURS: lambda x=x: stats.Moments(x),
            COPY: lambda x=x, out=out: np.copyto(out, x),
        }
        timings = measure(calls, rounds)
        row(f"mean, std, min, max with places, {n:.0e}", n, timings, {"numpy": "numpy, four calls"})
        if n == 10_000_000:
            print(f"{'':44}{'plain read (numpy sum)':<24}{1e9 * measure({'sum': x.sum}, 9)['sum'].median_s / n:10.3f}")
        calls[OURS] = lambda x=x: stats.describe(x)
        row(f"describe (with skew, kurtosis), {n:.0e}", n, measure(calls, rounds), {"numpy": "numpy, four calls"})
    x16 = (1000 * rng.standard_normal(10_000_000)).astype(np.int16)
    out16 = np.empty_like(x16)
    calls = {
        "numpy": lambda: (x16.mean(), x16.std(), x16.min(), x16.max()),
        OURS: lambda: stats.Moments(x16),
        COPY: lambda: np.copyto(out16, x16),
    }
    row("the same of int16, 1e+07", x16.size, measure(calls, 5), {"numpy": "numpy, four calls"})


def fits(rng: np.random.Generator) -> None:
    """Print what fits of a whole record cost."""
    head("fits, ns per point")
    n = 1_000_000
    x = rng.standard_normal(n)
    y, out = 2 * x + rng.standard_normal(n), np.empty(n)
    calls = {
        "scipy": lambda: linregress(x, y),
        OURS: lambda: regression.line(x, y),
        COPY: lambda: np.copyto(out, x),
    }
    row("line with standard errors, 1e+06", n, measure(calls, 11), {"scipy": "scipy linregress"})
    for degree in (1, 3, 8):
        calls = {
            "polyfit": lambda degree=degree: np.polyfit(x, y, degree),
            "fit": lambda degree=degree: np.polynomial.Polynomial.fit(x, y, degree),
            OURS: lambda degree=degree: regression.polynomial(x, y, degree),
            COPY: lambda: np.copyto(out, x),
        }
        peers = {"polyfit": "numpy polyfit", "fit": "numpy Polynomial.fit"}
        row(f"polynomial of degree {degree}, 1e+06", n, measure(calls, 5), peers)
    rows = rng.standard_normal((n // 10, 5))
    design = np.column_stack([np.ones(n // 10), rows])
    right = rng.standard_normal(n // 10)
    calls = {
        "numpy": lambda: np.linalg.lstsq(design, right, rcond=None),
        OURS: lambda: regression.linear(rows, right),
        COPY: lambda: np.copyto(out[: n // 10], right),
    }
    row("5 predictors with standard errors, 1e+05", n // 10, measure(calls, 7), {"numpy": "numpy lstsq (no errors)"})


def windows(rng: np.random.Generator) -> None:
    """Print what rolling statistics cost."""
    head("rolling, window 1000, ns per sample")
    x, out = rng.standard_normal(1_000_000), np.empty(1_000_000)
    series = pd.Series(x).rolling(1000)
    calls = {
        "pandas std": series.std,
        "pandas all": lambda: (series.mean(), series.std(), series.min(), series.max()),
        OURS: lambda: stats.rolling(x, 1000),
        COPY: lambda: np.copyto(out, x),
    }
    peers = {"pandas std": "pandas, std alone", "pandas all": "pandas, all four"}
    row("mean, std, min, max, 1e+06", x.size, measure(calls, 5), peers)


def streams(rng: np.random.Generator) -> None:
    """Print what running statistics cost, by chunk and by sample, from Python."""
    head("running mean and deviation, ns per sample")
    x = rng.standard_normal(1000)
    values = x.tolist()
    ours, out = stats.Moments(), np.empty(1000)
    by_chunk: dict[str, Callable[[], object]] = {OURS: lambda: ours.push(x), COPY: lambda: np.copyto(out, x)}
    by_sample: dict[str, Callable[[], object]] = {OURS: lambda: [ours.push(v) for v in values], COPY: by_chunk[COPY]}
    titles = {}
    if importlib.util.find_spec("river"):
        from river.stats import Var

        variance = Var()
        titles["river"] = "river Var.update"
        by_chunk["river"] = by_sample["river"] = lambda: [variance.update(v) for v in values]
        titles_many = {"river many": "river Var.update_many"}
        many = Var()
        by_chunk["river many"] = lambda: many.update_many(x)
    else:
        titles_many = {}
        print("river is not installed: its rows are left out")
    if importlib.util.find_spec("runstats"):
        from runstats import Statistics

        running = Statistics()
        titles["runstats"] = "runstats push"
        by_chunk["runstats"] = by_sample["runstats"] = lambda: [running.push(v) for v in values]
    else:
        print("runstats is not installed: its rows are left out")
    row("chunks of 1000", 1000, measure(by_chunk, 21), {**titles, **titles_many})
    row("one sample at a time", 1000, measure(by_sample, 21), titles, copy=False)
    if importlib.util.find_spec("runstats"):
        from runstats import Regression

        theirs, sums = Regression(), regression.LineSums()
        calls = {
            "runstats": lambda: [theirs.push(v, v) for v in values],
            OURS: lambda: sums.push(x, x),
            COPY: lambda: np.copyto(out, x),
        }
        row("running line, chunks of 1000", 1000, measure(calls, 21), {"runstats": "runstats Regression"})


def calls_of_ten(rng: np.random.Generator) -> None:
    """Print what one push of ten samples costs in all, from Python."""
    print(f"\n{'push of 10 samples, ns in all':<44}{'median':>10}{'least':>9}")
    x, counts = rng.standard_normal(10), np.arange(10, dtype=np.int16)
    rows = rng.standard_normal((10, 2))
    moments, shaped = stats.Moments(), stats.Moments(shape=True, nan="skip")
    rolling, sketch, counted = stats.Rolling(1000), stats.QuantileSketch(), stats.Counts()
    sums, fading, last = regression.LineSums(), regression.LineSums(forgetting=0.99), regression.RollingLine(1000)
    times, linear = regression.TimeLine(1000.0, start_s=1.7e9), regression.LinearSums(2)
    polynomial, recursive = regression.PolynomialSums(2, (-4.0, 4.0)), regression.RecursiveLeastSquares([0.0, 0.0])
    calls: dict[str, Callable[[], object]] = {
        "nothing (the loop itself)": lambda: None,
        "Moments": lambda: moments.push(x),
        "Moments of int16": lambda: moments.push(counts),
        "Moments with shape, skipping NaN": lambda: shaped.push(x),
        "Rolling": lambda: rolling.push(x),
        "QuantileSketch": lambda: sketch.push(x),
        "Counts": lambda: counted.push(counts),
        "LineSums": lambda: sums.push(x, x),
        "LineSums with forgetting": lambda: fading.push(x, x),
        "RollingLine": lambda: last.push(x, x),
        "TimeLine": lambda: times.push(x),
        "LinearSums, 2 predictors": lambda: linear.push(rows, x),
        "PolynomialSums, degree 2": lambda: polynomial.push(x, x),
        "RecursiveLeastSquares, 2 coefficients": lambda: recursive.push(rows, x),
    }
    timings = measure(calls, 15)
    for name, timing in timings.of.items():
        print(f"{name:<44}{1e9 * timing.median_s:10.0f}{1e9 * timing.least_s:9.0f}")


def quantiles(rng: np.random.Generator) -> None:
    """Print what quantiles cost."""
    head("quantiles, ns per sample")
    x = rng.standard_normal(1_000_000)
    x16, out = (1000 * x).astype(np.int16), np.empty_like(x)
    sketch, counts = stats.QuantileSketch(0.01), stats.Counts()
    calls = {
        "numpy": lambda: np.quantile(x, 0.5),
        OURS: lambda: (sketch.push(x), sketch.quantile(0.5)),
        COPY: lambda: np.copyto(out, x),
    }
    row("sketch within 1 %, one quantile, 1e+06", x.size, measure(calls, 7), {"numpy": "numpy quantile (at once)"})
    calls["numpy"] = lambda: np.quantile(x16, 0.5)
    calls[OURS] = lambda: (counts.push(x16), counts.quantile(0.5))
    row("int16 counted, exact, 1e+06", x.size, measure(calls, 7), {"numpy": "numpy quantile (at once)"})


def threads(rng: np.random.Generator) -> None:
    """Print what two threads on two objects gain over one after the other."""
    from concurrent.futures import ThreadPoolExecutor

    x = rng.standard_normal(200_000)
    made = [stats.Moments(shape=True) for _ in range(2)]

    def push(m: stats.Moments) -> None:
        for _ in range(50):
            m.push(x)

    with ThreadPoolExecutor(2) as pool:
        calls = {"one": lambda: [push(m) for m in made], "two": lambda: list(pool.map(push, made))}
        timings = measure(calls, 9)
    print(f"\ntwo threads on two objects: {timings.ratio('one', 'two'):.2f} times as fast as one after the other")


def main() -> None:
    """Print all tables."""
    rng = np.random.default_rng(1)
    whole_records(rng)
    fits(rng)
    streams(rng)
    calls_of_ten(rng)
    windows(rng)
    quantiles(rng)
    threads(rng)


if __name__ == "__main__":
    main()
