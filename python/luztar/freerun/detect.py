"""Is anything missing from a free-run model: tests by random signs of whole strokes."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from ..diagnosis.chance import one_sided, p_values, signs, studentised
from ..diagnosis.floor import hats
from ..diagnosis.prepare import Prepared
from ..diagnosis.score import Detection
from .fit import FreeFit
from .least_squares import jacobian

# Cells of the handwheel's angle, in each direction, and of its speed.
ANGLES, SPEEDS = 9, 6
# Times since the reversal, s: a gap or a break-away shows there.
SINCE = (0.0, 0.05, 0.1, 0.2, 0.4, 0.8)


def _features(fitted: FreeFit) -> dict[str, np.ndarray]:
    """Return directions to look along, each of shape (samples, count)."""
    runs = [r.outputs[0] for r in fitted.free_problem.data.records]
    usable = [r.usable for r in runs]

    def stack(values: list[np.ndarray]) -> np.ndarray:
        return np.concatenate([v[u] for v, u in zip(values, usable, strict=True)])

    psi = stack([r.motion for r in runs])
    speed = stack([r.speed for r in runs])
    since, direction, clock = (stack(v) for v in _clocks(runs))
    angles = hats(psi, np.linspace(psi.min(), psi.max(), ANGLES))
    top = float(np.abs(speed).max())
    speeds = hats(np.abs(speed), top * np.linspace(0.0, 1.0, SPEEDS) ** 1.5)
    after = hats(since, np.array(SINCE))[:, :-1]
    side = direction[:, None]
    each = {
        "state": np.hstack([angles, side * angles, speeds, side * speeds]),
        "reversal": np.hstack([after, side * after]),
        "time": np.column_stack([clock, side[:, 0] * clock]),
    }
    # Along every channel out by itself: a sample's channels stand side by side.
    channels = np.eye(len(fitted.free_problem.data.records[0].channels))
    return {name: np.kron(columns, channels) for name, columns in each.items()}


def _clocks(runs: Sequence[Prepared]) -> tuple[list[np.ndarray], list[np.ndarray], list[np.ndarray]]:
    since, direction, clock = [], [], []
    for r in runs:
        elapsed, way = np.full(r.motion.size, np.inf), np.zeros(r.motion.size)
        for s in r.strokes:
            elapsed[s.onset : s.last] = np.arange(s.last - s.onset) * r.step_s
            way[s.onset : s.last] = s.direction
        since.append(np.minimum(elapsed, SINCE[-1]))
        direction.append(way)
        clock.append(r.time_s / max(r.duration_s, 1e-9) - 0.5)
    return since, direction, clock


def detection(fitted: FreeFit, gains: Mapping[str, np.ndarray]) -> Detection:
    """Test the residual along the state and the gains of the candidates, one level over all.

    Parameters
    ----------
    fitted : FreeFit
    gains : mapping of str to ndarray, shape (strokes,)
        By how much each candidate lowers the unseen loss of every stroke.
    """
    problem, solution = fitted.free_problem, fitted.solution
    residual, derivative = jacobian(problem.data, solution.parameters, solution.values[None, :])
    known = derivative[0].T
    strokes = problem.strokes
    flips = signs(len(strokes))
    names, drawn = [], []
    for name, columns in _features(fitted).items():
        # What the parameters could take up is no lack of fit.
        free = columns - known @ np.linalg.lstsq(known, columns, rcond=None)[0] if known.size else columns
        scores = np.array([residual[0][s] @ free[s] for s in strokes])
        names.append(name)
        drawn.append(p_values(studentised(scores, flips)).min(axis=1))
    lack_each = p_values(-np.column_stack(drawn))
    lack = p_values(-lack_each.min(axis=1)[:, None])[:, 0]
    along = names[int(np.argmin(lack_each[0]))]
    adjusted: dict[str, float] = {}
    together = [lack]
    if gains:
        statistics = one_sided(np.column_stack(list(gains.values())), flips)
        most = statistics.max(axis=1)
        adjusted = {n: float(np.mean(most >= v - 1e-12)) for n, v in zip(gains, statistics[0], strict=True)}
        together.append(p_values(most[:, None])[:, 0])
    overall = p_values(-np.column_stack(together).min(axis=1)[:, None])[0, 0]
    kinds = {n: (float(p), n) for n, p in zip(names, lack_each[0], strict=True)}
    return Detection(float(overall), adjusted, float(lack[0]), along, len(strokes), kinds)
