//! The channels of a recorded run.

/// Their names.
pub const CHANNELS: [&str; 20] = [
    "handwheel_rad",
    "roadwheel_rad",
    "roadwheel_speed_rad_s",
    "rearwheel_rad",
    "column_torque_nm",
    "tyre_torque_nm",
    "lateral_acceleration_m_s2",
    "lateral_speed_m_s",
    "yaw_rate_rad_s",
    "yaw_rad",
    "x_m",
    "y_m",
    "roll_rad",
    "roll_rate_rad_s",
    "heave_m",
    "pitch_rad",
    "load_front_left_n",
    "load_front_right_n",
    "load_rear_left_n",
    "load_rear_right_n",
];
