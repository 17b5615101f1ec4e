//! The angle channel is late against the torque channel.

use super::{Card, Grid, Kind, Lane, Law, Motion, Parameter, Role};

/// The law of `lead`.
pub struct Lead;

impl Law for Lead {
    const CARD: Card = Card {
        name: "lead",
        title: "torque ahead of the angle",
        kind: Kind::Sensor,
        behind_gap: false,
        equation: "T(t) = model(t + tau)",
        look: "Every reversal of the torque comes before that of the angle, by the same time.",
        cause: "A filter or tracking loop in the angle channel only, channels sampled one after the other, a command recorded in place of the torque.",
        check: "Record both channels on one clock with the same filter; ask for the logger's filter settings.",
        typical: "1 to 50 ms",
        source: "a dead time of the other channel; on the EMPS axis (Janot, Gautier, Brunot 2019) the recorded command leads by 0.8 ms",
        parameters: &[Parameter {
            key: "time_s",
            symbol: "tau",
            meaning: "how early the torque is",
            role: Role::Inner(Grid::Delay),
            low: 0.0,
            high: 0.1,
        }],
        becomes: Some("coulomb"),
        per_turn: false,
        channel: None,
        needs: None,
        // A rig measures its torque: there a lead would only be one more curve that a start can look like.
        structures: &["axis"],
    };
    const COLUMNS: usize = 0;
    const SHAPES_OTHERS: bool = true;

    fn basis<L: Lane>(_motion: &Motion<L>, _inner: &[f64], _out: &mut [L]) {}

    fn delay_s(inner: &[f64]) -> f64 {
        -inner[0]
    }
}
