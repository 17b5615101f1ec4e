"""What a simulated drive gives back."""

from __future__ import annotations

from dataclasses import dataclass, fields
from typing import Any

import numpy as np


@dataclass(frozen=True)
class Drive:
    """What :func:`simulate` returns. Axes of ISO 8855: x forward, y to the left, angles positive to the left.

    Attributes
    ----------
    time_s : ndarray, shape (n,)
    handwheel_rad, roadwheel_rad, roadwheel_speed_rad_s, rearwheel_rad : ndarray, shape (n,) or (cars, n)
        A road-wheel speed of exactly 0 is stick.
    column_torque_nm : ndarray
        Torque in the column spring, as the handwheel feels it.
    tyre_torque_nm : ndarray
        Torque of the front tyres on the king-pins, M_phi of the paper's equation (5).
    lateral_acceleration_m_s2, lateral_speed_m_s, yaw_rate_rad_s, yaw_rad, x_m, y_m : ndarray
        Of the point below the centre of mass.
    roll_rad, roll_rate_rad_s : ndarray
        To the right positive: outward in a turn to the left.
    heave_m, pitch_rad : ndarray
        Of the body, up and nose down; 0 where the model has none.
    load_front_left_n, load_front_right_n, load_rear_left_n, load_rear_right_n : ndarray
        What the wheels carry.
    """

    time_s: np.ndarray
    handwheel_rad: np.ndarray
    roadwheel_rad: np.ndarray
    roadwheel_speed_rad_s: np.ndarray
    rearwheel_rad: np.ndarray
    column_torque_nm: np.ndarray
    tyre_torque_nm: np.ndarray
    lateral_acceleration_m_s2: np.ndarray
    lateral_speed_m_s: np.ndarray
    yaw_rate_rad_s: np.ndarray
    yaw_rad: np.ndarray
    x_m: np.ndarray
    y_m: np.ndarray
    roll_rad: np.ndarray
    roll_rate_rad_s: np.ndarray
    heave_m: np.ndarray
    pitch_rad: np.ndarray
    load_front_left_n: np.ndarray
    load_front_right_n: np.ndarray
    load_rear_left_n: np.ndarray
    load_rear_right_n: np.ndarray

    def to_dict(self) -> dict[str, Any]:
        """Return the drive as plain JSON values."""
        return {f.name: getattr(self, f.name).tolist() for f in fields(self)}

    def __str__(self) -> str:
        cars = 1 if self.x_m.ndim == 1 else len(self.x_m)
        most = float(np.abs(self.lateral_acceleration_m_s2).max())
        return f"{cars} car{'s' if cars > 1 else ''}, {self.time_s[-1]:g} s; lateral acceleration up to {most:.3g} m/s2"

    __repr__ = __str__
