"""The position that value sets predict, stroke by stroke: one batch of lanes per stroke."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence

import numpy as np

from ... import _core
from ..parameters import Parameters
from ..record import Record
from .windows import Window, windows_of

# Key of a model: column of the core's one-mass mechanism, whose road wheel is the mass here. A constant force is dry
# friction that differs between the sides, at rest and in motion.
COLUMNS: Mapping[str, str] = {
    "inertia.inertia_kg": "inertia_kg_m2",
    "stiffness.stiffness_n_per_m": "aligning_nm_per_rad",
    "viscous.coefficient_n_s_per_m": "viscous_nm_s_per_rad",
    "asymmetric_viscous.difference_n_s_per_m": "asymmetric_viscous_nm_s_per_rad",
    "drag.coefficient_n_s2_per_m2": "drag_nm_s2_per_rad2",
    "coulomb.level_n": "coulomb_nm",
    "offset.level_n": "asymmetric_coulomb_nm",
    "stribeck.extra_n": "stribeck_nm",
    "stribeck.speed_m_s": "stribeck_speed_rad_s",
    "stiction.extra_n": "stiction_nm",
}
# The column that the mechanism has and an axis has not: so weak a spring that it moves nothing.
NO_SPRING = 1e-12
# A step times the circular frequency of the spring to the ground, or times the rate at which friction stops the mass.
STEP_SHARE = 0.2
STIFFEST = 1.0
MOST_SUBSTEPS = 16


def rows_of(parameters: Parameters, values: np.ndarray) -> np.ndarray:
    """Return the core's rows for value sets, shape (lanes, len(free))."""
    names = _core.steering_parameters()
    at = {name: i for i, name in enumerate(names)}
    rows = np.zeros((len(values), len(names)))
    for key, given in parameters.by_key(values).items():
        if key in COLUMNS:
            rows[:, at[COLUMNS[key]]] = given
    rows[:, at["ratio"]] = 1.0
    rows[:, at["stiffness_nm_per_rad"]] = NO_SPRING
    # A step of a derivative or a trial may ask for friction that drives: the nearest that does not.
    coulomb = rows[:, at["coulomb_nm"]]
    rows[:, at["asymmetric_coulomb_nm"]] = np.clip(rows[:, at["asymmetric_coulomb_nm"]], -coulomb, coulomb)
    viscous = rows[:, at["viscous_nm_s_per_rad"]]
    one_sided = rows[:, at["asymmetric_viscous_nm_s_per_rad"]]
    rows[:, at["asymmetric_viscous_nm_s_per_rad"]] = np.clip(one_sided, -viscous, viscous)
    least = coulomb - np.abs(rows[:, at["asymmetric_coulomb_nm"]])
    rows[:, at["stribeck_nm"]] = np.maximum(rows[:, at["stribeck_nm"]], -least)
    return rows


def predict(parameters: Parameters, records: Sequence[Record], values: np.ndarray) -> list[np.ndarray]:
    """See :meth:`luztar.freerun.plant.Plant.predict`."""
    rows = rows_of(parameters, np.atleast_2d(values))
    inertia = rows[:, _core.steering_parameters().index("inertia_kg_m2")]
    viscous = rows[:, _core.steering_parameters().index("viscous_nm_s_per_rad")]
    aligning = np.maximum(rows[:, _core.steering_parameters().index("aligning_nm_per_rad")], 0.0)
    quickest = np.maximum(np.sqrt(aligning / inertia), viscous / inertia)
    slowest = min(r.rate_hz for r in records)
    typical = float(np.sort(quickest)[quickest.size // 2])
    substeps = min(max(1, math.ceil(typical / (slowest * STEP_SHARE))), MOST_SUBSTEPS)
    sound = quickest < STIFFEST * slowest * substeps
    out = []
    for r in records:
        made = np.full((len(rows), r.drives["force"].size, 1), np.inf)
        if sound.any():
            made[sound, :, 0] = _one_run(rows[sound], r, substeps)
        out.append(made)
    return out


def _one_run(rows: np.ndarray, record: Record, substeps: int) -> np.ndarray:
    position = record.channel("position")
    bounds = [(s.first, s.last) for s in record.outputs[0].strokes]
    out = np.empty((len(rows), position.size))
    for window in windows_of(position, record.rate_hz, bounds):
        part = slice(window.first, window.last)
        force = np.ascontiguousarray(record.drives["force"][part])
        out[:, part] = _one_window(rows, window, force, position[part], record.rate_hz, substeps)
    return out


def _one_window(
    rows: np.ndarray, window: Window, force: np.ndarray, measured: np.ndarray, rate_hz: float, substeps: int
) -> np.ndarray:
    if force.size < 2:
        return np.tile(measured, (len(rows), 1))
    lanes = len(rows)
    # As read, with the position off by its standard error, and with the speed off by its own.
    starts = np.tile([0.0, window.start[1]], (3, lanes, 1))
    starts[1, :, 0] += window.uncertainty[0]
    starts[2, :, 1] += window.uncertainty[1]
    moved = np.empty((3 * lanes, force.size))
    _core.simulate_steering(
        np.ascontiguousarray(np.tile(rows, (3, 1))),
        starts.reshape(-1, 2),
        np.zeros(force.size),
        force,
        sample_rate_hz=rate_hz,
        substeps=substeps,
        method="split",
        width="widest",
        phi=moved,
        speed=None,
    )
    plain, by_position, by_speed = moved.reshape(3, lanes, -1)
    plain = plain + window.start[0]
    return corrected(plain, np.stack([by_position, by_speed]) + window.start[0] - plain, measured, window)


def corrected(plain: np.ndarray, changes: np.ndarray, measured: np.ndarray, window: Window) -> np.ndarray:
    """Return the motion from the most likely start: what was read of it weighs as its standard error says.

    Parameters
    ----------
    plain : ndarray, shape (lanes, n)
    changes : ndarray, shape (2, lanes, n)
        What a standard error of position and speed at the start changes.
    measured : ndarray, shape (n,)
    window : Window
    """
    residual = (measured - plain) / window.noise
    scaled = changes / window.noise
    gram = np.einsum("iln,jln->lij", scaled, scaled) + np.eye(2)
    slope = np.einsum("iln,ln->li", scaled, residual)
    by = np.linalg.solve(gram, slope[:, :, None])[:, :, 0]
    return np.asarray(plain + np.einsum("li,iln->ln", by, changes))
