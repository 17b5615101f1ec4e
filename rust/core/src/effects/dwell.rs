//! Static friction that grows with the time at rest.

use super::{Card, Grid, Kind, Lane, Law, Motion, Parameter, Role};

/// The law of `dwell`.
pub struct Dwell;

impl Law for Dwell {
    const CARD: Card = Card {
        name: "dwell",
        title: "static friction that grows at rest",
        kind: Kind::FrictionLevel,
        behind_gap: true,
        equation: "+ extra (1 - exp(-rest / time)) at break-away",
        look: "The spike at a start is higher after a longer pause.",
        cause: "Creep of the contact, squeezed-out grease.",
        check: "Start after pauses of different length.",
        typical: "0.1 to 0.5 Nm over 0.2 to 3 s",
        source: "Rabinowicz 1958; Armstrong-Helouvry, Dupont, Canudas de Wit 1994, Automatica 30:1083",
        parameters: &[
            Parameter {
                key: "extra_nm",
                symbol: "extra",
                meaning: "growth after a long rest",
                role: Role::Linear,
                low: f64::NEG_INFINITY,
                high: f64::INFINITY,
            },
            Parameter {
                key: "time_s",
                symbol: "tau",
                meaning: "time of growth",
                role: Role::Inner(Grid::Rest),
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
    const AT_REST: bool = true;

    #[inline]
    fn basis<L: Lane>(motion: &Motion<L>, inner: &[f64], out: &mut [L]) {
        let grown = L::splat(1.0) - (motion.rest_s * L::splat(-1.0 / inner[0])).exp();
        out[0] = grown * motion.left_of_rest();
    }
}
