"""Filters against scipy, in one run on one machine: `OPENBLAS_NUM_THREADS=1 python benches/bench_signal.py`.

Every repeat times both in turn; a row gives the median of the ratios of wall time and of processor time (the latter
does not count waiting for a busy core, but threads add up in it), the nanoseconds per sample of both (median and
least), and how many plain copies of the same samples ours is. Build with ``maturin develop --release`` first. `--quick`
makes fewer repeats; other work on the machine shows in the longest records, which wait for memory, and in the threads.
"""

from __future__ import annotations

import hashlib
import statistics
import sys
import threading
import time
from collections.abc import Callable
from dataclasses import dataclass
from functools import partial

import numpy as np
from scipy import signal as scipy_signal

from luztar import signal

RATE_HZ, CUTOFF_HZ, POLES = 1000.0, 6.0, 4
CHUNK = 64
# A repeat lasts at least this long, so that the clock's step does not show.
LEAST_S = 2e-3


@dataclass
class Row:
    """One line of the table."""

    work: str
    peer: str
    asked: str
    ratio: float
    processor_ratio: float
    ours_ns: tuple[float, float]
    peer_ns: tuple[float, float]
    copies: float


def seconds(call: Callable[[], object], times: int) -> tuple[float, float]:
    """Return the seconds of one call by the wall and by the processor, the mean over a burst."""
    wall, processor = time.perf_counter(), time.process_time()
    for _ in range(times):
        call()
    return (time.perf_counter() - wall) / times, (time.process_time() - processor) / times


def burst(call: Callable[[], object]) -> int:
    """Return how many calls make a repeat."""
    call()
    return max(1, round(LEAST_S / seconds(call, 1)[0]))


def compare(
    work: str,
    asked: str,
    ours: Callable[[], object],
    peer: Callable[[], object],
    copy: Callable[[], object],
    samples: int,
    repeats: int,
    against: str = "sosfiltfilt",
) -> Row:
    """Time ours, the peer and a copy in turn."""
    calls = [(call, burst(call)) for call in (ours, peer, copy)]
    taken = [[seconds(call, times) for call, times in calls] for _ in range(repeats)]

    def nanoseconds(which: int) -> tuple[float, float]:
        wall = [repeat[which][0] * 1e9 / samples for repeat in taken]
        return statistics.median(wall), min(wall)

    return Row(
        work,
        against,
        asked,
        statistics.median(p[0] / o[0] for o, p, _ in taken),
        statistics.median(p[1] / max(o[1], 1e-9) for o, p, _ in taken),
        nanoseconds(0),
        nanoseconds(1),
        statistics.median(o[0] / c[0] for o, _, c in taken),
    )


def records(repeats: int) -> list[Row]:
    """One channel, forward and backward."""
    sos = scipy_signal.butter(POLES, CUTOFF_HZ, fs=RATE_HZ, output="sos")
    rows = []
    for n in (1000, 1_000_000, 10_000_000):
        x = 100 + np.random.default_rng(0).standard_normal(n)
        out = np.empty_like(x)
        asked = {1000: ("20", "20"), 1_000_000: ("10", "6"), 10_000_000: ("10", "6")}[n]
        fresh_asked = {10_000_000: ("8", "5")}.get(n, ("", ""))
        for name, least, fresh_least in zip(("avx512", "avx2"), asked, fresh_asked, strict=True):
            if name not in signal.instruction_sets():
                continue
            design = signal.LowPass(poles=POLES, cutoff_hz=CUTOFF_HZ, sample_rate_hz=RATE_HZ, instruction_set=name)
            few = repeats if n < 10_000_000 else max(5, repeats // 3)
            rows.append(
                compare(
                    f"zero phase, {n:.0e} samples, out=, {name}",
                    least if n > 1000 or name == "avx512" else "",
                    partial(signal.zero_phase, x, design=design, out=out),
                    partial(scipy_signal.sosfiltfilt, sos, x),
                    partial(np.copyto, out, x),
                    n,
                    few,
                )
            )
            rows.append(
                compare(
                    f"zero phase, {n:.0e} samples, fresh, {name}",
                    fresh_least,
                    partial(signal.zero_phase, x, design=design),
                    partial(scipy_signal.sosfiltfilt, sos, x),
                    x.copy,
                    n,
                    few,
                )
            )
        if n == 1000:
            rows.append(
                compare(
                    "the same by cut-off, no design given",
                    "20",
                    partial(signal.zero_phase, x, sample_rate_hz=RATE_HZ, cutoff_hz=CUTOFF_HZ),
                    partial(scipy_signal.sosfiltfilt, sos, x),
                    x.copy,
                    n,
                    repeats,
                )
            )
    return rows


def channels(repeats: int) -> list[Row]:
    """Sixteen channels."""
    sos = scipy_signal.butter(POLES, CUTOFF_HZ, fs=RATE_HZ, output="sos")
    x = 100 + np.random.default_rng(0).standard_normal((16, 1_000_000))
    out = np.empty_like(x)
    design = signal.LowPass(poles=POLES, cutoff_hz=CUTOFF_HZ, sample_rate_hz=RATE_HZ)
    few = max(3, repeats // 8)
    rows = [
        compare(
            f"16 channels x 1e6, {threads} thread{'s' if threads > 1 else ''}",
            "14" if threads == 2 else "",
            partial(signal.zero_phase, x, design=design, threads=threads, out=out),
            lambda: scipy_signal.sosfiltfilt(sos, x),
            lambda: np.copyto(out, x),
            x.size,
            few,
        )
        for threads in (1, 2)
    ]
    frames = np.ascontiguousarray(x[:, :200_000].T)
    place = np.empty_like(frames)
    rows.append(
        compare(
            "16 channels side by side, zero phase, out=",
            "",
            lambda: signal.zero_phase(frames, design=design, axis=0, out=place),
            lambda: scipy_signal.sosfiltfilt(sos, frames, axis=0),
            lambda: np.copyto(place, frames),
            frames.size,
            few * 3,
        )
    )
    bank = signal.FilterBank(causal_design(), 16)
    zi = np.repeat(scipy_signal.sosfilt_zi(sos)[:, :, np.newaxis], 16, axis=2)
    rows.append(
        compare(
            "bank: 16 channels in frames, causal, in place",
            "",
            lambda: bank.push_in_place(frames),
            lambda: scipy_signal.sosfilt(sos, frames, axis=0, zi=zi),
            lambda: np.copyto(place, frames),
            frames.size,
            few * 3,
            "sosfilt + zi",
        )
    )
    return rows


def causal_design() -> signal.LowPass:
    """Return the design of the streams."""
    return signal.LowPass(poles=POLES, cutoff_hz=CUTOFF_HZ, sample_rate_hz=RATE_HZ, zero_phase=False)


def streams(repeats: int) -> list[Row]:
    """Chunks with state."""
    sos = scipy_signal.butter(POLES, CUTOFF_HZ, fs=RATE_HZ, output="sos")
    state = scipy_signal.sosfilt_zi(sos)

    def peer(chunk: np.ndarray) -> np.ndarray:
        nonlocal state
        y, state = scipy_signal.sosfilt(sos, chunk, zi=state)
        return y

    rows = []
    for length in (10, CHUNK, 1024):
        chunk = 100 + np.random.default_rng(0).standard_normal(length)
        out = np.empty_like(chunk)
        f, g = signal.Filter.of(causal_design()), signal.Filter.of(causal_design())
        asked = "30" if length == CHUNK else ""
        for name, ours in (("push", partial(f.push, chunk)), ("push_into", partial(g.push_into, chunk, out))):
            rows.append(
                compare(
                    f"causal chunks of {length}, {name}",
                    asked,
                    ours,
                    partial(peer, chunk),
                    partial(np.copyto, out, chunk),
                    length,
                    repeats,
                    "sosfilt + zi",
                )
            )
    return rows


def two_threads(one: Callable[[], object], other: Callable[[], object]) -> float:
    """Return how many times as fast two calls on two threads are as one after the other."""
    ratios = []
    for _ in range(15):
        started = time.perf_counter()
        one()
        other()
        between = time.perf_counter()
        running = [threading.Thread(target=call) for call in (one, other)]
        for thread in running:
            thread.start()
        for thread in running:
            thread.join()
        ratios.append((between - started) / (time.perf_counter() - between))
    return statistics.median(ratios)


def scaling() -> tuple[float, float]:
    """Return what two threads give two filters, and what they give two hashes: all this machine has to give now."""
    x = np.random.default_rng(0).standard_normal(100_000)
    filters = [signal.Filter.of(causal_design()) for _ in range(2)]
    outs = [np.empty_like(x) for _ in range(2)]

    def stream(which: int) -> None:
        for _ in range(300):
            filters[which].push_into(x, outs[which])

    data = bytes(20_000_000)
    hashes = two_threads(lambda: hashlib.sha256(data), lambda: hashlib.sha256(data))
    return two_threads(partial(stream, 0), partial(stream, 1)), hashes


def main() -> None:
    """Print the table."""
    repeats = 8 if "--quick" in sys.argv else 25
    print(
        f"instruction sets: {', '.join(signal.instruction_sets())}; {POLES} poles, {CUTOFF_HZ:g} Hz at {RATE_HZ:g} Hz\n"
    )
    print(
        "| work | against | asked | ratio | by processor time | ours ns/sample (least) | peer (least) | plain copies |"
    )
    print("|---|---|---|---|---|---|---|---|")
    for row in (*records(repeats), *channels(repeats), *streams(repeats)):
        ours, peer = (f"{median:.2f} ({least:.2f})" for median, least in (row.ours_ns, row.peer_ns))
        print(
            f"| {row.work} | {row.peer} | {row.asked and row.asked + 'x'} | {row.ratio:.1f}x "
            f"| {row.processor_ratio:.1f}x | {ours} | {peer} | {row.copies:.1f} |",
            flush=True,
        )
    chunk = np.ones(10)
    f = signal.Filter.of(causal_design())
    each = min(seconds(lambda: f.push(chunk), 5000)[0] for _ in range(repeats))
    filters, hashes = scaling()
    print(f"\npush of 10 samples: {1e9 * each:.0f} ns in all")
    print(f"two filters on two threads: {filters:.2f}x (two hashes: {hashes:.2f}x, what the cores are free for)")


if __name__ == "__main__":
    main()
