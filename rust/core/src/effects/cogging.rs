//! A torque that repeats three or more times per turn.

use super::{Card, Grid, Kind, Lane, Law, Motion, Parameter, Role};

/// The law of `cogging`.
pub struct Cogging;

impl Law for Cogging {
    const CARD: Card = Card {
        name: "cogging",
        title: "cogging",
        kind: Kind::Torque,
        behind_gap: false,
        equation: "a sin(n x + phase), n >= 3",
        look: "Even waves over the angle, the same in both directions.",
        cause: "Magnets of the motor, teeth of the gear ring.",
        check: "Count the waves per turn: teeth or pole pairs have that number.",
        typical: "0.05 to 0.3 Nm",
        source: "permanent-magnet motors: cogging torque",
        parameters: &[
            Parameter {
                key: "amplitude_nm",
                symbol: "a",
                meaning: "amplitude",
                role: Role::Amplitude,
                low: 0.0,
                high: f64::INFINITY,
            },
            Parameter {
                key: "phase_rad",
                symbol: "phase",
                meaning: "phase at angle zero",
                role: Role::Phase,
                low: -std::f64::consts::PI,
                high: std::f64::consts::PI,
            },
            Parameter {
                key: "per_turn",
                symbol: "n",
                meaning: "waves per turn",
                role: Role::Inner(Grid::Count),
                low: 3.0,
                high: 12.0,
            },
        ],
        becomes: None,
        per_turn: true,
        channel: None,
        needs: None,
        structures: &[],
    };
    const COLUMNS: usize = 2;

    #[inline]
    fn basis<L: Lane>(motion: &Motion<L>, inner: &[f64], out: &mut [L]) {
        let angle = motion.turn_rad * L::splat(inner[0]);
        out[0] = angle.sin();
        out[1] = angle.cos();
    }
}
