//! Friction torque in proportion to speed.

use super::{Card, Kind, Lane, Law, Motion, Parameter, Role};

/// The law of `viscous`.
pub struct Viscous;

impl Law for Viscous {
    const CARD: Card = Card {
        name: "viscous",
        title: "viscous friction",
        kind: Kind::Torque,
        behind_gap: true,
        equation: "mu w",
        look: "The loop grows in height with speed, by the same amount each way.",
        cause: "Grease, oil, eddy currents in the motor.",
        check: "Warm the robot up; compare slow and fast strokes.",
        typical: "0.1 to 0.6 Nm per rad/s",
        source: "Wieckowski and Zardecki, Influence of freeplay and friction in steering system on double lane change manoeuvre, eq. (4)",
        parameters: &[Parameter {
            key: "coefficient_nm_s_per_rad",
            symbol: "mu",
            meaning: "torque per speed",
            role: Role::Linear,
            low: 0.0,
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
        out[0] = motion.speed;
    }
}
