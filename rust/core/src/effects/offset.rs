//! A constant torque: the load cell or its amplifier is not zero.

use super::{Card, Kind, Lane, Law, Motion, Parameter, Role};

/// The law of `offset`.
pub struct Offset;

impl Law for Offset {
    const CARD: Card = Card {
        name: "offset",
        title: "offset",
        kind: Kind::Sensor,
        behind_gap: false,
        equation: "c",
        look: "The whole loop sits too high or too low; both directions move together.",
        cause: "Load cell not zeroed, weight of arm and cell, amplifier offset.",
        check: "Zero the load cell with nothing attached (TB 038 Annex I step 9); centre the hysteresis (step 13).",
        typical: "up to 0.2 Nm",
        source: "TB 038 Annex I steps 9 and 13",
        parameters: &[Parameter {
            key: "level_nm",
            symbol: "c",
            meaning: "torque read when nothing acts",
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

    fn basis<L: Lane>(_motion: &Motion<L>, _inner: &[f64], out: &mut [L]) {
        out[0] = L::splat(1.0);
    }
}
