"""The road wheel's angle that value sets predict, for all runs: one batch of lanes per run."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from ... import _core
from ...dynamics import COLUMNS
from ..parameters import Parameters
from ..record import Record
from ..sensor import late

SENSOR_KEYS = ("delay.time_s", "offset.level_rad")
# Steps of the simulation per period of the mechanism's own oscillation, at least: an error of 3e-4 in its frequency.
STEPS_PER_RADIAN = 10.0

# A lane whose highest circular frequency times the step is above this is not simulated: it is no mechanism that the
# record could show.
STIFFEST = 1.0
# The simulation allows a step times frequency of 2, however far the spring is wound up.
LIMIT = 1.5
# No road wheel turns further than its handwheel.
FARTHEST = 1.0
# The column is wound up by a part of the handwheel's angle; the rest turns the road wheel.
WOUND_SHARE = 0.3


def _rows(parameters: Parameters, values: np.ndarray) -> tuple[np.ndarray, dict[str, np.ndarray]]:
    """Return the core's rows for value sets, shape (lanes, len(free)), and the sensor parameters per lane."""
    names = _core.steering_parameters()
    at = {key: names.index(column) for key, column in COLUMNS.items()}
    rows = np.zeros((len(values), len(names)))
    sensors: dict[str, np.ndarray] = {}
    for key, given in parameters.by_key(values).items():
        if key in SENSOR_KEYS:
            sensors[key] = given
        else:
            rows[:, at[key]] = given
    # A step of a derivative or a trial may ask for friction that drives: the nearest that does not.
    coulomb = rows[:, at["coulomb.level_nm"]]
    for key, limit in (
        ("asymmetric_coulomb.difference_nm", coulomb),
        ("asymmetric_viscous.difference_nm_s_per_rad", rows[:, at["viscous.coefficient_nm_s_per_rad"]]),
    ):
        rows[:, at[key]] = np.clip(rows[:, at[key]], -limit, limit)
    least = coulomb - np.abs(rows[:, at["asymmetric_coulomb.difference_nm"]])
    rows[:, at["stribeck.extra_nm"]] = np.maximum(rows[:, at["stribeck.extra_nm"]], -least)
    return rows, sensors


def highest_rad_s(rows: np.ndarray, wound_rad: float) -> np.ndarray:
    """Return the highest circular frequency of every row, its spring wound up by so much."""
    return _core.steering_highest_rad_s(np.ascontiguousarray(rows), wound_rad)


def _substeps_for(records: Sequence[Record], highest: float) -> int:
    """Return the sub-steps per sample that a mechanism of this highest circular frequency needs."""
    return max(1, math.ceil(STEPS_PER_RADIAN * highest / min(r.rate_hz for r in records)))


def _steps(records: Sequence[Record], rows: np.ndarray) -> tuple[int, np.ndarray]:
    """Return the sub-steps for a batch, and which of its rows are too stiff for them."""
    reach = max(float(np.abs(r.drives["handwheel"]).max()) for r in records)
    ratio = float(np.abs(rows[:, _core.steering_parameters().index("ratio")]).max())
    farthest = reach + ratio * max(abs(r.start[0]) for r in records)
    usual, worst = highest_rad_s(rows, WOUND_SHARE * reach), highest_rad_s(rows, farthest)
    typical = int(np.argsort(usual)[len(usual) // 2])
    slowest = min(r.rate_hz for r in records)
    steps = max(_substeps_for(records, float(usual[typical])), math.ceil(float(worst[typical]) / (slowest * LIMIT)))
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
    rows, sensors = _rows(parameters, np.atleast_2d(values))
    steps, wild = _steps(records, rows)
    if wild.all():
        return [np.full((len(rows), r.drives["handwheel"].size), np.inf) for r in records]
    # In the place of those that cannot be simulated stands one that can.
    rows[wild] = rows[int(np.argmin(wild))]
    out = []
    for r in records:
        psi = r.drives["handwheel"]
        phi = np.empty((len(rows), psi.size))
        starts = np.empty((len(rows), 2))
        offset = sensors.get("offset.level_rad")
        starts[:, 0] = r.start[0] - (offset if offset is not None else 0.0)
        starts[:, 1] = r.start[1]
        _core.simulate_steering(
            np.ascontiguousarray(rows),
            starts,
            psi,
            None,
            sample_rate_hz=r.rate_hz,
            substeps=steps,
            method="split",
            width="widest",
            phi=phi,
            speed=None,
        )
        if "delay.time_s" in sensors:
            phi = late(phi, sensors["delay.time_s"] * r.rate_hz)
        if offset is not None:
            phi += offset[:, None]
        # A spring that softens lets go of a body that is wound up too far: such a lane has no answer.
        away = wild | ~(np.abs(phi).max(axis=1) < FARTHEST * float(np.abs(psi).max()))
        phi[away] = np.inf
        out.append(phi)
    return out
