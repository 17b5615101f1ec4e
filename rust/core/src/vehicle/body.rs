//! What a car model is to the step: a few states and their rates.

use crate::Error;
use crate::dynamics::Pure;

use super::parameters::Parameters;
use super::prepared::Prepared;
use super::start::Start;
use super::tyre::Tyre;

/// Speed and steer angles at one instant.
#[derive(Debug, Clone, Copy)]
pub(super) struct Moment {
    /// Forward speed, m/s.
    pub speed: Pure,
    /// 1 over it.
    pub inv_speed: Pure,
    /// Angle of the front wheels, rad.
    pub front: Pure,
    /// Angle of the rear wheels, rad.
    pub rear: Pure,
    /// Forward acceleration that the speed asks for, m/s2.
    pub push: Pure,
}

/// How the states of a car change.
#[derive(Debug, Clone, Copy)]
pub(super) struct Rates<const S: usize> {
    /// Per second.
    pub change: [Pure; S],
    /// Torque of the front tyres on the king-pins, Nm.
    pub king_pin: Pure,
    /// Lateral acceleration of the reference point, m/s2.
    pub side: Pure,
}

/// How the body stands and what the wheels carry.
#[derive(Debug, Clone, Copy)]
pub(super) struct Posture {
    /// Roll angle, rad, to the right.
    pub roll: Pure,
    /// Its rate, rad/s.
    pub roll_rate: Pure,
    /// Height above the place at rest, m.
    pub heave: Pure,
    /// Pitch angle, rad, nose down.
    pub pitch: Pure,
    /// Loads, N: front left, front right, rear left, rear right.
    pub loads: [Pure; 4],
}

impl Posture {
    /// The least of the loads.
    #[inline(always)]
    pub fn least_load(&self) -> Pure {
        let lesser = |a: Pure, b: Pure| a.when(a.0 < b.0, b);
        let [a, b, c, d] = self.loads;
        lesser(lesser(a, b), lesser(c, d))
    }
}

/// A car model of `S` states; the first two are lateral speed (m/s) and yaw rate (rad/s).
pub(super) trait Body<const S: usize> {
    /// Rates at one instant.
    fn rates<T: Tyre>(car: &Prepared, now: &Moment, state: &[Pure; S]) -> Rates<S>;

    /// How the body stands on its wheels.
    fn posture(car: &Prepared, now: &Moment, state: &[Pure; S]) -> Posture;

    /// The states of a start.
    fn start(start: &Start) -> [Pure; S];

    /// Refuses parameters that this model cannot do with.
    fn check(car: &Parameters) -> Result<(), Error>;

    /// Highest circular frequency of the model's own springs, or rate of its own decay, rad/s.
    fn quickest(car: &Parameters) -> f64;
}
