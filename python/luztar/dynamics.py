"""Free runs of the steering model: handwheel angle in, motion out, many parameter sets at once.

The model is the seed paper's equation (5): one mass at the road wheel, driven through ratio, column spring and freeplay
by the handwheel, braked by dry and viscous friction. At rest the speed is exactly 0: nothing creeps and nothing
chatters.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from types import MappingProxyType
from typing import Any

import numpy as np

from . import _core
from ._arrays import number, vector, whole_number
from .errors import ParameterError

# Key as in model files and JSON: column of the core.
COLUMNS: Mapping[str, str] = MappingProxyType(
    {
        "steering.inertia_kg_m2": "inertia_kg_m2",
        "steering.ratio": "ratio",
        "steering.stiffness_nm_per_rad": "stiffness_nm_per_rad",
        "steering.aligning_nm_per_rad": "aligning_nm_per_rad",
        "freeplay.gap_rad": "gap_rad",
        "hardening.coefficient_nm_per_rad3": "hardening_nm_per_rad3",
        "viscous.coefficient_nm_s_per_rad": "viscous_nm_s_per_rad",
        "asymmetric_viscous.difference_nm_s_per_rad": "asymmetric_viscous_nm_s_per_rad",
        "drag.coefficient_nm_s2_per_rad2": "drag_nm_s2_per_rad2",
        "coulomb.level_nm": "coulomb_nm",
        "asymmetric_coulomb.difference_nm": "asymmetric_coulomb_nm",
        "stribeck.extra_nm": "stribeck_nm",
        "stribeck.speed_rad_s": "stribeck_speed_rad_s",
        "stiction.extra_nm": "stiction_nm",
    }
)
METHODS = ("split", "moreau_jean")
# Lanes between two looks for an interrupt: 2 s of run at 1 ms each are 10^7 lane-steps, a tenth of a second.
CHUNK = 4096


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
class Trace(Trajectory):
    """What :func:`trace` returns: a trajectory with its events and energies.

    Attributes
    ----------
    handwheel_rad : ndarray, shape (n,)
    events : tuple of Event
    energy_j : mapping of str to float
        ``handwheel`` and ``load`` (work put in), ``stored_first``, ``stored_last``, ``dry``, ``viscous``, ``curved``
        (heat; curved is drag and one-sided viscous friction), ``turnover`` and ``residual``.
    """

    handwheel_rad: np.ndarray
    events: tuple[Event, ...]
    energy_j: Mapping[str, float]

    @property
    def balanced(self) -> bool:
        """Whether the energy that the numbers do not account for is below a hundredth of what was turned over."""
        return abs(self.energy_j["residual"]) <= LARGEST_RESIDUAL * self.energy_j["turnover"]

    def to_dict(self) -> dict[str, Any]:
        """Return the trace as plain JSON values."""
        return {
            **super().to_dict(),
            "handwheel_rad": self.handwheel_rad.tolist(),
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


EVENT_KINDS = ("stick", "slip", "reversal", "contact", "release")
# Of the energy turned over; the residual is of second order in the step, so that a step a third as long has a tenth.
LARGEST_RESIDUAL = 0.01


def table(parameters: Mapping[str, Any]) -> tuple[np.ndarray, bool]:
    """Return parameters as rows of the core's columns, and whether they are many.

    Raises
    ------
    ParameterError
        Names the parameter.
    """
    names = _core.steering_parameters()
    values: dict[str, np.ndarray] = {}
    for key, value in parameters.items():
        if key not in COLUMNS:
            raise ParameterError(f"there is no parameter '{key}'", "parameters", f"Known are: {', '.join(COLUMNS)}.")
        try:
            array = np.asarray(value, dtype=np.float64)
        except (TypeError, ValueError):
            raise ParameterError(f"{key} is {value!r}", key, "Give a number, or one per lane.") from None
        if array.ndim > 1:
            raise ParameterError(f"{key} has the shape {array.shape}", key, "Give a number, or one per lane.")
        values[COLUMNS[key]] = array
    for needed in ("steering.inertia_kg_m2", "steering.ratio", "steering.stiffness_nm_per_rad"):
        if COLUMNS[needed] not in values:
            raise ParameterError(f"{needed} is missing", "parameters", "Give inertia, ratio and stiffness.")
    sizes = {key: a.size for key, a in values.items() if a.ndim == 1}
    lanes = max(sizes.values(), default=1)
    for key, size in sizes.items():
        if size != lanes:
            raise ParameterError(f"{key} has {size} values, others {lanes}", key, "Give one value per lane.")
    if lanes == 0:
        raise ParameterError("there are no lanes", "parameters", "Give at least one value.")
    rows = np.zeros((lanes, len(names)))
    for i, name in enumerate(names):
        rows[:, i] = values.get(name, 0.0)
    return rows, bool(sizes)


def simulate(
    parameters: Mapping[str, Any],
    handwheel_rad: Any,
    *,
    sample_rate_hz: float,
    load_nm: Any = None,
    start_rad: Any = 0.0,
    start_speed_rad_s: Any = 0.0,
    substeps: int = 1,
    method: str = "split",
    width: str = "widest",
) -> Trajectory:
    """Run the steering model along a handwheel angle.

    Parameters
    ----------
    parameters : mapping of str to float or array_like, shape (lanes,)
        Keys as in model files (``steering.inertia_kg_m2``, ``coulomb.level_nm`` ...); what is not given is 0. Arrays
        make lanes: one trajectory per value, side by side.
    handwheel_rad : array_like, shape (n,), n >= 2
        Evenly sampled; between the samples a cubic runs through the four nearest.
    sample_rate_hz : float, > 0
    load_nm : array_like, shape (n,), optional
        Torque on the road wheel.
    start_rad, start_speed_rad_s : float or array_like, shape (lanes,)
    substeps : int, >= 1
        Steps per sampling interval. The step times the highest circular frequency of the springs must stay below 2.
    method : {"split", "moreau_jean"}
        ``split``: second order, reversals and break-aways located inside the step; the default. ``moreau_jean``: first
        order.
    width : {"widest", "avx512", "avx2", "baseline"}
        Instruction set, for tests: the bits are the same. One that the processor lacks gives way to the next.

    Returns
    -------
    Trajectory

    Raises
    ------
    ParameterError
        A negative inertia, friction, gap or step, NaN, a step too large for the stiffest spring: named with its value.

    Examples
    --------
    >>> import numpy as np, luztar
    >>> psi = np.sin(np.pi * np.arange(2001) / 500)
    >>> mechanism = {"steering.inertia_kg_m2": 3.0, "steering.ratio": 16.0, "steering.stiffness_nm_per_rad": 60.0,
    ...              "viscous.coefficient_nm_s_per_rad": 40.0, "coulomb.level_nm": 8.1, "freeplay.gap_rad": 0.1}
    >>> run = luztar.dynamics.simulate(mechanism, psi, sample_rate_hz=500)
    >>> round(float(run.roadwheel_rad.max()), 4)
    0.059
    """
    rows, many = table(parameters)
    psi = vector("handwheel_rad", handwheel_rad, minimum=2)
    load = None if load_nm is None else vector("load_nm", load_nm)
    rate = _rate(sample_rate_hz)
    _check_method(method)
    starts = _starts(len(rows), start_rad, start_speed_rad_s)
    phi, speed = (np.empty((len(rows), psi.size)) for _ in range(2))
    _core.simulate_steering(
        rows,
        starts,
        psi,
        load,
        sample_rate_hz=rate,
        substeps=whole_number("substeps", substeps, 1, 1_000_000),
        method=method,
        width=width,
        phi=phi,
        speed=speed,
    )
    time_s = np.arange(psi.size) / rate
    return Trajectory(time_s, phi, speed) if many else Trajectory(time_s, phi[0], speed[0])


def summarise(
    parameters: Mapping[str, Any],
    handwheel_rad: Any,
    *,
    sample_rate_hz: float,
    load_nm: Any = None,
    start_rad: Any = 0.0,
    start_speed_rad_s: Any = 0.0,
    substeps: int = 1,
    method: str = "split",
    width: str = "widest",
    progress: Callable[[int, int], None] | None = None,
) -> dict[str, np.ndarray]:
    """Run many mechanisms and keep a few numbers of each: memory does not grow with the length of the run.

    Arguments are those of :func:`simulate`. Lanes are run a few thousand at a time, so that an interrupt is heard and
    ``progress`` is called with (lanes done, lanes).

    Returns
    -------
    dict of str to ndarray, shape (lanes,)
        ``last_rad``, ``last_speed_rad_s``, ``peak_rad``, ``rms_rad`` of the road wheel's samples, and
        ``at_rest_share``, the share of the samples at which it stood.

    Raises
    ------
    ParameterError
        As :func:`simulate`.

    Examples
    --------
    >>> import numpy as np, luztar
    >>> psi = np.sin(np.pi * np.arange(2001) / 500)
    >>> mechanism = {"steering.inertia_kg_m2": 3.0, "steering.ratio": 16.0, "steering.stiffness_nm_per_rad": 60.0,
    ...              "viscous.coefficient_nm_s_per_rad": 40.0, "coulomb.level_nm": np.array([0.0, 8.0, 2000.0])}
    >>> luztar.dynamics.summarise(mechanism, psi, sample_rate_hz=500)["at_rest_share"].round(2).tolist()
    [0.0, 0.05, 1.0]
    """
    rows, _ = table(parameters)
    psi = vector("handwheel_rad", handwheel_rad, minimum=2)
    load = None if load_nm is None else vector("load_nm", load_nm)
    rate = _rate(sample_rate_hz)
    _check_method(method)
    starts = _starts(len(rows), start_rad, start_speed_rad_s)
    steps = whole_number("substeps", substeps, 1, 1_000_000)
    names = _core.steering_summary_names()
    out = np.empty((len(rows), len(names)))
    for first in range(0, len(rows), CHUNK):
        part = slice(first, first + CHUNK)
        _core.summarise_steering(
            rows[part],
            starts[part],
            psi,
            load,
            sample_rate_hz=rate,
            substeps=steps,
            method=method,
            width=width,
            out=out[part],
        )
        if progress is not None:
            progress(min(first + CHUNK, len(rows)), len(rows))
    return {name: out[:, i].copy() for i, name in enumerate(names)}


def _rate(sample_rate_hz: Any) -> float:
    rate = number("sample_rate_hz", sample_rate_hz)
    if not (math.isfinite(rate) and rate > 0.0):
        raise ParameterError(f"sample_rate_hz is {rate}", "sample_rate_hz", "Give a positive number of Hz.")
    return rate


def _check_method(method: str) -> None:
    if method not in METHODS:
        raise ParameterError(f"there is no method {method!r}", "method", f"Known are: {', '.join(METHODS)}.")


def _starts(lanes: int, angle_rad: Any, speed_rad_s: Any) -> np.ndarray:
    starts = np.zeros((lanes, 2))
    for column, (name, value) in enumerate((("start_rad", angle_rad), ("start_speed_rad_s", speed_rad_s))):
        array = np.asarray(value, dtype=np.float64)
        if array.ndim > 1 or array.size not in (1, lanes):
            raise ParameterError(f"{name} has the shape {array.shape}", name, "Give a number, or one per lane.")
        starts[:, column] = array
    return starts


def trace(
    parameters: Mapping[str, float],
    handwheel_rad: Any,
    *,
    sample_rate_hz: float,
    load_nm: Any = None,
    start_rad: float = 0.0,
    start_speed_rad_s: float = 0.0,
    substeps: int = 1,
    method: str = "split",
) -> Trace:
    """Run one mechanism and keep what happened: every event with its instant, and where the energy went.

    Parameters are those of :func:`simulate`, one value each; the samples have the same bits.

    Raises
    ------
    ParameterError
        As :func:`simulate`.
    """
    rows, many = table(parameters)
    if many:
        raise ParameterError("there are several lanes", "parameters", "Give one value each, or call simulate.")
    psi = vector("handwheel_rad", handwheel_rad, minimum=2)
    load = None if load_nm is None else vector("load_nm", load_nm)
    rate = number("sample_rate_hz", sample_rate_hz)
    start = (number("start_rad", start_rad), number("start_speed_rad_s", start_speed_rad_s))
    steps = whole_number("substeps", substeps, 1, 1_000_000)
    phi, speed, events, energies = _core.trace_steering(
        rows, start, psi, load, sample_rate_hz=rate, substeps=steps, method=method
    )
    return Trace(
        time_s=np.arange(psi.size) / rate,
        roadwheel_rad=phi,
        speed_rad_s=speed,
        handwheel_rad=psi,
        events=tuple(Event(t, kind, int(direction)) for t, kind, direction in events),
        energy_j=MappingProxyType(dict(energies)),
    )
