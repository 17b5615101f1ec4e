//! Torque in proportion to the acceleration.

use super::{Card, Kind, Lane, Law, Motion, Parameter, Role};

/// The law of `inertia`.
pub struct Inertia;

impl Law for Inertia {
    const CARD: Card = Card {
        name: "inertia",
        title: "inertia",
        kind: Kind::Torque,
        behind_gap: false,
        equation: "J dw/dt",
        look: "Torque leads at the start of a stroke and trails at its end; wiggles of speed show as wiggles of torque.",
        cause: "Inertia of wheel and robot ring.",
        check: "Turn more evenly; weigh the ring.",
        typical: "0.02 to 0.15 kg m^2",
        source: "Newton, Euler",
        parameters: &[Parameter {
            key: "inertia_kg_m2",
            symbol: "J",
            meaning: "moment of inertia",
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

    fn basis<L: Lane>(motion: &Motion<L>, _inner: &[f64], out: &mut [L]) {
        out[0] = motion.acceleration;
    }
}
