//! The seed paper's steering model of one mass, equation (5): handwheel angle in, road-wheel angle out.
//!
//! `I phi'' + friction(phi') = M`, `M = p (K l + K3 l^3) - c phi + M_phi`, `l = luz(psi - p phi, z0)`. At rest friction
//! is whatever keeps the body there, up to its static level.

use crate::Error;
use crate::effects::{
    AsymmetricCoulomb, AsymmetricViscous, Drag, Hardening, Law, Motion, Stiffness, Stribeck,
    Viscous,
};
use crate::projections::luz;

use super::number::Pure;

/// How many parameters a body has.
pub const PARAMETERS: usize = 14;

/// Their names, in the order of [`OneMass::from_array`].
pub const NAMES: [&str; PARAMETERS] = [
    "inertia_kg_m2",
    "ratio",
    "stiffness_nm_per_rad",
    "aligning_nm_per_rad",
    "gap_rad",
    "hardening_nm_per_rad3",
    "viscous_nm_s_per_rad",
    "asymmetric_viscous_nm_s_per_rad",
    "drag_nm_s2_per_rad2",
    "coulomb_nm",
    "asymmetric_coulomb_nm",
    "stribeck_nm",
    "stribeck_speed_rad_s",
    "stiction_nm",
];

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
}

impl OneMass<f64> {
    /// Reads the parameters in the order of [`NAMES`] and checks them.
    ///
    /// # Errors
    /// [`Error::NonFinite`] or [`Error::OutOfRange`], naming the parameter.
    pub fn from_array(values: &[f64; PARAMETERS]) -> Result<Self, Error> {
        for (name, value) in NAMES.iter().zip(values) {
            if !value.is_finite() {
                return Err(Error::NonFinite {
                    name,
                    index: 0,
                    value: *value,
                });
            }
        }
        let out = |name: &'static str, value: f64, interval: &str| {
            Err(Error::OutOfRange {
                name,
                value,
                interval: interval.to_owned(),
            })
        };
        for positive in [0, 1] {
            if values[positive] <= 0.0 {
                return out(NAMES[positive], values[positive], "(0, inf)");
            }
        }
        for not_negative in [2, 3, 4, 6, 8, 9, 12] {
            if values[not_negative] < 0.0 {
                return out(NAMES[not_negative], values[not_negative], "[0, inf)");
            }
        }
        let [
            inertia,
            ratio,
            stiffness,
            aligning,
            gap,
            hardening,
            viscous,
            asymmetric_viscous,
            drag,
            coulomb,
            asymmetric_coulomb,
            stribeck,
            stribeck_speed,
            stiction,
        ] = *values;
        // Friction that drives the motion would be a source of energy.
        if asymmetric_coulomb.abs() > coulomb {
            return out(NAMES[10], asymmetric_coulomb, "[-coulomb_nm, coulomb_nm]");
        }
        if asymmetric_viscous.abs() > viscous {
            let interval = "[-viscous_nm_s_per_rad, viscous_nm_s_per_rad]";
            return out(NAMES[7], asymmetric_viscous, interval);
        }
        let least = coulomb - asymmetric_coulomb.abs();
        if stribeck < -least {
            return out(NAMES[11], stribeck, "[-coulomb_nm, inf)");
        }
        if stribeck != 0.0 && stribeck_speed <= 0.0 {
            return out(NAMES[12], stribeck_speed, "(0, inf) with a stribeck_nm");
        }
        if stiction < 0.0 {
            let interval = "[0, inf): static friction is at least kinetic friction";
            return out(NAMES[13], stiction, interval);
        }
        Ok(Self {
            inertia,
            ratio,
            stiffness,
            aligning,
            gap,
            hardening,
            viscous,
            asymmetric_viscous,
            drag,
            coulomb,
            asymmetric_coulomb,
            stribeck,
            // Without an extra the speed says nothing, and 0 would divide.
            stribeck_speed: if stribeck_speed > 0.0 {
                stribeck_speed
            } else {
                1.0
            },
            stiction,
        })
    }

    /// The parameters in the order of [`NAMES`].
    #[must_use]
    pub fn to_array(&self) -> [f64; PARAMETERS] {
        [
            self.inertia,
            self.ratio,
            self.stiffness,
            self.aligning,
            self.gap,
            self.hardening,
            self.viscous,
            self.asymmetric_viscous,
            self.drag,
            self.coulomb,
            self.asymmetric_coulomb,
            self.stribeck,
            self.stribeck_speed,
            self.stiction,
        ]
    }

    /// The same body as the step takes it.
    #[must_use]
    pub fn pure(&self) -> OneMass<Pure> {
        let values = self.to_array();
        OneMass::gather(&values.map(|v| [v]), 0)
    }

    /// Highest circular frequency of the body on its springs, rad/s, where the handwheel spring is wound up by no
    /// more than `wound_rad`.
    #[must_use]
    pub fn highest_frequency_rad_s(&self, wound_rad: f64) -> f64 {
        let tangent = self.stiffness + 3.0 * self.hardening.max(0.0) * wound_rad * wound_rad;
        ((self.ratio * self.ratio * tangent + self.aligning) / self.inertia).sqrt()
    }

    /// Whether anything beyond linear springs, a gap, viscous and symmetric dry friction acts. What does not act adds
    /// exactly 0, so that leaving it out of the step changes no bit.
    #[must_use]
    pub fn is_rich(&self) -> bool {
        self.stribeck != 0.0
            || self.drag != 0.0
            || self.asymmetric_viscous != 0.0
            || self.asymmetric_coulomb != 0.0
            || self.hardening != 0.0
    }
}

impl OneMass<Pure> {
    /// One lane of a table of parameters, in the order of [`NAMES`].
    #[inline(always)]
    pub(super) fn gather<const N: usize>(table: &[[f64; N]; PARAMETERS], lane: usize) -> Self {
        let of = |row: usize| Pure(table[row][lane]);
        Self {
            inertia: of(0),
            ratio: of(1),
            stiffness: of(2),
            aligning: of(3),
            gap: of(4),
            hardening: of(5),
            viscous: of(6),
            asymmetric_viscous: of(7),
            drag: of(8),
            coulomb: of(9),
            asymmetric_coulomb: of(10),
            stribeck: of(11),
            stribeck_speed: of(12),
            stiction: of(13),
        }
    }

    /// The torque that springs and load put on the body.
    #[inline(always)]
    #[must_use]
    pub fn torque<const RICH: bool>(&self, psi: Pure, load: Pure, phi: Pure) -> Pure {
        let at_wheel = motion(phi, Pure::ZERO, Pure::ZERO);
        self.ratio * self.at_handwheel::<RICH>(psi, phi)
            - self.aligning * one::<Stiffness>(&at_wheel, 0.0)
            + load
    }

    /// The torque that the spring asks of the handwheel.
    #[inline(always)]
    #[must_use]
    pub fn at_handwheel<const RICH: bool>(&self, psi: Pure, phi: Pure) -> Pure {
        let wound = motion(self.wound(psi, phi), Pure::ZERO, Pure::ZERO);
        let linear = self.stiffness * one::<Stiffness>(&wound, 0.0);
        if !RICH {
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
    }

    /// Stribeck's part of dry friction.
    #[inline(always)]
    #[must_use]
    pub fn stribeck_torque(&self, speed: Pure, direction: Pure) -> Pure {
        let moving = motion(Pure::ZERO, speed, direction);
        direction * self.stribeck * one::<Stribeck>(&moving, self.stribeck_speed.0)
    }

    /// Dry friction while moving in a direction, without Stribeck's part.
    #[inline(always)]
    #[must_use]
    pub fn kinetic<const RICH: bool>(&self, direction: Pure) -> Pure {
        if !RICH {
            return direction * self.coulomb;
        }
        let moving = motion(Pure::ZERO, Pure::ZERO, direction);
        direction
            * (self.coulomb + self.asymmetric_coulomb * one::<AsymmetricCoulomb>(&moving, 0.0))
    }

    /// The largest torque on either side that friction holds at rest.
    #[inline(always)]
    #[must_use]
    pub fn held<const RICH: bool>(&self, direction: Pure) -> Pure {
        if !RICH {
            return self.coulomb + self.stiction;
        }
        self.coulomb + direction * self.asymmetric_coulomb + self.stribeck + self.stiction
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
fn one<T: Law>(motion: &Motion<Pure>, inner: f64) -> Pure {
    let mut out = [Pure::ZERO];
    T::basis(motion, &[inner], &mut out);
    out[0]
}
