//! A break-away over a visible travel: the contact deforms before it slides.

use super::{Card, Contact, Grid, Kind, Lane, Law, Motion, Parameter, Role};

/// What Dahl's law makes of a friction state over a `travel` in one direction, given in break-aways: the state
/// approaches its `target` (the side of the motion, as a rule) by the exponential. Exact for any travel.
#[inline]
pub(crate) fn dahl<L: Lane>(state: L, target: L, travel: L) -> L {
    state + (state - target) * (-travel.abs()).exp_m1()
}

/// The law of `presliding`.
pub struct Presliding;

impl Law for Presliding {
    const CARD: Card = Card {
        name: "presliding",
        title: "presliding (elastic break-away)",
        kind: Kind::FrictionLevel,
        behind_gap: true,
        equation: "s follows the motion over the travel r: stop operator, or Dahl s' = (1 - s sgn w) w / r",
        look: "Rounded or slanted corners after every reversal, the same at every speed.",
        cause: "Elastic seals, belts, bristles in the contact, a soft load-cell mount.",
        check: "Reverse slowly at several angles; check the sucker mount and tie-down of the load cell (TB 038 Annex I step 3).",
        typical: "0.2 to 3 degrees",
        source: "Dahl 1968; Prandtl and Jenkins (stop operator)",
        parameters: &[
            Parameter {
                key: "breakaway_rad",
                symbol: "r",
                meaning: "travel from rest to full friction",
                role: Role::Inner(Grid::Travel {
                    share_of_range: 0.07,
                }),
                low: 0.0,
                high: f64::INFINITY,
            },
            Parameter {
                key: "shape",
                symbol: "",
                meaning: "0 straight (stop), 1 exponential (Dahl)",
                role: Role::Inner(Grid::Shape),
                low: 0.0,
                high: 1.0,
            },
        ],
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
        contact.breakaway = inner[0];
        contact.exponential = inner[1] > 0.5;
    }
}
