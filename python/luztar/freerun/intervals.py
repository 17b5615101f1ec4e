"""Parameters with 95 % intervals clustered by stroke, from the derivative of the simulated motion."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from ..diagnosis.intervals import COLLINEAR_SHARE, Estimate, student
from ..model import card
from .least_squares import Data, jacobian
from .parameters import Parameters, keys_of


def stroke_slices(data: Data) -> list[slice]:
    """Return the comparison's samples of every stroke, in the order of the data."""
    out, begin = [], 0
    for r in data.records:
        p = r.prepared
        first = int(np.argmax(p.usable))
        for from_, to in p.used:
            if to > from_:
                out.append(slice(begin + from_ - first, begin + to - first))
        begin += int(p.usable.sum())
    return out


# Not a size but one of two kinds.
CHOICES = ("presliding.shape",)


def estimates(data: Data, parameters: Parameters, values: np.ndarray) -> dict[str, Estimate]:
    """Return every parameter of a fit, keyed ``effect.parameter``."""
    model = parameters.model
    units = {
        f"{name}.{p.key}": p.unit
        for name in (model.structure_name, *model.effects)
        for p in card(name, model.structure_name).parameters
    }
    half, collinear = _half_widths(data, parameters, values)
    out: dict[str, Estimate] = {}
    for key in keys_of(model):
        if key in model.known:
            value = model.known[key]
            out[key] = Estimate(value, value, value, True, units[key], "given")
            continue
        i = parameters.free.index(key)
        value, width = float(values[i]), float(half[i])
        if key in CHOICES:
            value = float(value > 0.5)
            out[key] = Estimate(value, value, value, True, units[key], "the better of two")
            continue
        if value <= parameters.low[i] or value >= parameters.high[i]:
            out[key] = Estimate(value, None, None, False, units[key], "the search stopped at its bound")
        elif not math.isfinite(width):
            out[key] = Estimate(value, None, None, False, units[key], "too few strokes for an interval")
        else:
            effect, _, name = key.partition(".")
            p = next(p for p in card(effect, model.structure_name).parameters if p.key == name)
            note = "another parameter of the model explains it as well" if collinear[i] else ""
            low, high = max(value - width, p.low), min(value + width, p.high)
            out[key] = Estimate(value, low, high, not note, units[key], note)
    return out


def _half_widths(data: Data, parameters: Parameters, values: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    count = values.size
    if count == 0:
        return np.zeros(0), np.zeros(0, bool)
    residual, derivative = jacobian(data, parameters, values[None, :])
    scaled = derivative[0] * parameters.scale[:, None]
    inner = (values > parameters.low) & (values < parameters.high)
    scaled = scaled[inner]
    half, collinear = np.full(count, math.inf), np.zeros(count, bool)
    slices = stroke_slices(data)
    if len(slices) < 2 or not inner.any():
        return half, collinear
    changes = jackknife(scaled, residual[0], slices)
    covariance = (len(slices) - 1) / len(slices) * changes.T @ changes
    half[inner] = student(len(slices) - 1) * np.sqrt(np.diag(covariance)) * parameters.scale[inner]
    gram = scaled @ scaled.T
    size = np.sqrt(np.maximum(np.diag(gram), np.finfo(float).tiny))
    inverse = np.linalg.pinv(gram / np.outer(size, size), hermitian=True)
    share = 1.0 / np.sqrt(np.maximum(np.diag(inverse), 1.0))
    collinear[inner] = share < COLLINEAR_SHARE
    return half, collinear


def jackknife(derivative: np.ndarray, residual: np.ndarray, slices: Sequence[slice]) -> np.ndarray:
    """Return how the solution moves when one stroke is left out, shape (strokes, free)."""
    grams = np.array([derivative[:, s] @ derivative[:, s].T for s in slices])
    slopes = np.array([derivative[:, s] @ residual[s] for s in slices])
    gram, slope = grams.sum(axis=0), slopes.sum(axis=0)
    full = np.linalg.lstsq(gram, slope, rcond=None)[0]
    return np.array(
        [np.linalg.lstsq(gram - g, slope - b, rcond=None)[0] - full for g, b in zip(grams, slopes, strict=True)]
    )
