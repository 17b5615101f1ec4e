"""One free run solved exactly: closed form between events, events to rounding."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from .. import _core
from .._arrays import number, vector, whole_number
from ..errors import ParameterError
from . import lanes
from .signal import Signal, drive
from .trajectory import EVENT_KINDS, Event, Trajectory

# What makes a mechanism linear between events.
PIECEWISE_LINEAR = frozenset(
    {
        "steering.inertia_kg_m2",
        "steering.ratio",
        "steering.stiffness_nm_per_rad",
        "steering.aligning_nm_per_rad",
        "freeplay.gap_rad",
        "viscous.coefficient_nm_s_per_rad",
        "asymmetric_viscous.difference_nm_s_per_rad",
        "coulomb.level_nm",
        "asymmetric_coulomb.difference_nm",
        "stiction.extra_nm",
    }
)
# Far more than a mechanism has in an hour; a run with more has a mistake in it.
MOST_EVENTS = 100_000


@dataclass(frozen=True)
class ExactEvent(Event):
    """One event of an exact run.

    Attributes
    ----------
    angle_rad : float
        Of the body; for contact and release, how far the spring's driven end is ahead of its other end.
    element : int
        Number of the body, or of the spring for contact and release.
    """

    angle_rad: float
    element: int = 0

    def to_dict(self) -> dict[str, Any]:
        """Return the event as plain JSON values."""
        return {**super().to_dict(), "angle_rad": self.angle_rad, "element": self.element}


@dataclass(frozen=True)
class Exact(Trajectory):
    """What :func:`exact` returns: a trajectory at the times asked for, and its events.

    Attributes
    ----------
    events : tuple of ExactEvent
    """

    events: tuple[ExactEvent, ...]

    def to_dict(self) -> dict[str, Any]:
        """Return the trajectory as plain JSON values."""
        return {**super().to_dict(), "events": [e.to_dict() for e in self.events]}

    def __str__(self) -> str:
        counts = {kind: sum(e.kind == kind for e in self.events) for kind in EVENT_KINDS}
        told = ", ".join(f"{n} {kind}" for kind, n in counts.items() if n) or "none"
        return f"{super().__str__()}\nevents: {told}"

    __repr__ = __str__


def exact(
    parameters: Mapping[str, float],
    handwheel_rad: Signal | float,
    times_s: Any,
    *,
    load_nm: Signal | float = 0.0,
    start_rad: float = 0.0,
    start_speed_rad_s: float = 0.0,
    ground_speed_rad_s: float = 0.0,
    most_events: int = MOST_EVENTS,
) -> Exact:
    """Solve the steering model by its closed form from event to event.

    Between two events a mechanism of linear springs, a gap, viscous and dry friction is linear; its motion is the
    exponential of a matrix, summed to rounding. Where a mode ends is isolated by bounds on the motion, not by looking
    at samples of it, and located to rounding: about 1e-15 of the time.

    Parameters
    ----------
    parameters : mapping of str to float
        As :func:`simulate` takes them, one value each. Hardening, drag and Stribeck friction are not piecewise linear
        and are refused.
    handwheel_rad, load_nm : Signal or float
        The handwheel's angle and the torque on the road wheel.
    times_s : array_like, shape (n,)
        Where the motion is wanted, not decreasing; the run starts at the first.
    start_rad, start_speed_rad_s : float
        At ``times_s[0]``. A start with the speed of the ground is at rest on it.
    ground_speed_rad_s : float
        Speed of what the body rubs on (a belt): dry and viscous friction act on the motion relative to it.
    most_events : int, >= 1

    Returns
    -------
    Exact

    Raises
    ------
    ParameterError
        What :func:`simulate` refuses, an effect that is not piecewise linear, times that decrease or lie beyond a
        sampled drive, more events than allowed.

    Examples
    --------
    >>> import luztar
    >>> body = {"steering.inertia_kg_m2": 1.0, "steering.ratio": 1.0, "steering.stiffness_nm_per_rad": 1.0,
    ...         "coulomb.level_nm": 0.1}
    >>> run = luztar.dynamics.exact(body, 0.0, [0.0, 20.0], start_rad=1.03)
    >>> [e.kind for e in run.events]
    ['slip', 'reversal', 'reversal', 'reversal', 'reversal', 'stick']
    >>> round(float(run.roadwheel_rad[-1]), 12)
    -0.03
    """
    table, many = lanes.table(parameters)
    if many:
        raise ParameterError("there are several lanes", "parameters", "Give one value each, or call simulate.")
    for key, value in parameters.items():
        if key not in PIECEWISE_LINEAR and float(value) != 0.0:
            raise ParameterError(
                f"{key} is {value}, and its law is not piecewise linear",
                key,
                "Leave it out, or call simulate, whose step takes it.",
            )
    times = vector("times_s", times_s)
    angle, speed, events = _core.solve_steering_exactly(
        table[0],
        (number("start_rad", start_rad), number("start_speed_rad_s", start_speed_rad_s)),
        drive("handwheel_rad", handwheel_rad, times),
        drive("load_nm", load_nm, times),
        ground_speed=number("ground_speed_rad_s", ground_speed_rad_s),
        times_s=times,
        most_events=whole_number("most_events", most_events, 1, 2**53),
    )
    told = tuple(ExactEvent(t, kind, way, angle_rad, element) for t, kind, way, element, angle_rad in events)
    return Exact(times, angle[0], speed[0], told)
