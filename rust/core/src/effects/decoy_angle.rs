//! A decoy: a wave over the range of motion with a number of periods that no part has.

use super::{Card, Grid, Kind, Lane, Law, Motion, Parameter, Role};

/// The law of `decoy_angle`.
pub struct DecoyAngle;

impl Law for DecoyAngle {
    const CARD: Card = Card {
        name: "decoy_angle",
        title: "decoy (wave over the range)",
        kind: Kind::Decoy,
        behind_gap: false,
        equation: "c sin(2 pi 2.3 x / range)",
        look: "Nothing to look for.",
        cause: "None: a ruler for what chance alone can explain.",
        check: "Nothing; if it wins, something outside the catalogue is missing.",
        typical: "none",
        source: "a random probe feature, after Stoppiglia et al. 2003, J. Machine Learning Research 3:1399",
        parameters: &[
            Parameter {
                key: "level_nm",
                symbol: "c",
                meaning: "amplitude",
                role: Role::Linear,
                low: f64::NEG_INFINITY,
                high: f64::INFINITY,
            },
            Parameter {
                key: "wave_number_per_rad",
                symbol: "n",
                meaning: "waves per angle",
                role: Role::Inner(Grid::WavesPerRange(2.3)),
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

    fn basis<L: Lane>(motion: &Motion<L>, inner: &[f64], out: &mut [L]) {
        out[0] = (motion.position * L::splat(inner[0])).sin();
    }
}
