//! The seed paper's steering model of one mass, equation (5): handwheel angle in, road-wheel angle out.
//!
//! `I phi'' + friction(phi') = M`, `M = p (K l + K3 l^3) - c phi + M_phi`, `l = luz(psi - p phi, z0)`. At rest friction
//! is whatever keeps the body there, up to its static level.

use crate::effects::{
    AsymmetricCoulomb, AsymmetricViscous, Drag, Hardening, Lane, Law, Motion, Stiffness, Stribeck,
    Viscous,
};
use crate::projections::luz;

use super::bristle::Bristle;
use super::ground::Ground;
use super::level::Level;
use super::number::Pure;

/// Which effects a step looks at, as bits; what does not act adds exactly 0, so that leaving it out changes no bit.
/// None of them: linear springs, a gap, viscous and symmetric dry friction.
pub(super) const PLAIN: usize = 0;
/// What needs neither the speed nor a transcendental function: hardening, stops, friction over side, angle and load.
pub(super) const LOCAL: usize = 1;
/// What depends on the speed in a curved way.
pub(super) const CURVED: usize = 2;
/// Waves and bumps over the angle.
pub(super) const WAVY: usize = 4;
/// Everything on a rigid contact.
pub(super) const EVERY: usize = LOCAL | CURVED | WAVY;
/// A contact that gives way before it slides.
pub(super) const ELASTIC: usize = 8;
/// One that does so by the law of `LuGre`.
pub(super) const LUGRE: usize = 16;

/// One body: what stands between the handwheel and it, what pulls it to the ground, what brakes it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct OneMass<L> {
    /// Moment of inertia.
    pub inertia: L,
    /// Handwheel angle per road-wheel angle, p.
    pub ratio: L,
    /// Spring at the handwheel, K.
    pub stiffness: L,
    /// Spring to the ground at the road wheel, c.
    pub aligning: L,
    /// Full width of the freeplay at the handwheel, 2 z0.
    pub gap: L,
    /// Cubic part of the spring at the handwheel, K3.
    pub hardening: L,
    /// Viscous coefficient.
    pub viscous: L,
    /// Half the difference of the one-sided viscous coefficients.
    pub asymmetric_viscous: L,
    /// Torque per speed squared.
    pub drag: L,
    /// Kinetic dry friction.
    pub coulomb: L,
    /// Half the difference of the one-sided dry friction.
    pub asymmetric_coulomb: L,
    /// Dry friction at very low speed above the kinetic one, and the speed that takes it away.
    pub stribeck: L,
    /// See [`OneMass::stribeck`].
    pub stribeck_speed: L,
    /// Static friction above the kinetic one, felt at rest only.
    pub stiction: L,
    /// What acts by angle alone.
    pub ground: Ground<L>,
    /// What changes the level of dry friction.
    pub level: Level<L>,
    /// What the contact gives way before it slides.
    pub bristle: Bristle<L>,
}

/// The torque that friction holds at rest.
#[derive(Debug, Clone, Copy)]
pub(super) struct Held {
    middle: Pure,
    difference: Pure,
}

impl Held {
    /// To one side.
    #[inline(always)]
    pub fn to<const WITH: usize>(self, direction: Pure) -> Pure {
        if WITH & LOCAL == 0 {
            return self.middle;
        }
        self.middle + direction * self.difference
    }
}

impl OneMass<f64> {
    /// Highest circular frequency of the body on its springs, rad/s, where the handwheel spring is wound up by no
    /// more than `wound_rad`.
    #[must_use]
    pub fn highest_frequency_rad_s(&self, wound_rad: f64) -> f64 {
        let total: f64 = self.springs(wound_rad).iter().map(|(_, k)| k).sum();
        (total / self.inertia).sqrt()
    }

    /// The parameter of the stiffest spring.
    pub(super) fn stiffest_spring(&self, wound_rad: f64) -> &'static str {
        let springs = self.springs(wound_rad).into_iter();
        springs
            .max_by(|a, b| a.1.total_cmp(&b.1))
            .map_or("", |s| s.0)
    }

    /// The stiffest that every spring can be, at the road wheel, Nm/rad, by the name of its parameter.
    fn springs(&self, wound_rad: f64) -> [(&'static str, f64); 6] {
        let tangent = self.stiffness + 3.0 * self.hardening.max(0.0) * wound_rad * wound_rad;
        let [stop, zone, waves] = self.ground.stiffnesses(self.ratio);
        // Friction that gives way is a spring below break-away; the level may be higher elsewhere, but not by orders.
        let level = self.coulomb
            + self.asymmetric_coulomb.abs()
            + self.stribeck.max(0.0)
            + self.level.tight_spot[0].max(0.0);
        [
            ("stiffness_nm_per_rad", self.ratio * self.ratio * tangent),
            ("aligning_nm_per_rad", self.aligning),
            ("end_stop_nm_per_rad", stop),
            ("dead_zone_nm_per_rad", zone),
            ("cogging_nm", waves),
            ("presliding_breakaway_rad", level * self.bristle.per_travel),
        ]
    }

    /// Which effects the step must look at, as bits.
    pub(super) fn effects(&self) -> usize {
        let any = |values: &[f64]| values.iter().any(|v| *v != 0.0);
        let local = any(&[self.hardening, self.asymmetric_coulomb])
            || self.ground.has_springs()
            || self.level.is_straight();
        [
            (LOCAL, local),
            (
                CURVED,
                any(&[self.stribeck, self.drag, self.asymmetric_viscous]),
            ),
            (WAVY, self.ground.has_waves() || self.level.has_spot()),
            (ELASTIC, self.bristle.acts()),
            (LUGRE, self.bristle.lugre != 0.0),
        ]
        .into_iter()
        .fold(
            PLAIN,
            |bits, (bit, acts)| if acts { bits | bit } else { bits },
        )
    }
}

impl OneMass<Pure> {
    /// The torque that springs and load put on the body.
    #[inline(always)]
    #[must_use]
    pub fn torque<const WITH: usize>(&self, psi: Pure, load: Pure, phi: Pure) -> Pure {
        let at_wheel = motion(phi, Pure::ZERO, Pure::ZERO);
        let sum = self.ratio * self.at_handwheel::<WITH>(psi, phi)
            - self.aligning * one::<Stiffness>(&at_wheel, 0.0)
            + load;
        if WITH & (LOCAL | WAVY) == 0 {
            return sum;
        }
        sum - self.ground.torque::<WITH>(phi, self.ratio)
    }

    /// The torque that the spring asks of the handwheel.
    #[inline(always)]
    #[must_use]
    pub fn at_handwheel<const WITH: usize>(&self, psi: Pure, phi: Pure) -> Pure {
        let wound = motion(self.wound(psi, phi), Pure::ZERO, Pure::ZERO);
        let linear = self.stiffness * one::<Stiffness>(&wound, 0.0);
        if WITH & LOCAL == 0 {
            return linear;
        }
        linear + self.hardening * one::<Hardening>(&wound, 0.0)
    }

    /// How far the spring at the handwheel is wound up, its gap taken off.
    #[inline(always)]
    fn wound(&self, psi: Pure, phi: Pure) -> Pure {
        luz(psi - self.ratio * phi, self.gap * Pure(0.5))
    }

    /// Energy of motion and springs.
    #[must_use]
    pub fn stored(&self, psi: Pure, phi: Pure, v: Pure) -> Pure {
        let wound = self.wound(psi, phi);
        let square = wound * wound;
        Pure(0.5) * (self.inertia * v * v + self.stiffness * square + self.aligning * phi * phi)
            + Pure(0.25) * self.hardening * square * square
            + self.ground.stored(phi, self.ratio)
    }

    /// Stribeck's part of dry friction.
    #[inline(always)]
    #[must_use]
    pub fn stribeck_torque(&self, speed: Pure, direction: Pure) -> Pure {
        let moving = motion(Pure::ZERO, speed, direction);
        direction * self.stribeck * one::<Stribeck>(&moving, self.stribeck_speed.0)
    }

    /// The level of dry friction at an angle and under a load, without what depends on side and speed. It never falls
    /// so far that friction drives.
    #[inline(always)]
    #[must_use]
    pub(super) fn base<const WITH: usize>(&self, phi: Pure, load: Pure) -> Pure {
        if WITH & (LOCAL | WAVY) == 0 {
            return self.coulomb;
        }
        let least =
            self.asymmetric_coulomb.abs() + Pure::ZERO.when(self.stribeck.0 > 0.0, -self.stribeck);
        (self.coulomb + self.level.here::<WITH>(phi, load)).clamp(least, Pure(f64::INFINITY))
    }

    /// Dry friction while moving in a direction, without Stribeck's part.
    #[inline(always)]
    #[must_use]
    pub(super) fn kinetic<const WITH: usize>(
        &self,
        direction: Pure,
        phi: Pure,
        load: Pure,
    ) -> Pure {
        let base = self.base::<WITH>(phi, load);
        if WITH & LOCAL == 0 {
            return direction * base;
        }
        let moving = motion(Pure::ZERO, Pure::ZERO, direction);
        direction * (base + self.asymmetric_coulomb * one::<AsymmetricCoulomb>(&moving, 0.0))
    }

    /// What friction holds after a rest of so many seconds.
    #[inline(always)]
    pub(super) fn held<const WITH: usize>(&self, phi: Pure, load: Pure, rest_s: Pure) -> Held {
        let base = self.base::<WITH>(phi, load);
        let level = if WITH & CURVED == 0 {
            base
        } else {
            base + self.stribeck
        };
        if WITH & LOCAL == 0 {
            return Held {
                middle: level + self.stiction,
                difference: Pure::ZERO,
            };
        }
        Held {
            middle: level + self.stiction + self.level.rested(rest_s),
            difference: self.asymmetric_coulomb,
        }
    }

    /// The torque of what depends on the speed in a curved way: Stribeck's part, drag, one-sided viscous friction.
    #[inline(always)]
    #[must_use]
    pub fn curved(&self, speed: Pure, direction: Pure) -> Pure {
        let moving = motion(Pure::ZERO, speed, direction);
        self.stribeck_torque(speed, direction)
            + self.asymmetric_viscous * one::<AsymmetricViscous>(&moving, 0.0)
            + self.drag * one::<Drag>(&moving, 0.0)
    }

    /// The viscous torque.
    #[inline(always)]
    #[must_use]
    pub fn linear(&self, speed: Pure) -> Pure {
        self.viscous * one::<Viscous>(&motion(Pure::ZERO, speed, Pure::ZERO), 0.0)
    }
}

/// The state of motion at an angle of the road wheel, the turning part turned by another, at rest.
#[inline(always)]
pub(super) fn at(position: Pure, turn_rad: Pure) -> Motion<Pure> {
    let mut motion = motion(position, Pure::ZERO, Pure::ZERO);
    motion.turn_rad = turn_rad;
    motion
}

#[inline(always)]
fn motion(position: Pure, speed: Pure, direction: Pure) -> Motion<Pure> {
    Motion {
        position,
        speed,
        acceleration: Pure::ZERO,
        turn_rad: position,
        time_s: Pure::ZERO,
        rest_s: Pure::ZERO,
        travelled: Pure::ZERO,
        direction,
        slowest_speed: Pure::ONE,
        load_n: Pure::ZERO,
    }
}

/// The one basis value of a law.
#[inline(always)]
pub(super) fn one<T: Law>(motion: &Motion<Pure>, inner: f64) -> Pure {
    let mut out = [Pure::ZERO];
    T::basis(motion, &[inner], &mut out);
    out[0]
}
