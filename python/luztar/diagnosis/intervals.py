"""Parameters with 95 % intervals that take the stroke, not the sample, as the unit of chance.

Samples of one stroke share whatever wandered while it was recorded; intervals that count samples are ten times too
narrow. Each stroke is left out in turn (the jackknife, "CR3"), inner parameters enter through the derivative of the
model, and Student's t with strokes - 1 degrees of freedom gives the width.

Source: Cameron and Miller 2015, A Practitioner's Guide to Cluster-Robust Inference, J. Human Resources 50:317.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from ..model import Parameter, card
from .equations import Blocks, Columns, blocks
from .grids import is_geometric, is_sharpness, word
from .jacobian import continuous, jacobian
from .profile import Problem, State, owners

LEVEL = 0.95
# Where the others explain all but this share of a column's length, the data cannot tell its coefficient: a variance
# inflation of 10^4, an interval a hundred times wider than the noise asks for.
COLLINEAR_SHARE = 0.01
# The motion under way tells a coefficient by itself where its standard error is within this factor of that of all.
TOLD_IN_MOTION = 4.0


@dataclass(frozen=True)
class Estimate:
    """One parameter.

    Attributes
    ----------
    value : float
    low, high : float or None
        The 95 % interval; None where there is none.
    identifiable : bool
    unit : str
    note : str
        Why it is not identifiable, or that it was given.
    """

    value: float
    low: float | None
    high: float | None
    identifiable: bool
    unit: str
    note: str = ""

    def to_dict(self) -> dict[str, Any]:
        """Return the estimate as the JSON interface prints it."""
        out: dict[str, Any] = {
            "value": self.value,
            "low": self.low,
            "high": self.high,
            "identifiable": self.identifiable,
            "unit": self.unit,
        }
        if self.note:
            out["note"] = self.note
        return out


def estimates(problem: Problem, fitted: State) -> dict[str, Estimate]:
    """Return every parameter of a fitted state, keyed ``effect.parameter``."""
    # A sharp break-away has no interval of its own, but what is not known of it widens those of a delay or a gap.
    varied = continuous(problem, fitted, sharpness=True)
    made = jacobian(problem, fitted, varied)
    parts = blocks(problem.runs, made, problem.weights)
    full = parts.solve()
    covariance, degrees = jackknife(parts, full)
    quantile = student(degrees)
    pull = _pull_of_reversals(problem, made, full, covariance)
    covariance = covariance + np.outer(pull, pull) / quantile**2
    collinear = _collinear(parts.gram.sum(axis=0))
    model = problem.model
    free = [o for o in owners(fitted.terms, model) if o not in problem.fixed]
    out: dict[str, Estimate] = {}
    for name in fitted.terms.effects:
        linear = card(name, model.structure_name).linear
        places = [free.index((name, i)) if (name, i) in free else None for i in range(len(linear))]
        if linear and linear[0].role == "amplitude":
            out |= _polar(name, linear, places, full, covariance, quantile, collinear, model.known)
        else:
            for p, place in zip(linear, places, strict=True):
                key = f"{name}.{p.key}"
                if place is None:
                    out[key] = _given(model.known[key], p.unit)
                else:
                    half = quantile * math.sqrt(covariance[place, place])
                    out[key] = _estimate(float(fitted.coefficients[place]), half, p.unit, bool(collinear[place]))
        for i, p in enumerate(card(name, model.structure_name).inner):
            key = f"{name}.{p.key}"
            value = fitted.terms.inner[name][i]
            if key in model.known:
                out[key] = _given(model.known[key], p.unit)
                continue
            at = next((k for k, v in enumerate(varied) if (v.effect, v.index) == (name, i)), None)
            if at is None or is_sharpness(p):
                out[key] = Estimate(value, None, None, False, p.unit, _why_none(p))
                continue
            place = len(free) + at
            half = quantile * math.sqrt(covariance[place, place])
            low, high = value - half, value + half
            note = ""
            if not math.isfinite(half) or collinear[place] or half > 5.0 * abs(value):
                note = "the data do not determine it"
            elif is_geometric(p) and low <= 0.0:
                low = 0.0
                note = "the data do not keep it away from zero"
            out[key] = Estimate(value, max(low, p.low), min(high, p.high), not note, p.unit, note)
    return out


def student(degrees: int) -> float:
    """Return the two-sided quantile of Student's t for the intervals' level."""
    from scipy.special import stdtrit

    return float(stdtrit(max(degrees, 1), 0.5 + LEVEL / 2.0))


def jackknife(parts: Blocks, full: np.ndarray) -> tuple[np.ndarray, int]:
    """Return the covariance of coefficients by leaving out one stroke at a time, and its degrees of freedom."""
    kept = np.flatnonzero(parts.samples > 0)
    count = kept.size
    if count < 2:
        return np.full((full.size, full.size), np.inf), 1
    changes = np.array([parts.solve(kept[kept != j]) - full for j in kept])
    return (count - 1) / count * changes.T @ changes, count - 1


def _pull_of_reversals(problem: Problem, made: Columns, full: np.ndarray, covariance: np.ndarray) -> np.ndarray:
    """Return by how much each coefficient changes without the reversal zones; zero where only they tell it.

    How a motion starts is extrapolated from what the sensor shows, the same way for every stroke: what that gets wrong
    does not average out over strokes, and leaving one out does not show it.
    """
    parts = blocks(problem.runs, made, problem.weights, moving=True)
    without = parts.solve()
    spread, _ = jackknife(parts, without)
    told = np.diag(spread) <= TOLD_IN_MOTION**2 * np.diag(covariance)
    return np.where(told, without - full, 0.0)


def _collinear(gram: np.ndarray) -> np.ndarray:
    p = gram.shape[0] - 1
    scale = np.sqrt(np.diag(gram)[:p])
    dead = scale <= 1e-12 * max(float(scale.max(initial=0.0)), np.finfo(float).tiny)
    scale = np.where(dead, 1.0, scale)
    normal = gram[:p, :p] / np.outer(scale, scale) + 1e-14 * np.eye(p)
    share = 1.0 / np.sqrt(np.maximum(np.diag(np.linalg.pinv(normal, hermitian=True)), 1.0))
    return (share < COLLINEAR_SHARE) | dead


def _given(value: float, unit: str) -> Estimate:
    return Estimate(value, value, value, True, unit, "given")


def _estimate(value: float, half: float, unit: str, collinear: bool) -> Estimate:
    if not math.isfinite(half):
        return Estimate(value, None, None, False, unit, "too few strokes for an interval")
    note = "another effect of the model explains it as well" if collinear else ""
    return Estimate(value, value - half, value + half, not collinear, unit, note)


def _why_none(parameter: Parameter) -> str:
    if is_sharpness(parameter):
        return "sharper than the position sensor can show"
    return "not fitted" if word(parameter) == "waves_per_range" else "chosen among a few values"


def _polar(
    name: str,
    linear: Sequence[Any],
    places: Sequence[int | None],
    full: np.ndarray,
    covariance: np.ndarray,
    quantile: float,
    collinear: np.ndarray,
    known: Any,
) -> dict[str, Estimate]:
    keys = [f"{name}.{p.key}" for p in linear]
    if places[0] is None or places[1] is None:
        return {k: _given(known[k], p.unit) for k, p in zip(keys, linear, strict=True)}
    pair = [places[0], places[1]]
    a, b = full[pair]
    size = math.hypot(a, b)
    c = covariance[np.ix_(pair, pair)]
    if not np.isfinite(c).all() or size == 0.0:
        return {k: _estimate(v, math.inf, p.unit, False) for k, v, p in zip(keys, (size, 0.0), linear, strict=True)}
    along, across = np.array([a, b]) / size, np.array([-b, a]) / size**2
    half_size, half_phase = (quantile * math.sqrt(max(float(d @ c @ d), 0.0)) for d in (along, across))
    hidden = bool(collinear[pair].any())
    amplitude = _estimate(size, half_size, linear[0].unit, hidden)
    low = max(size - half_size, 0.0)
    phase = _estimate(math.atan2(b, a), min(half_phase, math.pi), linear[1].unit, hidden or half_phase >= math.pi)
    return {
        keys[0]: Estimate(size, low, amplitude.high, amplitude.identifiable, amplitude.unit, amplitude.note),
        keys[1]: phase,
    }
