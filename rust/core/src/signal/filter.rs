//! The causal filter on a stream: a design and its memory, fed in chunks of any size.

use super::butterworth::LowPass;
use super::cascade::{MAX_PAIRS, State};
use crate::error::{Error, require_moderate, require_same_length};

/// A running filter. The output does not depend on how the stream is cut into chunks, bit for bit.
///
/// A new filter starts settled at the first sample it is given, so that a record that begins at 100 units does not
/// begin with a step of 100; [`Filter::reset`] chooses another start.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Filter {
    low_pass: LowPass,
    /// The level the memory is relative to; None until the first sample. Rounding is then relative to the signal's
    /// excursion, not to its offset.
    origin: Option<f64>,
    state: State,
}

/// The numbers a filter remembers: the origin's presence, the origin, the real pole, the pairs.
pub const STATE_LEN: usize = 3 + 2 * MAX_PAIRS;

impl Filter {
    /// A filter that will settle at its first sample.
    #[must_use]
    pub fn new(low_pass: LowPass) -> Self {
        Self {
            low_pass,
            origin: None,
            state: State::default(),
        }
    }

    /// The design.
    #[must_use]
    pub fn low_pass(&self) -> &LowPass {
        &self.low_pass
    }

    /// Forgets the past: settled at `level`, or at the next sample if None. Zero gives the filter at rest.
    ///
    /// # Errors
    /// [`Error::NonFinite`] or [`Error::OutOfRange`] for a level that no sample may have; the memory is untouched.
    pub fn reset(&mut self, level: Option<f64>) -> Result<(), Error> {
        if let Some(level) = level {
            require_moderate("level", &[level])?;
        }
        self.origin = level;
        self.state = State::default();
        Ok(())
    }

    /// Filters `x` into `out`. Nothing is allocated.
    ///
    /// # Errors
    /// [`Error::NonFinite`], [`Error::OutOfRange`] or [`Error::Length`]; the memory is untouched by a refused chunk.
    pub fn push_into(&mut self, x: &[f64], out: &mut [f64]) -> Result<(), Error> {
        require_same_length("out", out, "x", x.len())?;
        require_moderate("x", x)?;
        let Some(&first) = x.first() else {
            return Ok(());
        };
        let origin = *self.origin.get_or_insert(first);
        let samples = x.iter().map(|v| v - origin).zip(out);
        let cascade = self.low_pass.cascade;
        cascade.run(&mut self.state, samples, |y| y + origin);
        Ok(())
    }

    /// Filters a buffer in place. Nothing is allocated.
    ///
    /// # Errors
    /// As [`Self::push_into`].
    pub fn push_in_place(&mut self, x: &mut [f64]) -> Result<(), Error> {
        require_moderate("x", x)?;
        let Some(&first) = x.first() else {
            return Ok(());
        };
        let origin = *self.origin.get_or_insert(first);
        let samples = x.iter_mut().map(|v| (*v - origin, v));
        let cascade = self.low_pass.cascade;
        cascade.run(&mut self.state, samples, |y| y + origin);
        Ok(())
    }

    /// Filters one chunk into a new vector.
    ///
    /// # Errors
    /// As [`Self::push_into`].
    pub fn push(&mut self, x: &[f64]) -> Result<Vec<f64>, Error> {
        let mut out = x.to_vec();
        self.push_in_place(&mut out)?;
        Ok(out)
    }

    /// The memory as plain numbers, to be stored and given to [`Self::restore`].
    #[must_use]
    pub fn state(&self) -> [f64; STATE_LEN] {
        let mut flat = [0.0; STATE_LEN];
        flat[0] = f64::from(u8::from(self.origin.is_some()));
        flat[1] = self.origin.unwrap_or(0.0);
        flat[2] = self.state.single;
        flat[3..].copy_from_slice(self.state.pairs.as_flattened());
        flat
    }

    /// Continues from a stored memory, bit for bit.
    ///
    /// # Errors
    /// [`Error::Length`] or [`Error::NonFinite`] for numbers that [`Self::state`] did not make.
    pub fn restore(&mut self, state: &[f64]) -> Result<(), Error> {
        require_same_length("state", state, "the memory", STATE_LEN)?;
        require_moderate("state", state)?;
        self.origin = (state[0] != 0.0).then_some(state[1]);
        self.state.single = state[2];
        for (pair, stored) in self.state.pairs.iter_mut().zip(state[3..].chunks_exact(2)) {
            pair.copy_from_slice(stored);
        }
        Ok(())
    }
}
