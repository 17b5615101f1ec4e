"""Handwheel manoeuvres, and how far a one-mass model is off the mechanism it stands for."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from .mechanism import Mechanism
from .run import simulate
from .structures import steering_one_mass

RATE_HZ = 500.0


@dataclass(frozen=True)
class Manoeuvre:
    """A handwheel angle over time.

    Attributes
    ----------
    name : str
    angle_rad : ndarray, shape (n,)
        Sampled at 500 Hz.
    """

    name: str
    angle_rad: np.ndarray


@dataclass(frozen=True)
class ReductionError:
    """How far a one-mass model is off in one manoeuvre.

    Attributes
    ----------
    manoeuvre : str
    rms_rad, max_rad : float
        Of the difference of the two motions (m where the body is of unit m).
    range_rad : float
        Largest less smallest position of the mechanism.
    time_s, mechanism, one_mass : ndarray, shape (n,)
        The two motions.
    """

    manoeuvre: str
    rms_rad: float
    max_rad: float
    range_rad: float
    time_s: np.ndarray
    mechanism: np.ndarray
    one_mass: np.ndarray

    @property
    def relative(self) -> float:
        """The rms of the difference as a share of the range; 0 where nothing moves in both."""
        return 0.0 if self.range_rad == 0.0 else self.rms_rad / self.range_rad

    def to_dict(self) -> dict[str, Any]:
        """Return the error as plain JSON values, without the motions."""
        return {
            "manoeuvre": self.manoeuvre,
            "rms_rad": self.rms_rad,
            "max_rad": self.max_rad,
            "range_rad": self.range_rad,
            "relative": self.relative,
        }

    def __str__(self) -> str:
        return (
            f"{self.manoeuvre}: off by {self.rms_rad:.3g} rms, {self.max_rad:.3g} at most, "
            f"{100 * self.relative:.2f} % of {self.range_rad:.3g}"
        )


def manoeuvres(amplitude_rad: float = 1.0) -> tuple[Manoeuvre, ...]:
    """Return a step within 0.1 s, sines of 0.5 Hz at three amplitudes, and an on-centre weave of 0.2 Hz.

    Parameters
    ----------
    amplitude_rad : float
        Of the step and the middle sine, at the handwheel; the other sines have a quarter of it and twice as much, the
        weave (small angles about the centre, slowly) a third.
    """

    def sine(share: float, hz: float, seconds: float) -> np.ndarray:
        t = np.arange(round(seconds * RATE_HZ) + 1) / RATE_HZ
        return share * amplitude_rad * np.sin(2.0 * math.pi * hz * t)

    t = np.arange(round(2.0 * RATE_HZ) + 1) / RATE_HZ
    # A cubic from 0 to 1: no jump in the speed.
    rise = np.clip((t - 0.2) / 0.1, 0.0, 1.0)
    made = {"step": amplitude_rad * rise**2 * (3.0 - 2.0 * rise)}
    made |= {f"sine {share * amplitude_rad:g} rad": sine(share, 0.5, 6.0) for share in (0.25, 1.0, 2.0)}
    made["weave"] = sine(1.0 / 3.0, 0.2, 10.0)
    return tuple(Manoeuvre(name, angle) for name, angle in made.items())


def compare(
    mechanism: Mechanism, parameters: Mapping[str, float], at: str, handwheel: str, test: Manoeuvre
) -> ReductionError:
    """Return the error of a one-mass model in one manoeuvre."""
    one = steering_one_mass(parameters)
    runs = []
    for m, drive, body in ((mechanism, handwheel, at), (one, "handwheel", "roadwheel")):
        runs.append(simulate(m, {drive: test.angle_rad}, sample_rate_hz=RATE_HZ).position[body])
    whole, single = runs
    off = single - whole
    return ReductionError(
        manoeuvre=test.name,
        rms_rad=float(np.sqrt(np.mean(off**2))),
        max_rad=float(np.abs(off).max()),
        range_rad=float(np.ptp(whole)),
        time_s=np.arange(whole.size) / RATE_HZ,
        mechanism=whole,
        one_mass=single,
    )
