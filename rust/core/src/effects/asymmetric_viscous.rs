//! Viscous friction that differs between the two directions.

use super::{Card, Kind, Lane, Law, Motion, Parameter, Role};

/// The law of `asymmetric_viscous`.
pub struct AsymmetricViscous;

impl Law for AsymmetricViscous {
    const CARD: Card = Card {
        name: "asymmetric_viscous",
        title: "direction-dependent viscous friction",
        kind: Kind::Torque,
        behind_gap: true,
        equation: "d |w|",
        look: "One side of the loop grows with speed more than the other.",
        cause: "A worn or fatigued screw or gear flank, a one-way seal.",
        check: "Inspect the flank or screw that carries the load in the heavier direction.",
        typical: "0.05 to 0.5 Nm per rad/s",
        source: "Janot, Gautier, Brunot 2019, Data Set and Reference Models of EMPS (screw fatigue)",
        parameters: &[Parameter {
            key: "difference_nm_s_per_rad",
            symbol: "d",
            meaning: "half the difference of the one-sided coefficients",
            role: Role::Linear,
            low: f64::NEG_INFINITY,
            high: f64::INFINITY,
        }],
        becomes: None,
        per_turn: false,
        channel: None,
        needs: None,
        structures: &[],
    };
    const COLUMNS: usize = 1;

    #[inline]
    fn basis<L: Lane>(motion: &Motion<L>, _inner: &[f64], out: &mut [L]) {
        out[0] = motion.speed.abs();
    }
}
