//! Where a car starts.

use crate::Error;
use crate::error::require_finite;

/// How many numbers a start has.
pub const STARTS: usize = 11;

/// Their names, in the order of [`Start::from_array`].
pub const START_NAMES: [&str; STARTS] = [
    "x_m",
    "y_m",
    "yaw_rad",
    "lateral_speed_m_s",
    "yaw_rate_rad_s",
    "roll_rad",
    "roll_rate_rad_s",
    "roadwheel_rad",
    "roadwheel_speed_rad_s",
    "handwheel_rad",
    "handwheel_speed_rad_s",
];

/// Place, motion and steering at the start; the slip of a lagging tyre starts at 0.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Start {
    /// m
    pub x: f64,
    /// m
    pub y: f64,
    /// rad
    pub yaw: f64,
    /// m/s, to the left
    pub lateral_speed: f64,
    /// rad/s
    pub yaw_rate: f64,
    /// rad, to the right
    pub roll: f64,
    /// rad/s
    pub roll_rate: f64,
    /// rad
    pub roadwheel: f64,
    /// rad/s
    pub roadwheel_speed: f64,
    /// rad; a state under steering torque only
    pub handwheel: f64,
    /// rad/s
    pub handwheel_speed: f64,
}

impl Start {
    /// Reads a start in the order of [`START_NAMES`].
    ///
    /// # Errors
    /// [`Error::NonFinite`], with the index in that order.
    pub fn from_array(values: &[f64; STARTS]) -> Result<Self, Error> {
        require_finite("start", values)?;
        let [
            x,
            y,
            yaw,
            lateral_speed,
            yaw_rate,
            roll,
            roll_rate,
            roadwheel,
            roadwheel_speed,
            handwheel,
            handwheel_speed,
        ] = *values;
        Ok(Self {
            x,
            y,
            yaw,
            lateral_speed,
            yaw_rate,
            roll,
            roll_rate,
            roadwheel,
            roadwheel_speed,
            handwheel,
            handwheel_speed,
        })
    }
}
