//! The torque channel is late against the angle channel.

use super::{Card, Grid, Kind, Lane, Law, Motion, Parameter, Role};

/// The law of `delay`.
pub struct Delay;

impl Law for Delay {
    const CARD: Card = Card {
        name: "delay",
        title: "sensor delay",
        kind: Kind::Sensor,
        behind_gap: false,
        equation: "T(t) = model(t - tau)",
        look: "Every reversal is late by the same time: wider corners at higher speed.",
        cause: "A filter in one channel only, bus latency, unsynchronised clocks.",
        check: "Record both channels on one clock with the same filter; ask for the logger's filter settings.",
        typical: "2 to 50 ms",
        source: "definition of a dead time; a causal 4-pole Butterworth low pass at f Hz is late by 2.61 / (2 pi f)",
        parameters: &[Parameter {
            key: "time_s",
            symbol: "tau",
            meaning: "how late the torque is",
            role: Role::Inner(Grid::Delay),
            low: 0.0,
            high: 0.1,
        }],
        becomes: Some("coulomb"),
        per_turn: false,
        channel: None,
        needs: None,
        structures: &[],
    };
    const COLUMNS: usize = 0;
    const SHAPES_OTHERS: bool = true;

    fn basis<L: Lane>(_motion: &Motion<L>, _inner: &[f64], _out: &mut [L]) {}

    fn delay_s(inner: &[f64]) -> f64 {
        inner[0]
    }
}
