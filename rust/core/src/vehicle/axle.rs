//! The tyres of an axle: slip from the motion, forces from slip and load.

use crate::dynamics::Pure;
use crate::effects::Lane;

use super::tyre::{Contact, Grip, Tyre};

/// An axle at its static load.
#[derive(Debug, Clone, Copy)]
pub(super) struct Axle {
    /// Both tyres together, each at its static load.
    pub grip: Grip,
    /// Static load over the load at which the cornering stiffness is largest.
    pub load_ratio: Pure,
    /// Share of friction lost per share of load gained.
    pub friction_load: Pure,
}

/// Tangent of a steer angle, within 1e-6 below 0.2 rad (of the series of the tangent the next term is 17/315 x^7).
#[inline(always)]
fn tangent(x: Pure) -> Pure {
    let z = x * x;
    x + x * z * (Pure(1.0 / 3.0) + z * Pure(2.0 / 15.0))
}

/// Slip of a wheel steered by `steer` whose axle moves to the left with `side` times the forward speed.
#[inline(always)]
pub(super) fn slip<T: Tyre>(side: Pure, steer: Pure) -> Pure {
    if T::LINEAR {
        return side - steer;
    }
    let t = tangent(steer);
    (side - t) / (Pure::ONE + side * t)
}

/// The part of a wheel's lateral force that acts across the car: cosine of the steer angle, within 1e-7 below 0.2 rad.
#[inline(always)]
pub(super) fn across<T: Tyre>(force: Pure, steer: Pure) -> Pure {
    if T::LINEAR {
        return force;
    }
    let z = steer * steer;
    force * (Pure::ONE - z * (Pure(0.5) - z * Pure(1.0 / 24.0)))
}

/// The part of a wheel's lateral force that acts backward: sine of the steer angle, within 1e-7 below 0.2 rad.
#[inline(always)]
pub(super) fn along<T: Tyre>(force: Pure, steer: Pure) -> Pure {
    if T::LINEAR {
        return Pure::ZERO;
    }
    let z = steer * steer;
    force * steer * (Pure::ONE - z * (Pure(1.0 / 6.0) - z * Pure(1.0 / 120.0)))
}

/// The share of its static load that a wheel carries where `shift` of it has come: not below 0, and not above 2, for
/// the other wheel has no more to give.
#[inline(always)]
pub(super) fn carried(shift: Pure) -> Pure {
    (Pure::ONE + shift).clamp(Pure::ZERO, Pure(2.0))
}

impl Axle {
    /// One wheel whose load is `load` times its static one. Stiffness over load is Pacejka's
    /// `K = Kmax sin(2 atan(Fz/Fz_peak)) = Kmax 2 u/(1 + u^2)`, friction `mu = mu0 (1 - c (Fz/Fz0 - 1))`.
    #[inline(always)]
    pub fn wheel<T: Tyre>(&self, slip: Pure, load: Pure) -> Contact {
        let half = Pure(0.5);
        let z = self.load_ratio * self.load_ratio;
        let stiffness =
            half * self.grip.stiffness * load * (Pure::ONE + z) / (Pure::ONE + z * load * load);
        let friction =
            (Pure::ONE - self.friction_load * (load - Pure::ONE)).clamp(Pure::ZERO, Pure(f64::MAX));
        T::contact(
            &Grip {
                stiffness,
                limit: half * self.grip.limit * load * friction,
                ..self.grip
            },
            slip,
        )
    }

    /// Both wheels at their static load.
    #[inline(always)]
    pub fn level<T: Tyre>(&self, slip: Pure) -> Contact {
        T::contact(&self.grip, slip)
    }

    /// Both wheels where `shift` of a wheel's static load has moved from the left to the right one.
    #[inline(always)]
    pub fn leaning<T: Tyre>(&self, slip: Pure, shift: Pure) -> Contact {
        let (left, right) = (
            self.wheel::<T>(slip, carried(-shift)),
            self.wheel::<T>(slip, carried(shift)),
        );
        Contact {
            force: left.force + right.force,
            moment: left.moment + right.moment,
        }
    }
}
