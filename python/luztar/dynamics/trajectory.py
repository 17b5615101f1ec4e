"""What a free run gives back: angles, speeds, events, energies."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from .._stream import Mappings

EVENT_KINDS = ("stick", "slip", "reversal", "contact", "release")
# Of the energy turned over; the residual is of second order in the step, so that a step a third as long has a tenth.
LARGEST_RESIDUAL = 0.01


@dataclass(frozen=True)
class Trajectory:
    """What :func:`simulate` returns.

    Attributes
    ----------
    time_s : ndarray, shape (n,)
    roadwheel_rad, speed_rad_s : ndarray, shape (n,) or (lanes, n)
        Angle and speed of the road wheel; a speed of exactly 0 is stick.
    """

    time_s: np.ndarray
    roadwheel_rad: np.ndarray
    speed_rad_s: np.ndarray

    def to_dict(self) -> dict[str, Any]:
        """Return the trajectory as plain JSON values."""
        return {
            "time_s": self.time_s.tolist(),
            "roadwheel_rad": self.roadwheel_rad.tolist(),
            "speed_rad_s": self.speed_rad_s.tolist(),
        }

    def __str__(self) -> str:
        lanes = 1 if self.roadwheel_rad.ndim == 1 else len(self.roadwheel_rad)
        stuck = 100.0 * float(np.mean(self.speed_rad_s == 0.0))
        return (
            f"{lanes} trajector{'y' if lanes == 1 else 'ies'} of {self.time_s[-1]:g} s; road wheel between "
            f"{self.roadwheel_rad.min():.4g} and {self.roadwheel_rad.max():.4g} rad, at rest {stuck:.1f} % of the time"
        )

    __repr__ = __str__


@dataclass(frozen=True)
class Event:
    """One event of a trajectory.

    Attributes
    ----------
    time_s : float
    kind : str
        ``stick``, ``slip``, ``reversal``, ``contact`` or ``release`` (of the gap).
    direction : int
        Of the motion that follows, or the side that touches; 0 where the body stays.
    """

    time_s: float
    kind: str
    direction: int

    def to_dict(self) -> dict[str, Any]:
        """Return the event as plain JSON values."""
        return {"time_s": self.time_s, "kind": self.kind, "direction": self.direction}


@dataclass(frozen=True)
class Trace(Mappings, Trajectory):
    """What :func:`trace` returns: a trajectory with its events and energies.

    Attributes
    ----------
    handwheel_rad : ndarray, shape (n,)
    friction_nm : ndarray, shape (n,)
        Torque of all friction against the road wheel's motion: the mean over the step after each sample, of second
        order in the step but for steps with an event. At rest it is what is held.
    events : tuple of Event
    energy_j : mapping of str to float
        ``handwheel`` and ``load`` (work put in), ``stored_first``, ``stored_last``, ``dry``, ``viscous``, ``curved``
        (heat; curved is drag and one-sided viscous friction), ``turnover`` and ``residual``.
    """

    handwheel_rad: np.ndarray
    friction_nm: np.ndarray
    events: tuple[Event, ...]
    energy_j: Mapping[str, float]

    @property
    def balanced(self) -> bool:
        """Whether the energy that the numbers do not account for is below a hundredth of what was turned over."""
        return abs(self.energy_j["residual"]) <= LARGEST_RESIDUAL * self.energy_j["turnover"]

    def figure(self) -> Any:
        """Return angles over time with stick shaded, phase portrait, friction over speed and energies (plotly)."""
        from ..report.free_run import free_run

        return free_run(self)

    def to_dict(self) -> dict[str, Any]:
        """Return the trace as plain JSON values."""
        return {
            **super().to_dict(),
            "handwheel_rad": self.handwheel_rad.tolist(),
            "friction_nm": self.friction_nm.tolist(),
            "events": [e.to_dict() for e in self.events],
            "energy_j": dict(self.energy_j),
            "balanced": self.balanced,
        }

    def __str__(self) -> str:
        counts = {kind: sum(e.kind == kind for e in self.events) for kind in EVENT_KINDS}
        told = ", ".join(f"{n} {kind}" for kind, n in counts.items() if n) or "none"
        e = self.energy_j
        lines = [
            super().__str__(),
            f"events: {told}",
            f"energy: handwheel {e['handwheel']:.4g} J, load {e['load']:.4g} J; dry {e['dry']:.4g} J, viscous "
            f"{e['viscous']:.4g} J, other {e['curved']:.4g} J; residual {e['residual']:.2g} J",
        ]
        if not self.balanced:
            lines.append("The energy does not add up: take more substeps.")
        return "\n".join(lines)

    __repr__ = __str__
