"""Runs made ready for a driven fit: filtered, cut into strokes, the unknown start masked."""

from __future__ import annotations

import functools
import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from .. import _core
from .._arrays import vector
from ..errors import MeasurementError
from ..model import Model
from .resolved import FILTER_MEMORY_PERIODS, require_resolved

if TYPE_CHECKING:
    from ..measurement import Run

# Speed and acceleration take two samples on either side each; nearer to the end they are one-sided.
DERIVATIVE_REACH = 4
# The reversal zone reaches this far beyond the stretch of low speed (interface: 0.15 s at the 6 Hz of a rig).
ZONE_WIDTH_PERIODS = 0.9
# A structure without a speed of rest of its own takes this share of its top speed.
REST_SHARE_OF_TOP_SPEED = 0.03


@dataclass(frozen=True)
class Stroke:
    """One stroke of one run, in kept samples.

    Attributes
    ----------
    run : int
        Number of the run.
    first, last : int
        Kept samples of the stroke, ``[first, last)``; it begins a filter's memory before the motion starts, so that
        the whole reversal belongs to it.
    onset : int
        The kept sample where the motion starts.
    direction : int
        +1 where the motion increases, -1 where it decreases.
    onset_uncertainty_s : float
        By how much the instant of the start is uncertain: the time the sensor needs for half a step.
    """

    run: int
    first: int
    last: int
    onset: int
    direction: int
    onset_uncertainty_s: float


@dataclass(frozen=True)
class Prepared:
    """One run ready for a driven fit; all arrays hold the kept samples.

    Attributes
    ----------
    name : str
    recording : Recording
        The core's prepared run: gives the columns of any model.
    time_s, motion, speed, acceleration, effort : ndarray, shape (n,)
        Time since the start of the file; smoothed motion and its derivatives; the measured torque or force, filtered.
    usable : ndarray of bool, shape (n,)
        False before the first motion has fixed the friction state, and where the acceleration is one-sided.
    zone : ndarray of bool, shape (n,)
        True at rest and around reversals.
    strokes : tuple of Stroke
    used : tuple of (int, int)
        The usable samples of every stroke, ``[first, last)``.
    step_s : float
        Seconds between kept samples.
    duration_s : float
    has_load : bool
        Whether the load was recorded.
    channel : str
        The channel of ``effort`` where a structure explains several; else empty.
    doubt : str
        What stands against naming an effect from this run; empty where nothing does.
    own_offset, own_delay_s : float
        What the sensor of this run alone had, taken off the effort already.
    """

    name: str
    recording: _core.Recording
    time_s: np.ndarray
    motion: np.ndarray
    speed: np.ndarray
    acceleration: np.ndarray
    effort: np.ndarray
    usable: np.ndarray
    zone: np.ndarray
    strokes: tuple[Stroke, ...]
    used: tuple[tuple[int, int], ...]
    step_s: float
    duration_s: float
    has_load: bool
    channel: str = ""
    doubt: str = ""
    own_offset: float = 0.0
    own_delay_s: float = 0.0


def prepare(runs: Sequence[Run], model: Model) -> tuple[Prepared, ...]:
    """Make runs ready for the fits of a model's structure and band.

    Raises
    ------
    MeasurementError
        A channel is missing, a record is cut, uneven, holds NaN, does not move, or is sampled too slowly.
    """
    if not len(runs):
        raise MeasurementError("there are no runs", "runs", "Give at least one run file.")
    return tuple(prepare_run(number, run, model) for number, run in enumerate(runs))


def prepare_run(number: int, run: Run, model: Model) -> Prepared:
    """Make one run ready; its strokes carry the number."""
    structure = model.structure
    if not run.integrity.complete:
        why = next((f.text for f in run.integrity.findings if f.kind == "cut"), "the file ends in the middle")
        raise MeasurementError(why, run.name, "Export the run again; a cut file is not used.")
    run.require_even()
    motion = vector(f"{run.name}: {structure.motion}", run[structure.motion], minimum=16)
    effort = vector(f"{run.name}: {structure.effort}", run[structure.effort], minimum=16)
    load = vector(f"{run.name}: load", run["load"]) if "load" in run else None
    rate = run.sample_rate_hz
    band = comparison_band_hz(model, rate)
    if not band < 0.45 * rate:
        raise MeasurementError(
            f"sampled at {rate:g} Hz, too slowly for a band of {band:g} Hz", run.name, "Compare with a smaller --band."
        )
    span = float(np.ptp(motion))
    if span == 0.0:
        raise MeasurementError(f"the {structure.motion} never moves", run.name, "Check the channel or its --map.")
    pitch = model.known.get("pitch_m")
    turn = 1.0 if structure.name == "rig" else 2.0 * math.pi / pitch if pitch else math.nan
    recorded = functools.partial(
        _core.Recording,
        motion,
        sample_rate_hz=rate,
        already_filtered=model.comparison.filter_already_applied,
        hysteresis=structure.hysteresis(span),
        minimum_travel=structure.minimum_travel(span),
        turn_rad_per_unit=turn,
        load_n=load,
    )
    recording = recorded(band_hz=band, decimate=model.comparison.decimate, anti_alias=decimates_alone(model))
    position, speed, acceleration = recording.kept()
    every = recording.decimate
    step_s = every / rate
    found = recording.strokes()

    def usually() -> int:
        usual = recorded(band_hz=min(structure.band_hz, 0.4 * rate), decimate=None, anti_alias=False)
        return len(usual.strokes())

    require_resolved(run.name, model, band, rate, run.duration_s, position.size, len(found), usually)
    if not found:
        raise MeasurementError("holds no stroke", run.name, f"A stroke needs {_least_travel(model, span)} of travel.")
    memory = math.ceil(FILTER_MEMORY_PERIODS / band / step_s)
    strokes = _strokes(number, found, every, memory, position.size)
    from_, to = _usable(
        position, strokes[0], memory, structure.unknown_travel_share * recording.range, every, len(recording)
    )
    place = np.arange(position.size)
    return Prepared(
        name=run.name,
        recording=recording,
        time_s=np.arange(position.size) * step_s,
        motion=position,
        speed=speed,
        acceleration=acceleration,
        effort=recording.measured(effort),
        usable=(place >= from_) & (place < to),
        zone=_zone(speed, structure.rest_speed, ZONE_WIDTH_PERIODS / band / step_s),
        strokes=strokes,
        used=tuple((min(max(s.first, from_), to), max(min(s.last, to), from_)) for s in strokes),
        step_s=step_s,
        duration_s=run.duration_s,
        has_load=load is not None,
    )


def decimates_alone(model: Model) -> bool:
    """Whether the model asks for a decimation without a band: its anti-alias filter is then the comparison's."""
    return (model.comparison.decimate or 1) > 1 and model.comparison.band_hz is None


def comparison_band_hz(model: Model, rate_hz: float) -> float:
    """Return the upper edge of the comparison at a sample rate."""
    every = model.comparison.decimate or 1
    # Four fifths of the new Nyquist frequency, the edge of the decimation's filter.
    return 0.8 * rate_hz / (2 * every) if decimates_alone(model) else model.band_hz


def _least_travel(model: Model, span: float) -> str:
    least = model.structure.minimum_travel(span)
    return f"{math.degrees(least):.3g} degrees" if model.structure_name == "rig" else f"{least:.3g} m"


def _strokes(
    number: int, found: list[tuple[int, int, float, float]], every: int, memory: int, size: int
) -> tuple[Stroke, ...]:
    onsets = [onset // every for onset, *_ in found]
    # The reversal's echo in the filtered torque reaches back before the onset: it must not be cut in two.
    firsts = [max(0, onset - memory) for onset in onsets]
    return tuple(
        Stroke(number, first, last, onset, int(direction), uncertain)
        for first, last, onset, (_, _, direction, uncertain) in zip(
            firsts, [*firsts[1:], size], onsets, found, strict=True
        )
    )


def _usable(
    position: np.ndarray, first: Stroke, memory: int, unknown_travel: float, every: int, samples: int
) -> tuple[int, int]:
    """Return the usable samples, ``[from, to)``: after the first motion has fixed the friction state."""
    travelled = np.abs(position - position[first.onset]) > unknown_travel
    travelled[: first.onset] = False
    known = int(np.argmax(travelled)) if travelled.any() else position.size
    to = max(0, math.ceil((samples - DERIVATIVE_REACH) / every))
    return min(max(known, first.onset) + memory, to), to


def _zone(speed: np.ndarray, rest_speed: float | None, width: float) -> np.ndarray:
    limit = rest_speed if rest_speed is not None else REST_SHARE_OF_TOP_SPEED * float(np.abs(speed).max())
    slow = np.flatnonzero(np.abs(speed) < limit)
    zone = np.zeros(speed.size, bool)
    reach = math.ceil(width)
    for offset in range(-reach, reach + 1):
        zone[np.clip(slow + offset, 0, speed.size - 1)] = True
    return zone


def stroke_offsets(runs: Sequence[Prepared]) -> list[tuple[Prepared, int]]:
    """Return every run with the number of its first stroke, strokes counted over all runs."""
    found, offset = [], 0
    for r in runs:
        found.append((r, offset))
        offset += len(r.strokes)
    return found


def stroke_of_samples(r: Prepared, offset: int) -> np.ndarray:
    """Return the number of the stroke of every kept sample of a run; -1 before its first."""
    owner = np.full(r.motion.size, -1)
    for i, s in enumerate(r.strokes):
        owner[s.first : s.last] = offset + i
    return owner
