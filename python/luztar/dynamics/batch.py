"""Free runs of many mechanisms side by side: whole trajectories, or a few numbers of each."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

import numpy as np

from .. import _core
from .._arrays import vector, whole_number
from . import lanes
from .trajectory import Trajectory

# Lanes between two looks for an interrupt: 2 s of run at 1 ms each are 10^7 lane-steps, a tenth of a second.
CHUNK = 4096


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
    rows, many = lanes.table(parameters)
    psi = vector("handwheel_rad", handwheel_rad, minimum=2)
    load = None if load_nm is None else vector("load_nm", load_nm)
    rate = lanes.rate(sample_rate_hz)
    lanes.check_method(method)
    starts = lanes.starts(len(rows), start_rad, start_speed_rad_s)
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
    rows, _ = lanes.table(parameters)
    psi = vector("handwheel_rad", handwheel_rad, minimum=2)
    load = None if load_nm is None else vector("load_nm", load_nm)
    rate = lanes.rate(sample_rate_hz)
    lanes.check_method(method)
    starts = lanes.starts(len(rows), start_rad, start_speed_rad_s)
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
