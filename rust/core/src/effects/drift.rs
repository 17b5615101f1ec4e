//! A reading that wanders in proportion to time.

use super::{Card, Kind, Lane, Law, Motion, Parameter, Role};

/// The law of `drift`.
pub struct Drift;

impl Law for Drift {
    const CARD: Card = Card {
        name: "drift",
        title: "drift",
        kind: Kind::Sensor,
        behind_gap: false,
        equation: "rate t",
        look: "Loops of one run climb or sink one after the other.",
        cause: "Load cell or amplifier warming up, a leaking sucker mount.",
        check: "Let the amplifier warm up for 20 minutes; zero again (TB 038 Annex I step 9) and compare the zero before and after.",
        typical: "0.001 to 0.02 Nm/s",
        source: "definition: a wandering zero, first order in time; the zero is TB 038 Annex I step 9",
        parameters: &[Parameter {
            key: "rate_nm_per_s",
            symbol: "rate",
            meaning: "change of the reading per second",
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

    fn basis<L: Lane>(motion: &Motion<L>, _inner: &[f64], out: &mut [L]) {
        out[0] = motion.time_s;
    }
}
