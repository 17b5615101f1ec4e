"""The derivative of a fitted model by everything that was fitted, inner parameters included."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ..model import card
from .equations import Columns
from .grids import is_continuous, is_geometric, is_sharpness, points
from .profile import Problem, State, state


@dataclass(frozen=True)
class Inner:
    """An inner parameter that varies continuously, with the step of its numerical derivative."""

    effect: str
    index: int
    key: str
    step: float


def continuous(problem: Problem, fitted: State, sharpness: bool = False) -> list[Inner]:
    """Return the inner parameters that were fitted and vary continuously.

    With ``sharpness`` also a break-away sharper than the sensor shows, which no interval is given for.
    """
    found = []
    for name in fitted.terms.effects:
        for i, p in enumerate(card(name, problem.model.structure_name).inner):
            if f"{name}.{p.key}" in problem.model.known or not is_continuous(p) or (is_sharpness(p) and not sharpness):
                continue
            # Presliding replaces the break-away of Coulomb friction, which then does nothing.
            if is_sharpness(p) and "presliding" in fitted.terms.effects:
                continue
            value = fitted.terms.inner[name][i]
            grid = points(p, problem.runs)
            step = 0.05 * value if is_geometric(p) else 0.2 * float(grid[1] - grid[0])
            found.append(Inner(name, i, p.key, max(step, np.finfo(float).tiny)))
    return found


def jacobian(problem: Problem, fitted: State, varied: Sequence[Inner]) -> Columns:
    """Put the derivative of the model by each inner parameter beside the columns (central differences)."""
    derivative: list[list[np.ndarray]] = [[] for _ in problem.runs]
    for v in varied:
        sides = []
        for sign in (1.0, -1.0):
            inner = list(fitted.terms.inner[v.effect])
            inner[v.index] += sign * v.step
            moved = state(problem, fitted.terms.having(v.effect, tuple(inner)))
            sides.append([_model(m, fitted.coefficients) for m in moved.made.matrix])
        for k, (up, down) in enumerate(zip(*sides, strict=True)):
            derivative[k].append((up - down) / (2.0 * v.step))
    more = [np.array(d).T.reshape(m.shape[0], -1) for d, m in zip(derivative, fitted.made.matrix, strict=True)]
    return fitted.made.having(more)


def _model(matrix: np.ndarray, coefficients: np.ndarray) -> np.ndarray:
    # What is known beforehand is subtracted from the measurement and may depend on the parameter as well.
    return matrix[:, :-1] @ coefficients - matrix[:, -1]
