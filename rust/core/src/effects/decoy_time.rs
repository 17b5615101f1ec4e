//! A decoy: a cosine of time with a period of 7 s, which no mechanism has.

use super::{Card, Kind, Lane, Law, Motion, Parameter, Role};

/// The law of `decoy_time`.
pub struct DecoyTime;

impl Law for DecoyTime {
    const CARD: Card = Card {
        name: "decoy_time",
        title: "decoy (cosine of time)",
        kind: Kind::Decoy,
        behind_gap: false,
        equation: "c cos(2 pi t / 7 s)",
        look: "Nothing to look for.",
        cause: "None: a ruler for what chance alone can explain.",
        check: "Nothing; if it wins, something outside the catalogue is missing.",
        typical: "none",
        source: "a random probe feature, after Stoppiglia et al. 2003, J. Machine Learning Research 3:1399",
        parameters: &[Parameter {
            key: "level_nm",
            symbol: "c",
            meaning: "amplitude",
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
        out[0] = (motion.time_s * L::splat(std::f64::consts::TAU / 7.0)).cos();
    }
}
