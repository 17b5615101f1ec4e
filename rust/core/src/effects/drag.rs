//! Friction torque that grows with the square of the speed.

use super::{Card, Kind, Lane, Law, Motion, Parameter, Role};

/// The law of `drag`.
pub struct Drag;

impl Law for Drag {
    const CARD: Card = Card {
        name: "drag",
        title: "quadratic drag",
        kind: Kind::Torque,
        behind_gap: true,
        equation: "c w |w|",
        look: "The loop widens ever faster with speed.",
        cause: "Stirred oil or grease, air, back-EMF of a short-circuited motor.",
        check: "Compare three even speeds; change the lubricant.",
        typical: "0.5 to 2 Nm per (rad/s)^2",
        source: "quadratic drag law",
        parameters: &[Parameter {
            key: "coefficient_nm_s2_per_rad2",
            symbol: "c",
            meaning: "torque per speed squared",
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
        out[0] = motion.speed * motion.speed.abs();
    }
}
