"""A motion that nobody has made yet, seen by the sensor and prepared like a measured run."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from ..diagnosis.prepare import Prepared, Stroke, prepare
from ..measurement import Run
from ..model import Model

# Samples per period of the band's upper edge. The kinematics keep 2.5 times the band, which wants more than 11.
SAMPLES_PER_BAND_PERIOD = 24.0
# A start wants this many samples per second, however narrow the band.
SLOWEST_HZ = 50.0


@dataclass(frozen=True)
class Sensor:
    """What records a rehearsal.

    Attributes
    ----------
    step : float
        Step of the position sensor, in the motion's unit (rad, m).
    rate_hz : float
    noise_rms : float
        The torque's noise inside the comparison's band, Nm or N: what ``luztar compare`` calls the noise floor.
    noise_time_s : float
        How long the noise keeps its sign: zero for white noise.
    """

    step: float
    rate_hz: float
    noise_rms: float
    noise_time_s: float = 0.0

    def density(self, band_hz: float) -> float:
        """Return the noise's power density at low frequency, Nm² s: white noise of a variance has it over the band.

        Noise that keeps its sign for longer than the band's period has its power at low frequency, where the effects
        are, too.
        """
        return self.noise_rms**2 * max(1.0 / (2.0 * band_hz), 2.0 * self.noise_time_s)


def planning_rate_hz(rate_hz: float, band_hz: float) -> float:
    """Return the rate of a rehearsal: no more samples than its band needs."""
    return min(rate_hz, max(SAMPLES_PER_BAND_PERIOD * band_hz, SLOWEST_HZ))


def rehearse(positions: Sequence[np.ndarray], sensor: Sensor, model: Model) -> tuple[Prepared, ...]:
    """Prepare motions as if they had been measured with a torque of zero.

    Parameters
    ----------
    positions : sequence of ndarray
        One per run, sampled at ``sensor.rate_hz``.
    sensor : Sensor
    model : Model
        Its structure and band.
    """
    structure = model.structure
    runs = []
    for number, position in enumerate(positions, start=1):
        seen = np.round(position / sensor.step) * sensor.step if sensor.step > 0.0 else position
        channels: dict[str, Any] = {structure.motion: seen, structure.effort: np.zeros(seen.size)}
        runs.append(Run(sample_rate_hz=sensor.rate_hz, name=f"trial {number}", **channels))
    return prepare(runs, model)


def with_effort(runs: Sequence[Prepared], effort: Sequence[np.ndarray]) -> tuple[Prepared, ...]:
    """Return rehearsed runs with a torque (or force) at their kept samples."""
    return tuple(replace(r, effort=e) for r, e in zip(runs, effort, strict=True))


def minutes(runs: Sequence[Prepared]) -> float:
    """Return how long the runs take together."""
    return sum(r.duration_s for r in runs) / 60.0


def every_stroke(runs: Sequence[Prepared]) -> list[tuple[Prepared, Stroke]]:
    """Return all strokes with their runs."""
    return [(r, s) for r in runs for s in r.strokes]
