//! Where the energy of a trajectory went.

use super::keep::ENERGIES;
use super::number::Pure;
use super::one_mass::OneMass;
use super::split::Step;

/// Energies of a trajectory, J.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Ledger {
    /// Work that the handwheel did.
    pub handwheel: f64,
    /// Work that the load on the road wheel did.
    pub load: f64,
    /// Energy of motion and springs at the start.
    pub stored_first: f64,
    /// The same at the end.
    pub stored_last: f64,
    /// Turned into heat by dry friction, Stribeck's part included.
    pub dry: f64,
    /// By viscous friction.
    pub viscous: f64,
    /// By drag and one-sided viscous friction.
    pub curved: f64,
    /// All that was ever put in, taken out or turned into heat, by size: what the residual is measured against.
    pub turnover: f64,
}

impl Ledger {
    /// Energy that the numbers do not account for: of second order in the step.
    #[must_use]
    pub fn residual(&self) -> f64 {
        self.handwheel + self.load
            - (self.stored_last - self.stored_first)
            - self.dry
            - self.viscous
            - self.curved
    }

    /// In the order of [`super::ENERGIES`].
    #[must_use]
    pub fn to_array(&self) -> [f64; ENERGIES.len()] {
        [
            self.handwheel,
            self.load,
            self.stored_first,
            self.stored_last,
            self.dry,
            self.viscous,
            self.curved,
            self.turnover,
            self.residual(),
        ]
    }

    /// Books one sub-step of length `h` from (`phi`, `v`), driven from `first` to `last` (handwheel, load).
    pub(super) fn book(
        &mut self,
        body: &OneMass<Pure>,
        h: f64,
        (phi, v): (Pure, Pure),
        step: &Step,
        (first, last): ((Pure, Pure), (Pure, Pure)),
    ) {
        let mean = |a: Pure, b: Pure| 0.5 * (a.0 + b.0);
        let turned = body.at_handwheel::<true>(first.0, phi);
        let turned_last = body.at_handwheel::<true>(last.0, step.phi);
        let input = mean(turned, turned_last) * (last.0.0 - first.0.0);
        let loaded = mean(first.1, last.1) * (step.phi.0 - phi.0);
        // Until the speed is 0, and from the break-away on.
        let before = part(
            body,
            step.moving.0 * h,
            v,
            step.speed_turn,
            step.phi_turn.0 - phi.0,
        );
        let left = (1.0 - step.moving.0 - step.stuck.0) * h;
        let after = part(
            body,
            left,
            Pure::ZERO,
            step.speed,
            step.phi.0 - step.phi_turn.0,
        );
        self.handwheel += input;
        self.load += loaded;
        self.dry += before[0] + after[0];
        self.viscous += before[1] + after[1];
        self.curved += before[2] + after[2];
        self.turnover += input.abs() + loaded.abs();
    }
}

/// Heat of dry, viscous and curved friction over a stretch in which the speed goes evenly from one value to another.
fn part(body: &OneMass<Pure>, seconds: f64, from: Pure, to: Pure, way: f64) -> [f64; 3] {
    if seconds <= 0.0 {
        return [0.0; 3];
    }
    let direction = Pure(way).sign();
    let middle = Pure(0.5 * (from.0 + to.0));
    // Simpson's rule: exact for the viscous part, whose power is a parabola.
    let along = |power: &dyn Fn(Pure) -> f64| {
        seconds * (power(from) + 4.0 * power(middle) + power(to)) / 6.0
    };
    let extra = |v: Pure| body.stribeck_torque(v, direction).0 * v.0;
    [
        body.kinetic::<true>(direction).0 * way + along(&extra),
        along(&|v| body.linear(v).0 * v.0),
        along(&|v| (body.curved(v, direction).0 - body.stribeck_torque(v, direction).0) * v.0),
    ]
}
