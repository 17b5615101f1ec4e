//! The sections of one filter, one after the other.

use super::section::{LOW, Section};
use super::state_space::StateSpace;

/// Twelve poles in pairs.
pub const MAX_SECTIONS: usize = 6;

/// At most six sections and what they do to a constant.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Cascade {
    sections: [Section; MAX_SECTIONS],
    count: usize,
    /// The gain of a constant, without rounding: 1 or 0.
    pub level_gain: f64,
}

impl Cascade {
    /// Collects sections, at most six.
    pub fn new(list: impl IntoIterator<Item = Section>, level_gain: f64) -> Self {
        let nothing = Section::Pair {
            g: 1.0,
            k: 2.0,
            mix: LOW,
        };
        let (mut sections, mut count) = ([nothing; MAX_SECTIONS], 0);
        for section in list {
            sections[count] = section;
            count += 1;
        }
        Self {
            sections,
            count,
            level_gain,
        }
    }

    /// The sections in the order of the signal.
    pub fn sections(&self) -> &[Section] {
        &self.sections[..self.count]
    }

    /// The whole as one linear system.
    pub fn space(&self) -> StateSpace {
        StateSpace::new(self.sections())
    }

    /// The same with its output's derivative per sample as output; None where that has no finite gain.
    pub fn derivative(&self) -> Option<Self> {
        let mut changed = *self;
        let last = self.sections().last()?.derivative()?;
        changed.sections[self.count - 1] = last;
        changed.level_gain = 0.0;
        Some(changed)
    }

    /// The logarithm of the largest pole radius.
    pub fn ln_radius(&self) -> f64 {
        let each = self.sections().iter().map(Section::ln_radius);
        each.fold(f64::NEG_INFINITY, f64::max)
    }

    /// Samples until the slowest pole has decayed to a tolerance in (0, 1), at least one.
    pub fn settle_samples(&self, tolerance: f64) -> usize {
        // A float-to-integer cast saturates.
        ((tolerance.ln() / self.ln_radius()).ceil() as usize).max(1)
    }

    /// How far the output of a steady ramp lags behind its input, in samples, for a gain of one at zero frequency.
    pub fn lag(&self) -> f64 {
        let space = self.space();
        let per_slope = space.steady().at(0.0, -1.0);
        space.c.iter().zip(&per_slope).map(|(c, s)| c * s).sum()
    }
}
