//! Friction at rest above the level while moving.

use super::{Card, Kind, Lane, Law, Motion, Parameter, Role};

/// The law of `stiction`.
pub struct Stiction;

impl Law for Stiction {
    const CARD: Card = Card {
        name: "stiction",
        title: "stiction (static above kinetic friction)",
        kind: Kind::FrictionLevel,
        behind_gap: true,
        equation: "F_S - F_K at w = 0, on top of Coulomb friction",
        look: "A spike at every start, gone once the motion is under way.",
        cause: "Dry contact that settles at rest, sticking seals.",
        check: "Start several strokes very slowly; relubricate.",
        typical: "0.1 to 0.5 Nm",
        source: "paper eq. (5): kinetic and static dry friction",
        parameters: &[Parameter {
            key: "extra_nm",
            symbol: "F_S - F_K",
            meaning: "static friction above the Coulomb level",
            role: Role::Linear,
            low: 0.0,
            high: f64::INFINITY,
        }],
        becomes: None,
        per_turn: false,
        channel: None,
        needs: Some("coulomb"),
        structures: &[],
    };
    const COLUMNS: usize = 1;
    const AT_REST: bool = true;

    fn basis<L: Lane>(motion: &Motion<L>, _inner: &[f64], out: &mut [L]) {
        // Either the limit of Stribeck's law for a speed that goes to zero, the slowest the record resolves, or what is
        // left over of the rest a little after break-away: whichever is more.
        let ratio = motion.speed / motion.slowest_speed;
        let slow = (-(ratio * ratio)).exp();
        out[0] = slow.clamp(motion.left_of_rest(), L::splat(1.0));
    }
}
