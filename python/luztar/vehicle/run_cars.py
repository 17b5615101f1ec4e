"""Cars driven side by side: whole traces, or what the criterion needs of each."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

import numpy as np

from .._arrays import whole_number
from .car import CHANNELS, SUMMARY_COLUMNS, Car
from .corridor import Corridor
from .drive import Drive
from .fleet import fleet

# Cars between two looks for an interrupt: 12 s at 0.1 to 0.2 ms each are a tenth of a second.
CHUNK = 1024


def simulate(
    car: Car,
    *,
    handwheel_rad: Any = None,
    torque_nm: Any = None,
    speed_m_s: Any,
    duration_s: Any,
    step_s: float = 0.0025,
    every: int = 1,
    model: str = "single_track",
    tyre: str | None = None,
    vary: Mapping[str, Any] | None = None,
    start: Mapping[str, Any] | None = None,
    width: str = "widest",
) -> Drive:
    """Drive a car, or many of them side by side.

    Parameters
    ----------
    car : Car
    handwheel_rad, torque_nm : Pieces, Samples, float or array_like, shape (cars,)
        What the driver gives, one of the two: the angle of the handwheel, or a torque on it. Under a torque the
        handwheel is a body of its own (``handwheel.inertia_kg_m2`` ...). Signals may have one row per car.
    speed_m_s : float, array_like of shape (cars,), Pieces or Samples, > 0
        The forward speed; whatever drives the car keeps it.
    duration_s : float or array_like, shape (cars,), > 0
        A car whose time is over stands still in the trace.
    step_s : float
        Too long a step is refused with the part of the car that does not allow it.
    every : int
        Steps from one sample of the trace to the next.
    model : {"single_track", "lateral_roll", "twelve"}
    tyre : {"linear", "brush", "magic_formula"}, optional
        The car's own where not given.
    vary : mapping of str to float or array_like, shape (cars,)
        Parameters that differ from the car's, any by name.
    start : mapping of str to float or array_like, shape (cars,)
        ``x_m``, ``y_m``, ``yaw_rad``, ``lateral_speed_m_s``, ``yaw_rate_rad_s``, ``roll_rad``, ``roll_rate_rad_s``,
        ``roadwheel_rad``, ``roadwheel_speed_rad_s``, ``handwheel_rad``, ``handwheel_speed_rad_s`` (the last two under a
        torque); 0 where not given.
    width : {"widest", "avx512", "avx2", "baseline"}
        Instruction set, for tests: the bits are the same.

    Returns
    -------
    Drive

    Raises
    ------
    ParameterError
        Names the parameter, its value and what it must be.

    Notes
    -----
    Second order in the step, through the events of friction and gap; beyond 45 degrees of sideslip a car stands still.

    Examples
    --------
    >>> import luztar
    >>> car = luztar.vehicle.Car.named("bmw_320i")
    >>> hand = luztar.vehicle.Pieces(start_s=[1.0, 3.5], amplitude=[0.8, 0.0], frequency_hz=0.4)
    >>> run = luztar.vehicle.simulate(car, handwheel_rad=hand, speed_m_s=20.0, duration_s=5.0,
    ...                               vary={"freeplay.gap_rad": [0.0, 0.1]})
    >>> run.yaw_rate_rad_s.shape
    (2, 2001)
    """
    every = whole_number("every", every, 1, 1_000_000_000)
    made = fleet(
        car,
        handwheel_rad=handwheel_rad,
        torque_nm=torque_nm,
        speed_m_s=speed_m_s,
        duration_s=duration_s,
        step_s=step_s,
        model=model,
        tyre=tyre,
        vary=vary,
        start=start,
        corridor=None,
        width=width,
    )
    traces = made.run(slice(None), every=every, summary=False)
    channels = {name: traces[:, i] if made.many else traces[0, i] for i, name in enumerate(CHANNELS)}
    return Drive(time_s=np.arange(traces.shape[2]) * (every * made.step_s), **channels)


def summarise(
    car: Car,
    *,
    handwheel_rad: Any = None,
    torque_nm: Any = None,
    speed_m_s: Any,
    duration_s: Any,
    step_s: float = 0.0025,
    corridor: Corridor | None = None,
    model: str = "single_track",
    tyre: str | None = None,
    vary: Mapping[str, Any] | None = None,
    start: Mapping[str, Any] | None = None,
    width: str = "widest",
    progress: Callable[[int, int], None] | None = None,
) -> dict[str, np.ndarray]:
    """Drive many cars and keep the terms of the criterion and extremes of each: memory does not grow with the run.

    Arguments are those of :func:`simulate`; cars are run a thousand at a time, so that an interrupt is heard and
    ``progress`` is called with (cars done, cars).

    Parameters
    ----------
    corridor : Corridor, optional
        Where to stay.

    Returns
    -------
    dict of str to ndarray, shape (cars,)
        ``handwheel_rate_mean_square_rad2_s2`` (of pieces in closed form; jumps between them count nothing),
        ``lateral_acceleration_max_m_s2``, ``clearance_left_min_m`` and ``clearance_right_min_m`` (least distance of the
        body's sides from the edges, across the corridor; negative outside, infinite where no section was reached),
        ``clearance_min_m`` of both, ``outside_m_s`` (integral over time of the distance outside), extremes of other
        channels, ``roadwheel_at_rest_share``, ``spun_s`` (when the sideslip passed 45 degrees and the run ended;
        infinite where it did not), and the state at the end.

    Raises
    ------
    ParameterError
        As :func:`simulate`.

    Examples
    --------
    >>> import luztar
    >>> car = luztar.vehicle.Car.named("bmw_320i")
    >>> hand = luztar.vehicle.Pieces(start_s=[1.0, 3.5], amplitude=[0.8, 0.0], frequency_hz=0.4)
    >>> lane = luztar.vehicle.Corridor(from_m=0.0, to_m=[30.0], right_m=-1.5, left_m=1.5)
    >>> kept = luztar.vehicle.summarise(car, handwheel_rad=hand, speed_m_s=[15.0, 20.0], duration_s=5.0, corridor=lane)
    >>> kept["clearance_min_m"].round(3).tolist()
    [-0.33, 0.521]
    """
    made = fleet(
        car,
        handwheel_rad=handwheel_rad,
        torque_nm=torque_nm,
        speed_m_s=speed_m_s,
        duration_s=duration_s,
        step_s=step_s,
        model=model,
        tyre=tyre,
        vary=vary,
        start=start,
        corridor=corridor,
        width=width,
    )
    count = len(made.cars)
    out = np.empty((count, len(SUMMARY_COLUMNS)))
    for first in range(0, count, CHUNK):
        part = slice(first, first + CHUNK)
        out[part] = made.run(part, every=1, summary=True)
        if progress is not None:
            progress(min(first + CHUNK, count), count)
    kept = {name: out[:, i].copy() for i, name in enumerate(SUMMARY_COLUMNS)}
    kept["clearance_min_m"] = np.minimum(kept["clearance_left_min_m"], kept["clearance_right_min_m"])
    return kept
