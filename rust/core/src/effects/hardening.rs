//! A spring that stiffens (or softens) with the cube of the angle.

use super::{Card, Kind, Lane, Law, Motion, Parameter, Role};

/// The law of `hardening`.
pub struct Hardening;

impl Law for Hardening {
    const CARD: Card = Card {
        name: "hardening",
        title: "hardening spring",
        kind: Kind::Spring,
        behind_gap: false,
        equation: "k3 x^3",
        look: "Both sides of the loop bend up or down towards the ends.",
        cause: "Rubber parts, wound cables, linkage geometry.",
        check: "Turn further than usual: the cube grows fast.",
        typical: "0.1 to 0.5 Nm/rad^3",
        source: "Duffing spring",
        parameters: &[Parameter {
            key: "coefficient_nm_per_rad3",
            symbol: "k3",
            meaning: "torque per angle cubed",
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
        out[0] = motion.position * motion.position * motion.position;
    }
}
