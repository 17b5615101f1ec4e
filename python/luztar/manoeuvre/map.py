"""The paper's fig. 8: amplitude and frequency of the optimal signal over the corridor's length and the speed."""

from __future__ import annotations

import os
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np

from .._arrays import vector, whole_number
from .._printed import Printed
from ..errors import ParameterError
from .journal import Journal
from .optimise import LARGEST_SEED, broken, optimise
from .task import Manoeuvre, manoeuvre


@dataclass(frozen=True)
class SignalMap(Printed):
    """What :func:`map` returns; arrays over lengths (rows) and speeds (columns).

    Attributes
    ----------
    tasks : tuple of tuple of Manoeuvre
    lengths_m, speeds_m_s : ndarray
    values : ndarray, shape (lengths, speeds, parameters)
        Parameters of the optimal signals, NaN where none within the limits was found.
    criterion : ndarray, shape (lengths, speeds)
        J_w, infinite there.
    why : tuple of tuple of str
        What the least bad signal breaks; empty where one within the limits was found.
    seed : int
    effort : str
    """

    tasks: tuple[tuple[Manoeuvre, ...], ...]
    lengths_m: np.ndarray
    speeds_m_s: np.ndarray
    values: np.ndarray
    criterion: np.ndarray
    why: tuple[tuple[str, ...], ...]
    seed: int
    effort: str

    def of(self, name: str) -> np.ndarray:
        """Return one parameter of the signals by its name, shape (lengths, speeds)."""
        names = self.tasks[0][0].form.names
        if name not in names:
            raise ParameterError(f"the signal has no '{name}'", "name", f"Known are: {', '.join(names)}.")
        return self.values[:, :, names.index(name)]

    def to_dict(self) -> dict[str, Any]:
        """Return the result as plain JSON values; what is not finite is None."""

        def plain(table: np.ndarray) -> list[list[float | None]]:
            return [[float(v) if np.isfinite(v) else None for v in row] for row in table]

        return {
            "schema": 1,
            "study": "map",
            "task": self.tasks[0][0].to_dict(),
            "seed": self.seed,
            "effort": self.effort,
            "length_m": self.lengths_m.tolist(),
            "speed_m_s": self.speeds_m_s.tolist(),
            "parameters": {name: plain(self.of(name)) for name in self.tasks[0][0].form.names},
            "criterion": plain(self.criterion),
            "broken": [list(row) for row in self.why],
        }

    def figure(self) -> Any:
        """Return amplitude, frequency and J_w over length and speed."""
        from ..report.manoeuvre_figures import maps

        return maps(self)

    def report(self, path: str | os.PathLike[str]) -> None:
        """Write the result as one HTML file.

        Parameters
        ----------
        path : path
            An existing file is replaced.
        """
        from ..report.manoeuvre_page import write_map

        write_map(path, self)

    def _rows(self) -> list[tuple[str, str]]:
        task = self.tasks[0][0]
        rows = [("map", f"{task.track.name}, steered by {task.steer}; {task.car.title}")]
        for name in ("amplitude_1", "frequency_1_hz"):
            rows.append((name, "L [m] down, speed [m/s] across"))
            rows.append(("", " ".join(f"{v:>9}" for v in ["", *(f"{s:g}" for s in self.speeds_m_s)])))
            for length, line in zip(self.lengths_m, self.of(name), strict=True):
                cells = [f"{v:.4g}" if np.isfinite(v) else "-" for v in line]
                rows.append(("", " ".join(f"{c:>9}" for c in [f"{length:g}", *cells])))
        missing = int((~np.isfinite(self.criterion)).sum())
        rows.append(("not possible", f"{missing} of {self.criterion.size} cells"))
        return rows


def map(
    name: str,
    *,
    lengths_m: Any,
    speeds_m_s: Any,
    seed: int = 0,
    effort: str = "usual",
    journal: str | os.PathLike[str] | None = None,
    progress: Callable[[str, int, int], None] | None = None,
    **options: Any,
) -> SignalMap:
    """Optimise the signal of a manoeuvre over lengths of the corridor and speeds.

    Parameters
    ----------
    name : {"avoiding", "overtaking"}
    lengths_m, speeds_m_s : array_like, ascending
    seed, effort, journal, progress
        As :func:`robust`.
    **options
        As :func:`manoeuvre` takes them.

    Returns
    -------
    SignalMap

    Raises
    ------
    ParameterError
        A manoeuvre with a length of its own, values that do not ascend, a journal of another study.
    """
    axes = {}
    for key, given in (("lengths_m", lengths_m), ("speeds_m_s", speeds_m_s)):
        values = vector(key, np.asarray(given))
        if (np.diff(values) <= 0.0).any():
            raise ParameterError(f"{key} is {values.tolist()}", key, "Give ascending values.")
        axes[key] = np.array(values)
    lengths, speeds = axes.values()
    whole_number("seed", seed, 0, LARGEST_SEED)
    tasks = tuple(
        tuple(manoeuvre(name, length_m=float(length), speed_m_s=float(v), **options) for v in speeds)
        for length in lengths
    )
    names = tasks[0][0].form.names
    study = {"study": "map", "task": tasks[0][0].to_dict(), "seed": seed, "effort": effort}
    kept = Journal(journal, study)
    found = np.full((len(lengths), len(speeds), len(names)), np.nan)
    criterion = np.full((len(lengths), len(speeds)), np.inf)
    why = [[""] * len(speeds) for _ in lengths]
    cells = [(i, j) for i in range(len(lengths)) for j in range(len(speeds))]
    for number, (i, j) in enumerate(cells):
        task = tasks[i][j]
        if progress is not None:
            progress(f"optimising L = {lengths[i]:g} m at {speeds[j]:g} m/s", number, len(cells))
        cell = kept.cell(f"{float(lengths[i])!r}/{float(speeds[j])!r}", lambda task=task: _optimal(task, seed, effort))
        if cell["scores"]["criterion"] is not None:
            found[i, j], criterion[i, j] = cell["values"], cell["scores"]["criterion"]
        else:
            why[i][j] = "; ".join(broken(cell["scores"], task.limit_m_s2))
    if progress is not None:
        progress("done", len(cells), len(cells))
    return SignalMap(tasks, lengths, speeds, found, criterion, tuple(tuple(row) for row in why), seed, effort)


def _optimal(task: Manoeuvre, seed: int, effort: str) -> dict[str, Any]:
    best = optimise(task, seed=seed, effort=effort).best
    return {"values": best.values.tolist(), "scores": dict(best.scores)}
