//! Friction that falls as speed rises, down to the Coulomb level.

use super::{Card, Grid, Kind, Lane, Law, Motion, Parameter, Role};

/// The law of `stribeck`.
pub struct Stribeck;

impl Law for Stribeck {
    const CARD: Card = Card {
        name: "stribeck",
        title: "Stribeck friction",
        kind: Kind::FrictionLevel,
        behind_gap: true,
        equation: "dF exp(-(w/v)^2) s, on top of Coulomb friction",
        look: "More torque at low speed than at medium speed; humps at both ends of a stroke.",
        cause: "Boundary lubrication at low speed; dry or stiff grease.",
        check: "Regrease; repeat with one very slow and one fast stroke.",
        typical: "0.1 to 0.5 Nm below 0.05 to 0.2 rad/s",
        source: "Armstrong-Helouvry, Dupont, Canudas de Wit 1994, Automatica 30:1083 (Gaussian form)",
        parameters: &[
            Parameter {
                key: "extra_nm",
                symbol: "dF",
                meaning: "friction at very low speed above the Coulomb level",
                role: Role::Linear,
                low: f64::NEG_INFINITY,
                high: f64::INFINITY,
            },
            Parameter {
                key: "speed_rad_s",
                symbol: "v",
                meaning: "speed at which the extra has fallen to 37 %",
                role: Role::Inner(Grid::Speed),
                low: 0.0,
                high: f64::INFINITY,
            },
        ],
        becomes: Some("stiction"),
        per_turn: false,
        channel: None,
        needs: Some("coulomb"),
        structures: &[],
    };
    const COLUMNS: usize = 1;

    #[inline]
    fn basis<L: Lane>(motion: &Motion<L>, inner: &[f64], out: &mut [L]) {
        let ratio = motion.speed / L::splat(inner[0]);
        out[0] = (-(ratio * ratio)).exp();
    }
}
