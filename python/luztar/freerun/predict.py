"""The road wheel's angle that value sets predict, for all runs: one batch of lanes per run."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from .. import _core
from .parameters import Parameters
from .record import Record, substeps_for

# A lane whose highest circular frequency times the step is above this is not simulated: it is no mechanism that the
# record could show.
STIFFEST = 1.0
# The simulation allows a step times frequency of 2, however far the spring is wound up.
LIMIT = 1.5
# No road wheel turns further than its handwheel.
FARTHEST = 1.0
# The column is wound up by a part of the handwheel's angle; the rest turns the road wheel.
WOUND_SHARE = 0.3


def highest_rad_s(rows: np.ndarray, wound_rad: float) -> np.ndarray:
    """Return the highest circular frequency of every row, its spring wound up by so much."""
    return _core.steering_highest_rad_s(np.ascontiguousarray(rows), wound_rad)


def _steps(records: Sequence[Record], rows: np.ndarray) -> tuple[int, np.ndarray]:
    """Return the sub-steps for a batch, and which of its rows are too stiff for them."""
    reach = max(float(np.abs(r.drive_rad).max()) for r in records)
    ratio = float(np.abs(rows[:, _core.steering_parameters().index("ratio")]).max())
    farthest = reach + ratio * max(abs(r.start[0]) for r in records)
    usual, worst = highest_rad_s(rows, WOUND_SHARE * reach), highest_rad_s(rows, farthest)
    typical = int(np.argsort(usual)[len(usual) // 2])
    slowest = min(r.rate_hz for r in records)
    steps = max(substeps_for(records, float(usual[typical])), math.ceil(float(worst[typical]) / (slowest * LIMIT)))
    return steps, ~((usual <= STIFFEST * slowest * steps) & (worst <= LIMIT * slowest * steps))


def predict(parameters: Parameters, records: Sequence[Record], values: np.ndarray) -> list[np.ndarray]:
    """Return the modelled road-wheel angle of every run.

    Parameters
    ----------
    parameters : Parameters
    records : sequence of Record
    values : ndarray, shape (lanes, len(parameters.free))

    Returns
    -------
    list of ndarray, shape (lanes, n)
        One per run. A lane that cannot be simulated is infinite.
    """
    rows, sensors = parameters.rows(np.atleast_2d(values))
    steps, wild = _steps(records, rows)
    if wild.all():
        return [np.full((len(rows), r.drive_rad.size), np.inf) for r in records]
    # In the place of those that cannot be simulated stands one that can.
    rows[wild] = rows[int(np.argmin(wild))]
    out = []
    for r in records:
        phi = np.empty((len(rows), r.drive_rad.size))
        starts = np.empty((len(rows), 2))
        offset = sensors.get("offset.level_rad")
        starts[:, 0] = r.start[0] - (offset if offset is not None else 0.0)
        starts[:, 1] = r.start[1]
        _core.simulate_steering(
            np.ascontiguousarray(rows),
            starts,
            r.drive_rad,
            None,
            sample_rate_hz=r.rate_hz,
            substeps=steps,
            method="split",
            width="widest",
            phi=phi,
            speed=None,
        )
        if "delay.time_s" in sensors:
            phi = _late(phi, sensors["delay.time_s"] * r.rate_hz)
        if offset is not None:
            phi += offset[:, None]
        # A spring that softens lets go of a body that is wound up too far: such a lane has no answer.
        away = wild | ~(np.abs(phi).max(axis=1) < FARTHEST * float(np.abs(r.drive_rad).max()))
        phi[away] = np.inf
        out.append(phi)
    return out


def _late(phi: np.ndarray, samples: np.ndarray) -> np.ndarray:
    """Return rows shifted to later by a number of samples each, straight lines between samples."""
    place = np.maximum(np.arange(phi.shape[1])[None, :] - samples[:, None], 0.0)
    left = np.minimum(place.astype(np.int64), phi.shape[1] - 2)
    share = place - left
    before = np.take_along_axis(phi, left, axis=1)
    return before + share * (np.take_along_axis(phi, left + 1, axis=1) - before)
