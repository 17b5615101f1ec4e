//! What acts between the road wheel and the ground, and at the pinion, by angle alone: stops, springs, waves per turn.

use crate::effects::{Cogging, DeadZone, EndStop, Lane, OncePerRev, TwicePerRev};
use crate::projections::luz;

use super::number::Pure;
use super::one_mass::{WAVY, at, one};

/// How many values a [`Ground`] has.
pub(super) const VALUES: usize = 11;

/// Springs and waves. A wave's amplitude and phase are kept as the coefficients of sine and cosine.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Ground<L> {
    /// Stiffness of the stop, and the angle where it is met on either side.
    pub end_stop: [L; 2],
    /// Stiffness beyond a dead zone, and its half width.
    pub dead_zone: [L; 2],
    /// Wave once per turn of the pinion.
    pub once: [L; 2],
    /// Wave twice per turn.
    pub twice: [L; 2],
    /// Wave `per_turn` times per turn.
    pub cogging: [L; 2],
    /// See [`Ground::cogging`].
    pub per_turn: L,
}

impl<L: Copy> Ground<L> {
    /// From the values in a row.
    #[inline(always)]
    pub(super) fn from_values(of: impl Fn(usize) -> L) -> Self {
        let two = |first: usize| [of(first), of(first + 1)];
        Self {
            end_stop: two(0),
            dead_zone: two(2),
            once: two(4),
            twice: two(6),
            cogging: two(8),
            per_turn: of(10),
        }
    }

    /// The values of a row.
    pub(super) fn to_values(self) -> [L; VALUES] {
        let Self {
            end_stop: [k, limit],
            dead_zone: [slope, half_width],
            once: [a, b],
            twice: [c, d],
            cogging: [e, f],
            per_turn,
        } = self;
        [k, limit, slope, half_width, a, b, c, d, e, f, per_turn]
    }
}

impl Ground<f64> {
    /// Whether a stop or a dead zone is there.
    pub(super) fn has_springs(&self) -> bool {
        self.end_stop[0] != 0.0 || self.dead_zone[0] != 0.0
    }

    /// Whether there are waves per turn.
    pub(super) fn has_waves(&self) -> bool {
        let waves = self.once.iter().chain(&self.twice).chain(&self.cogging);
        waves.copied().any(|v| v != 0.0)
    }

    /// The stiffest that each part can be, at the road wheel, Nm/rad: stop, dead zone, the three waves together.
    pub(super) fn stiffnesses(&self, ratio: f64) -> [f64; 3] {
        let size = |wave: &[f64; 2]| wave[0].hypot(wave[1]);
        let waves =
            size(&self.once) + 2.0 * size(&self.twice) + self.per_turn * size(&self.cogging);
        [
            self.end_stop[0],
            self.dead_zone[0].max(0.0),
            ratio * ratio * waves,
        ]
    }
}

/// `a` times the sine's column and `b` times the cosine's.
#[inline(always)]
fn wave<T: crate::effects::Law>(turn: Pure, inner: f64, [a, b]: [Pure; 2]) -> Pure {
    let mut columns = [Pure::ZERO; 2];
    T::basis(&at(Pure::ZERO, turn), &[inner], &mut columns);
    a * columns[0] + b * columns[1]
}

impl Ground<Pure> {
    /// The torque against a turn to the positive side. The pinion turns `ratio` times as far as the road wheel; what
    /// acts on it is felt `ratio` times at the road wheel.
    #[inline(always)]
    pub(super) fn torque<const WITH: usize>(&self, phi: Pure, ratio: Pure) -> Pure {
        let turn = ratio * phi;
        let here = at(phi, turn);
        let springs = self.end_stop[0] * one::<EndStop>(&here, self.end_stop[1].0)
            + self.dead_zone[0] * one::<DeadZone>(&here, self.dead_zone[1].0);
        if WITH & WAVY == 0 {
            return springs;
        }
        let waves = wave::<OncePerRev>(turn, 0.0, self.once)
            + wave::<TwicePerRev>(turn, 0.0, self.twice)
            + wave::<Cogging>(turn, self.per_turn.0, self.cogging);
        springs + ratio * waves
    }

    /// The energy held, the waves' counted from a road wheel in the middle: the integral of the torque.
    pub(super) fn stored(&self, phi: Pure, ratio: Pure) -> Pure {
        let turn = ratio * phi;
        let spring = |[stiffness, limit]: [Pure; 2]| {
            let beyond = luz(phi, limit);
            Pure(0.5) * stiffness * beyond * beyond
        };
        let wave = |[a, b]: [Pure; 2], times: Pure| {
            let angle = times * turn;
            (a * (Pure::ONE - angle.cos()) + b * angle.sin()) / times
        };
        spring(self.end_stop)
            + spring(self.dead_zone)
            + wave(self.once, Pure::ONE)
            + wave(self.twice, Pure(2.0))
            + wave(self.cogging, self.per_turn)
    }
}
