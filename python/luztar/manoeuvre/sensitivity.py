"""Which parameter of the car decides whether a manoeuvre succeeds, and what it costs: global, all at once."""

from __future__ import annotations

import os
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from .._arrays import number, vector, whole_number
from .._printed import Printed
from ..errors import ParameterError
from .indices import Indices, by_bins, design, saltelli
from .journal import Journal
from .optimise import LARGEST_SEED, optimise
from .task import Manoeuvre

# The speed is no parameter of the car, but may vary like one.
SPEED = "speed_m_s"
# Rows of the design in a cell of the journal.
CELL_ROWS = 64
# Ranges where none are given: the paper's freeplay and friction; of the others a spread as cars in use have it.
RANGES = {"freeplay.gap_rad": (0.0, 0.2), "coulomb.level_nm": (0.0, 8.1)}
SHARES = {
    "body.mass_kg": 0.1,
    "body.yaw_inertia_kg_m2": 0.1,
    "front.cornering_n_per_rad": 0.1,
    "rear.cornering_n_per_rad": 0.1,
    "front.pneumatic_trail_m": 0.3,
    "steering.stiffness_nm_per_rad": 0.3,
    "viscous.coefficient_nm_s_per_rad": 0.3,
}


@dataclass(frozen=True)
class Sensitivity(Printed):
    """What :func:`sensitivity` returns.

    Attributes
    ----------
    task : Manoeuvre
    signal : ndarray
        The parameters of the signal that every car was given.
    ranges : mapping of str to (low, high)
        The parameters that varied, independent and uniform.
    samples : int
        Rows of A and of B in Saltelli's design; there are (parameters + 2) times as many drives.
    drives, feasible : int
        How many were simulated, and how many stayed within the limits. None was dropped.
    on_feasibility : Indices or None
        Of 0 (outside the limits) and 1 (within), by Saltelli's design over all drives. None where all are alike.
    on_criterion : Indices or None
        Of ln J_w given that it is finite: first order by bins, on the feasible rows of A and B. None with fewer than
        64. The parameters are then no longer quite independent: shares of the variance within the feasible set.
    on_rank : Indices or None
        Of the rank among all drives, by Saltelli's design: feasible ones by J_w, after them the others by how far they
        break the limits (the companion). Ranks exist where J_w is infinite.

    Notes
    -----
    J_w has no variance to share out, even where it is finite: towards the edge it grows as 1/c^2 while the clearance c
    has a density there, so that J_w > j with a probability like ``j**-0.5``. Its logarithm has all moments.
    """

    task: Manoeuvre
    signal: np.ndarray
    ranges: Mapping[str, tuple[float, float]]
    samples: int
    drives: int
    feasible: int
    on_feasibility: Indices | None
    on_criterion: Indices | None
    on_rank: Indices | None
    seed: int

    def to_dict(self) -> dict[str, Any]:
        """Return the result as plain JSON values."""
        parts = {"feasibility": self.on_feasibility, "criterion": self.on_criterion, "rank": self.on_rank}
        return {
            "schema": 1,
            "study": "sensitivity",
            "task": self.task.to_dict(),
            "signal": self.task.form.to_dict(self.signal),
            "ranges": {k: list(v) for k, v in self.ranges.items()},
            "samples": self.samples,
            "drives": self.drives,
            "feasible": self.feasible,
            "seed": self.seed,
            "indices": {k: None if v is None else v.to_dict() for k, v in parts.items()},
        }

    def figure(self) -> Any:
        """Return the indices with their intervals as a picture."""
        from ..report.manoeuvre_figures import indices

        return indices(self)

    def report(self, path: str | os.PathLike[str]) -> None:
        """Write the result as one HTML file.

        Parameters
        ----------
        path : path
            An existing file is replaced.
        """
        from ..report.manoeuvre_page import write_sensitivity

        write_sensitivity(path, self)

    def _rows(self) -> list[tuple[str, str]]:
        rows = [("manoeuvre" if not i else "", line) for i, line in enumerate(str(self.task).splitlines())]
        share = 100.0 * self.feasible / self.drives
        rows.append(
            ("drives", f"{self.drives}, of them {self.feasible} ({share:.1f} %) within the limits; none dropped")
        )
        outputs = (
            ("whether the limits hold", self.on_feasibility),
            ("ln J_w where it is finite", self.on_criterion),
            ("rank among all drives", self.on_rank),
        )
        for title, found in outputs:
            if found is None:
                rows.append(("indices of", f"{title}: none; all drives are alike, or too few are within the limits"))
                continue
            rows.append(("indices of", f"{title} (rows used: {found.rows}; 95 % intervals)"))
            order = sorted(found.first, key=lambda k: -(found.total or found.first)[k].value)
            for name in order:
                one = found.first[name]
                text = f"{name:<34} first {one.value:6.3f} ({one.low:6.3f} to {one.high:6.3f})"
                if found.total is not None:
                    all_ = found.total[name]
                    text += f"   total {all_.value:6.3f} ({all_.low:6.3f} to {all_.high:6.3f})"
                rows.append(("", text))
        return rows


def sensitivity(
    task: Manoeuvre,
    *,
    ranges: Mapping[str, tuple[float, float]] | None = None,
    signal: Any = None,
    samples: int = 1024,
    seed: int = 0,
    effort: str = "usual",
    journal: str | os.PathLike[str] | None = None,
    progress: Callable[[str, int, int], None] | None = None,
) -> Sensitivity:
    """Drive one signal with cars whose parameters all vary, and share out what follows among the parameters.

    Parameters
    ----------
    task : Manoeuvre
    ranges : mapping of str to (low, high), optional
        Parameters of the car by name, and ``speed_m_s``. Where not given: the paper's freeplay and friction, masses and
        tyres within 10 %, trail, column stiffness and damping within 30 %.
    signal : array_like, shape (parameters,), optional
        In the order of ``task.form.names``; the optimum for the task's own car where not given.
    samples : int, >= 64, a power of two
        Rows of A and of B.
    seed, effort, journal, progress
        As :func:`robust`.

    Returns
    -------
    Sensitivity

    Raises
    ------
    ParameterError
        Unknown parameters, empty ranges, too few samples or no power of two, a journal of another study.
    """
    seed = whole_number("seed", seed, 0, LARGEST_SEED)
    samples = whole_number("samples", samples, 64, 2**20)
    if samples & (samples - 1):
        below = 1 << (samples.bit_length() - 1)
        raise ParameterError(
            f"samples is {samples}, which is no power of two: Sobol's sequence would lose its balance",
            "samples",
            f"Give {below} or {2 * below}.",
        )
    chosen = usual_ranges(task) if ranges is None else _checked(task, ranges)
    names = list(chosen)
    given = None if signal is None else vector("signal", np.asarray(signal))
    study = {
        "study": "sensitivity",
        "task": task.to_dict(),
        "ranges": {k: list(v) for k, v in chosen.items()},
        "signal": None if given is None else given.tolist(),
        "samples": samples,
        "seed": seed,
        "effort": effort,
    }
    kept = Journal(journal, study)
    if given is None:
        if progress is not None:
            progress("optimising the signal", 0, samples)
        cell = kept.cell("signal", lambda: optimise(task, seed=seed, effort=effort).best.values.tolist())
        given = np.array(cell)
    # Refuses a wrong number of parameters before anything is driven.
    task.form.pieces(given)
    points = design(len(names), samples, seed)
    low, high = np.array(list(chosen.values())).T
    cars = low + (high - low) * points
    made = []
    for first in range(0, samples, CELL_ROWS):
        if progress is not None:
            progress("driving", first, samples)
        rows = cars[first : first + CELL_ROWS].reshape(-1, len(names))
        made.append(kept.cell(f"rows {first}", lambda rows=rows: _driven(task, given, names, rows)))
    shape = (samples, len(names) + 2)
    criterion = np.array([v for cell in made for v in cell["criterion"]], dtype=np.float64).reshape(shape)
    companion = np.array([v for cell in made for v in cell["companion"]]).reshape(shape)
    feasible = np.isfinite(criterion)
    if progress is not None:
        progress("done", samples, samples)
    plain = feasible[:, :2]
    return Sensitivity(
        task=task,
        signal=given,
        ranges=chosen,
        samples=samples,
        drives=criterion.size,
        feasible=int(feasible.sum()),
        on_feasibility=saltelli(names, feasible.astype(np.float64), seed),
        on_criterion=by_bins(names, points[:, :2][plain], np.log(criterion[:, :2][plain]), seed),
        on_rank=saltelli(names, _ranks(feasible, criterion, companion), seed),
        seed=seed,
    )


def usual_ranges(task: Manoeuvre) -> dict[str, tuple[float, float]]:
    """Return the ranges that :func:`sensitivity` takes where none are given."""
    around = {k: (task.car[k] * (1.0 - s), task.car[k] * (1.0 + s)) for k, s in SHARES.items() if task.car[k] > 0.0}
    return {**RANGES, **around}


def _checked(task: Manoeuvre, ranges: Mapping[str, tuple[float, float]]) -> dict[str, tuple[float, float]]:
    made = {}
    for key, pair in ranges.items():
        if key != SPEED:
            task.car[key]
        limits = tuple(number(key, v) for v in pair) if np.ndim(pair) == 1 else ()
        if len(limits) != 2 or not np.isfinite(limits).all() or not limits[0] < limits[1]:
            raise ParameterError(f"the range of {key} is {pair!r}", key, "Give two numbers, the smaller one first.")
        made[key] = (limits[0], limits[1])
    if not made:
        raise ParameterError("no parameter varies", "ranges", "Give at least one range.")
    return made


def _driven(task: Manoeuvre, signal: np.ndarray, names: list[str], cars: np.ndarray) -> dict[str, Any]:
    vary = dict(zip(names, cars.T, strict=True))
    speed = vary.pop(SPEED, None)
    scores = task.scores(np.repeat(signal[np.newaxis], len(cars), axis=0), vary, speed_m_s=speed)
    return {
        "criterion": [float(v) if np.isfinite(v) else None for v in scores.criterion],
        "companion": scores.companion.tolist(),
    }


def _ranks(feasible: np.ndarray, criterion: np.ndarray, companion: np.ndarray) -> np.ndarray:
    """Ranks from 0 to 1: feasible drives by J_w, after them the others by their companion; ties share the mean."""
    from scipy.stats import rankdata

    ranks = np.empty(criterion.shape)
    inside = int(feasible.sum())
    ranks[feasible] = rankdata(criterion[feasible])
    ranks[~feasible] = inside + rankdata(companion[~feasible])
    return ranks / criterion.size
