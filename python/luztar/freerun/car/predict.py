"""The motion of the car that value sets predict, for all runs: one batch of lanes per run."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence

import numpy as np

from ...vehicle import Car, Samples, simulate
from ...vehicle.car import CAR_COLUMNS, REQUIRED, Parameter
from ..parameters import Parameters
from ..record import Record
from ..sensor import late
from .body import rolls
from .sizes import GRAVITY

# Where a channel stands in a simulated drive.
CHANNELS: Mapping[str, str] = {
    "yaw_rate": "yaw_rate_rad_s",
    "lateral_acceleration": "lateral_acceleration_m_s2",
    "roll_angle": "roll_rad",
    "roadwheel": "roadwheel_rad",
}
# Columns of a car that one parameter of an effect sets.
OF_EFFECTS: Mapping[str, tuple[str, ...]] = {
    "tyre_saturation.friction": ("front.friction", "rear.friction"),
    "tyre_relaxation.length_m": ("front.relaxation_m", "rear.relaxation_m"),
    "roll_steer.front_rad_per_rad": ("front.roll_steer",),
    "roll_steer.rear_rad_per_rad": ("rear.roll_steer",),
}
NOT_OF_THE_CAR = ("delay.time_s", "offset.handwheel_rad", "speed_m_s")
# A step times the circular frequency of the front wheels on their column: an error of 2e-3 in that frequency, which is
# above what a hand excites.
STEP_SHARE = 0.2
# Lanes whose step times frequency, or times the rate of a decay, is above this are not simulated.
STIFFEST = 0.9
# A trace holds 14 channels: so many cars at a time keep it in some ten megabytes.
CHUNK = 128
# Every parameter is overruled by lanes.
OVERRULED = {key: Parameter(1.0, "overruled") for key in REQUIRED}


def columns_of(parameters: Parameters, values: np.ndarray) -> dict[str, np.ndarray]:
    """Return the columns of cars, one value per lane, for value sets of shape (lanes, free)."""
    out: dict[str, np.ndarray] = {}
    for key, given in parameters.by_key(values).items():
        if key in NOT_OF_THE_CAR:
            continue
        for column in OF_EFFECTS.get(key, (key,)):
            # Roll steer that is missing adds to what is known; one relaxation length stands for both axles.
            out[column] = out[column] + given if key.startswith("roll_steer.") and column in out else given
    if "stribeck.extra_nm" in out:
        out["stribeck.extra_nm"] = np.maximum(out["stribeck.extra_nm"], -out["coulomb.level_nm"])
    return out


def predict(parameters: Parameters, records: Sequence[Record], values: np.ndarray) -> list[np.ndarray]:
    """See :meth:`luztar.freerun.plant.Plant.predict`."""
    values = np.atleast_2d(values)
    columns = columns_of(parameters, values)
    return [_one_run(parameters, r, values, columns) for r in records]


def _one_run(
    parameters: Parameters, record: Record, values: np.ndarray, columns: Mapping[str, np.ndarray]
) -> np.ndarray:
    lanes, samples = len(values), record.drives["handwheel"].size
    out = np.full((lanes, samples, len(record.channels)), np.inf)
    speed = record.drives["speed"]
    substeps, sound = _steps(columns, record)
    if not sound.any():
        return out
    step = 1.0 / (record.rate_hz * substeps)
    given = dict(columns)
    for key in ("front.relaxation_m", "rear.relaxation_m"):
        if key in given:
            # A lag that is over within a step is none.
            given[key] = np.where(given[key] * STIFFEST > float(speed.max()) * step, given[key], 0.0)
    by_key = parameters.by_key(values)
    car = Car("model", "model", "linear", OVERRULED, {})
    yaw_rate, roll, roadwheel = record.start
    saturates = "tyre_saturation" in parameters.model.effects
    where = np.flatnonzero(sound)
    for first in range(0, where.size, CHUNK):
        at = where[first : first + CHUNK]
        hand = record.drives["handwheel"]
        if "offset.handwheel_rad" in by_key:
            hand = hand + by_key["offset.handwheel_rad"][at, None]
        drive = simulate(
            car,
            handwheel_rad=Samples(hand, record.rate_hz),
            speed_m_s=Samples(speed, record.rate_hz),
            duration_s=(samples - 1) / record.rate_hz,
            step_s=step,
            every=substeps,
            model="lateral_roll" if rolls(parameters.model) else "single_track",
            tyre="brush" if saturates else "linear",
            vary={key: column[at] for key, column in given.items()},
            start={"yaw_rate_rad_s": yaw_rate, "roll_rad": roll, "roadwheel_rad": roadwheel},
        )
        for i, channel in enumerate(record.channels):
            motion = getattr(drive, CHANNELS[channel])
            if "delay.time_s" in by_key:
                motion = late(motion, by_key["delay.time_s"][at] * record.rate_hz)
            out[at, :, i] = motion
    return out


def _steps(columns: Mapping[str, np.ndarray], record: Record) -> tuple[int, np.ndarray]:
    """Return the sub-steps for a batch, and which of its lanes can be simulated with them."""
    nothing = np.zeros(len(columns["body.mass_kg"]))
    car = {key: columns.get(key, nothing) for key in CAR_COLUMNS}
    slow = float(record.drives["speed"].min())
    cornering = car["front.cornering_n_per_rad"]
    trail = np.abs(car["front.pneumatic_trail_m"]) + np.abs(car["front.caster_trail_m"])
    springs = car["steering.ratio"] ** 2 * car["steering.stiffness_nm_per_rad"]
    ground = car["steering.aligning_nm_per_rad"] + trail * cornering
    steering = np.sqrt((springs + ground) / car["steering.inertia_kg_m2"])
    a, b, rear = car["body.front_axle_m"], car["body.rear_axle_m"], car["rear.cornering_n_per_rad"]
    lateral = (cornering + rear) / (car["body.mass_kg"] * slow)
    yaw = (a**2 * cornering + b**2 * rear) / (car["body.yaw_inertia_kg_m2"] * slow)
    quickest = np.maximum(np.maximum(steering, lateral), yaw)
    sound = np.ones(nothing.size, bool)
    if (car["body.roll_inertia_kg_m2"] > 0.0).any():
        arm = car["body.sprung_mass_kg"] * car["body.roll_arm_m"]
        inertia = car["body.roll_inertia_kg_m2"] - arm**2 / car["body.mass_kg"]
        stiffness = car["front.roll_stiffness_nm_per_rad"] + car["rear.roll_stiffness_nm_per_rad"] - arm * GRAVITY
        damping = car["front.roll_damping_nm_s_per_rad"] + car["rear.roll_damping_nm_s_per_rad"]
        sound = (inertia > 0.0) & (stiffness > 0.0) & (car["body.sprung_mass_kg"] <= car["body.mass_kg"])
        safe = np.where(sound, inertia, 1.0)
        quickest = np.maximum(quickest, np.where(sound, np.sqrt(np.abs(stiffness) / safe), 0.0))
        quickest = np.maximum(quickest, np.where(sound, damping / safe, 0.0))
    typical = float(np.sort(quickest)[quickest.size // 2])
    substeps = max(1, math.ceil(typical / (record.rate_hz * STEP_SHARE)))
    return substeps, sound & (quickest < STIFFEST * record.rate_hz * substeps)
