"""Run cases in processes; every finished one is a line in a file, so that a calibration can be stopped and go on."""

from __future__ import annotations

import json
import multiprocessing
import sys
import time
from collections.abc import Callable, Sequence
from concurrent.futures import FIRST_COMPLETED, Future, ProcessPoolExecutor, wait
from pathlib import Path
from typing import Any

from . import jobs
from .cases import Case


def finished(path: Path) -> dict[str, dict[str, Any]]:
    """Return the records of a file by key; the last of equal keys counts, half a line at the end does not."""
    records: dict[str, dict[str, Any]] = {}
    if path.exists():
        for line in path.read_text(encoding="utf-8").splitlines():
            try:
                record = json.loads(line)
            except json.JSONDecodeError:
                continue
            records[record["key"]] = record
    return records


def run_all(cases: Sequence[Case], path: Path, *, workers: int, minutes: float | None = None) -> None:
    """Run what is not finished yet. Failed cases are tried again.

    Parameters
    ----------
    cases : sequence of Case
    path : Path
        The file of results.
    workers : int
        Processes.
    minutes : float, optional
        Start no case after this time.
    """
    have = finished(path)
    left = [c for c in cases if "failed" in have.get(c.key, {"failed": ""})]
    done_before = len(cases) - len(left)
    show = _Progress(len(left), done_before)
    if not left:
        return
    until = float("inf") if minutes is None else time.monotonic() + 60.0 * minutes
    path.parent.mkdir(parents=True, exist_ok=True)
    # Spawned, not forked: the core and the linear algebra have threads of their own.
    context = multiprocessing.get_context("spawn")
    queue = iter(left)
    with path.open("a", encoding="utf-8") as file, ProcessPoolExecutor(workers, mp_context=context) as pool:
        running: set[Future[dict[str, Any]]] = set()
        while True:
            while len(running) < 2 * workers and time.monotonic() < until and (case := next(queue, None)):
                running.add(pool.submit(jobs.run, case))
            if not running:
                break
            ready, running = wait(running, return_when=FIRST_COMPLETED)
            for future in ready:
                record = future.result()
                file.write(json.dumps(record) + "\n")
                file.flush()
                show(record)
    show.end()


class _Progress:
    """One line on standard error: how many are done, how many failed, how long the rest takes."""

    def __init__(self, total: int, before: int, write: Callable[[str], object] = sys.stderr.write) -> None:
        self._total, self._before, self._write = total, before, write
        self._done = self._failed = 0
        self._started = time.monotonic()
        if before:
            write(f"{before} cases were finished before\n")

    def __call__(self, record: dict[str, Any]) -> None:
        self._done += 1
        self._failed += "failed" in record
        left_s = (time.monotonic() - self._started) / self._done * (self._total - self._done)
        failed = f", {self._failed} failed" if self._failed else ""
        line = f"{self._done} of {self._total} cases{failed}, about {left_s / 60.0:.1f} min left"
        # Where nobody watches, a line now and then is enough.
        if sys.stderr.isatty():
            self._write(f"\r{line:<70}")
        elif self._done % 25 == 0 or self._done == self._total:
            self._write(line + "\n")

    def end(self) -> None:
        if sys.stderr.isatty():
            self._write("\n")
