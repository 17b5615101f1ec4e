"""The noise floor: what a model of this kind could not remove however many effects it had.

Where runs repeat a motion, their differences tell it (see ``repeats``). Else a saturated model of the state (position,
speed, direction, travel since the reversal, acceleration, slow time) is fitted away from the reversal zones. What it
leaves where it was fitted is too little, what it leaves on a run it has not seen is too much; the floor is between them
(root of the mean square) and both are given. Inside the reversal zones the instant of the start, known to one step of
the sensor, adds its own part.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from .. import _core
from ..errors import MeasurementError
from ..model import Model
from .colour import WHITE, Colour, colour_of
from .equations import Blocks, loss
from .folds import Folds
from .prepare import Prepared, comparison_band_hz, decimates_alone
from .repeats import repeats

# Hat functions over position and speed. A period of cogging up to twelve per turn is 30 degrees: with 36 hats over
# +-60 degrees each spans 3.4 degrees, a ninth of it.
POSITION_HATS = 36
SPEED_HATS = 6
# Hats over time: what warms up or drifts does so over many strokes.
TIME_HATS = 5
# Knots of the hats over travel since the reversal, as shares of the range: a gap or break-away of 0.5 to 12 degrees in
# 120 shows between the first and the last.
TRAVEL_KNOTS = (0.0, 0.004, 0.008, 0.015, 0.022, 0.03, 0.04, 0.055, 0.075, 0.1, 0.15)
# Where what was not seen is missed by more than twice what was fitted, the model is too large for so few strokes; that
# says nothing of the noise.
LARGEST_RATIO = 2.0
SATURATED = "saturated model of the state, between what it leaves where it was fitted (low) and where it was not (high)"
# Standard errors of a 95 % interval.
SURE = 2.0
# Far below one sample's weight.
RIDGE = 1e-6


@dataclass(frozen=True)
class NoiseFloor:
    """The noise floor of a set of runs.

    Attributes
    ----------
    rms : float
        Over all samples of the comparison, reversal zones included.
    low, high : float
        What the saturated model leaves where it was fitted, and on what it has not seen, over the same samples.
    moving_rms, zone_rms : float
        Away from the reversal zones, and inside them.
    unit : str
    method : str
    colour : Colour
        The shape of its spectrum away from the reversal zones.
    """

    rms: float
    low: float
    high: float
    moving_rms: float
    zone_rms: float
    unit: str
    method: str
    colour: Colour = WHITE

    def to_dict(self) -> dict[str, Any]:
        """Return the floor as the JSON interface prints it."""
        return {
            "rms": self.rms,
            "low": self.low,
            "high": self.high,
            "unit": self.unit,
            "method": self.method,
            "moving_rms": self.moving_rms,
            "zone_rms": self.zone_rms,
        }


def hats(values: np.ndarray, knots: np.ndarray) -> np.ndarray:
    """Return piecewise-linear hat functions, shape (n, knots): they sum to one inside the knots."""
    clipped = np.clip(values, knots[0], knots[-1])
    right = np.clip(np.searchsorted(knots, clipped, side="right"), 1, knots.size - 1)
    share = (clipped - knots[right - 1]) / (knots[right] - knots[right - 1])
    out = np.zeros((values.size, knots.size))
    rows = np.arange(values.size)
    out[rows, right - 1] = 1.0 - share
    out[rows, right] += share
    return out


def _direction(r: Prepared) -> np.ndarray:
    direction = np.zeros(r.motion.size)
    for s in r.strokes:
        direction[s.onset : s.last] = s.direction
    return direction


def travel_since_reversal(r: Prepared) -> np.ndarray:
    """Return how far the motion has come since the onset of its stroke."""
    travel = np.zeros(r.motion.size)
    for s in r.strokes:
        travel[s.onset : s.last] = np.abs(r.motion[s.onset : s.last] - r.motion[s.onset])
    return travel


def saturated(runs: Sequence[Prepared]) -> list[np.ndarray]:
    """Return the saturated model's columns for every run."""
    low = min(float(r.motion.min()) for r in runs)
    high = max(float(r.motion.max()) for r in runs)
    top = max(float(np.abs(r.speed).max()) for r in runs)
    longest = max(r.duration_s for r in runs)
    position_knots = np.linspace(low, high, POSITION_HATS)
    # Speeds crowd at the low end, and so do the laws that depend on them.
    speed_knots = top * np.linspace(0.0, 1.0, SPEED_HATS) ** 1.5
    travel_knots = (high - low) * np.array(TRAVEL_KNOTS)
    made = []
    for r in runs:
        s = _direction(r)[:, None]
        place = hats(r.motion, position_knots)
        speed = hats(np.abs(r.speed), speed_knots)[:, 1:]
        travel = hats(travel_since_reversal(r), travel_knots)[:, :-1]
        time = hats(r.time_s, np.linspace(0.0, longest, TIME_HATS))[:, 1:]
        slow = np.hstack([time, s * time])
        # What changes within the filter's memory has to go through the filter; the hats change slowly.
        quick = r.recording.columns([("viscous", []), ("inertia", [])], [0, 1]).T
        load = r.recording.columns([("load", [])], [0]).T if all(run.has_load for run in runs) else quick[:, :0]
        made.append(np.hstack([place, s * place, speed, s * speed, s * travel, slow, quick, load]))
    return made


@dataclass(frozen=True)
class _Saturated:
    """The saturated model fitted away from the reversal zones."""

    made: list[np.ndarray]
    blocks: Blocks
    coefficients: np.ndarray

    @classmethod
    def of(cls, runs: Sequence[Prepared]) -> _Saturated:
        made = saturated(runs)
        grams, owners, counts = [], [], []
        for r, m in zip(runs, made, strict=True):
            rows, tables, start = [], [], 0
            for s in r.strokes:
                part = slice(s.first, s.last)
                keep = r.usable[part] & ~r.zone[part]
                tables.append(np.column_stack([m[part][keep], r.effort[part][keep]]))
                # An infinite ridge: away from the zones no start is uncertain.
                rows.append((start, start + int(keep.sum()), np.inf))
                start = rows[-1][1]
                owners.append(s.run)
                counts.append(int(keep.sum()))
            grams.append(_core.normal_equations(np.ascontiguousarray(np.concatenate(tables).T), rows))
        gram = np.concatenate(grams)
        # A ridge keeps hats that no sample touches from making the equations singular; spread over the strokes, it is
        # in every sum that is solved.
        ridge = RIDGE * np.eye(gram.shape[1]) / len(gram)
        ridge[-1, -1] = 0.0
        blocks = Blocks(gram + ridge, np.inf, np.array(owners), np.array(counts))
        return cls(made, blocks, blocks.solve())

    def pieces(self, runs: Sequence[Prepared]) -> list[tuple[np.ndarray, float]]:
        """Return what it leaves, in pieces without an interruption."""
        found = []
        for r, m in zip(runs, self.made, strict=True):
            keep = r.usable & ~r.zone
            left = r.effort - m[:, : self.coefficients.size] @ self.coefficients
            edges = np.flatnonzero(np.diff(np.concatenate([[False], keep, [False]]).astype(int)))
            found += [(left[a:b], r.step_s) for a, b in edges.reshape(-1, 2)]
        return found

    def errors(self) -> tuple[float, float]:
        """Return the mean squares that it leaves where it was fitted and on strokes that it has not seen."""
        blocks, fitted = self.blocks, self.coefficients
        inside = float(loss(blocks.gram, fitted).sum()) / max(int(blocks.samples.sum()), 1)
        folds = Folds.of(blocks)
        if folds.count < 2:
            return inside, inside
        losses, _ = blocks.held_out(folds)
        # A hat that only one run visits has no prediction there: such strokes say nothing about the noise. The median
        # over strokes, scaled to a mean by the training's own ratio, is deaf to them.
        per_stroke = losses / np.maximum(blocks.samples, 1)
        seen = blocks.samples > 0
        trained = loss(blocks.gram[seen], fitted) / blocks.samples[seen]
        ratio = float(np.median(per_stroke[seen] / np.maximum(trained, 1e-300)))
        return inside, inside * min(max(ratio, 1.0), LARGEST_RATIO**2)


def noise_floor(runs: Sequence[Prepared], model: Model) -> NoiseFloor:
    """Estimate the noise floor from runs alone; of the model only the structure and the band are looked at.

    Raises
    ------
    MeasurementError
        No run moves fast enough away from the reversal zones.
    """
    if not any((r.usable & ~r.zone).any() for r in runs):
        raise MeasurementError(
            "nowhere is the motion fast enough, and away from reversals, to tell noise from friction",
            ", ".join(r.name for r in runs),
            "Record strokes faster than 2 degrees/s (an axis: 3 % of its top speed), or compare with a larger --band.",
        )
    fitted = _Saturated.of(runs)
    low_passed = not (decimates_alone(model) or model.comparison.filter_already_applied)
    band_hz = min(comparison_band_hz(model, r.recording.decimate / r.step_s) for r in runs)
    colour = colour_of(fitted.pieces(runs), band_hz, low_passed)
    unit = model.structure.effort_unit
    repeated = repeats(runs)
    if repeated is not None:
        noise, error = repeated.rms, SURE * repeated.error
        method = f"repeats in the same state, over {100.0 * repeated.covered:.0f} % of the moving record"
        return _with_reversals(runs, noise, (max(noise - error, 0.0), noise + error), unit, method, colour)
    inside, unseen = fitted.errors()
    moving = float(np.sqrt((inside + unseen) / 2.0))
    return _with_reversals(runs, moving, (float(np.sqrt(inside)), float(np.sqrt(unseen))), unit, SATURATED, colour)


def _with_reversals(
    runs: Sequence[Prepared], moving: float, limits: tuple[float, float], unit: str, method: str, colour: Colour
) -> NoiseFloor:
    """Add what the uncertain starts of the strokes leave in the reversal zones."""
    level = friction_level(runs)
    squares, samples, zone_samples = 0.0, 0, 0
    for r in runs:
        shift = r.recording.start_shift([("coulomb", [0.5 * r.recording.resolution])])
        for s in r.strokes:
            part = slice(s.first, s.last)
            keep = r.usable[part]
            squares += float(np.sum((shift[part][keep] * level * s.onset_uncertainty_s) ** 2))
            samples += int(keep.sum())
            zone_samples += int((keep & r.zone[part]).sum())
    start = squares / max(samples, 1)
    rms, low_all, high_all = (float(np.sqrt(v**2 + start)) for v in (moving, *limits))
    return NoiseFloor(
        rms,
        low_all,
        high_all,
        moving,
        float(np.sqrt(moving**2 + squares / max(zone_samples, 1))),
        unit,
        "; ".join(filter(None, [method, "in the reversal zones plus the uncertain instant of the start", colour.text])),
        colour,
    )


def friction_level(runs: Sequence[Prepared]) -> float:
    """Return half the height of the loop, roughly: what a reversal of friction changes by half."""
    up, down = [], []
    for r in runs:
        direction = _direction(r)
        keep = r.usable & ~r.zone
        up.append(r.effort[keep & (direction > 0)])
        down.append(r.effort[keep & (direction < 0)])
    ups, downs = np.concatenate(up), np.concatenate(down)
    if not ups.size or not downs.size:
        return float(np.sqrt(np.mean(np.concatenate([ups, downs]) ** 2))) if ups.size + downs.size else 0.0
    return abs(float(np.mean(ups) - np.mean(downs))) / 2.0
