"""Stage 2 of the paper: the signal with the least criterion, the next best, and how flat the optimum is."""

from __future__ import annotations

import os
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from .._arrays import whole_number
from .._printed import Printed
from ..errors import ParameterError
from .search import FLAT_ROUNDS, Effort, Step, search
from .task import Manoeuvre

EFFORTS = {
    "quick": Effort(first=1024, population=64, generations=35, refinement=16, refinements=60, flat=128),
    "usual": Effort(),
    "hard": Effort(first=8192, population=192, generations=150, refinement=64, refinements=150, flat=512),
}
# Seeds are counted by 32 bits in the journal.
LARGEST_SEED = 2**32 - 1


@dataclass(frozen=True)
class Signal:
    """A signal by its parameters, and what it costs.

    Attributes
    ----------
    values : ndarray
        In the order of the form's names.
    parameters : mapping of str to float
    scores : mapping of str to float or None
        The criterion, its companion and terms; None where not finite.
    """

    values: np.ndarray
    parameters: Mapping[str, float]
    scores: Mapping[str, Any]

    @property
    def feasible(self) -> bool:
        """Whether the car stays in the corridor below the limit of the lateral acceleration."""
        return bool(self.scores["feasible"])

    def to_dict(self) -> dict[str, Any]:
        """Return the signal as plain JSON values."""
        return {"parameters": dict(self.parameters), **self.scores}


@dataclass(frozen=True)
class Optimum(Printed):
    """What :func:`optimise` returns.

    Attributes
    ----------
    task : Manoeuvre
    best : Signal
    other : Signal or None
        The best that differs by at least 0.15 of the searched range in some parameter.
    flat : mapping of str to (low, high), or None
        Values of each parameter among the signals evaluated that cost at most 1 % more: an inner bound of that set.
    history : tuple of Step
        The least companion after every generation.
    seed : int
    effort : str
    """

    task: Manoeuvre
    best: Signal
    other: Signal | None
    flat: Mapping[str, tuple[float, float]] | None
    history: tuple[Step, ...]
    seed: int
    effort: str

    @property
    def feasible(self) -> bool:
        """Whether a signal within the limits was found."""
        return self.best.feasible

    @property
    def evaluations(self) -> int:
        """How many drives were simulated."""
        return self.history[-1].evaluations

    def to_dict(self) -> dict[str, Any]:
        """Return the result as plain JSON values."""
        return {
            "schema": 1,
            "study": "optimise",
            "task": self.task.to_dict(),
            "unit": self.task.unit,
            "seed": self.seed,
            "effort": self.effort,
            "feasible": self.feasible,
            "broken": self.broken(),
            "best": self.best.to_dict(),
            "other": None if self.other is None else self.other.to_dict(),
            "flat": None if self.flat is None else {k: list(v) for k, v in self.flat.items()},
            "evaluations": self.evaluations,
            "history": [s.to_dict() for s in self.history],
        }

    def broken(self) -> list[str]:
        """Return the limits that the best signal breaks; empty where it is within all."""
        return broken(self.best.scores, self.task.limit_m_s2)

    def figure(self) -> Any:
        """Return the drive as a picture: path in the corridor, handwheel, lateral acceleration, kappa."""
        from ..report.manoeuvre_figures import drives

        return drives(self)

    def report(self, path: str | os.PathLike[str]) -> None:
        """Write the result as one HTML file.

        Parameters
        ----------
        path : path
            An existing file is replaced.
        """
        from ..report.manoeuvre_page import write_optimum

        write_optimum(path, self)

    def _rows(self) -> list[tuple[str, str]]:
        s = self.best.scores
        value = "infinite: " + "; ".join(self.broken()) if not self.feasible else f"{s['criterion']:.6g}"
        rows = [("manoeuvre", line) if not i else ("", line) for i, line in enumerate(str(self.task).splitlines())]
        rows += [
            ("J_w", value),
            ("companion", f"{s['companion']:.6g}"),
            ("terms", _terms(s)),
        ]
        for name, amount in self.best.parameters.items():
            text = f"{amount:.5g}" + (f" {self.task.unit}" if name.startswith("amplitude") else "")
            if self.flat is not None:
                low, high = self.flat[name]
                text += f"   (within 1 %: {low:.4g} to {high:.4g})"
            rows.append((name, text))
        if self.other is not None:
            cost = self.other.scores["criterion"]
            rows.append(("runner-up", "infinite" if cost is None else f"J_w {cost:.6g}"))
        rows.append(("search", f"{self.evaluations} drives, seed {self.seed}, effort {self.effort}"))
        return rows


def _terms(s: Mapping[str, Any]) -> str:
    kappa = s["kappa_max_per_m"]
    return (
        f"mean square of the handwheel's speed {s['handwheel_rate_mean_square_rad2_s2']:.4g} rad2/s2, "
        f"kappa {'infinite' if kappa is None else f'{kappa:.4g} 1/m'} (clearance {s['clearance_min_m']:.3f} m), "
        f"a_y {s['lateral_acceleration_max_m_s2']:.3f} m/s2"
    )


def broken(scores: Mapping[str, Any], limit_m_s2: float) -> list[str]:
    """Return in words which limits a drive breaks."""
    made = []
    clearance = scores["clearance_min_m"]
    if clearance is not None and clearance <= 0.0:
        made.append(f"the body leaves the corridor by {-clearance:.3f} m")
    side = scores["lateral_acceleration_max_m_s2"]
    if side > limit_m_s2:
        made.append(f"the lateral acceleration is {side:.3f} m/s2, above {limit_m_s2:g}")
    if not made and not scores["feasible"]:
        made.append("the car is lost: it spins, or does not come to the exit lane")
    return made


def optimise(
    task: Manoeuvre,
    *,
    seed: int = 0,
    effort: str = "usual",
    progress: Callable[[str, int, int], None] | None = None,
) -> Optimum:
    """Find the signal with the least criterion J_w.

    A first sample of the whole box, adaptive differential evolution, then CMA-ES from the best and from the best
    elsewhere; every generation is one batch of cars. The smooth companion leads, J_w is what is reported.

    Parameters
    ----------
    task : Manoeuvre
    seed : int, >= 0
        The same seed gives the same bits, whatever the number of threads.
    effort : {"quick", "usual", "hard"}
        About 7 000, 18 000 and 80 000 drives.
    progress : callable, optional
        Called with (stage, drives so far, drives at most).

    Returns
    -------
    Optimum
        Where no signal within the limits was found, ``feasible`` is False; ``broken()`` says what the least bad breaks.

    Raises
    ------
    ParameterError
        An unknown effort or a seed that is no whole number.

    Examples
    --------
    >>> import luztar
    >>> task = luztar.manoeuvre.manoeuvre("avoiding", length_m=60.0, speed_m_s=15.0)
    >>> found = luztar.manoeuvre.optimise(task, effort="quick")
    >>> found.feasible
    True
    """
    seed = whole_number("seed", seed, 0, LARGEST_SEED)
    if effort not in EFFORTS:
        raise ParameterError(f"there is no effort {effort!r}", "effort", f"Known are: {', '.join(EFFORTS)}.")
    hard = EFFORTS[effort]
    box = task.box
    most = at_most(hard)

    def told(step: Step) -> None:
        if progress is not None:
            progress(step.stage, step.evaluations, most)

    least = _Least()

    def evaluate(points: np.ndarray) -> np.ndarray:
        values = box.values(points)
        scores = task.scores(values)
        least.look(values, scores.criterion)
        return scores.companion

    found = search(
        evaluate,
        len(task.form.names),
        seed=seed,
        effort=hard,
        told=told,
    )
    best = signal(task, box.values(found.point[np.newaxis])[0])
    if least.values is not None and least.criterion < _criterion_of(best):
        best = signal(task, least.values)
    return Optimum(
        task=task,
        best=best,
        other=None if found.other is None else signal(task, box.values(found.other[np.newaxis])[0]),
        flat=None if found.flat is None else _ranges(task, found.flat),
        history=found.history,
        seed=seed,
        effort=effort,
    )


class _Least:
    """The drive within the limits that costs least, of all that a search has tried.

    The companion leads, and where it charges for the last decimetre of clearance or lets a limit be passed by a little,
    its least is not the criterion's.
    """

    def __init__(self) -> None:
        self.values: np.ndarray | None = None
        self.criterion = np.inf

    def look(self, values: np.ndarray, criterion: np.ndarray) -> None:
        at = int(np.argmin(criterion))
        if criterion[at] < self.criterion:
            self.criterion = float(criterion[at])
            self.values = values[at].copy()


def _criterion_of(found: Signal) -> float:
    """Return J_w of a signal, infinite where a limit is broken."""
    value = found.scores["criterion"]
    return np.inf if value is None else float(value)


def at_most(effort: Effort) -> int:
    """Return how many drives a search takes at most."""
    refined = 3 * effort.refinement * effort.refinements
    return effort.first + effort.population * effort.generations + refined + FLAT_ROUNDS * effort.flat


def signal(task: Manoeuvre, values: np.ndarray) -> Signal:
    """Return a signal with what it costs."""
    return Signal(values, task.form.to_dict(values), task.scores(values[np.newaxis]).row(0))


def _ranges(task: Manoeuvre, points: np.ndarray) -> dict[str, tuple[float, float]]:
    # Amplitudes are no axis of the box: the ranges are those of the points, not of the corners around them.
    values = task.box.values(points)
    return {n: (float(values[:, i].min()), float(values[:, i].max())) for i, n in enumerate(task.form.names)}
