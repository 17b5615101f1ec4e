//! The effects: one law per file, its card beside it, and the list of them all.
//!
//! To add one, write its file and name it in [`CATALOGUE`].

mod card;
mod lane;
mod law;

mod asymmetric_coulomb;
mod asymmetric_viscous;
mod cogging;
mod coulomb;
mod dead_zone;
mod decoy_angle;
mod decoy_time;
mod delay;
mod drag;
mod drift;
mod dwell;
mod end_stop;
mod freeplay;
mod hardening;
mod inertia;
mod lead;
mod load;
mod offset;
mod once_per_rev;
mod position_coulomb;
mod presliding;
mod stiction;
mod stiffness;
mod stribeck;
mod tight_spot;
mod twice_per_rev;
mod viscous;
mod warmup;

pub use card::{Card, Grid, Kind, Parameter, Role};
pub use lane::Lane;
pub use law::{Channels, Contact, Effect, Law, Motion};

pub(crate) use asymmetric_coulomb::AsymmetricCoulomb;
pub(crate) use asymmetric_viscous::AsymmetricViscous;
pub(crate) use cogging::Cogging;
pub(crate) use dead_zone::DeadZone;
pub(crate) use drag::Drag;
pub(crate) use dwell::Dwell;
pub(crate) use end_stop::EndStop;
pub(crate) use hardening::Hardening;
pub(crate) use load::Load;
pub(crate) use once_per_rev::OncePerRev;
pub(crate) use position_coulomb::PositionCoulomb;
pub(crate) use presliding::dahl;
pub(crate) use stiffness::Stiffness;
pub(crate) use stribeck::Stribeck;
pub(crate) use tight_spot::TightSpot;
pub(crate) use twice_per_rev::TwicePerRev;
pub(crate) use viscous::Viscous;

use crate::Error;

/// Every effect, in the order in which lists and reports show them.
pub static CATALOGUE: &[Effect] = &[
    Effect::of::<offset::Offset>(),
    Effect::of::<coulomb::Coulomb>(),
    Effect::of::<viscous::Viscous>(),
    Effect::of::<asymmetric_coulomb::AsymmetricCoulomb>(),
    Effect::of::<asymmetric_viscous::AsymmetricViscous>(),
    Effect::of::<drag::Drag>(),
    Effect::of::<stribeck::Stribeck>(),
    Effect::of::<stiction::Stiction>(),
    Effect::of::<presliding::Presliding>(),
    Effect::of::<freeplay::Freeplay>(),
    Effect::of::<dead_zone::DeadZone>(),
    Effect::of::<stiffness::Stiffness>(),
    Effect::of::<hardening::Hardening>(),
    Effect::of::<end_stop::EndStop>(),
    Effect::of::<inertia::Inertia>(),
    Effect::of::<once_per_rev::OncePerRev>(),
    Effect::of::<twice_per_rev::TwicePerRev>(),
    Effect::of::<cogging::Cogging>(),
    Effect::of::<position_coulomb::PositionCoulomb>(),
    Effect::of::<tight_spot::TightSpot>(),
    Effect::of::<load::Load>(),
    Effect::of::<delay::Delay>(),
    Effect::of::<lead::Lead>(),
    Effect::of::<warmup::Warmup>(),
    Effect::of::<drift::Drift>(),
    Effect::of::<dwell::Dwell>(),
    Effect::of::<decoy_time::DecoyTime>(),
    Effect::of::<decoy_angle::DecoyAngle>(),
];

/// Looks an effect up by name.
///
/// # Errors
/// [`Error::Unknown`] with the names that exist.
pub fn find(name: &str) -> Result<&'static Effect, Error> {
    CATALOGUE
        .iter()
        .find(|e| e.card.name == name)
        .ok_or_else(|| Error::Unknown {
            what: "effect",
            name: name.to_owned(),
            known: CATALOGUE
                .iter()
                .map(|e| e.card.name)
                .collect::<Vec<_>>()
                .join(", "),
        })
}

#[cfg(test)]
mod tests {
    use super::{CATALOGUE, Role};

    #[test]
    fn every_card_lists_as_many_linear_parameters_as_its_law_has_columns() {
        for effect in CATALOGUE {
            let linear = effect
                .card
                .parameters
                .iter()
                .filter(|p| !matches!(p.role, Role::Inner(_)))
                .count();
            assert_eq!(linear, effect.columns, "{}", effect.card.name);
        }
    }

    #[test]
    fn names_are_unique() {
        let mut names: Vec<_> = CATALOGUE.iter().map(|e| e.card.name).collect();
        names.sort_unstable();
        names.dedup();
        assert_eq!(names.len(), CATALOGUE.len());
    }
}
