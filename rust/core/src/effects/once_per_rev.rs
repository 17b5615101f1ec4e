//! A torque that repeats once per turn of the wheel.

use super::{Card, Kind, Lane, Law, Motion, Parameter, Role};

/// The law of `once_per_rev`.
pub struct OncePerRev;

impl Law for OncePerRev {
    const CARD: Card = Card {
        name: "once_per_rev",
        title: "once-per-turn torque",
        kind: Kind::Torque,
        behind_gap: false,
        equation: "a sin(x + phase)",
        look: "A sine over the angle, the same in both directions; within +-60 degrees it looks like a spring.",
        cause: "Gear ring off centre or out of balance: its weight acts on the load cell.",
        check: "Recentre the Orbit gear ring on the column (TB 038 Annex I step 12); turn beyond +-180 degrees to be sure.",
        typical: "0.05 to 0.3 Nm",
        source: "TB 038 Annex I step 12",
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
        out[0] = motion.turn_rad.sin();
        out[1] = motion.turn_rad.cos();
    }
}
