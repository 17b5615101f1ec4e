//! A stop that is met near the ends of the strokes.

use super::{Card, Grid, Kind, Lane, Law, Motion, Parameter, Role};

/// The law of `end_stop`.
pub struct EndStop;

impl Law for EndStop {
    const CARD: Card = Card {
        name: "end_stop",
        title: "end stop",
        kind: Kind::Spring,
        behind_gap: false,
        equation: "k luz(x, limit)",
        look: "Torque shoots up beyond one angle on either side.",
        cause: "Steering lock, cable end, robot tie-down touching.",
        check: "Keep away from the lock; check the tie-down (TB 038 Annex I step 3).",
        typical: "2 Nm/rad and more",
        source: "Wieckowski and Zardecki, Influence of freeplay and friction in steering system on double lane change manoeuvre, eq. (3), unilateral",
        parameters: &[
            Parameter {
                key: "stiffness_nm_per_rad",
                symbol: "k",
                meaning: "stiffness of the stop",
                role: Role::Linear,
                low: 0.0,
                high: f64::INFINITY,
            },
            Parameter {
                key: "limit_rad",
                symbol: "limit",
                meaning: "angle where the stop is met",
                role: Role::Inner(Grid::Reach {
                    low: 0.68,
                    high: 0.98,
                }),
                low: 0.0,
                high: f64::INFINITY,
            },
        ],
        becomes: None,
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
