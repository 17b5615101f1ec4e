//! One step of a body that turns with dry friction: handwheel or king-pins.
//!
//! The same splitting as the one-mass mechanism's step (`dynamics/split.rs`): drift, torque, drift, with the instants
//! of one reversal and one break-away located inside the step. Here the torque comes from outside, as a value in the
//! middle of the step and as a function of share and angle; a body without dry friction takes the plain linear step.

use crate::dynamics::Pure;
use crate::effects::Lane;

/// What brakes a body, and its step: divisions that are made once.
#[derive(Debug, Clone, Copy)]
pub(super) struct Bearing {
    /// Moment of inertia, kg m2.
    pub inertia: Pure,
    /// Viscous coefficient, Nm s/rad.
    pub viscous: Pure,
    /// Kinetic dry friction, Nm.
    pub coulomb: Pure,
    /// Dry friction at very low speed above the kinetic one, and the speed that takes it away.
    pub stribeck: Pure,
    /// See `stribeck`; rad/s.
    pub stribeck_speed: Pure,
    /// Largest torque that friction holds at rest, Nm.
    pub held: Pure,
    /// Step, s.
    pub h: Pure,
    /// Step over inertia.
    pub rate: Pure,
    /// `1 - k`, k half the share of the speed that viscous friction takes in a step.
    pub kept: Pure,
    /// `1 / (1 + k)`.
    pub damped: Pure,
}

/// The torque on a body at a share of the step and an angle, the neighbours moving on as they did at its start.
pub(super) trait Pull {
    /// Nm.
    fn at(&self, share: Pure, angle: Pure) -> Pure;
}

/// Kinetic dry friction's part that falls with speed.
#[inline(always)]
fn curved(b: &Bearing, speed: Pure, direction: Pure) -> Pure {
    let x = speed / b.stribeck_speed;
    direction * b.stribeck * (-(x * x)).exp()
}

/// Angle and speed at the end of the step; `middle` is the torque at half of it. In stick the speed is exactly 0.
#[inline(always)]
pub(super) fn turn<const RICH: bool, P: Pull>(
    b: &Bearing,
    middle: Pure,
    pull: &P,
    angle: Pure,
    v: Pure,
) -> (Pure, Pure) {
    let half = Pure(0.5);
    let (h, rate) = (b.h, b.rate);
    let s = v.sign();
    let drifted = angle + h * v * half;
    let mut v1 = (v * b.kept + rate * (middle - s * b.coulomb)) * b.damped;
    if RICH {
        // What curves with speed: predicted at the speed of the start, then taken at the middle.
        let guess = v1 - rate * curved(b, v, s) * b.damped;
        v1 = v1 - rate * curved(b, (v + guess) * half, s) * b.damped;
    }
    let dry = (b.held.0 > 0.0) | (b.coulomb.0 > 0.0);
    let event = dry & ((v1 * v).0 <= 0.0);
    let rested = v.0 == 0.0;

    // The instant at which the speed is 0, and the torque from there on with the body held.
    let fall = (v - v1).when(event & !rested, Pure::ONE);
    let moving = (v / fall).when(!rested, Pure::ZERO);
    let at = angle + moving * h * v * half;
    let at_turn = pull.at(moving, at);
    let at_end = pull.at(Pure::ONE, at);
    let breaks_now = at_turn.abs().0 > b.held.0;
    let breaks_later = !breaks_now & (at_end.abs().0 > b.held.0);
    let rise = (at_end - at_turn).when(breaks_later, Pure::ONE);
    let located = ((at_end.sign() * b.held - at_turn) / rise).clamp(Pure::ZERO, Pure::ONE);
    let stuck = Pure::ZERO.when(breaks_now, located.when(breaks_later, Pure::ONE));

    // From the break-away to the end, from rest.
    let way = at_turn.when(breaks_now, at_end);
    let direction = way.sign();
    let left = (Pure::ONE - moving) * (Pure::ONE - stuck) * h;
    let mean = (at_turn + (at_end - at_turn) * stuck + at_end) * half - direction * b.coulomb;
    let slow = left / (b.inertia + left * b.viscous * half);
    let mut v2 = slow * mean;
    if RICH {
        let guess = v2 - slow * curved(b, Pure::ZERO, direction);
        v2 = v2 - slow * curved(b, guess * half, direction);
    }
    let v2 = Pure::ZERO.when((v2 * way).0 <= 0.0, v2);

    (
        (at + left * v2 * half).when(event, drifted + h * v1 * half),
        v2.when(event, v1),
    )
}
