//! What is kept of a run: the terms of the paper's criterion (6), extremes, the end.

use crate::dynamics::Pure;
use crate::effects::Lane;

use super::step::State;

/// How many numbers are kept of a run.
pub const KEPT: usize = 21;

/// Their names.
pub const SUMMARY: [&str; KEPT] = [
    "handwheel_rate_mean_square_rad2_s2",
    "lateral_acceleration_max_m_s2",
    "lateral_acceleration_mean_square_m2_s4",
    "clearance_left_min_m",
    "clearance_right_min_m",
    "outside_m_s",
    "yaw_rate_max_rad_s",
    "sideslip_max_rad",
    "roll_max_rad",
    "handwheel_max_rad",
    "roadwheel_max_rad",
    "column_torque_max_nm",
    "roadwheel_at_rest_share",
    "wheel_load_min_n",
    "spun_s",
    "end_x_m",
    "end_y_m",
    "end_yaw_rad",
    "end_lateral_speed_m_s",
    "end_yaw_rate_rad_s",
    "end_roadwheel_rad",
];

/// Sums and extremes of a block of lanes.
pub(super) struct Tally<const N: usize> {
    pub rate_square: [f64; N],
    pub side: [f64; N],
    pub side_square: [f64; N],
    pub left: [f64; N],
    pub right: [f64; N],
    pub outside: [f64; N],
    pub yaw_rate: [f64; N],
    pub sideslip: [f64; N],
    pub roll: [f64; N],
    pub handwheel: [f64; N],
    pub roadwheel: [f64; N],
    pub column: [f64; N],
    pub rest: [f64; N],
    pub load: [f64; N],
    pub spun: [f64; N],
}

/// What a lane shows at the start of a step.
#[derive(Debug, Clone, Copy)]
pub(super) struct Shown {
    /// Lateral acceleration.
    pub side: Pure,
    /// Yaw rate.
    pub yaw_rate: Pure,
    /// Lateral over forward speed.
    pub sideslip: Pure,
    /// Roll angle.
    pub roll: Pure,
    /// Handwheel angle.
    pub handwheel: Pure,
    /// Road-wheel angle and speed.
    pub roadwheel: Pure,
    /// See `roadwheel`.
    pub roadwheel_speed: Pure,
    /// Torque in the column.
    pub column: Pure,
    /// Least load of a wheel.
    pub load: Pure,
    /// Speed of the handwheel.
    pub turning: Pure,
}

impl<const N: usize> Tally<N> {
    /// Nothing seen yet.
    pub fn new() -> Self {
        let zero = [0.0; N];
        Self {
            rate_square: zero,
            side: zero,
            side_square: zero,
            left: [f64::INFINITY; N],
            right: [f64::INFINITY; N],
            outside: zero,
            yaw_rate: zero,
            sideslip: zero,
            roll: zero,
            handwheel: zero,
            roadwheel: zero,
            column: zero,
            rest: zero,
            load: [f64::INFINITY; N],
            spun: [f64::INFINITY; N],
        }
    }

    /// Takes up what a lane shows; `weight` is the share of a step that counts in sums.
    #[inline(always)]
    pub fn see(&mut self, lane: usize, shown: &Shown, weight: Pure) {
        let most = |kept: &mut f64, value: Pure| {
            let size = value.abs();
            *kept = size.when(size.0 > *kept, Pure(*kept)).0;
        };
        most(&mut self.side[lane], shown.side);
        most(&mut self.yaw_rate[lane], shown.yaw_rate);
        most(&mut self.sideslip[lane], shown.sideslip);
        most(&mut self.roll[lane], shown.roll);
        most(&mut self.handwheel[lane], shown.handwheel);
        most(&mut self.roadwheel[lane], shown.roadwheel);
        most(&mut self.column[lane], shown.column);
        let least = self.load[lane];
        self.load[lane] = shown.load.when(shown.load.0 < least, Pure(least)).0;
        self.rate_square[lane] += (weight * shown.turning * shown.turning).0;
        self.side_square[lane] += (weight * shown.side * shown.side).0;
        self.rest[lane] += weight.when(shown.roadwheel_speed.0 == 0.0, Pure::ZERO).0;
    }

    /// Writes what is kept of a lane; `squares` is the integral of the square of the handwheel's rate over its time.
    pub fn finish<const S: usize>(
        &self,
        lane: usize,
        time_s: f64,
        squares: f64,
        end: &State<S>,
        kept: &mut [f64],
    ) {
        let per = if time_s > 0.0 { 1.0 / time_s } else { 0.0 };
        kept.copy_from_slice(&[
            squares * per,
            self.side[lane],
            self.side_square[lane] * per,
            self.left[lane],
            self.right[lane],
            self.outside[lane],
            self.yaw_rate[lane],
            self.sideslip[lane],
            self.roll[lane],
            self.handwheel[lane],
            self.roadwheel[lane],
            self.column[lane],
            self.rest[lane] * per,
            self.load[lane],
            self.spun[lane],
            end.x.0,
            end.y.0,
            end.yaw.0,
            end.car[0].0,
            end.car[1].0,
            end.phi.0,
        ]);
    }
}
