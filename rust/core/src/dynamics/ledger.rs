//! Where the energy of a trajectory went.

use super::keep::ENERGIES;
use super::number::Pure;
use super::one_mass::{CURVED, EVERY, LOCAL, OneMass, PLAIN, WAVY};
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
    /// Turned into heat by dry friction, Stribeck's part included; on an elastic contact with what the contact holds.
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

    /// Books one sub-step.
    pub(super) fn book(&mut self, entry: &[f64; ENTRIES]) {
        let [handwheel, load, dry, viscous, curved, turnover] = entry;
        self.handwheel += handwheel;
        self.load += load;
        self.dry += dry;
        self.viscous += viscous;
        self.curved += curved;
        self.turnover += turnover;
    }
}

/// What is booked of a sub-step: work of handwheel and load, dry, viscous and curved heat, turnover.
pub(super) const ENTRIES: usize = 6;

/// The entry of one sub-step.
pub(super) type Booker =
    fn(&OneMass<Pure>, f64, (Pure, Pure), &Step, ((Pure, Pure), (Pure, Pure))) -> [f64; ENTRIES];

/// What books the effects at work and as few others as there are.
pub(super) fn booker(effects: usize) -> Booker {
    match effects {
        PLAIN => entry::<PLAIN>,
        1..WAVY => entry::<TAME>,
        _ => entry::<EVERY>,
    }
}

/// Everything but sines.
pub(super) const TAME: usize = LOCAL | CURVED;

/// The entry of one sub-step of length `h` from (`phi`, `v`), driven from `first` to `last` (handwheel, load). Without
/// branches, for the loop over lanes; effects that do not act change no bit of it.
#[inline(always)]
pub(super) fn entry<const WITH: usize>(
    body: &OneMass<Pure>,
    h: f64,
    (phi, v): (Pure, Pure),
    step: &Step,
    (first, last): ((Pure, Pure), (Pure, Pure)),
) -> [f64; ENTRIES] {
    let turned = body.at_handwheel::<WITH>(first.0, phi);
    let turned_last = body.at_handwheel::<WITH>(last.0, step.phi);
    let input = 0.5 * (turned.0 + turned_last.0) * (last.0.0 - first.0.0);
    let load = Pure(0.5 * (first.1.0 + last.1.0));
    let loaded = load.0 * (step.phi.0 - phi.0);
    // Until the speed is 0, and from the break-away on.
    let before = part::<WITH>(
        body,
        step.moving.0 * h,
        (v, step.speed_turn),
        (phi, step.phi_turn),
        load,
    );
    let left = (1.0 - step.moving.0 - step.stuck.0) * h;
    let after = part::<WITH>(
        body,
        left,
        (Pure::ZERO, step.speed),
        (step.phi_turn, step.phi),
        load,
    );
    let rigid = Pure(before[0] + after[0]);
    let elastic = step.grip * (step.phi - phi);
    [
        input,
        loaded,
        rigid.when(body.bristle.per_travel.0 == 0.0, elastic).0,
        before[1] + after[1],
        before[2] + after[2],
        input.abs() + loaded.abs(),
    ]
}

/// Heat of dry, viscous and curved friction over a stretch in which the speed goes evenly from one value to another.
#[inline(always)]
fn part<const WITH: usize>(
    body: &OneMass<Pure>,
    seconds: f64,
    (from, to): (Pure, Pure),
    (first, last): (Pure, Pure),
    load: Pure,
) -> [f64; 3] {
    // Written out: what a closure of `map` computes is not compiled for the loop's instruction set.
    let way = last.0 - first.0;
    let direction = Pure(way).sign();
    let middle = Pure(0.5 * (from.0 + to.0));
    let place = Pure(0.5 * (first.0 + last.0));
    // Simpson's rule: exact for the viscous part, whose power is a parabola.
    let third = seconds / 6.0;
    let viscous = third
        * (body.linear(from).0 * from.0
            + 4.0 * (body.linear(middle).0 * middle.0)
            + body.linear(to).0 * to.0);
    let dry = body.kinetic::<WITH>(direction, place, load).0 * way;
    if WITH & CURVED == 0 {
        return [dry, viscous, 0.0];
    }
    let (a, b, c) = (
        body.stribeck_torque(from, direction).0,
        body.stribeck_torque(middle, direction).0,
        body.stribeck_torque(to, direction).0,
    );
    let extra = third * (a * from.0 + 4.0 * (b * middle.0) + c * to.0);
    let (a, b, c) = (
        body.curved(from, direction).0 - a,
        body.curved(middle, direction).0 - b,
        body.curved(to, direction).0 - c,
    );
    let curved = third * (a * from.0 + 4.0 * (b * middle.0) + c * to.0);
    [dry + extra, viscous, curved]
}
