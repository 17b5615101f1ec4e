"""The step steer: how quickly and how far yaw rate and lateral acceleration follow the handwheel."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, fields
from typing import Any

import numpy as np

from .._arrays import number
from ..errors import ParameterError
from .car import Car
from .run_cars import simulate
from .signals import Pieces

# Share of the steady value at which a response is counted as having come.
RESPONDED = 0.9
START_S = 0.5
# Of the largest value: what changes by more over the last tenth of the time is not steady.
STEADY = 0.02


@dataclass(frozen=True)
class StepSteer:
    """Figures of a step steer, each of shape (cars,) or a number.

    Times run from the instant at which half of the handwheel angle is there.

    Attributes
    ----------
    yaw_rate_gain_per_s, lateral_acceleration_gain_m_s2_per_rad : ndarray or float
        Steady value per handwheel angle.
    yaw_rate_response_time_s, lateral_acceleration_response_time_s : ndarray or float
        Until nine tenths of the steady value.
    yaw_rate_peak_time_s, lateral_acceleration_peak_time_s : ndarray or float
        Until the largest value.
    yaw_rate_overshoot, lateral_acceleration_overshoot : ndarray or float
        What the largest value exceeds the steady one by, as a share of it.
    sideslip_rad : ndarray or float
        Steady sideslip angle.
    tb_factor_s_rad : ndarray or float
        Peak time of the yaw rate times the size of the steady sideslip angle.
    """

    yaw_rate_gain_per_s: Any
    lateral_acceleration_gain_m_s2_per_rad: Any
    yaw_rate_response_time_s: Any
    lateral_acceleration_response_time_s: Any
    yaw_rate_peak_time_s: Any
    lateral_acceleration_peak_time_s: Any
    yaw_rate_overshoot: Any
    lateral_acceleration_overshoot: Any
    sideslip_rad: Any
    tb_factor_s_rad: Any

    def to_dict(self) -> dict[str, Any]:
        """Return the figures as plain JSON values."""
        return {f.name: np.asarray(getattr(self, f.name)).tolist() for f in fields(self)}


def step_steer(
    car: Car,
    *,
    speed_m_s: Any,
    handwheel_rad: float,
    rise_s: float = 0.15,
    duration_s: float = 8.0,
    step_s: float = 0.0025,
    model: str = "lateral_roll",
    tyre: str | None = None,
    vary: Mapping[str, Any] | None = None,
) -> StepSteer:
    """Turn the handwheel quickly to an angle and hold it.

    The handwheel rises along half a cosine. Of the kind of ISO 7401; its text was not at hand, the figures are defined
    in :class:`StepSteer`.

    Parameters
    ----------
    car : Car
    speed_m_s : float or array_like, shape (cars,)
    handwheel_rad : float
        The angle that is held.
    rise_s : float
        How long the handwheel turns.
    duration_s : float
        From the beginning of the turn; the last tenth is the steady state.
    step_s, model, tyre, vary
        As :func:`simulate`.

    Raises
    ------
    ParameterError
        As :func:`simulate`; an angle of 0; a car that does not come to a steady turn.
    """
    angle, rise = number("handwheel_rad", handwheel_rad), number("rise_s", rise_s)
    if angle == 0.0:
        raise ParameterError("handwheel_rad is 0", "handwheel_rad", "Give an angle to turn to.")
    if not rise > 0.0:
        raise ParameterError(f"rise_s is {rise}", "rise_s", "Give a positive number of seconds.")
    hand = Pieces(
        start_s=[0.0, START_S, START_S + rise],
        level=[0.0, 0.5 * angle, angle],
        amplitude=[0.0, 0.5 * angle, 0.0],
        frequency_hz=[0.0, 0.5 / rise, 0.0],
        phase_rad=[0.0, -0.5 * np.pi, 0.0],
    )
    run = simulate(
        car,
        handwheel_rad=hand,
        speed_m_s=speed_m_s,
        duration_s=START_S + number("duration_s", duration_s),
        step_s=step_s,
        model=model,
        tyre=tyre,
        vary=vary,
    )
    since = run.time_s - START_S - 0.5 * rise
    steady = _becomes_steady(run.yaw_rate_rad_s) & np.atleast_1d(run.x_m[..., -1] != run.x_m[..., -2])
    if not steady.all():
        which = f" of car {int(np.argmin(steady))}" if steady.size > 1 else ""
        raise ParameterError(
            f"the yaw rate{which} does not become steady within {duration_s:g} s, or the car spins",
            "handwheel_rad",
            "Turn less, drive slower, or give a longer duration_s: gain and overshoot refer to the steady value.",
        )
    yaw = step_figures(since, run.yaw_rate_rad_s)
    side = step_figures(since, run.lateral_acceleration_m_s2)
    last = run.time_s >= run.time_s[-1] - 0.1 * duration_s
    # In a steady turn the yaw rate times the speed is the lateral acceleration.
    speed = side["steady"] / yaw["steady"]
    sideslip = np.arctan(run.lateral_speed_m_s[..., last].mean(axis=-1) / speed)
    return StepSteer(
        yaw_rate_gain_per_s=yaw["steady"] / angle,
        lateral_acceleration_gain_m_s2_per_rad=side["steady"] / angle,
        yaw_rate_response_time_s=yaw["response"],
        lateral_acceleration_response_time_s=side["response"],
        yaw_rate_peak_time_s=yaw["peak"],
        lateral_acceleration_peak_time_s=side["peak"],
        yaw_rate_overshoot=yaw["overshoot"],
        lateral_acceleration_overshoot=side["overshoot"],
        sideslip_rad=sideslip,
        tb_factor_s_rad=yaw["peak"] * np.abs(sideslip),
    )


def _becomes_steady(response: np.ndarray) -> np.ndarray:
    """Whether responses (n,) or (cars, n) change by less than :data:`STEADY` over their last tenth."""
    rows = np.atleast_2d(response)
    tail = rows[:, -max(2, rows.shape[1] // 10) :]
    return np.ptp(tail, axis=1) <= STEADY * np.abs(rows).max(axis=1)


def step_figures(time_s: np.ndarray, response: np.ndarray) -> dict[str, Any]:
    """Return steady value, response time, peak time and overshoot of responses (n,) or (cars, n).

    Times between samples by a line (response) and a parabola (peak). A response that does not exceed its steady value
    has its peak where it is largest, and no overshoot.
    """
    rows = np.atleast_2d(response)
    last = time_s >= time_s[-1] - 0.1 * (time_s[-1] - time_s[0])
    steady = rows[:, last].mean(axis=1)
    # A response to the right is turned around.
    share = rows / np.where(steady == 0.0, np.inf, steady)[:, np.newaxis]
    come = np.full(len(rows), np.nan)
    peak, height = np.empty(len(rows)), np.empty(len(rows))
    for i, row in enumerate(share):
        above = np.flatnonzero(row >= RESPONDED)
        if above.size and above[0] > 0:
            k = above[0]
            part = (RESPONDED - row[k - 1]) / (row[k] - row[k - 1])
            come[i] = time_s[k - 1] + part * (time_s[k] - time_s[k - 1])
        k = min(max(int(np.argmax(row)), 1), row.size - 2)
        bend = row[k - 1] - 2.0 * row[k] + row[k + 1]
        shift = 0.5 * (row[k - 1] - row[k + 1]) / bend if bend < 0.0 else 0.0
        peak[i] = time_s[k] + shift * (time_s[1] - time_s[0])
        height[i] = row[k] - 0.25 * (row[k - 1] - row[k + 1]) * shift
    told = {"steady": steady, "response": come, "peak": peak, "overshoot": np.maximum(height - 1.0, 0.0)}
    return told if response.ndim == 2 else {name: value[0] for name, value in told.items()}
