"""The paper's fig. 9 and 10: signals optimised for cars with some freeplay and friction, tried on all the others."""

from __future__ import annotations

import os
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from .._arrays import vector, whole_number
from .._printed import Printed
from ..errors import ParameterError
from .journal import Journal
from .optimise import LARGEST_SEED, optimise
from .task import Manoeuvre

# The sets of the paper: half widths of the freeplay at the handwheel, dry friction at the king-pins.
FREEPLAY_RAD = (0.0, 0.05, 0.10)
FRICTION_NM = (0.0, 4.05, 8.10)
# Cars between the paper's: every 0.005 rad and every half newton metre.
FINE = (21, 17)


@dataclass(frozen=True)
class Robustness(Printed):
    """What :func:`robust` returns. A pair is (half freeplay z0, friction); pairs go row by row through the two sets.

    Attributes
    ----------
    task : Manoeuvre
    freeplay_rad, friction_nm : ndarray
        The two sets.
    signals : ndarray, shape (pairs, parameters)
        The optimal signal of each pair's car.
    criterion : ndarray, shape (pairs, pairs)
        J_w of the signal optimised for one pair (row) on the car of another (column); infinite outside the limits.
    companion : ndarray
        The same for the smooth companion, finite everywhere.
    fine_freeplay_rad, fine_friction_nm : ndarray
    fine_criterion : ndarray, shape (pairs, freeplays, frictions)
        J_w of each signal on a finer grid of cars.
    seed : int
    effort : str
    """

    task: Manoeuvre
    freeplay_rad: np.ndarray
    friction_nm: np.ndarray
    signals: np.ndarray
    criterion: np.ndarray
    companion: np.ndarray
    fine_freeplay_rad: np.ndarray
    fine_friction_nm: np.ndarray
    fine_criterion: np.ndarray
    fine_companion: np.ndarray
    seed: int
    effort: str

    @property
    def pairs(self) -> list[tuple[float, float]]:
        """Half freeplay (rad) and friction (Nm) of every pair."""
        return [(float(z), float(f)) for z in self.freeplay_rad for f in self.friction_nm]

    @property
    def infeasible_share(self) -> np.ndarray:
        """Share of the cars of the finer grid that leave the limits under each signal."""
        return np.mean(~np.isfinite(self.fine_criterion), axis=(1, 2))

    @property
    def most_robust(self) -> int:
        """The pair whose signal fails on the smallest share of the finer grid; where several do, the cheapest.

        Cheapest by the mean companion over the grid, which counts by how much a limit is broken.
        """
        share = self.infeasible_share
        cost = self.fine_companion.mean(axis=(1, 2))
        return int(min(range(len(share)), key=lambda i: (share[i], cost[i])))

    def spread(self) -> dict[str, float | None]:
        """Return by how much J_w of the optima grows over freeplay and over friction, largest over smallest minus 1.

        ``freeplay``: along the freeplay at the least friction; ``friction``: along the friction at the least freeplay.
        None where an optimum is infinite.
        """
        own = np.diag(self.criterion).reshape(len(self.freeplay_rad), len(self.friction_nm))
        made = {}
        for name, line in (("freeplay", own[:, 0]), ("friction", own[0])):
            made[name] = float(line.max() / line.min() - 1.0) if np.isfinite(line).all() else None
        return made

    def differences(self, signal: int = 0) -> dict[str, np.ndarray]:
        """Return difference signals: what every car does beyond the one that the signal was optimised for.

        Parameters
        ----------
        signal : int
            Number of the pair.

        Returns
        -------
        dict of str to ndarray
            ``time_s``, shape (n,), and ``y_m``, ``lateral_acceleration_m_s2``, ``yaw_rate_rad_s``, ``roadwheel_rad``,
            shape (pairs, n).
        """
        signal = whole_number("signal", signal, 0, len(self.signals) - 1)
        values = np.repeat(self.signals[signal][np.newaxis], len(self.signals), axis=0)
        drive = self.task.drive(values, _cars(self.pairs))
        names = ("y_m", "lateral_acceleration_m_s2", "yaw_rate_rad_s", "roadwheel_rad")
        made = {name: getattr(drive, name) - getattr(drive, name)[signal] for name in names}
        return {"time_s": drive.time_s, **made}

    def to_dict(self) -> dict[str, Any]:
        """Return the result as plain JSON values; infinite criteria are None."""
        return {
            "schema": 1,
            "study": "robust",
            "task": self.task.to_dict(),
            "seed": self.seed,
            "effort": self.effort,
            "freeplay_half_width_rad": self.freeplay_rad.tolist(),
            "friction_nm": self.friction_nm.tolist(),
            "pairs": [
                {
                    "freeplay_half_width_rad": z,
                    "friction_nm": f,
                    "signal": self.task.form.to_dict(self.signals[i]),
                    "criterion": _finite(self.criterion[i, i]),
                    "on_all_cars": [_finite(v) for v in self.criterion[i]],
                    "infeasible_share": float(self.infeasible_share[i]),
                }
                for i, (z, f) in enumerate(self.pairs)
            ],
            "most_robust": self.most_robust,
            "spread": self.spread(),
            "fine": {
                "freeplay_half_width_rad": self.fine_freeplay_rad.tolist(),
                "friction_nm": self.fine_friction_nm.tolist(),
                "criterion": [[[_finite(v) for v in row] for row in each] for each in self.fine_criterion],
                "infeasible_share_of_all": float(self.infeasible_share.mean()),
            },
        }

    def figure(self) -> Any:
        """Return the table of J_w as a picture, infeasible cells marked."""
        from ..report.manoeuvre_figures import table

        return table(self)

    def report(self, path: str | os.PathLike[str]) -> None:
        """Write the result as one HTML file.

        Parameters
        ----------
        path : path
            An existing file is replaced.
        """
        from ..report.manoeuvre_page import write_robustness

        write_robustness(path, self)

    def _rows(self) -> list[tuple[str, str]]:
        rows = [("manoeuvre" if not i else "", line) for i, line in enumerate(str(self.task).splitlines())]
        names = [f"{z:g}/{f:g}" for z, f in self.pairs]
        rows.append(("J_w", "signal of z0 [rad]/friction [Nm] (rows) on the car of (columns)"))
        rows.append(("", " ".join(f"{n:>10}" for n in ["", *names, "fails on"])))
        for name, line, share in zip(names, self.criterion, self.infeasible_share, strict=True):
            cells = [f"{v:.4g}" if np.isfinite(v) else "inf" for v in line]
            rows.append(("", " ".join(f"{c:>10}" for c in [name, *cells, f"{100 * share:.0f} %"])))
        rows.append(("most robust", self.verdict()))
        for name, value in self.spread().items():
            text = "cannot be told: an optimum is infinite" if value is None else f"grows by {100 * value:.2f} %"
            rows.append((f"over {name}", f"J_w of the optima {text}"))
        return rows

    def verdict(self) -> str:
        """Return in words which signal is the most robust."""
        cars = self.fine_criterion[0].size
        share = float(self.infeasible_share[self.most_robust])
        if share == 1.0:
            return f"none: every signal breaks the limits on all {cars} cars of the finer grid"
        z, f = self.pairs[self.most_robust]
        return (
            f"the signal optimised for z0 = {z:g} rad and {f:g} Nm; it fails on {100 * share:.1f} % of the {cars} cars "
            "of the finer grid"
        )


def _finite(value: float) -> float | None:
    return float(value) if np.isfinite(value) else None


def _cars(pairs: Sequence[tuple[float, float]]) -> dict[str, np.ndarray]:
    half, friction = np.array(pairs).T
    return {"freeplay.gap_rad": 2.0 * half, "coulomb.level_nm": friction, "stiction.extra_nm": np.zeros_like(half)}


def robust(
    task: Manoeuvre,
    *,
    freeplay_half_width_rad: Any = FREEPLAY_RAD,
    friction_nm: Any = FRICTION_NM,
    fine: tuple[int, int] = FINE,
    seed: int = 0,
    effort: str = "usual",
    journal: str | os.PathLike[str] | None = None,
    progress: Callable[[str, int, int], None] | None = None,
) -> Robustness:
    """Optimise a signal for every pair of freeplay and friction, and try each on the cars of all pairs.

    Parameters
    ----------
    task : Manoeuvre
        Its car's own freeplay and friction are replaced.
    freeplay_half_width_rad : array_like, >= 0, ascending
        z0 at the handwheel; ``freeplay.gap_rad`` is twice this.
    friction_nm : array_like, >= 0, ascending
        Dry friction at the king-pins, static and kinetic alike.
    fine : (int, int)
        How many freeplays and frictions the finer grid of cars has, between the least and the largest of the sets.
    seed, effort
        As :func:`optimise`.
    journal : path, optional
        A file that keeps finished optimisations; an interrupted study goes on from there and gives the same bits.
    progress : callable, optional
        Called with (what, pairs done, pairs).

    Returns
    -------
    Robustness

    Raises
    ------
    ParameterError
        Sets that do not ascend or go below 0; a journal of another study.
    """
    sets = {"freeplay_half_width_rad": freeplay_half_width_rad, "friction_nm": friction_nm}
    for name, given in sets.items():
        values = vector(name, np.asarray(given))
        if (values < 0.0).any() or (np.diff(values) <= 0.0).any():
            raise ParameterError(f"{name} is {values.tolist()}", name, "Give ascending values, 0 or above.")
        sets[name] = np.array(values)
    if not isinstance(fine, (tuple, list)) or len(fine) != 2:
        raise ParameterError(f"fine is {fine!r}", "fine", "Give two whole numbers: freeplays and frictions.")
    counts = [whole_number("fine", n, 1, 1000) for n in fine]
    whole_number("seed", seed, 0, LARGEST_SEED)
    half, friction = sets.values()
    pairs = [(float(z), float(f)) for z in half for f in friction]
    study = {"study": "robust", "task": task.to_dict(), "seed": seed, "effort": effort}
    kept = Journal(journal, study)
    signals = []
    for number, (z, f) in enumerate(pairs):
        if progress is not None:
            progress(f"optimising z0 = {z:g} rad, {f:g} Nm", number, len(pairs))
        car = {k: float(v[0]) for k, v in _cars([(z, f)]).items()}
        own = kept.cell(f"{z!r}/{f!r}", lambda car=car: _optimal(task, car, seed, effort))
        signals.append(own["values"])
    made = np.array(signals)
    every = _on(task, made, pairs)
    grid_z = np.linspace(half[0], half[-1], counts[0]) if half.size > 1 else half
    grid_f = np.linspace(friction[0], friction[-1], counts[1]) if friction.size > 1 else friction
    fine_pairs = [(float(z), float(f)) for z in grid_z for f in grid_f]
    finer = _on(task, made, fine_pairs)
    shape = (len(pairs), len(grid_z), len(grid_f))
    if progress is not None:
        progress("done", len(pairs), len(pairs))
    return Robustness(
        task=task,
        freeplay_rad=half,
        friction_nm=friction,
        signals=made,
        criterion=every[0],
        companion=every[1],
        fine_freeplay_rad=grid_z,
        fine_friction_nm=grid_f,
        fine_criterion=finer[0].reshape(shape),
        fine_companion=finer[1].reshape(shape),
        seed=seed,
        effort=effort,
    )


def _optimal(task: Manoeuvre, car: Mapping[str, float], seed: int, effort: str) -> dict[str, Any]:
    found = optimise(task.with_car(car), seed=seed, effort=effort)
    return {"values": found.best.values.tolist(), "evaluations": found.evaluations, "scores": dict(found.best.scores)}


def _on(task: Manoeuvre, signals: np.ndarray, pairs: Sequence[tuple[float, float]]) -> tuple[np.ndarray, np.ndarray]:
    """J_w and companion of every signal on every car, shape (signals, cars)."""
    cars = {key: np.tile(values, len(signals)) for key, values in _cars(pairs).items()}
    scores = task.scores(np.repeat(signals, len(pairs), axis=0), cars)
    shape = (len(signals), len(pairs))
    return scores.criterion.reshape(shape), scores.companion.reshape(shape)
