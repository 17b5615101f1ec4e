//! What the oracle can solve: bodies with linear springs and dampers between them, springs with a gap, dry friction.

use crate::Error;
use crate::error::require_same_length;

use super::super::{NAMES, OneMass, PARAMETERS};
use super::signal::Signal;

/// The parameters of the one-mass model whose laws are piecewise linear.
const PIECEWISE_LINEAR: [&str; 10] = [
    "inertia_kg_m2",
    "ratio",
    "stiffness_nm_per_rad",
    "aligning_nm_per_rad",
    "gap_rad",
    "viscous_nm_s_per_rad",
    "asymmetric_viscous_nm_s_per_rad",
    "coulomb_nm",
    "asymmetric_coulomb_nm",
    "stiction_nm",
];

/// One body and the friction on its own coordinate.
///
/// Friction acts on the motion relative to a ground that moves at a constant speed (a belt). Against a motion to the
/// side `s` it is `kinetic[s] s + viscous[s] v`; at rest it holds a torque of up to `held[s]` towards that side.
#[derive(Debug, Clone, PartialEq)]
pub struct Body {
    /// Moment of inertia, or mass.
    pub inertia: f64,
    /// Viscous coefficients, forward and backward.
    pub viscous: [f64; 2],
    /// Kinetic dry friction, forward and backward.
    pub kinetic: [f64; 2],
    /// Largest torque held at rest, forward and backward.
    pub held: [f64; 2],
    /// Speed of the ground.
    pub ground_speed: f64,
    /// Torque from outside.
    pub load: Signal,
}

/// A spring with a gap, `stiffness * luz(end - sum of at_i q_i, half_gap)`, pulling body i with `at_i` times its torque.
#[derive(Debug, Clone, PartialEq)]
pub struct Spring {
    /// Torque per angle beyond the gap.
    pub stiffness: f64,
    /// Half the width of the gap.
    pub half_gap: f64,
    /// Where its driven end is.
    pub end: Signal,
    /// How much each body moves its other end.
    pub at: Vec<f64>,
}

/// A mechanism that is linear in each of its modes.
#[derive(Debug, Clone, PartialEq)]
pub struct System {
    pub(super) bodies: Vec<Body>,
    pub(super) stiffness: Vec<f64>,
    pub(super) damping: Vec<f64>,
    pub(super) springs: Vec<Spring>,
}

impl System {
    /// Bodies, the matrices of linear springs and dampers between them and the ground (row by row), springs with gaps.
    ///
    /// # Errors
    /// [`Error::Length`] where a matrix or a spring does not fit the bodies, [`Error::NonFinite`],
    /// [`Error::OutOfRange`] for an inertia that is not positive, negative friction, stiffness or gap, static friction
    /// below kinetic friction.
    pub fn new(
        bodies: Vec<Body>,
        stiffness: &[f64],
        damping: &[f64],
        springs: Vec<Spring>,
    ) -> Result<Self, Error> {
        let count = bodies.len();
        if count == 0 {
            return Err(Error::Length {
                name: "inertia",
                expected: "at least 1".to_owned(),
                got: 0,
            });
        }
        for (name, matrix) in [("stiffness", stiffness), ("damping", damping)] {
            require_same_length(name, matrix, "inertia squared", count * count)?;
            crate::error::require_finite(name, matrix)?;
        }
        for body in &bodies {
            check_body(body)?;
        }
        for spring in &springs {
            require_same_length("at", &spring.at, "inertia", count)?;
            crate::error::require_finite("at", &spring.at)?;
            not_negative("stiffness", spring.stiffness)?;
            not_negative("gap", 2.0 * spring.half_gap)?;
        }
        Ok(Self {
            bodies,
            stiffness: stiffness.to_vec(),
            damping: damping.to_vec(),
            springs,
        })
    }

    /// The steering model of one mass, its parameters in the order of [`NAMES`], its friction on a ground of constant
    /// speed.
    ///
    /// # Errors
    /// Those of [`OneMass::from_array`], and [`Error::OutOfRange`] for what is not piecewise linear.
    pub fn one_mass(
        values: &[f64; PARAMETERS],
        handwheel: Signal,
        load: Signal,
        ground_speed: f64,
    ) -> Result<Self, Error> {
        let body = OneMass::from_array(values)?;
        for (name, &value) in NAMES.into_iter().zip(values) {
            if value != 0.0 && !PIECEWISE_LINEAR.contains(&name) {
                return Err(Error::OutOfRange {
                    name,
                    value,
                    interval: "{0}: it is not piecewise linear, simulate() takes it".to_owned(),
                });
            }
        }
        let sides = |middle: f64, half_difference: f64| {
            [middle + half_difference, middle - half_difference]
        };
        let kinetic = sides(body.coulomb, body.asymmetric_coulomb);
        let made = Body {
            inertia: body.inertia,
            viscous: sides(body.viscous, body.asymmetric_viscous),
            kinetic,
            held: kinetic.map(|level| level + body.stiction),
            ground_speed,
            load,
        };
        let spring = Spring {
            stiffness: body.stiffness,
            half_gap: 0.5 * body.gap,
            end: handwheel,
            at: vec![body.ratio],
        };
        Self::new(vec![made], &[body.aligning], &[0.0], vec![spring])
    }

    /// How many bodies.
    pub(super) fn count(&self) -> usize {
        self.bodies.len()
    }

    /// All drives.
    pub(super) fn signals(&self) -> impl Iterator<Item = &Signal> {
        let loads = self.bodies.iter().map(|body| &body.load);
        loads.chain(self.springs.iter().map(|spring| &spring.end))
    }
}

fn check_body(body: &Body) -> Result<(), Error> {
    crate::error::require_positive("inertia", body.inertia)?;
    crate::error::require_finite("ground_speed", &[body.ground_speed])?;
    for side in 0..2 {
        not_negative("viscous", body.viscous[side])?;
        not_negative("kinetic", body.kinetic[side])?;
        crate::error::require_finite("static", &[body.held[side]])?;
        if body.held[side] < body.kinetic[side] {
            return Err(Error::OutOfRange {
                name: "static",
                value: body.held[side],
                interval: format!(
                    "[{}, inf): static friction is at least kinetic friction",
                    body.kinetic[side]
                ),
            });
        }
    }
    Ok(())
}

fn not_negative(name: &'static str, value: f64) -> Result<(), Error> {
    crate::error::require_finite(name, &[value])?;
    if value < 0.0 {
        return Err(Error::OutOfRange {
            name,
            value,
            interval: "[0, inf)".to_owned(),
        });
    }
    Ok(())
}
