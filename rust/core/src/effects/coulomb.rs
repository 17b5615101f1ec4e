//! Dry friction of constant size: the level of the contact's friction state.

use super::{Card, Contact, Grid, Kind, Lane, Law, Motion, Parameter, Role};

/// The law of `coulomb`.
pub struct Coulomb;

impl Law for Coulomb {
    const CARD: Card = Card {
        name: "coulomb",
        title: "Coulomb friction",
        kind: Kind::FrictionLevel,
        behind_gap: true,
        equation: "F s, s in [-1, 1] the friction state",
        look: "A rectangular loop of height 2F that does not depend on speed.",
        cause: "Seals, bearings, belt and gear mesh of the robot and the column.",
        check: "Loosen the two thumb screws of the motor by a quarter turn (TB 038 Annex I step 18) if the level is too high.",
        typical: "0.2 to 1.5 Nm",
        source: "Wieckowski and Zardecki, Influence of freeplay and friction in steering system on double lane change manoeuvre, eq. (4); TB 038 section 2.2",
        parameters: &[
            Parameter {
                key: "level_nm",
                symbol: "F",
                meaning: "dry friction torque",
                role: Role::Linear,
                low: 0.0,
                high: f64::INFINITY,
            },
            Parameter {
                key: "breakaway_rad",
                symbol: "r",
                meaning: "travel from rest to full friction",
                role: Role::Inner(Grid::Resolution),
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
    const SHAPES_OTHERS: bool = true;

    fn basis<L: Lane>(_motion: &Motion<L>, _inner: &[f64], out: &mut [L]) {
        out[0] = L::splat(1.0);
    }

    fn contact(inner: &[f64], contact: &mut Contact) {
        contact.breakaway = inner[0];
        contact.exponential = false;
    }
}
