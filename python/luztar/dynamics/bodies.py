"""Several bodies solved exactly: linear springs and dampers, springs with gaps, dry friction on own coordinates."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from .. import _core
from .._arrays import number, rows, vector, whole_number
from ..errors import ParameterError
from .exact import MOST_EVENTS, ExactEvent
from .signal import Signal, drive


@dataclass(frozen=True)
class GapSpring:
    """A spring with a gap: torque ``stiffness * luz(end - at . q, gap / 2)``, body i is pulled by ``at[i]`` times it.

    Attributes
    ----------
    stiffness : float, >= 0
    gap : float, >= 0
        Full width.
    at : sequence of float, shape (n,)
        How much each body moves the spring's end: 1 and -1 between two bodies, a ratio behind a gear.
    end : Signal or float
        Where the driven end is; 0 where the spring ends at the ground or between bodies.
    """

    stiffness: float
    gap: float
    at: Sequence[float]
    end: Signal | float = 0.0


@dataclass(frozen=True)
class ExactBodies:
    """What :func:`exact_bodies` returns.

    Attributes
    ----------
    time_s : ndarray, shape (m,)
    angle, speed : ndarray, shape (n, m)
        Of each body; the speed of a body in stick is that of its ground, to the bit.
    events : tuple of ExactEvent
        ``element`` numbers the bodies, for contact and release the springs.
    """

    time_s: np.ndarray
    angle: np.ndarray
    speed: np.ndarray
    events: tuple[ExactEvent, ...]


def exact_bodies(
    inertia: Any,
    times_s: Any,
    *,
    stiffness: Any = None,
    damping: Any = None,
    viscous: Any = 0.0,
    kinetic: Any = 0.0,
    static: Any = None,
    ground_speed: Any = 0.0,
    loads: Sequence[Signal | float] | None = None,
    springs: Sequence[GapSpring] = (),
    start: Any = 0.0,
    start_speed: Any = 0.0,
    most_events: int = MOST_EVENTS,
) -> ExactBodies:
    """Solve several bodies by the closed form of each mode, from event to event, as :func:`exact` does for one.

    ``I q'' + damping q' + stiffness q + friction = loads + springs``, with friction on the coordinate of each body:
    viscous and kinetic against its motion relative to its ground, up to the static level at rest.

    Parameters
    ----------
    inertia : array_like, shape (n,), > 0
        kg m2 with angles in rad, or kg with positions in m; all else in the same units.
    times_s : array_like, shape (m,)
        Where the motion is wanted, not decreasing; the run starts at the first.
    stiffness, damping : array_like, shape (n, n), optional
    viscous, kinetic, static : float or array_like, shape (n,) or (n, 2), >= 0
        Two columns are forward and backward. ``static`` is at least ``kinetic``, which it is if it is not given.
    ground_speed : float or array_like, shape (n,)
    loads : sequence of n Signal or float, optional
    springs : sequence of GapSpring
    start, start_speed : float or array_like, shape (n,)
        At ``times_s[0]``.
    most_events : int, >= 1

    Returns
    -------
    ExactBodies

    Raises
    ------
    ParameterError
        Shapes that do not fit the bodies, an inertia that is not positive, negative friction or gap, static below
        kinetic friction, NaN, times that decrease or lie beyond a sampled drive, more events than allowed.

    Examples
    --------
    >>> import luztar
    >>> spring = luztar.dynamics.GapSpring(stiffness=50.0, gap=0.1, at=[1.0, -1.0])
    >>> run = luztar.dynamics.exact_bodies([1.0, 2.0], [0.0, 9.0], kinetic=[0.3, 0.2], springs=[spring],
    ...                                    start_speed=[1.0, 0.0])
    >>> [e.kind for e in run.events][:3]
    ['contact', 'slip', 'reversal']
    >>> run.speed[:, -1].tolist()
    [0.0, 0.0]
    """
    masses = vector("inertia", inertia)
    n = masses.size
    levels = _sides("kinetic", kinetic, n)
    columns = [
        masses[:, np.newaxis],
        _sides("viscous", viscous, n),
        levels,
        levels if static is None else _sides("static", static, n),
        _each("ground_speed", ground_speed, n)[:, np.newaxis],
    ]
    times = vector("times_s", times_s)
    given = [0.0] * n if loads is None else list(loads)
    if len(given) != n:
        raise ParameterError(f"there are {len(given)} loads for {n} bodies", "loads", "Give one load per body.")
    starts = np.column_stack((_each("start", start, n), _each("start_speed", start_speed, n)))
    angle, speed, events = _core.solve_bodies_exactly(
        np.hstack(columns),
        [drive(f"loads[{i}]", load, times) for i, load in enumerate(given)],
        _square("stiffness", stiffness, n),
        _square("damping", damping, n),
        [_spring(f"springs[{j}]", spring, n, times) for j, spring in enumerate(springs)],
        [tuple(row) for row in starts.tolist()],
        times_s=times,
        most_events=whole_number("most_events", most_events, 1, 2**53),
    )
    told = tuple(ExactEvent(t, kind, way, place, element) for t, kind, way, element, place in events)
    return ExactBodies(times, angle, speed, told)


def _spring(name: str, spring: GapSpring, n: int, times_s: np.ndarray) -> tuple[float, float, np.ndarray, Any]:
    for key in ("stiffness", "gap"):
        value = number(f"{name}.{key}", getattr(spring, key))
        if not (math.isfinite(value) and value >= 0.0):
            raise ParameterError(f"{name}.{key} is {value}", f"{name}.{key}", "Give a number that is not negative.")
    at = vector(f"{name}.at", spring.at)
    if at.size != n:
        raise ParameterError(f"{name}.at holds {at.size} values for {n} bodies", f"{name}.at", "Give one per body.")
    return float(spring.stiffness), float(spring.gap) / 2.0, at, drive(f"{name}.end", spring.end, times_s)


def _each(name: str, value: Any, n: int) -> np.ndarray:
    """Return one value per body."""
    array = np.asarray(value, dtype=np.float64)
    if array.shape not in ((), (n,)):
        raise ParameterError(f"{name} has the shape {array.shape}", name, f"Give a number, or {n}: one per body.")
    return np.broadcast_to(array, (n,))


def _sides(name: str, value: Any, n: int) -> np.ndarray:
    """Return a forward and a backward value per body."""
    array = np.asarray(value, dtype=np.float64)
    if array.shape == (n, 2):
        return array
    return np.repeat(_each(name, array, n)[:, np.newaxis], 2, axis=1)


def _square(name: str, value: Any, n: int) -> np.ndarray:
    """Return a matrix over the bodies."""
    matrix = np.zeros((n, n)) if value is None else rows(name, value, n)
    if matrix.shape != (n, n):
        raise ParameterError(f"{name} has the shape {matrix.shape}", name, f"Give a matrix of {n} by {n}.")
    return matrix
