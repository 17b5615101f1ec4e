//! A lane of car, steering and step as the loop takes it: quotients that are made once.

use crate::dynamics::Pure;

use super::axle::Axle;
use super::parameters::Parameters;
use super::table::lane_rows;
use super::turn::Bearing;
use super::tyre::Grip;

/// Standard gravity, m/s2.
pub(super) const GRAVITY: f64 = 9.806_65;

lane_rows! {
    /// See the fields of [`Parameters`] and [`Bearing`].
    Prepared, PREPARED:
    /// Step, s.
    h,
    inv_mass,
    inv_yaw_inertia,
    front_axle,
    rear_axle,
    front_stiffness,
    front_limit,
    front_shape,
    front_inv_shape,
    front_curvature,
    front_trail,
    front_caster,
    /// 1 over the relaxation length; 0 where there is none.
    front_inv_relaxation,
    front_load_ratio,
    front_friction_load,
    front_roll_steer,
    /// Load moved to the right wheel, as a share of a wheel's static load, per rad of roll, per rad/s, per m/s2.
    front_shift_roll,
    front_shift_rate,
    front_shift_side,
    front_half_track,
    front_inv_track,
    front_wheel_load,
    front_tyre_spring,
    front_spring,
    front_damper,
    front_bar,
    front_inv_wheel_mass,
    front_moved,
    rear_stiffness,
    rear_limit,
    rear_shape,
    rear_inv_shape,
    rear_curvature,
    rear_inv_relaxation,
    rear_load_ratio,
    rear_friction_load,
    rear_roll_steer,
    rear_shift_roll,
    rear_shift_rate,
    rear_shift_side,
    rear_half_track,
    rear_inv_track,
    rear_wheel_load,
    rear_tyre_spring,
    rear_spring,
    rear_damper,
    rear_bar,
    rear_inv_wheel_mass,
    rear_moved,
    /// Acceleration per force and per roll moment, roll acceleration per force and per roll moment.
    side_by_force,
    side_by_roll,
    roll_by_force,
    roll_by_roll,
    roll_stiffness,
    roll_damping,
    /// Tilting moment of the weight per rad of roll.
    roll_weight,
    inv_sprung_mass,
    inv_pitch_inertia,
    /// Pitch moment per forward acceleration.
    pitch_arm,
    ratio,
    stiffness,
    half_gap,
    aligning,
    assist_gain,
    assist_threshold,
    assist_second_gain,
    assist_second_threshold,
    rear_steer,
    rear_steer_half_gap,
    king_inertia,
    king_viscous,
    king_coulomb,
    king_stribeck,
    king_stribeck_speed,
    king_held,
    king_rate,
    king_kept,
    king_damped,
    wheel_inertia,
    wheel_viscous,
    wheel_coulomb,
    wheel_held,
    wheel_rate,
    wheel_kept,
    wheel_damped,
}

/// 1 over a length (or mass, inertia), 0 for none.
fn inverse(length: f64) -> f64 {
    if length > 0.0 { 1.0 / length } else { 0.0 }
}

fn square(x: f64) -> f64 {
    x * x
}

impl Prepared {
    /// The lane of a car with a step of `h` seconds.
    // A list: one line per number.
    #[allow(clippy::too_many_lines)]
    pub fn of(car: &Parameters, h: f64) -> Self {
        let base = car.front_axle + car.rear_axle;
        let weight = car.mass * GRAVITY;
        let (front_load, rear_load) = (
            weight * car.rear_axle / base,
            weight * car.front_axle / base,
        );
        let arm = car.sprung_mass * car.roll_arm;
        let det = car.mass * car.roll_inertia - arm * arm;
        let (front_inv, rear_inv) = (inverse(car.front_track), inverse(car.rear_track));
        let inv_det = if det > 0.0 { 1.0 / det } else { 0.0 };
        // A wheel's static load is half of the axle's; half of what moves goes onto it.
        let shift = |stiffness: f64, track: f64, load: f64| {
            if track > 0.0 {
                2.0 * stiffness / (track * load)
            } else {
                0.0
            }
        };
        let step = |inertia: f64, viscous: f64| {
            let rate = if inertia > 0.0 { h / inertia } else { 0.0 };
            let k = 0.5 * rate * viscous;
            (rate, 1.0 - k, 1.0 / (1.0 + k))
        };
        let (king_rate, king_kept, king_damped) = step(car.steering_inertia, car.viscous);
        let (wheel_rate, wheel_kept, wheel_damped) = step(car.wheel_inertia, car.wheel_viscous);
        let p = Pure;
        Self {
            h: p(h),
            inv_mass: p(1.0 / car.mass),
            inv_yaw_inertia: p(1.0 / car.yaw_inertia),
            front_axle: p(car.front_axle),
            rear_axle: p(car.rear_axle),
            front_stiffness: p(car.front_cornering),
            front_limit: p(car.front_friction * front_load),
            front_shape: p(car.front_shape),
            front_inv_shape: p(inverse(car.front_shape)),
            front_curvature: p(car.front_curvature),
            front_trail: p(car.front_pneumatic_trail),
            front_caster: p(car.front_caster_trail),
            front_inv_relaxation: p(inverse(car.front_relaxation)),
            front_load_ratio: p(car.front_load_ratio),
            front_friction_load: p(car.front_friction_load),
            front_roll_steer: p(car.front_roll_steer),
            front_shift_roll: p(shift(car.front_roll_stiffness, car.front_track, front_load)),
            front_shift_rate: p(shift(car.front_roll_damping, car.front_track, front_load)),
            front_shift_side: p(shift(
                car.front_roll_centre * front_load / GRAVITY,
                car.front_track,
                front_load,
            )),
            front_half_track: p(0.5 * car.front_track),
            front_inv_track: p(inverse(car.front_track)),
            front_wheel_load: p(0.5 * front_load),
            front_tyre_spring: p(car.front_tyre_stiffness),
            front_spring: p(car.front_spring),
            front_damper: p(2.0 * car.front_roll_damping * square(front_inv)),
            front_bar: p(front_inv
                * (car.front_roll_stiffness - 0.5 * car.front_spring * square(car.front_track))),
            front_inv_wheel_mass: p(inverse(0.5 * car.front_unsprung)),
            front_moved: p(front_inv
                * ((front_load / GRAVITY - car.front_unsprung) * car.front_roll_centre
                    + car.front_unsprung * car.wheel_radius)),
            rear_stiffness: p(car.rear_cornering),
            rear_limit: p(car.rear_friction * rear_load),
            rear_shape: p(car.rear_shape),
            rear_inv_shape: p(inverse(car.rear_shape)),
            rear_curvature: p(car.rear_curvature),
            rear_inv_relaxation: p(inverse(car.rear_relaxation)),
            rear_load_ratio: p(car.rear_load_ratio),
            rear_friction_load: p(car.rear_friction_load),
            rear_roll_steer: p(car.rear_roll_steer),
            rear_shift_roll: p(shift(car.rear_roll_stiffness, car.rear_track, rear_load)),
            rear_shift_rate: p(shift(car.rear_roll_damping, car.rear_track, rear_load)),
            rear_shift_side: p(shift(
                car.rear_roll_centre * rear_load / GRAVITY,
                car.rear_track,
                rear_load,
            )),
            rear_half_track: p(0.5 * car.rear_track),
            rear_inv_track: p(inverse(car.rear_track)),
            rear_wheel_load: p(0.5 * rear_load),
            rear_tyre_spring: p(car.rear_tyre_stiffness),
            rear_spring: p(car.rear_spring),
            rear_damper: p(2.0 * car.rear_roll_damping * square(rear_inv)),
            rear_bar: p(rear_inv
                * (car.rear_roll_stiffness - 0.5 * car.rear_spring * square(car.rear_track))),
            rear_inv_wheel_mass: p(inverse(0.5 * car.rear_unsprung)),
            rear_moved: p(rear_inv
                * ((rear_load / GRAVITY - car.rear_unsprung) * car.rear_roll_centre
                    + car.rear_unsprung * car.wheel_radius)),
            side_by_force: p(car.roll_inertia * inv_det),
            side_by_roll: p(arm * inv_det),
            roll_by_force: p(arm * inv_det),
            roll_by_roll: p(car.mass * inv_det),
            roll_stiffness: p(car.front_roll_stiffness + car.rear_roll_stiffness - arm * GRAVITY),
            roll_damping: p(car.front_roll_damping + car.rear_roll_damping),
            roll_weight: p(arm * GRAVITY),
            inv_sprung_mass: p(inverse(car.sprung_mass)),
            inv_pitch_inertia: p(inverse(car.pitch_inertia)),
            pitch_arm: p(car.sprung_mass * car.cg_height),
            ratio: p(car.steering_ratio),
            stiffness: p(car.steering_stiffness),
            half_gap: p(0.5 * car.gap),
            aligning: p(car.steering_aligning),
            assist_gain: p(car.assist_gain),
            assist_threshold: p(car.assist_threshold),
            assist_second_gain: p(car.assist_second_gain),
            assist_second_threshold: p(car.assist_second_threshold),
            rear_steer: p(car.rear_steer),
            rear_steer_half_gap: p(0.5 * car.rear_steer_gap),
            king_inertia: p(car.steering_inertia),
            king_viscous: p(car.viscous),
            king_coulomb: p(car.coulomb),
            king_stribeck: p(car.stribeck),
            // Without an extra the speed says nothing, and 0 would divide.
            king_stribeck_speed: p(if car.stribeck_speed > 0.0 {
                car.stribeck_speed
            } else {
                1.0
            }),
            king_held: p(car.coulomb + car.stribeck + car.stiction),
            king_rate: p(king_rate),
            king_kept: p(king_kept),
            king_damped: p(king_damped),
            wheel_inertia: p(car.wheel_inertia),
            wheel_viscous: p(car.wheel_viscous),
            wheel_coulomb: p(car.wheel_coulomb),
            wheel_held: p(car.wheel_coulomb + car.wheel_stiction),
            wheel_rate: p(wheel_rate),
            wheel_kept: p(wheel_kept),
            wheel_damped: p(wheel_damped),
        }
    }

    /// The front axle.
    #[inline(always)]
    pub fn front(&self) -> Axle {
        Axle {
            grip: Grip {
                stiffness: self.front_stiffness,
                limit: self.front_limit,
                shape: self.front_shape,
                inv_shape: self.front_inv_shape,
                curvature: self.front_curvature,
                trail: self.front_trail,
            },
            load_ratio: self.front_load_ratio,
            friction_load: self.front_friction_load,
        }
    }

    /// The rear axle.
    #[inline(always)]
    pub fn rear(&self) -> Axle {
        Axle {
            grip: Grip {
                stiffness: self.rear_stiffness,
                limit: self.rear_limit,
                shape: self.rear_shape,
                inv_shape: self.rear_inv_shape,
                curvature: self.rear_curvature,
                trail: Pure::ZERO,
            },
            load_ratio: self.rear_load_ratio,
            friction_load: self.rear_friction_load,
        }
    }

    /// The king-pins.
    #[inline(always)]
    pub fn king_pins(&self) -> Bearing {
        Bearing {
            inertia: self.king_inertia,
            viscous: self.king_viscous,
            coulomb: self.king_coulomb,
            stribeck: self.king_stribeck,
            stribeck_speed: self.king_stribeck_speed,
            held: self.king_held,
            h: self.h,
            rate: self.king_rate,
            kept: self.king_kept,
            damped: self.king_damped,
        }
    }

    /// The handwheel.
    #[inline(always)]
    pub fn handwheel(&self) -> Bearing {
        Bearing {
            inertia: self.wheel_inertia,
            viscous: self.wheel_viscous,
            coulomb: self.wheel_coulomb,
            stribeck: Pure::ZERO,
            stribeck_speed: Pure::ONE,
            held: self.wheel_held,
            h: self.h,
            rate: self.wheel_rate,
            kept: self.wheel_kept,
            damped: self.wheel_damped,
        }
    }
}
