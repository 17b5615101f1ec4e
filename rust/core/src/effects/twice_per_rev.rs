//! A torque that repeats twice per turn of the wheel.

use super::{Card, Kind, Lane, Law, Motion, Parameter, Role};

/// The law of `twice_per_rev`.
pub struct TwicePerRev;

impl Law for TwicePerRev {
    const CARD: Card = Card {
        name: "twice_per_rev",
        title: "twice-per-turn torque",
        kind: Kind::Torque,
        behind_gap: false,
        equation: "a sin(2 x + phase)",
        look: "Two waves per turn, the same in both directions.",
        cause: "A universal joint at an angle, an oval ring.",
        check: "Check the angle of the universal joint and the roundness of the ring.",
        typical: "0.05 to 0.3 Nm",
        source: "universal joint: tan(out) = tan(in) cos(angle)",
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
        ],
        becomes: None,
        per_turn: true,
        channel: None,
        needs: None,
        structures: &[],
    };
    const COLUMNS: usize = 2;

    #[inline]
    fn basis<L: Lane>(motion: &Motion<L>, _inner: &[f64], out: &mut [L]) {
        let angle = motion.turn_rad * L::splat(2.0);
        out[0] = angle.sin();
        out[1] = angle.cos();
    }
}
