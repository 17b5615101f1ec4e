//! The default step: drift, torque, drift, with the instants of a reversal and of a break-away located inside it.
//!
//! Second order through events at a fixed cost: at most one reversal and one break-away per step are resolved, more of
//! them leave an error of second order for that step. All selects, no branches; a body in stick has a speed of
//! exactly 0, and that value is its state. For the closest published relative (Moreau's step with localised
//! switching points) see Studer, Leine, Glocker 2008, Int. J. Numer. Meth. Engng.

use super::drive::Span;
use super::number::Pure;
use super::one_mass::{CURVED, OneMass};
use crate::effects::Lane;

/// Where one sub-step ended, and what happened in it.
#[derive(Debug, Clone, Copy)]
pub(super) struct Step {
    /// Angle at the end.
    pub phi: Pure,
    /// Speed at the end; exactly 0 in stick.
    pub speed: Pure,
    /// Angle where the speed passed through 0, or at the end where it did not.
    pub phi_turn: Pure,
    /// Share of the step until the speed was 0; 1 where it never was.
    pub moving: Pure,
    /// Share of the step that was then spent at rest.
    pub stuck: Pure,
    /// Speed with which the first part ended.
    pub speed_turn: Pure,
    /// Dry friction in the middle of the step on an elastic contact; 0 on a rigid one, which has two parts.
    pub grip: Pure,
    /// What goes on to the next step besides angle and speed.
    pub carried: Carried,
}

/// What a body carries from step to step besides angle and speed. Plain bodies do not use it.
#[derive(Debug, Clone, Copy)]
pub(super) struct Carried {
    /// Seconds at rest so far.
    pub rest_s: Pure,
    /// Friction state of an elastic contact.
    pub bristle: Pure,
}

impl Carried {
    /// Of a body that has just come.
    pub const NONE: Self = Self {
        rest_s: Pure::ZERO,
        bristle: Pure::ZERO,
    };
}

/// What a lane's step of fixed length needs of its body: divisions that are made once. With viscous friction at the
/// middle speed a step is `v+ = kept v + gain net`.
#[derive(Debug, Clone, Copy)]
pub(super) struct Pace {
    /// Seconds of the step.
    pub h: Pure,
    /// Step over inertia.
    pub rate: Pure,
    /// What viscous friction leaves of a speed after a step: `(1 - k) / (1 + k)`, k half the share that it takes.
    pub kept: Pure,
    /// Speed that a torque gives in a step: `rate / (1 + k)`.
    pub gain: Pure,
}

impl Pace {
    /// The pace of a body.
    #[inline(always)]
    pub fn of(body: &OneMass<Pure>, h: Pure) -> Self {
        let rate = h / body.inertia;
        let k = rate * body.linear(Pure::ONE) * Pure(0.5);
        Self {
            h,
            rate,
            kept: (Pure::ONE - k) / (Pure::ONE + k),
            gain: rate / (Pure::ONE + k),
        }
    }
}

/// A step in which the speed keeps its sign.
#[derive(Debug, Clone, Copy)]
pub(super) struct Glide {
    /// Angle at the end.
    pub phi: Pure,
    /// Speed at the end.
    pub speed: Pure,
    /// Whether the speed does not keep its sign, or was 0: then the rest of [`step`] decides.
    pub event: bool,
}

/// One sub-step under the assumption that the speed keeps its sign; says whether it does.
#[inline(always)]
pub(super) fn glide<const WITH: usize>(
    body: &OneMass<Pure>,
    span: &Span,
    pace: Pace,
    phi: Pure,
    v: Pure,
) -> Glide {
    let Pace { h, kept, gain, .. } = pace;
    let drift = h * Pure(0.5);
    // At rest the side does not matter: that is an event, and this speed is not used.
    let side = v.side();
    let middle = phi + drift * v;
    let (psi, load) = span.middle();
    let torque = body.torque::<WITH>(psi, load, middle);
    let mut speed = v * kept + gain * (torque - body.kinetic::<WITH>(side, middle, load));
    if WITH & CURVED != 0 {
        // What curves with speed: predicted at the speed of the start, then taken at the middle.
        let guess = speed - gain * body.curved(v, side);
        speed = speed - gain * body.curved((v + guess) * Pure(0.5), side);
    }
    Glide {
        phi: middle + drift * speed,
        speed,
        event: (speed * v).0 <= 0.0,
    }
}

/// Whether a body that has been at rest for some time stays there for the whole sub-step. [`step`] then ends at
/// `phi + 0`, at a speed of 0, a step's time later.
#[inline(always)]
pub(super) fn stays<const WITH: usize>(
    body: &OneMass<Pure>,
    span: &Span,
    h: Pure,
    (phi, v): (Pure, Pure),
    rest_s: Pure,
) -> bool {
    (v.0 == 0.0)
        & holds::<WITH>(body, span.start(), phi, rest_s)
        & holds::<WITH>(body, span.end(), phi, rest_s + h)
}

/// Whether friction holds a body under an angle of the handwheel and a load. No closure: one that is not inlined into
/// the loop over the lanes would be called for each of them.
#[inline(always)]
fn holds<const WITH: usize>(
    body: &OneMass<Pure>,
    (psi, load): (Pure, Pure),
    phi: Pure,
    rest_s: Pure,
) -> bool {
    let torque = body.torque::<WITH>(psi, load, phi);
    let held = body.held::<WITH>(phi, load, rest_s);
    torque.abs_at_most(held.to::<WITH>(torque.sign()))
}

/// One sub-step of one body from (`phi`, `v`), at rest for `rest_s` if it is.
#[inline(always)]
pub(super) fn step<const WITH: usize>(
    body: &OneMass<Pure>,
    span: &Span,
    pace: Pace,
    (phi, v): (Pure, Pure),
    rest_s: Pure,
) -> Step {
    let plain = glide::<WITH>(body, span, pace, phi, v);
    resolve::<WITH>(body, span, pace, (phi, v), rest_s, plain)
}

/// The sub-step that starts at (`phi`, `v`) once it is known where it would end without an event.
#[inline(always)]
pub(super) fn resolve<const WITH: usize>(
    body: &OneMass<Pure>,
    span: &Span,
    pace: Pace,
    (phi, v): (Pure, Pure),
    rest_s: Pure,
    plain: Glide,
) -> Step {
    let half = Pure(0.5);
    let h = pace.h;
    let Glide {
        speed: v1, event, ..
    } = plain;
    let rested = v.0 == 0.0;

    // The instant at which the speed is 0, and the torque from there on with the body held.
    let fall = (v - v1).when(event & !rested, Pure::ONE);
    let moving = (v / fall).when(!rested, Pure::ZERO);
    let phi_turn = phi + moving * (h * half) * v;
    let (psi, load_turn) = span.at(moving);
    let at_turn = body.torque::<WITH>(psi, load_turn, phi_turn);
    let (psi, load_end) = span.end();
    let at_end = body.torque::<WITH>(psi, load_end, phi_turn);
    let rest_turn = rest_s.when(rested, Pure::ZERO);
    let rest_end = rest_turn + (Pure::ONE - moving) * h;
    let held_turn = body.held::<WITH>(phi_turn, load_turn, rest_turn);
    let held_end = body.held::<WITH>(phi_turn, load_end, rest_end);
    let side = at_end.sign();
    // By how much the torque is beyond what is held, to the side to which it is in the end.
    let beyond_turn = at_turn * side - held_turn.to::<WITH>(side);
    let beyond_end = at_end * side - held_end.to::<WITH>(side);
    let breaks_now = at_turn.abs().0 > held_turn.to::<WITH>(at_turn.sign()).0;
    let breaks_later = !breaks_now & (beyond_end.0 > 0.0);
    let rise = (beyond_end - beyond_turn).when(breaks_later, Pure::ONE);
    let located = (-beyond_turn / rise).clamp(Pure::ZERO, Pure::ONE);
    let stuck = Pure::ZERO.when(breaks_now, located.when(breaks_later, Pure::ONE));

    // From the break-away to the end, from rest.
    let way = at_turn.when(breaks_now, at_end);
    let direction = way.sign();
    let left = (Pure::ONE - moving) * (Pure::ONE - stuck) * h;
    let drift = left * half;
    let mean = (at_turn + (at_end - at_turn) * stuck + at_end) * half
        - body.kinetic::<WITH>(direction, phi_turn, load_end);
    let slow = left / (body.inertia + drift * body.linear(Pure::ONE));
    let mut v2 = slow * mean;
    if WITH & CURVED != 0 {
        let guess = v2 - slow * body.curved(Pure::ZERO, direction);
        v2 = v2 - slow * body.curved(guess * half, direction);
    }
    let v2 = Pure::ZERO.when((v2 * way).0 <= 0.0, v2);

    Step {
        phi: (phi_turn + drift * v2).when(event, plain.phi),
        speed: v2.when(event, v1),
        phi_turn: phi_turn.when(event, plain.phi),
        moving: moving.when(event, Pure::ONE),
        stuck: ((Pure::ONE - moving) * stuck).when(event, Pure::ZERO),
        speed_turn: Pure::ZERO.when(event, v1),
        grip: Pure::ZERO,
        carried: Carried {
            rest_s: rest_end.when(event & (stuck.0 == 1.0), Pure::ZERO),
            bristle: Pure::ZERO,
        },
    }
}
