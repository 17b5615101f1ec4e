"""Runs luztar as a user does, in a process of its own, and writes the small run files that the commands get."""

from __future__ import annotations

import gzip
import json
import subprocess
import sys
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from generators.rig import simulate_rig_set
from generators.write import run_text

# Small but whole: eight strokes at 100 Hz are 20 to 40 s.
MOTION = {"amplitude_deg": 45.0, "speeds_deg_s": (8.0, 38.0)}


@dataclass(frozen=True)
class Ended:
    """How a process ended."""

    code: int
    out: str
    err: str

    @property
    def json(self) -> dict[str, Any]:
        """Standard output as one JSON object and nothing else."""

        def refuse(word: str) -> None:
            raise AssertionError(f"{word} is not JSON")

        found = json.loads(self.out, parse_constant=refuse)
        assert isinstance(found, dict)
        return found


def luztar(*words: object, folder: Path | None = None) -> Ended:
    """Run one command in its own process."""
    command = [sys.executable, "-m", "luztar", *map(str, words)]
    done = subprocess.run(command, capture_output=True, text=True, cwd=folder, timeout=120)
    return Ended(done.returncode, done.stdout, done.stderr)


def rig_texts(
    hidden: Mapping[str, Any] | None = None, *, runs: int = 1, strokes: int = 8, seed: int = 7, **options: Any
) -> list[str]:
    """Return simulated rig runs as CSV texts."""
    motion = {**MOTION, "strokes": strokes}
    made = simulate_rig_set(hidden or {}, runs=runs, seed=seed, motion=motion, sample_rate_hz=100.0, **options)
    return [run_text(run) for run in made]


def write_gz(path: Path, text: str) -> Path:
    path.write_bytes(gzip.compress(text.encode(), mtime=0))
    return path


def columns(text: str) -> np.ndarray:
    """Return time [s], angle [deg] and torque [Nm] of a run's text."""
    return np.loadtxt(text.splitlines()[1:], delimiter=",")


def with_header(header: str, table: np.ndarray) -> str:
    """Return a CSV text with another header."""
    return "\n".join([header, *(",".join(f"{v:.4f}" for v in row) for row in table)]) + "\n"
