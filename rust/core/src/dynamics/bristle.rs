//! Friction with an elastic break-away: the contact deforms before it slides, and the step of a body on such a contact.
//!
//! The friction state s of the contact, in [-1, 1], follows the travel: as the stop operator (Prandtl, Jenkins), by
//! Dahl's exponential, or by the law of `LuGre` (Canudas de Wit, Olsson, Astrom, Lischinsky 1995), in which the state
//! ends where Stribeck's friction is and its rate is damped. There is no rest here: a body that is held swings on its
//! contact. Under a load that swings below break-away the stop closes its loops and comes back to where it was; Dahl
//! and `LuGre` creep, as is known of them (`tests/test_dynamics_bristle.py` has the figures).

use crate::effects::{Lane, dahl};
use crate::projections::stop;

use super::drive::Span;
use super::number::Pure;
use super::one_mass::{CURVED, LUGRE, OneMass};
use super::split::{Carried, Pace, Step};

/// How many values a [`Bristle`] has.
pub(super) const VALUES: usize = 4;

/// The elastic contact.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Bristle<L> {
    /// 1 over the travel from rest to full friction, 1/rad; 0 where the contact is rigid.
    pub per_travel: L,
    /// 1 where the state follows Dahl's exponential, 0 where it is a stop.
    pub exponential: L,
    /// 1 where it follows `LuGre`'s law.
    pub lugre: L,
    /// Torque per rate of deformation, `LuGre` only.
    pub damping: L,
}

impl<L: Copy> Bristle<L> {
    /// From the values in a row.
    #[inline(always)]
    pub(super) fn from_values(of: impl Fn(usize) -> L) -> Self {
        Self {
            per_travel: of(0),
            exponential: of(1),
            lugre: of(2),
            damping: of(3),
        }
    }

    /// The values of a row.
    pub(super) fn to_values(self) -> [L; VALUES] {
        [self.per_travel, self.exponential, self.lugre, self.damping]
    }
}

impl Bristle<f64> {
    /// Whether the contact is elastic.
    #[must_use]
    pub fn acts(&self) -> bool {
        self.per_travel != 0.0
    }
}

impl Bristle<Pure> {
    /// The friction state after a way in one direction, whose end would be `full`.
    #[inline(always)]
    fn walk(&self, state: Pure, way: Pure, full: Pure) -> Pure {
        let travel = way * self.per_travel;
        let curved = dahl(state, way.side() * full, travel / full);
        let straight = stop(state, travel, Pure::ONE);
        curved.when((self.exponential.0 + self.lugre.0) > 0.0, straight)
    }

    /// The end of the friction state at a speed: 1, and with `LuGre` Stribeck's level over Coulomb's.
    #[inline(always)]
    fn full<const WITH: usize>(&self, body: &OneMass<Pure>, speed: Pure) -> Pure {
        if WITH & LUGRE == 0 {
            return Pure::ONE;
        }
        let extra = body.stribeck_torque(speed, Pure::ONE);
        let dry = body.coulomb.when(self.lugre.0 > 0.0, Pure::ONE);
        (Pure::ONE + extra / dry).when(self.lugre.0 > 0.0, Pure::ONE)
    }
}

/// What acts in the middle of a step.
struct Push {
    /// Torque less dry friction.
    net: Pure,
    /// Friction state.
    state: Pure,
    /// The state as far as Stribeck's part goes with it.
    side: Pure,
}

impl Push {
    /// The damping of the deformation's rate is a viscous friction that fades as the state comes to its end.
    #[inline(always)]
    fn damping<const WITH: usize>(&self, body: &OneMass<Pure>, at_speed: Pure) -> Pure {
        if WITH & LUGRE == 0 {
            return Pure::ZERO;
        }
        let full = body.bristle.full::<WITH>(body, at_speed);
        body.bristle.damping * (Pure::ONE - at_speed.side() * self.state / full)
    }

    /// The speed at the end of a step from `v`, with what depends on the speed taken at another.
    #[inline(always)]
    fn end<const WITH: usize>(
        &self,
        body: &OneMass<Pure>,
        pace: Pace,
        v: Pure,
        at_speed: Pure,
    ) -> Pure {
        let damping = self.damping::<WITH>(body, at_speed);
        let k = pace.rate * (body.linear(Pure::ONE) + damping) * Pure(0.5);
        let curved = if WITH & CURVED == 0 {
            Pure::ZERO
        } else {
            body.curved(at_speed, self.side)
        };
        (v * (Pure::ONE - k) + pace.rate * (self.net - curved)) / (Pure::ONE + k)
    }
}

/// One sub-step of a body on an elastic contact: half a drift, the torque in the middle, the other half.
#[inline(always)]
pub(super) fn step<const WITH: usize>(
    body: &OneMass<Pure>,
    span: &Span,
    pace: Pace,
    (phi, v): (Pure, Pure),
    carried: Carried,
) -> Step {
    let (half, bristle) = (Pure(0.5), &body.bristle);
    let drift = pace.h * half;
    let middle = phi + drift * v;
    let (psi, load) = span.middle();
    let state = bristle.walk(carried.bristle, middle - phi, bristle.full::<WITH>(body, v));
    let dry = body.base::<WITH>(middle, load) * state + body.asymmetric_coulomb * state.abs();
    let net = body.torque::<WITH>(psi, load, middle) - dry;
    // Stribeck's part goes with the state; LuGre has it in the end of the state.
    let side = Pure::ZERO.when(bristle.lugre.0 > 0.0, state);
    let push = Push { net, state, side };
    // What depends on the speed is predicted at the speed of the start, then taken at the middle.
    let at_speed = (v + push.end::<WITH>(body, pace, v, v)) * half;
    let speed = push.end::<WITH>(body, pace, v, at_speed);
    let phi_next = middle + drift * speed;
    let turns = (speed * v).0 < 0.0;
    let fall = (v - speed).when(turns, Pure::ONE);
    Step {
        phi: phi_next,
        speed,
        phi_turn: phi_next,
        moving: (v / fall).when(turns, Pure::ONE),
        stuck: Pure::ZERO,
        speed_turn: Pure::ZERO.when(turns, speed),
        // For the energies only: a lane's compiler leaves it out.
        grip: dry
            + body.stribeck_torque(at_speed, side)
            + push.damping::<WITH>(body, at_speed) * (v + speed) * half,
        carried: Carried {
            rest_s: Pure::ZERO,
            bristle: bristle.walk(state, phi_next - middle, bristle.full::<WITH>(body, speed)),
        },
    }
}
