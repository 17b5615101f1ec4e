"""The same car in commonroad-vehicle-models (Althoff), driven by the road-wheel angle of a run."""

from __future__ import annotations

from typing import Any

import numpy as np
from scipy.integrate import solve_ivp


def drive(run: Any, speed_m_s: float, *, multi_body: bool) -> dict[str, np.ndarray]:
    """Return time, yaw rate, roll angle and place of BMW 320i (vehicle 2); nothing drives it, it may slow down."""
    from vehiclemodels.init_mb import init_mb
    from vehiclemodels.parameters_vehicle2 import parameters_vehicle2
    from vehiclemodels.vehicle_dynamics_mb import vehicle_dynamics_mb
    from vehiclemodels.vehicle_dynamics_st import vehicle_dynamics_st

    p = parameters_vehicle2()
    core = [0.0, 0.0, float(run.roadwheel_rad[0]), speed_m_s, 0.0, 0.0, 0.0]
    law = vehicle_dynamics_mb if multi_body else vehicle_dynamics_st

    def rates(t: float, x: np.ndarray) -> Any:
        return law(x, [float(np.interp(t, run.time_s, run.roadwheel_speed_rad_s)), 0.0], p)

    solved = solve_ivp(
        rates,
        (0.0, float(run.time_s[-1])),
        init_mb(core, p) if multi_body else core,
        t_eval=run.time_s[::10],
        rtol=1e-6,
        atol=1e-8,
        max_step=0.01,
    )
    return {
        "time_s": solved.t,
        "yaw_rate_rad_s": solved.y[5],
        # Their roll angle is positive to the left.
        "roll_rad": -solved.y[6] if multi_body else np.zeros(solved.t.size),
        "y_m": solved.y[1],
    }
