//! The step of Moreau and Jean: first order, without any assumption about events.
//!
//! Dry friction enters through its resolvent, luz: `v+ = luz(v_free, h F / I) / (1 + h mu / I)`. Static friction above
//! the kinetic one has no resolvent; a body at rest stays there as long as it holds.

use super::drive::Span;
use super::number::Pure;
use super::one_mass::OneMass;
use super::split::{Carried, Pace, Step};

/// One sub-step of length `h`.
#[inline(always)]
pub(super) fn step<const WITH: usize>(
    body: &OneMass<Pure>,
    span: &Span,
    pace: Pace,
    (phi, v): (Pure, Pure),
    rest_s: Pure,
) -> Step {
    let Pace { h, rate, .. } = pace;
    let (psi, load) = span.end();
    let torque = body.torque::<WITH>(psi, load, phi);
    let s = v.sign();
    let free = v + rate * (torque - body.curved(v, s));
    // The resolvent of friction whose levels differ: soft threshold with one width on each side.
    let up = free - rate * body.kinetic::<WITH>(Pure::ONE, phi, load);
    let down = free - rate * body.kinetic::<WITH>(-Pure::ONE, phi, load);
    let slipped = up.when(up.0 > 0.0, down.when(down.0 < 0.0, Pure::ZERO));
    let next = slipped / (Pure::ONE + rate * body.linear(Pure::ONE));
    let held = body.held::<WITH>(phi, load, rest_s + h);
    let holds = (v.0 == 0.0) & (torque.abs_at_most(held.to::<WITH>(torque.sign())));
    let speed = Pure::ZERO.when(holds, next);
    let phi_next = phi + h * speed;
    Step {
        phi: phi_next,
        speed,
        phi_turn: phi_next,
        moving: Pure::ONE,
        stuck: Pure::ZERO,
        speed_turn: speed,
        grip: Pure::ZERO,
        carried: Carried {
            rest_s: (rest_s + h).when(holds, Pure::ZERO),
            bristle: Pure::ZERO,
        },
    }
}
