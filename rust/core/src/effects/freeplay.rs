//! A gap between hand and friction: inside it nothing behind is felt.

use super::{Card, Contact, Grid, Kind, Lane, Law, Motion, Parameter, Role};

/// The law of `freeplay`.
pub struct Freeplay;

impl Law for Freeplay {
    const CARD: Card = Card {
        name: "freeplay",
        title: "freeplay (backlash)",
        kind: Kind::Transmission,
        behind_gap: false,
        equation: "s = luz(u, gap/2) / r with the stop operator u of radius r + gap/2; friction behind the gap is 0 inside it",
        look: "After every reversal the torque drops to the level without friction for the width of the gap.",
        cause: "Backlash in the gear, worn joint, loose clamp of the robot on the wheel.",
        check: "Rock the wheel by hand about one angle; tighten the clamp of the robot (TB 038 Annex I step 2), check gear and joints.",
        typical: "0.5 to 6 degrees",
        source: "Wieckowski and Zardecki, Influence of freeplay and friction in steering system on double lane change manoeuvre, eqs. (1) and (3); play operator",
        parameters: &[Parameter {
            key: "gap_rad",
            symbol: "g",
            meaning: "full width of the gap",
            role: Role::Inner(Grid::Travel {
                share_of_range: 0.1,
            }),
            low: 0.0,
            high: f64::INFINITY,
        }],
        becomes: Some("coulomb"),
        per_turn: false,
        channel: None,
        needs: Some("coulomb"),
        structures: &[],
    };
    const COLUMNS: usize = 0;
    const SHAPES_OTHERS: bool = true;

    fn basis<L: Lane>(_motion: &Motion<L>, _inner: &[f64], _out: &mut [L]) {}

    fn contact(inner: &[f64], contact: &mut Contact) {
        contact.gap = inner[0];
    }
}
