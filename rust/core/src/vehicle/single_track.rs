//! The single-track model: lateral speed and yaw rate, a lag of each axle's slip.
//!
//! `m (v' + u r) = Ff + Fr`, `Iz r' = a Ff - b Fr`; slip lags by distance, `sigma s' = u (slip - s)`.

use crate::Error;
use crate::dynamics::Pure;

use super::axle::{across, slip};
use super::body::{Body, Moment, Posture, Rates};
use super::parameters::Parameters;
use super::prepared::Prepared;
use super::start::Start;
use super::tyre::Tyre;

/// States: lateral speed, yaw rate, lagged slip front and rear.
pub(super) struct SingleTrack;

impl Body<4> for SingleTrack {
    #[inline(always)]
    fn rates<T: Tyre>(car: &Prepared, now: &Moment, state: &[Pure; 4]) -> Rates<4> {
        let [v, r, lag_front, lag_rear] = *state;
        let (front_slip, front_lag) = lagged(
            slip::<T>((v + car.front_axle * r) * now.inv_speed, now.front),
            lag_front,
            now.speed * car.front_inv_relaxation,
        );
        let (rear_slip, rear_lag) = lagged(
            slip::<T>((v - car.rear_axle * r) * now.inv_speed, now.rear),
            lag_rear,
            now.speed * car.rear_inv_relaxation,
        );
        let front = car.front().level::<T>(front_slip);
        let rear = car.rear().level::<T>(rear_slip);
        let front_side = across::<T>(front.force, now.front);
        let rear_side = across::<T>(rear.force, now.rear);
        let side = (front_side + rear_side) * car.inv_mass;
        let turn = (car.front_axle * front_side - car.rear_axle * rear_side) * car.inv_yaw_inertia;
        Rates {
            change: [side - now.speed * r, turn, front_lag, rear_lag],
            king_pin: -(front.moment + car.front_caster * front.force),
            side,
        }
    }

    #[inline(always)]
    fn posture(car: &Prepared, _now: &Moment, _state: &[Pure; 4]) -> Posture {
        let (front, rear) = (car.front_wheel_load, car.rear_wheel_load);
        Posture {
            roll: Pure::ZERO,
            roll_rate: Pure::ZERO,
            heave: Pure::ZERO,
            pitch: Pure::ZERO,
            loads: [front, front, rear, rear],
        }
    }

    fn start(start: &Start) -> [Pure; 4] {
        [start.lateral_speed, start.yaw_rate, 0.0, 0.0].map(Pure)
    }

    fn check(_car: &Parameters) -> Result<(), Error> {
        Ok(())
    }

    fn quickest(_car: &Parameters) -> f64 {
        0.0
    }
}

/// The slip that acts and the rate of its lag; without a relaxation length the slip acts at once.
#[inline(always)]
pub(super) fn lagged(slip: Pure, lag: Pure, rate: Pure) -> (Pure, Pure) {
    (lag.when(rate.0 > 0.0, slip), rate * (slip - lag))
}
