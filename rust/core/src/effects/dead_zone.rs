//! A spring that acts only beyond a dead zone.

use super::{Card, Grid, Kind, Lane, Law, Motion, Parameter, Role};

/// The law of `dead_zone`.
pub struct DeadZone;

impl Law for DeadZone {
    const CARD: Card = Card {
        name: "dead_zone",
        title: "spring with a dead zone",
        kind: Kind::Spring,
        behind_gap: false,
        equation: "k luz(x, half_width)",
        look: "Flat in the middle, a slope towards both ends of the stroke.",
        cause: "Cable or hose that becomes tight, centring with play.",
        check: "Route cables freely; look where the slope begins.",
        typical: "0.2 to 1 Nm/rad beyond 10 to 40 degrees",
        source: "Wieckowski and Zardecki, Influence of freeplay and friction in steering system on double lane change manoeuvre, eq. (3)",
        parameters: &[
            Parameter {
                key: "stiffness_nm_per_rad",
                symbol: "k",
                meaning: "slope beyond the dead zone",
                role: Role::Linear,
                low: f64::NEG_INFINITY,
                high: f64::INFINITY,
            },
            Parameter {
                key: "half_width_rad",
                symbol: "a",
                meaning: "half width of the dead zone",
                role: Role::Inner(Grid::Reach {
                    low: 0.05,
                    high: 0.65,
                }),
                low: 0.0,
                high: f64::INFINITY,
            },
        ],
        becomes: Some("stiffness"),
        per_turn: false,
        channel: None,
        needs: None,
        structures: &[],
    };
    const COLUMNS: usize = 1;

    #[inline]
    fn basis<L: Lane>(motion: &Motion<L>, inner: &[f64], out: &mut [L]) {
        let a = L::splat(inner[0]);
        out[0] = motion.position - motion.position.clamp(-a, a);
    }
}
