"""Timing of calls side by side: every round runs all of them once, so that a slow moment of the machine hits all alike.

The figure to quote is the median of the rounds' ratios; the least and the CPU time tell how quiet the machine was.
"""

from __future__ import annotations

import statistics
import time
from collections.abc import Callable, Mapping
from dataclasses import dataclass


@dataclass(frozen=True)
class Timing:
    """What one call took, in seconds per call: median and least by the clock, median of CPU time, every round."""

    name: str
    median_s: float
    least_s: float
    cpu_s: float
    rounds: tuple[float, ...]


@dataclass(frozen=True)
class Timings:
    """The timings of calls that ran interleaved."""

    of: dict[str, Timing]

    def __getitem__(self, name: str) -> Timing:
        return self.of[name]

    def ratio(self, slower: str, faster: str) -> float:
        """Return the median over the rounds of ``slower`` / ``faster``."""
        pairs = zip(self.of[slower].rounds, self.of[faster].rounds, strict=True)
        return statistics.median(a / b for a, b in pairs)


def measure(
    calls: Mapping[str, Callable[[], object]],
    rounds: int = 15,
    least_round_s: float = 2e-3,
    warm_up: int = 1,
    before: Mapping[str, Callable[[], object]] | None = None,
) -> Timings:
    """Time named calls interleaved.

    Parameters
    ----------
    calls : mapping of str to callable
        Called without arguments; what they return is dropped.
    rounds : int
        How often each is timed; odd, so that a median is a measured value.
    least_round_s : float [s]
        A call that is shorter is repeated within a round until the round takes this long.
    warm_up : int
        Calls of each before the first round.
    before : mapping of str to callable, optional
        Makes anew what the call of the same name works on, outside its time: for what keeps results of an earlier
        call. Such a call is timed once in every round.
    """
    before = before or {}
    repeats = {}
    for name, call in calls.items():
        for _ in range(warm_up):
            if name in before:
                before[name]()
            call()
        repeats[name] = 1 if name in before else _repeats(call, least_round_s)
    wall: dict[str, list[float]] = {name: [] for name in calls}
    cpu: dict[str, list[float]] = {name: [] for name in calls}
    names = list(calls)
    for turn in range(rounds):
        # the order turns, so that no call always runs in the wake of the same other one
        for name in names[turn % len(names) :] + names[: turn % len(names)]:
            call, times = calls[name], range(repeats[name])
            if name in before:
                before[name]()
            cpu_started, started = time.process_time(), time.perf_counter()
            for _ in times:
                call()
            wall[name].append((time.perf_counter() - started) / len(times))
            cpu[name].append((time.process_time() - cpu_started) / len(times))
    return Timings(
        {
            name: Timing(
                name, statistics.median(wall[name]), min(wall[name]), statistics.median(cpu[name]), (*wall[name],)
            )
            for name in names
        }
    )


def _repeats(call: Callable[[], object], least_s: float) -> int:
    repeats = 1
    while True:
        started = time.perf_counter()
        for _ in range(repeats):
            call()
        taken = time.perf_counter() - started
        if taken >= least_s / 2:
            return max(1, round(repeats * least_s / taken))
        repeats *= 4
