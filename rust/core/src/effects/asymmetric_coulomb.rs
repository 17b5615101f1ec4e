//! Coulomb friction that differs between the two directions.

use super::{Card, Kind, Lane, Law, Motion, Parameter, Role};

/// The law of `asymmetric_coulomb`.
pub struct AsymmetricCoulomb;

impl Law for AsymmetricCoulomb {
    const CARD: Card = Card {
        name: "asymmetric_coulomb",
        title: "direction-dependent Coulomb friction",
        kind: Kind::FrictionLevel,
        behind_gap: true,
        equation: "+ d sign(direction) on the level",
        look: "Both sides of the loop are shifted the same way: while moving it is an offset.",
        cause: "A worn flank, a one-sided seal, a belt that pulls one way.",
        check: "Read the load cell with nothing attached: what remains is offset, the rest is this (TB 038 Annex I step 9).",
        typical: "0.05 to 0.3 Nm",
        source: "Janot, Gautier, Brunot 2019, Data Set and Reference Models of EMPS (Fc+ and Fc-)",
        parameters: &[Parameter {
            key: "difference_nm",
            symbol: "d",
            meaning: "half the difference of the one-sided levels",
            role: Role::Linear,
            low: f64::NEG_INFINITY,
            high: f64::INFINITY,
        }],
        becomes: Some("offset"),
        per_turn: false,
        channel: None,
        needs: Some("coulomb"),
        structures: &[],
    };
    const COLUMNS: usize = 1;

    #[inline]
    fn basis<L: Lane>(motion: &Motion<L>, _inner: &[f64], out: &mut [L]) {
        out[0] = motion.direction;
    }
}
