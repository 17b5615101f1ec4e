//! One sub-step of a block of lanes: the short way where nothing happens, the whole step where something does.
//!
//! Most steps of most lanes hold no event, and most of the others find a body at rest that stays there. Lanes are
//! looked at in groups of one vector: a group takes the cheapest way that is right for all of its lanes. The ways are
//! parts of one step ([`split::step`]), made of the same operations in the same order, so that the way that a group
//! takes (and hence a lane's neighbours) changes no bit.

use super::drive::Span;
use super::lanes::Start;
use super::number::Pure;
use super::one_mass::{OneMass, PARAMETERS};
use super::split::{Glide, Pace, Step};
use super::{moreau, split};

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
}

/// Where the lanes are: angle and speed.
#[repr(align(64))]
pub(super) struct State<const N: usize> {
    pub phi: [f64; N],
    pub v: [f64; N],
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
        }
    }

    #[inline(always)]
    pub fn at(&self, lane: usize) -> (Pure, Pure) {
        (Pure(self.phi[lane]), Pure(self.v[lane]))
    }
}

/// A kernel as a type: passed as a function it would be called through a pointer's shim, which stays outside of the
/// code for the instruction set.
pub(super) trait Advance {
    /// One sub-step of one lane.
    fn step(body: &OneMass<Pure>, span: &Span, pace: Pace, phi: Pure, v: Pure) -> Step;

    /// Takes every lane one sub-step further, each along its span.
    fn advance<const N: usize>(
        lanes: &Lanes<N>,
        span_of: impl Fn(usize) -> Span,
        state: &mut State<N>,
    );
}

/// The split step.
pub(super) struct Split<const RICH: bool>;

impl<const RICH: bool> Advance for Split<RICH> {
    #[inline(always)]
    fn step(body: &OneMass<Pure>, span: &Span, pace: Pace, phi: Pure, v: Pure) -> Step {
        split::step::<RICH>(body, span, pace, phi, v)
    }

    #[inline(always)]
    fn advance<const N: usize>(
        lanes: &Lanes<N>,
        span_of: impl Fn(usize) -> Span,
        state: &mut State<N>,
    ) {
        for first in (0..N).step_by(GROUP) {
            let (mut phi_next, mut v_next) = ([0.0; GROUP], [0.0; GROUP]);
            let mut event = [0u64; GROUP];
            let mut any = 0;
            for i in 0..GROUP {
                let (body, pace) = lanes.lane(first + i);
                let (phi, v) = state.at(first + i);
                let plain = split::glide::<RICH>(&body, &span_of(first + i), pace, phi, v);
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
                    let (phi, v) = state.at(first + i);
                    moves |= event[i]
                        & u64::from(!split::stays::<RICH>(&body, &span_of(first + i), phi, v));
                }
                if moves == 0 {
                    for i in 0..GROUP {
                        let (phi, _) = state.at(first + i);
                        let rests = event[i] != 0;
                        phi_next[i] = (phi + Pure::ZERO).when(rests, Pure(phi_next[i])).0;
                        v_next[i] = Pure::ZERO.when(rests, Pure(v_next[i])).0;
                    }
                } else {
                    for i in 0..GROUP {
                        let (body, pace) = lanes.lane(first + i);
                        let plain = Glide {
                            phi: Pure(phi_next[i]),
                            speed: Pure(v_next[i]),
                            event: event[i] != 0,
                        };
                        let from = state.at(first + i);
                        let next =
                            split::resolve::<RICH>(&body, &span_of(first + i), pace, from, plain);
                        phi_next[i] = next.phi.0;
                        v_next[i] = next.speed.0;
                    }
                }
            }
            state.phi[first..first + GROUP].copy_from_slice(&phi_next);
            state.v[first..first + GROUP].copy_from_slice(&v_next);
        }
    }
}

/// The step of Moreau and Jean.
pub(super) struct MoreauJean;

impl Advance for MoreauJean {
    #[inline(always)]
    fn step(body: &OneMass<Pure>, span: &Span, pace: Pace, phi: Pure, v: Pure) -> Step {
        moreau::step(body, span, pace, phi, v)
    }

    #[inline(always)]
    fn advance<const N: usize>(
        lanes: &Lanes<N>,
        span_of: impl Fn(usize) -> Span,
        state: &mut State<N>,
    ) {
        for lane in 0..N {
            let (body, pace) = lanes.lane(lane);
            let (phi, v) = state.at(lane);
            let next = moreau::step(&body, &span_of(lane), pace, phi, v);
            state.phi[lane] = next.phi.0;
            state.v[lane] = next.speed.0;
        }
    }
}
