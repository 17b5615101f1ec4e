//! One sub-step of a block of lanes: the short way where nothing happens, the whole step where something does.
//!
//! Most steps of most lanes hold no event, and most of the others find a body at rest that stays there. Lanes are
//! looked at in groups of one vector: a group takes the cheapest way that is right for all of its lanes. The ways are
//! parts of one step ([`split::step`]), made of the same operations in the same order, so that the way that a group
//! takes (and hence a lane's neighbours) changes no bit.

use super::drive::Span;
use super::lanes::Kernel;
use super::lanes::Start;
use super::number::Pure;
use super::one_mass::{CURVED, ELASTIC, EVERY, LOCAL, LUGRE, OneMass, PLAIN};
use super::parameters::PARAMETERS;
use super::split::{Carried, Glide, Pace, Step};
use super::{bristle, moreau, split};

/// Lanes that take one way together: one vector of the widest instruction set.
pub(super) const GROUP: usize = 8;

/// What does not change from step to step. A row of lanes starts on a cache line, so that no vector lies on two.
#[repr(align(64))]
pub(super) struct Lanes<const N: usize> {
    table: [[f64; N]; PARAMETERS],
    rate: [f64; N],
    kept: [f64; N],
    gain: [f64; N],
    h: Pure,
    some_rigid: bool,
}

/// Where the lanes are: angle, speed, and what is carried besides them, which plain lanes do not touch.
#[derive(Clone, Copy)]
#[repr(align(64))]
pub(super) struct State<const N: usize> {
    pub phi: [f64; N],
    pub v: [f64; N],
    pub rest_s: [f64; N],
    pub bristle: [f64; N],
}

impl<const N: usize> Lanes<N> {
    /// The lanes of some bodies, in steps of `h`. Lanes beyond the last body repeat it, so that every block is full.
    #[inline(always)]
    pub fn new(bodies: &[OneMass<f64>], h: Pure) -> Self {
        const { assert!(N.is_multiple_of(GROUP)) }
        let mut out = Self {
            table: [[0.0; N]; PARAMETERS],
            rate: [0.0; N],
            kept: [0.0; N],
            gain: [0.0; N],
            h,
            some_rigid: bodies.iter().any(|body| !body.bristle.acts()),
        };
        for lane in 0..N {
            let body = &bodies[lane.min(bodies.len() - 1)];
            for (row, value) in out.table.iter_mut().zip(body.to_array()) {
                row[lane] = value;
            }
            let pace = Pace::of(&OneMass::gather(&out.table, lane), h);
            out.rate[lane] = pace.rate.0;
            out.kept[lane] = pace.kept.0;
            out.gain[lane] = pace.gain.0;
        }
        out
    }

    #[inline(always)]
    pub fn lane(&self, lane: usize) -> (OneMass<Pure>, Pace) {
        let pace = Pace {
            h: self.h,
            rate: Pure(self.rate[lane]),
            kept: Pure(self.kept[lane]),
            gain: Pure(self.gain[lane]),
        };
        (OneMass::gather(&self.table, lane), pace)
    }
}

impl<const N: usize> State<N> {
    /// The lanes at their starts; those beyond the last repeat it.
    #[inline(always)]
    pub fn new(starts: &[Start]) -> Self {
        let of = |lane: usize| starts[lane.min(starts.len() - 1)];
        Self {
            phi: std::array::from_fn(|lane| of(lane).phi),
            v: std::array::from_fn(|lane| of(lane).speed),
            rest_s: [0.0; N],
            bristle: [0.0; N],
        }
    }

    #[inline(always)]
    pub fn at(&self, lane: usize) -> (Pure, Pure) {
        (Pure(self.phi[lane]), Pure(self.v[lane]))
    }

    #[inline(always)]
    pub fn carried(&self, lane: usize) -> Carried {
        Carried {
            rest_s: Pure(self.rest_s[lane]),
            bristle: Pure(self.bristle[lane]),
        }
    }
}

/// A kernel as a type: passed as a function it would be called through a pointer's shim, which stays outside of the
/// code for the instruction set.
pub(super) trait Advance {
    /// One sub-step of one lane from an angle and a speed.
    fn step(
        body: &OneMass<Pure>,
        span: &Span,
        pace: Pace,
        from: (Pure, Pure),
        carried: Carried,
    ) -> Step;

    /// Takes every lane one sub-step further, each along its span.
    fn advance<const N: usize>(
        lanes: &Lanes<N>,
        span_of: impl Fn(usize) -> Span,
        state: &mut State<N>,
    );
}

/// What is done with the kernel that a method and the effects of a batch ask for.
pub(super) trait WithKernel {
    type Output;

    fn with<A: Advance>(self) -> Self::Output;
}

/// Everything on an elastic contact.
pub(super) const WHOLE: usize = EVERY | LUGRE;

/// Chooses the kernel that looks at the given effects ([`OneMass::effects`]) and at as few others as there are.
#[inline(always)]
pub(super) fn choose<T: WithKernel>(kernel: Kernel, effects: usize, then: T) -> T::Output {
    const BOTH: usize = LOCAL | CURVED;
    match (kernel, effects) {
        (Kernel::MoreauJean, PLAIN | CURVED) => then.with::<MoreauJean<CURVED>>(),
        (Kernel::MoreauJean, ..=BOTH) => then.with::<MoreauJean<BOTH>>(),
        (Kernel::MoreauJean, _) => then.with::<MoreauJean<EVERY>>(),
        (_, PLAIN) => then.with::<Split<PLAIN>>(),
        (_, LOCAL) => then.with::<Split<LOCAL>>(),
        (_, CURVED) => then.with::<Split<CURVED>>(),
        (_, BOTH) => then.with::<Split<BOTH>>(),
        (_, ..=EVERY) => then.with::<Split<EVERY>>(),
        _ if effects & !(ELASTIC | LOCAL) == 0 => then.with::<Elastic<LOCAL>>(),
        _ => then.with::<Elastic<WHOLE>>(),
    }
}

/// The split step on a rigid contact, with the effects of a level.
pub(super) struct Split<const WITH: usize>;

impl<const WITH: usize> Advance for Split<WITH> {
    #[inline(always)]
    fn step(
        body: &OneMass<Pure>,
        span: &Span,
        pace: Pace,
        from: (Pure, Pure),
        carried: Carried,
    ) -> Step {
        split::step::<WITH>(body, span, pace, from, carried.rest_s)
    }

    #[inline(always)]
    fn advance<const N: usize>(
        lanes: &Lanes<N>,
        span_of: impl Fn(usize) -> Span,
        state: &mut State<N>,
    ) {
        for first in (0..N).step_by(GROUP) {
            let (mut phi_next, mut v_next) = ([0.0; GROUP], [0.0; GROUP]);
            let mut rest_next = [0.0; GROUP];
            let mut event = [0u64; GROUP];
            let mut any = 0;
            for i in 0..GROUP {
                let (body, pace) = lanes.lane(first + i);
                let (phi, v) = state.at(first + i);
                let plain = split::glide::<WITH>(&body, &span_of(first + i), pace, phi, v);
                phi_next[i] = plain.phi.0;
                v_next[i] = plain.speed.0;
                event[i] = u64::from(plain.event);
                any |= event[i];
            }
            if any != 0 {
                // A lane with an event that is not at rest throughout needs the rest of the step.
                let mut moves = 0;
                for i in 0..GROUP {
                    let (body, _) = lanes.lane(first + i);
                    let rest_s = Pure(state.rest_s[first + i]);
                    let (from, span) = (state.at(first + i), span_of(first + i));
                    let stays = split::stays::<WITH>(&body, &span, lanes.h, from, rest_s);
                    moves |= event[i] & u64::from(!stays);
                }
                if moves == 0 {
                    for i in 0..GROUP {
                        let (phi, _) = state.at(first + i);
                        let rests = event[i] != 0;
                        phi_next[i] = (phi + Pure::ZERO).when(rests, Pure(phi_next[i])).0;
                        v_next[i] = Pure::ZERO.when(rests, Pure(v_next[i])).0;
                        if WITH & LOCAL != 0 {
                            let longer = Pure(state.rest_s[first + i]) + lanes.h;
                            rest_next[i] = longer.when(rests, Pure::ZERO).0;
                        }
                    }
                } else {
                    for i in 0..GROUP {
                        let (body, pace) = lanes.lane(first + i);
                        let plain = Glide {
                            phi: Pure(phi_next[i]),
                            speed: Pure(v_next[i]),
                            event: event[i] != 0,
                        };
                        let (from, span) = (state.at(first + i), span_of(first + i));
                        let rest_s = Pure(state.rest_s[first + i]);
                        let next = split::resolve::<WITH>(&body, &span, pace, from, rest_s, plain);
                        phi_next[i] = next.phi.0;
                        v_next[i] = next.speed.0;
                        rest_next[i] = next.carried.rest_s.0;
                    }
                }
            }
            state.phi[first..first + GROUP].copy_from_slice(&phi_next);
            state.v[first..first + GROUP].copy_from_slice(&v_next);
            if WITH & LOCAL != 0 {
                state.rest_s[first..first + GROUP].copy_from_slice(&rest_next);
            }
        }
    }
}

/// The split step where the contact of some lanes is elastic.
pub(super) struct Elastic<const WITH: usize>;

impl<const WITH: usize> Advance for Elastic<WITH> {
    #[inline(always)]
    fn step(
        body: &OneMass<Pure>,
        span: &Span,
        pace: Pace,
        from: (Pure, Pure),
        carried: Carried,
    ) -> Step {
        if body.bristle.per_travel.0 > 0.0 {
            bristle::step::<WITH>(body, span, pace, from, carried)
        } else {
            Split::<WITH>::step(body, span, pace, from, carried)
        }
    }

    #[inline(always)]
    fn advance<const N: usize>(
        lanes: &Lanes<N>,
        span_of: impl Fn(usize) -> Span,
        state: &mut State<N>,
    ) {
        let from = *state;
        if lanes.some_rigid {
            Split::<WITH>::advance(lanes, &span_of, state);
        }
        for lane in 0..N {
            let (body, pace) = lanes.lane(lane);
            let (at, carried) = (from.at(lane), from.carried(lane));
            let next = bristle::step::<WITH>(&body, &span_of(lane), pace, at, carried);
            let elastic = body.bristle.per_travel.0 > 0.0;
            let (phi, v) = state.at(lane);
            state.phi[lane] = next.phi.when(elastic, phi).0;
            state.v[lane] = next.speed.when(elastic, v).0;
            state.bristle[lane] = next.carried.bristle.0;
        }
    }
}

/// The step of Moreau and Jean.
pub(super) struct MoreauJean<const WITH: usize>;

impl<const WITH: usize> Advance for MoreauJean<WITH> {
    #[inline(always)]
    fn step(
        body: &OneMass<Pure>,
        span: &Span,
        pace: Pace,
        from: (Pure, Pure),
        carried: Carried,
    ) -> Step {
        moreau::step::<WITH>(body, span, pace, from, carried.rest_s)
    }

    #[inline(always)]
    fn advance<const N: usize>(
        lanes: &Lanes<N>,
        span_of: impl Fn(usize) -> Span,
        state: &mut State<N>,
    ) {
        for lane in 0..N {
            let (body, pace) = lanes.lane(lane);
            let (at, carried) = (state.at(lane), state.carried(lane));
            let next = Self::step(&body, &span_of(lane), pace, at, carried);
            state.phi[lane] = next.phi.0;
            state.v[lane] = next.speed.0;
            state.rest_s[lane] = next.carried.rest_s.0;
        }
    }
}
