//! A spring: torque in proportion to the angle.

use super::{Card, Kind, Lane, Law, Motion, Parameter, Role};

/// The law of `stiffness`.
pub struct Stiffness;

impl Law for Stiffness {
    const CARD: Card = Card {
        name: "stiffness",
        title: "stiffness (spring)",
        kind: Kind::Spring,
        behind_gap: false,
        equation: "k x",
        look: "Both sides of the loop are tilted by the same slope.",
        cause: "A cable or hose that winds up, a centring spring, the tyres.",
        check: "Route cables freely; lift the front axle or disconnect the column.",
        typical: "0.05 to 0.5 Nm/rad",
        source: "Wieckowski and Zardecki, Influence of freeplay and friction in steering system on double lane change manoeuvre, eq. (3)",
        parameters: &[Parameter {
            key: "stiffness_nm_per_rad",
            symbol: "k",
            meaning: "torque per angle",
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
        out[0] = motion.position;
    }
}
