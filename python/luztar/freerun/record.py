"""Runs made ready for a free-run fit: the drive, what came out, where it started, its strokes."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from .. import _core
from .._arrays import vector
from ..diagnosis.prepare import Prepared, Stroke
from ..errors import MeasurementError
from ..model import Model

if TYPE_CHECKING:
    from ..measurement import Run

# What the model does not know of the start has died away after this time: three time constants of a mechanism as slow
# as 2 I / mu = 0.17 s.
START_S = 0.5
# The start is read off this much of the record.
START_FIT_S = 0.05
# A start speed within so many standard errors is rest.
START_ERRORS = 3.0
# Strokes and the picture of speed come from the handwheel in this band, that of a rig.
STROKE_BAND_HZ = 6.0
# Encoder steps and noise of the handwheel above this are not passed on by a column whose lowest mode is below 15 Hz.
DRIVE_BAND_HZ = 40.0
# The reversal zone reaches so far beyond the stretch of low speed (interface: 0.15 s).
ZONE_S = 0.15
# Steps of the simulation per period of the mechanism's own oscillation, at least: an error of 3e-4 in its frequency.
STEPS_PER_RADIAN = 10.0
LONGEST_START_SHARE = 0.2


@dataclass(frozen=True)
class Record:
    """One run ready for free-run fits.

    Attributes
    ----------
    prepared : Prepared
        Motion is the handwheel, effort the road wheel, as measured; with strokes and the samples of the comparison.
    drive_rad : ndarray, shape (n,)
        The handwheel as the simulation takes it.
    rate_hz : float
    start : tuple of float
        Angle and speed of the road wheel at the first sample.
    """

    prepared: Prepared
    drive_rad: np.ndarray
    rate_hz: float
    start: tuple[float, float]


def make_records(runs: Sequence[Run], model: Model) -> tuple[Record, ...]:
    """Make runs ready for the free-run fits of a model.

    Raises
    ------
    MeasurementError
        A channel is missing, a record is cut, uneven, holds NaN, does not move, or is too short.
    """
    if not len(runs):
        raise MeasurementError("there are no runs", "runs", "Give at least one run file.")
    return tuple(_record(number, run, model) for number, run in enumerate(runs))


def _record(number: int, run: Run, model: Model) -> Record:
    structure = model.structure
    if not run.integrity.complete:
        why = next((f.text for f in run.integrity.findings if f.kind == "cut"), "the file ends in the middle")
        raise MeasurementError(why, run.name, "Export the run again; a cut file is not used.")
    run.require_even()
    psi = vector(f"{run.name}: {structure.motion}", run[structure.motion], minimum=16)
    phi = vector(f"{run.name}: {structure.effort}", run[structure.effort], minimum=16)
    for name, values in ((structure.motion, psi), (structure.effort, phi)):
        if float(np.ptp(values)) == 0.0:
            raise MeasurementError(f"the {name} never moves", run.name, "Check the channel or its --map.")
    rate = run.sample_rate_hz
    first = math.ceil(START_S * rate)
    if first > LONGEST_START_SHARE * psi.size:
        raise MeasurementError(
            f"lasts {run.duration_s:.3g} s", run.name, f"Record at least {START_S / LONGEST_START_SHARE:g} s."
        )
    if rate < 50.0:
        raise MeasurementError(f"is sampled at {rate:g} Hz", run.name, "Record with at least 50 Hz.")
    recording = _core.Recording(
        psi,
        sample_rate_hz=rate,
        band_hz=min(STROKE_BAND_HZ, 0.2 * rate),
        decimate=1,
        anti_alias=False,
        already_filtered=False,
        hysteresis=structure.hysteresis(float(np.ptp(psi))),
        minimum_travel=structure.minimum_travel(float(np.ptp(psi))),
        turn_rad_per_unit=1.0,
        load_n=None,
    )
    position, speed, acceleration = recording.kept()
    found = recording.strokes()
    if not found:
        raise MeasurementError("holds no stroke", run.name, "A stroke needs 5 degrees of travel of the handwheel.")
    onsets = [onset for onset, *_ in found]
    strokes = tuple(
        Stroke(number, begin, last, onset, int(direction), uncertain)
        for begin, last, (onset, _, direction, uncertain) in zip(
            [0, *onsets[1:]], [*onsets[1:], psi.size], found, strict=True
        )
    )
    zone = np.zeros(psi.size, bool)
    slow = np.flatnonzero(np.abs(speed) < (structure.rest_speed or 0.0))
    reach = math.ceil(ZONE_S * rate)
    for offset in range(-reach, reach + 1):
        zone[np.clip(slow + offset, 0, psi.size - 1)] = True
    place = np.arange(psi.size)
    prepared = Prepared(
        name=run.name,
        recording=recording,
        time_s=place / rate,
        motion=position,
        speed=speed,
        acceleration=acceleration,
        effort=phi,
        usable=place >= first,
        zone=zone,
        strokes=strokes,
        used=tuple((max(s.first, first), max(s.last, first)) for s in strokes),
        step_s=1.0 / rate,
        duration_s=run.duration_s,
        has_load=False,
    )
    return Record(prepared, _drive(psi, rate), rate, _start(phi, rate))


def _drive(psi: np.ndarray, rate: float) -> np.ndarray:
    if rate < 4.0 * DRIVE_BAND_HZ:
        return psi
    from ..signal import zero_phase

    return np.asarray(zero_phase(psi, sample_rate_hz=rate, cutoff_hz=DRIVE_BAND_HZ, poles=2))


def _start(phi: np.ndarray, rate: float) -> tuple[float, float]:
    n = max(math.ceil(START_FIT_S * rate), 4)
    t = np.arange(n) / rate
    line, residual, *_ = np.polyfit(t, phi[:n], 1, full=True)
    noise = math.sqrt(float(residual[0]) / (n - 2)) if residual.size else 0.0
    error = noise / math.sqrt(float(np.sum((t - t.mean()) ** 2)))
    if abs(line[0]) <= START_ERRORS * error:
        return float(np.mean(phi[:n])), 0.0
    return float(line[1]), float(line[0])


def substeps_for(records: Sequence[Record], highest_rad_s: float) -> int:
    """Return the sub-steps per sample that a mechanism of this highest circular frequency needs."""
    slowest = min(r.rate_hz for r in records)
    return max(1, math.ceil(STEPS_PER_RADIAN * highest_rad_s / slowest))
