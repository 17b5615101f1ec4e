"""Runs made ready for a free-run fit: the drives, what came out, where it started, its strokes."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np

from .. import _core
from .._arrays import vector
from ..diagnosis.prepare import REST_SHARE_OF_TOP_SPEED, Prepared, Stroke
from ..errors import MeasurementError
from ..model import Model
from .floor import noise_of
from .plant import Plant

if TYPE_CHECKING:
    from ..measurement import Run

# Strokes and the picture of speed come from the motion in this band, that of a rig.
STROKE_BAND_HZ = 6.0
# The reversal zone reaches so far beyond the stretch of low speed (interface: 0.15 s).
ZONE_S = 0.15
LONGEST_START_SHARE = 0.2
SLOWEST_HZ = 50.0


@dataclass(frozen=True)
class Record:
    """One run ready for free-run fits.

    Attributes
    ----------
    name : str
    outputs : tuple of Prepared
        One per channel out, in its order: motion is the channel of the strokes, effort the channel as measured, in
        multiples of its scale; with strokes and the samples of the comparison.
    channels : tuple of str
    scales : ndarray, shape (len(channels),)
    drives : mapping of str to ndarray, shape (n,)
        What drives the simulation.
    rate_hz : float
    start : tuple of float
        What the plant knows of the state at the first sample.
    """

    name: str
    outputs: tuple[Prepared, ...]
    channels: tuple[str, ...]
    scales: np.ndarray
    drives: Mapping[str, np.ndarray]
    rate_hz: float
    start: tuple[float, ...]

    @property
    def usable(self) -> np.ndarray:
        """The samples of the comparison, the same for every channel."""
        return self.outputs[0].usable

    @property
    def measured(self) -> np.ndarray:
        """What came out, in multiples of the scales, shape (n, outputs)."""
        return np.column_stack([p.effort for p in self.outputs])

    def channel(self, name: str) -> np.ndarray:
        """Return a channel out in its SI unit."""
        at = self.channels.index(name)
        return self.outputs[at].effort * self.scales[at]


def make_records(runs: Sequence[Run], plant: Plant, model: Model, like: Sequence[Record] = ()) -> tuple[Record, ...]:
    """Make runs ready for the free-run fits of a model.

    Parameters
    ----------
    runs : sequence of Run
    plant : Plant
    model : Model
    like : sequence of Record
        Records whose channels and scales these take over: held-out runs are compared as the fitted ones.

    Raises
    ------
    MeasurementError
        A channel is missing, a record is cut, uneven, holds NaN, does not move, or is too short.
    """
    if not len(runs):
        raise MeasurementError("there are no runs", "runs", "Give at least one run file.")
    for run in runs:
        if not run.integrity.complete:
            why = next((f.text for f in run.integrity.findings if f.kind == "cut"), "the file ends in the middle")
            raise MeasurementError(why, run.name, "Export the run again; a cut file is not used.")
        run.require_even()
    channels = like[0].channels if like else _compared(runs, plant, model)
    records = [_record(number, run, plant, model, channels) for number, run in enumerate(runs)]
    if like:
        scales = like[0].scales
    elif plant.scaled:
        each = [[r.outputs[i].effort for r in records] for i in range(len(channels))]
        scales = np.array([noise_of(e, records[0].rate_hz)[0] for e in each])
        if not (scales > 0.0).all():
            silent = channels[int(np.argmin(scales))]
            remedy = "Give the channel as recorded: its noise is the ruler of the comparison."
            raise MeasurementError(f"{silent} has no noise at all", runs[0].name, remedy)
    else:
        scales = np.ones(len(channels))
    return tuple(_scaled(r, scales) for r in records)


def _compared(runs: Sequence[Run], plant: Plant, model: Model) -> tuple[str, ...]:
    possible = plant.outputs(model)
    found = tuple(c for c in possible if all(c in run for run in runs))
    if found:
        return found
    if len(possible) == 1:
        for run in runs:
            run[possible[0]]
    lacking = next(run for run in runs if not any(c in run for c in possible))
    remedy = f'Name a column, such as --map {possible[0]}="COLUMN".'
    raise MeasurementError(f"none of {', '.join(possible)} is there", lacking.name, remedy)


def _scaled(record: Record, scales: np.ndarray) -> Record:
    outputs = tuple(replace(p, effort=p.effort / s) for p, s in zip(record.outputs, scales, strict=True))
    return replace(record, outputs=outputs, scales=scales)


def _record(number: int, run: Run, plant: Plant, model: Model, channels: Sequence[str]) -> Record:
    structure = model.structure
    stroke = plant.stroke_channel(model)
    motion = vector(f"{run.name}: {stroke}", run[stroke], minimum=16)
    outs = [vector(f"{run.name}: {c}", run[c], minimum=16) for c in channels]
    for name, values in zip((stroke, *channels), (motion, *outs), strict=True):
        if float(np.ptp(values)) == 0.0:
            raise MeasurementError(f"the {name} never moves", run.name, "Check the channel or its --map.")
    rate = run.sample_rate_hz
    first = math.ceil(plant.start_s * rate)
    if first > LONGEST_START_SHARE * motion.size:
        raise MeasurementError(
            f"lasts {run.duration_s:.3g} s", run.name, f"Record at least {plant.start_s / LONGEST_START_SHARE:g} s."
        )
    if rate < SLOWEST_HZ:
        raise MeasurementError(f"is sampled at {rate:g} Hz", run.name, f"Record with at least {SLOWEST_HZ:g} Hz.")
    span = float(np.ptp(motion))
    recording = _core.Recording(
        motion,
        sample_rate_hz=rate,
        band_hz=min(STROKE_BAND_HZ, 0.2 * rate),
        decimate=1,
        anti_alias=False,
        already_filtered=False,
        hysteresis=structure.hysteresis(span),
        minimum_travel=structure.minimum_travel(span),
        turn_rad_per_unit=1.0,
        load_n=None,
    )
    position, speed, acceleration = recording.kept()
    found = recording.strokes()
    if not found:
        least = "5 degrees of travel" if structure.turns else "a travel of 5 % of the range"
        raise MeasurementError("holds no stroke", run.name, f"A stroke needs {least} of the {stroke}.")
    onsets = [onset for onset, *_ in found]
    strokes = tuple(
        Stroke(number, begin, last, onset, int(direction), uncertain)
        for begin, last, (onset, _, direction, uncertain) in zip(
            [0, *onsets[1:]], [*onsets[1:], motion.size], found, strict=True
        )
    )
    zone = np.zeros(motion.size, bool)
    rest = structure.rest_speed or REST_SHARE_OF_TOP_SPEED * float(np.abs(speed).max())
    slow = np.flatnonzero(np.abs(speed) < rest)
    reach = math.ceil(ZONE_S * rate)
    for offset in range(-reach, reach + 1):
        zone[np.clip(slow + offset, 0, motion.size - 1)] = True
    place = np.arange(motion.size)
    prepared = tuple(
        Prepared(
            name=run.name if len(channels) == 1 else f"{run.name}, {channel}",
            recording=recording,
            time_s=place / rate,
            motion=position,
            speed=speed,
            acceleration=acceleration,
            effort=values,
            usable=place >= first,
            zone=zone,
            strokes=strokes,
            used=tuple((max(s.first, first), max(s.last, first)) for s in strokes),
            step_s=1.0 / rate,
            duration_s=run.duration_s,
            has_load=False,
            channel="" if len(channels) == 1 else channel,
        )
        for channel, values in zip(channels, outs, strict=True)
    )
    drives = plant.drives(model, run)
    start = plant.start(model, run, drives)
    return Record(run.name, prepared, tuple(channels), np.ones(len(channels)), drives, rate, start)
