//! Dry friction in proportion to the load on the contact.

use super::{Card, Kind, Lane, Law, Motion, Parameter, Role};

/// The law of `load`.
pub struct Load;

impl Law for Load {
    const CARD: Card = Card {
        name: "load",
        title: "load-dependent friction",
        kind: Kind::FrictionLevel,
        behind_gap: true,
        equation: "+ c |load| on the level",
        look: "The loop widens with the force on the link.",
        cause: "Side load on bearings and gear mesh.",
        check: "Keep the load cell perpendicular to the arm and in the plane of the ring (TB 038 Annex I step 4).",
        typical: "0.01 to 0.1 Nm per N",
        source: "Amontons, Coulomb",
        parameters: &[Parameter {
            key: "coefficient",
            symbol: "c",
            meaning: "friction per load",
            role: Role::Linear,
            low: 0.0,
            high: f64::INFINITY,
        }],
        becomes: None,
        per_turn: false,
        channel: Some("load"),
        needs: Some("coulomb"),
        structures: &[],
    };
    const COLUMNS: usize = 1;

    #[inline]
    fn basis<L: Lane>(motion: &Motion<L>, _inner: &[f64], out: &mut [L]) {
        out[0] = motion.load_n.abs();
    }
}
