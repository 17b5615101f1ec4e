//! The lateral-yaw-roll model: the single-track model with a body that rolls and four wheels whose load it moves.
//!
//! `m A - ms h p' = Ff + Fr`, `Iz r' = a Ff - b Fr`, `Ix p' - ms h A = -(K - ms g h) phi - C p`, `A = v' + u r`; roll to
//! the right is positive, Ix about the roll axis, h the height of the sprung mass above it. The load that moves at an
//! axle is `(K_i phi + C_i p + h_i m_i u r)/track`: what passes through its roll centre is taken quasi-statically.

use crate::Error;
use crate::dynamics::Pure;

use super::axle::{across, carried, slip};
use super::body::{Body, Moment, Posture, Rates};
use super::parameters::{Parameters, out};
use super::prepared::{GRAVITY, Prepared};
use super::single_track::lagged;
use super::start::Start;
use super::tyre::Tyre;

/// States: lateral speed, yaw rate, lagged slip front and rear, roll angle, roll rate.
pub(super) struct LateralRoll;

/// Shares of a wheel's static load that have moved to the right, front and rear.
#[inline(always)]
fn shifts(car: &Prepared, now: &Moment, state: &[Pure; 6]) -> (Pure, Pure) {
    let (steady, roll, rate) = (now.speed * state[1], state[4], state[5]);
    (
        car.front_shift_roll * roll + car.front_shift_rate * rate + car.front_shift_side * steady,
        car.rear_shift_roll * roll + car.rear_shift_rate * rate + car.rear_shift_side * steady,
    )
}

impl Body<6> for LateralRoll {
    #[inline(always)]
    fn rates<T: Tyre>(car: &Prepared, now: &Moment, state: &[Pure; 6]) -> Rates<6> {
        let [v, r, lag_front, lag_rear, roll, roll_rate] = *state;
        let front_angle = now.front + car.front_roll_steer * roll;
        let rear_angle = now.rear + car.rear_roll_steer * roll;
        let (front_slip, front_lag) = lagged(
            slip::<T>((v + car.front_axle * r) * now.inv_speed, front_angle),
            lag_front,
            now.speed * car.front_inv_relaxation,
        );
        let (rear_slip, rear_lag) = lagged(
            slip::<T>((v - car.rear_axle * r) * now.inv_speed, rear_angle),
            lag_rear,
            now.speed * car.rear_inv_relaxation,
        );
        let steady = now.speed * r;
        let (front_shift, rear_shift) = shifts(car, now, state);
        let front = car.front().leaning::<T>(front_slip, front_shift);
        let rear = car.rear().leaning::<T>(rear_slip, rear_shift);
        let front_side = across::<T>(front.force, front_angle);
        let rear_side = across::<T>(rear.force, rear_angle);
        let force = front_side + rear_side;
        let moment = -(car.roll_stiffness * roll + car.roll_damping * roll_rate);
        let side = car.side_by_force * force + car.side_by_roll * moment;
        let lean = car.roll_by_force * force + car.roll_by_roll * moment;
        let turn = (car.front_axle * front_side - car.rear_axle * rear_side) * car.inv_yaw_inertia;
        Rates {
            change: [side - steady, turn, front_lag, rear_lag, roll_rate, lean],
            king_pin: -(front.moment + car.front_caster * front.force),
            side,
        }
    }

    #[inline(always)]
    fn posture(car: &Prepared, now: &Moment, state: &[Pure; 6]) -> Posture {
        let (front, rear) = shifts(car, now, state);
        let load = |of: Pure, shift: Pure| of * carried(shift);
        Posture {
            roll: state[4],
            roll_rate: state[5],
            heave: Pure::ZERO,
            pitch: Pure::ZERO,
            loads: [
                load(car.front_wheel_load, -front),
                load(car.front_wheel_load, front),
                load(car.rear_wheel_load, -rear),
                load(car.rear_wheel_load, rear),
            ],
        }
    }

    fn start(start: &Start) -> [Pure; 6] {
        let s = start;
        [s.lateral_speed, s.yaw_rate, 0.0, 0.0, s.roll, s.roll_rate].map(Pure)
    }

    fn check(car: &Parameters) -> Result<(), Error> {
        let arm = car.sprung_mass * car.roll_arm;
        if car.mass * car.roll_inertia <= arm * arm {
            let interval = format!(
                "({:.6e}, inf): about the roll axis, so above sprung mass squared times arm squared over mass",
                arm * arm / car.mass
            );
            return Err(out("body.roll_inertia_kg_m2", car.roll_inertia, &interval));
        }
        let stiffness = car.front_roll_stiffness + car.rear_roll_stiffness;
        if stiffness <= arm * GRAVITY {
            let interval = format!(
                "({:.6e}, inf) minus that of the rear: else the body falls over",
                arm * GRAVITY
            );
            return Err(out(
                "front.roll_stiffness_nm_per_rad",
                car.front_roll_stiffness,
                &interval,
            ));
        }
        for (name, track) in [
            ("front.track_m", car.front_track),
            ("rear.track_m", car.rear_track),
        ] {
            if track <= 0.0 {
                return Err(out(name, track, "(0, inf)"));
            }
        }
        Ok(())
    }

    fn quickest(car: &Parameters) -> f64 {
        let arm = car.sprung_mass * car.roll_arm;
        let inertia = car.roll_inertia - arm * arm / car.mass;
        let stiffness = car.front_roll_stiffness + car.rear_roll_stiffness - arm * GRAVITY;
        let damping = car.front_roll_damping + car.rear_roll_damping;
        (stiffness / inertia).sqrt().max(damping / inertia)
    }
}
