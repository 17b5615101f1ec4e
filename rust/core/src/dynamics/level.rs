//! What changes the level of dry friction besides side and speed: the angle, the load, the time at rest.

use crate::effects::{Dwell, Law, Load, PositionCoulomb, TightSpot};

use super::number::Pure;
use super::one_mass::{WAVY, at, one};

/// How many values a [`Level`] has.
pub(super) const VALUES: usize = 7;

/// Parts of the level of dry friction.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Level<L> {
    /// Change of the level per angle of the road wheel.
    pub slope: L,
    /// Extra at a tight spot, its angle and its width.
    pub tight_spot: [L; 3],
    /// Friction per load on the road wheel.
    pub load: L,
    /// Extra after a long rest, and the time in which it grows; felt at rest only.
    pub dwell: [L; 2],
}

impl<L: Copy> Level<L> {
    /// From the values in a row.
    #[inline(always)]
    pub(super) fn from_values(of: impl Fn(usize) -> L) -> Self {
        Self {
            slope: of(0),
            tight_spot: [of(1), of(2), of(3)],
            load: of(4),
            dwell: [of(5), of(6)],
        }
    }

    /// The values of a row.
    pub(super) fn to_values(self) -> [L; VALUES] {
        let Self {
            slope,
            tight_spot: [extra, angle, width],
            load,
            dwell: [grown, time],
        } = self;
        [slope, extra, angle, width, load, grown, time]
    }
}

impl Level<f64> {
    /// Whether there is anything besides a tight spot.
    pub(super) fn is_straight(&self) -> bool {
        self.slope != 0.0 || self.load != 0.0 || self.dwell[0] != 0.0
    }

    /// Whether there is a tight spot.
    pub(super) fn has_spot(&self) -> bool {
        self.tight_spot[0] != 0.0
    }
}

impl Level<Pure> {
    /// What angle and load add.
    #[inline(always)]
    pub(super) fn here<const WITH: usize>(&self, phi: Pure, load: Pure) -> Pure {
        let mut here = at(phi, Pure::ZERO);
        here.load_n = load;
        let straight =
            self.slope * one::<PositionCoulomb>(&here, 0.0) + self.load * one::<Load>(&here, 0.0);
        if WITH & WAVY == 0 {
            return straight;
        }
        let [extra, angle, width] = self.tight_spot;
        let mut spot = [Pure::ZERO];
        TightSpot::basis(&here, &[angle.0, width.0], &mut spot);
        straight + extra * spot[0]
    }

    /// What a rest of so many seconds adds to the friction at rest. The law's fading after the break-away plays no part:
    /// a body that has broken away feels kinetic friction.
    #[inline(always)]
    pub(super) fn rested(&self, rest_s: Pure) -> Pure {
        let mut here = at(Pure::ZERO, Pure::ZERO);
        here.rest_s = rest_s;
        self.dwell[0] * one::<Dwell>(&here, self.dwell[1].0)
    }
}
