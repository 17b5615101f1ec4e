//! One sub-step of a block of lanes: the short way where nothing happens, the whole step where something does.
//!
//! Most steps of most lanes hold no event, and most of the others find a body at rest that stays there. Lanes are
//! looked at in groups of one vector: a group takes the cheapest way that is right for all of its lanes. The ways are
//! parts of one step ([`split::step`]), made of the same operations in the same order, so that the way that a group
//! takes (and hence a lane's neighbours) changes no bit.

use super::drive::Span;
use super::number::Pure;
use super::one_mass::{OneMass, PARAMETERS};
use super::split::Pace;
use super::{moreau, split};

/// Lanes that take one way together: one vector of the widest instruction set.
pub(super) const GROUP: usize = 8;

/// What does not change from step to step.
pub(super) struct Lanes<'a, const N: usize> {
    table: &'a [[f64; N]; PARAMETERS],
    h: Pure,
    rate: [f64; N],
    kept: [f64; N],
    damped: [f64; N],
}

impl<'a, const N: usize> Lanes<'a, N> {
    /// The lanes of a table of parameters, in steps of `h`.
    #[inline(always)]
    pub fn new(table: &'a [[f64; N]; PARAMETERS], h: Pure) -> Self {
        const { assert!(N.is_multiple_of(GROUP)) }
        let mut out = Self {
            table,
            h,
            rate: [0.0; N],
            kept: [0.0; N],
            damped: [0.0; N],
        };
        for lane in 0..N {
            let pace = Pace::of(&OneMass::gather(table, lane), h);
            out.rate[lane] = pace.rate.0;
            out.kept[lane] = pace.kept.0;
            out.damped[lane] = pace.damped.0;
        }
        out
    }

    #[inline(always)]
    fn lane(&self, lane: usize) -> (OneMass<Pure>, Pace) {
        let pace = Pace {
            h: self.h,
            rate: Pure(self.rate[lane]),
            kept: Pure(self.kept[lane]),
            damped: Pure(self.damped[lane]),
        };
        (OneMass::gather(self.table, lane), pace)
    }
}

/// A kernel as a type: passed as a function it would be called through a pointer's shim, which stays outside of the
/// code for the instruction set.
pub(super) trait Advance {
    /// Takes every lane one sub-step further.
    fn advance<const N: usize>(
        lanes: &Lanes<'_, N>,
        span: &Span,
        phi: &mut [f64; N],
        v: &mut [f64; N],
    );
}

/// The split step.
pub(super) struct Split<const RICH: bool>;

impl<const RICH: bool> Advance for Split<RICH> {
    #[inline(always)]
    fn advance<const N: usize>(
        lanes: &Lanes<'_, N>,
        span: &Span,
        phi: &mut [f64; N],
        v: &mut [f64; N],
    ) {
        for first in (0..N).step_by(GROUP) {
            let (mut phi_next, mut v_next) = ([0.0; GROUP], [0.0; GROUP]);
            let mut event = [0u64; GROUP];
            let mut any = 0;
            for i in 0..GROUP {
                let lane = first + i;
                let (body, pace) = lanes.lane(lane);
                let glide = split::glide::<RICH>(&body, span, pace, Pure(phi[lane]), Pure(v[lane]));
                phi_next[i] = glide.phi.0;
                v_next[i] = glide.speed.0;
                event[i] = u64::from(glide.event);
                any |= event[i];
            }
            if any != 0 {
                let mut moved = 0;
                for i in 0..GROUP {
                    let lane = first + i;
                    let (body, _) = lanes.lane(lane);
                    let stays = split::stays::<RICH>(&body, span, Pure(phi[lane]), Pure(v[lane]));
                    let event = event[i] != 0;
                    phi_next[i] = (Pure(phi[lane]) + Pure::ZERO)
                        .when(event, Pure(phi_next[i]))
                        .0;
                    v_next[i] = Pure::ZERO.when(event, Pure(v_next[i])).0;
                    moved |= u64::from(event & !stays);
                }
                if moved != 0 {
                    for i in 0..GROUP {
                        let lane = first + i;
                        let (body, pace) = lanes.lane(lane);
                        let next =
                            split::step::<RICH>(&body, span, pace, Pure(phi[lane]), Pure(v[lane]));
                        phi_next[i] = next.phi.0;
                        v_next[i] = next.speed.0;
                    }
                }
            }
            for i in 0..GROUP {
                phi[first + i] = phi_next[i];
                v[first + i] = v_next[i];
            }
        }
    }
}

/// The step of Moreau and Jean.
pub(super) struct MoreauJean;

impl Advance for MoreauJean {
    #[inline(always)]
    fn advance<const N: usize>(
        lanes: &Lanes<'_, N>,
        span: &Span,
        phi: &mut [f64; N],
        v: &mut [f64; N],
    ) {
        for lane in 0..N {
            let (body, pace) = lanes.lane(lane);
            let next = moreau::step(&body, span, pace, Pure(phi[lane]), Pure(v[lane]));
            phi[lane] = next.phi.0;
            v[lane] = next.speed.0;
        }
    }
}
