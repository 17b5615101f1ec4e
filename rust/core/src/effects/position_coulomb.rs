//! Dry friction that changes evenly with the angle.

use super::{Card, Kind, Lane, Law, Motion, Parameter, Role};

/// The law of `position_coulomb`.
pub struct PositionCoulomb;

impl Law for PositionCoulomb {
    const CARD: Card = Card {
        name: "position_coulomb",
        title: "friction that changes with angle",
        kind: Kind::FrictionLevel,
        behind_gap: true,
        equation: "+ slope x on the level",
        look: "The loop is higher at one end than at the other.",
        cause: "A ring that is clamped askew, a bearing under changing load.",
        check: "Recentre the ring (TB 038 Annex I step 12); loosen the thumb screws by a quarter turn (step 18).",
        typical: "0.1 to 0.4 Nm/rad",
        source: "first order of friction over angle",
        parameters: &[Parameter {
            key: "slope_nm_per_rad",
            symbol: "slope",
            meaning: "change of the level per angle",
            role: Role::Linear,
            low: f64::NEG_INFINITY,
            high: f64::INFINITY,
        }],
        becomes: None,
        per_turn: false,
        channel: None,
        needs: Some("coulomb"),
        structures: &[],
    };
    const COLUMNS: usize = 1;

    #[inline]
    fn basis<L: Lane>(motion: &Motion<L>, _inner: &[f64], out: &mut [L]) {
        out[0] = motion.position;
    }
}
