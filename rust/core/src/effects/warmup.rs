//! Dry friction that falls as the mechanism runs in.

use super::{Card, Grid, Kind, Lane, Law, Motion, Parameter, Role};

/// The law of `warmup`.
pub struct Warmup;

impl Law for Warmup {
    const CARD: Card = Card {
        name: "warmup",
        title: "warm-up",
        kind: Kind::FrictionLevel,
        behind_gap: true,
        equation: "+ extra exp(-t / time) on the level",
        look: "The first loops of a run are wider than the last.",
        cause: "Cold grease, a dry start.",
        check: "Turn a few strokes before the reading (TB 038 Annex I step 11).",
        typical: "0.1 to 0.4 Nm over 5 to 30 s",
        source: "exponential run-in",
        parameters: &[
            Parameter {
                key: "extra_nm",
                symbol: "extra",
                meaning: "friction at the start above the level",
                role: Role::Linear,
                low: f64::NEG_INFINITY,
                high: f64::INFINITY,
            },
            Parameter {
                key: "time_s",
                symbol: "tau",
                meaning: "time to fall to 37 %",
                role: Role::Inner(Grid::Time),
                low: 0.0,
                high: f64::INFINITY,
            },
        ],
        becomes: None,
        per_turn: false,
        channel: None,
        needs: Some("coulomb"),
        structures: &[],
    };
    const COLUMNS: usize = 1;

    fn basis<L: Lane>(motion: &Motion<L>, inner: &[f64], out: &mut [L]) {
        out[0] = (motion.time_s * L::splat(-1.0 / inner[0])).exp();
    }
}
