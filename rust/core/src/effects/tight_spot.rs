//! More dry friction around one angle.

use super::{Card, Grid, Kind, Lane, Law, Motion, Parameter, Role};

/// The law of `tight_spot`.
pub struct TightSpot;

impl Law for TightSpot {
    const CARD: Card = Card {
        name: "tight_spot",
        title: "tight spot",
        kind: Kind::FrictionLevel,
        behind_gap: true,
        equation: "+ extra exp(-(x - angle)^2 / (2 width^2)) on the level",
        look: "The loop bulges at one angle, outward on both sides.",
        cause: "A dent, a dirty tooth, a seal that catches.",
        check: "Turn slowly through the angle and feel; clean and inspect there.",
        typical: "0.1 to 0.5 Nm over 3 to 12 degrees",
        source: "Gaussian bump",
        parameters: &[
            Parameter {
                key: "extra_nm",
                symbol: "extra",
                meaning: "friction at the spot above the level",
                role: Role::Linear,
                low: f64::NEG_INFINITY,
                high: f64::INFINITY,
            },
            Parameter {
                key: "angle_rad",
                symbol: "angle",
                meaning: "where the spot is",
                role: Role::Inner(Grid::Place),
                low: f64::NEG_INFINITY,
                high: f64::INFINITY,
            },
            Parameter {
                key: "width_rad",
                symbol: "width",
                meaning: "standard deviation of the spot",
                role: Role::Inner(Grid::Width),
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

    #[inline]
    fn basis<L: Lane>(motion: &Motion<L>, inner: &[f64], out: &mut [L]) {
        let away = (motion.position - L::splat(inner[0])) / L::splat(inner[1]);
        out[0] = (away * away * L::splat(-0.5)).exp();
    }
}
