//! Forward and backward over a record: zero phase, with edges that are said and defined.
//!
//! The record is continued beyond both ends by point reflection, `x(-t) = 2 x(0) - x(t)`, as often as needed, so that
//! a ramp continues as the same ramp. Each pass starts in the steady state of a ramp: the chord of the extension.

use super::anti_alias::AntiAlias;
use super::butterworth::{LowPass, Passes};
use super::cascade::Cascade;
use crate::error::{Error, require_moderate, require_same_length};

/// What happens at the ends of the record.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Edges {
    /// The extension is as long as the filter's memory: until its slowest pole has decayed to the tolerance.
    Settled {
        /// In (0, 1).
        tolerance: f64,
    },
    /// What `scipy.signal.sosfiltfilt` does by default: `3 (poles + 1)` samples whatever the cut-off, started at the
    /// steady state of a constant. For comparison only: low cut-offs are wrong at both ends.
    Scipy,
}

impl Default for Edges {
    /// A tolerance of 1e-9: below the 24 bits of an acquisition card, for 1.5 times the length of one in a million.
    fn default() -> Self {
        Self::Settled { tolerance: 1e-9 }
    }
}

/// The longest extension: 2^26 samples are 0.5 GB; a filter that needs more wants a lower sample rate first.
pub const MAX_EXTENSION: usize = 1 << 26;

/// A zero-phase filter with its scratch memory, for many records of any length.
#[derive(Debug, Clone)]
pub struct ZeroPhase {
    cascade: Cascade,
    edges: Edges,
    /// One extension at a time, its length fixed by the design.
    extension: Vec<f64>,
}

impl ZeroPhase {
    /// Prepares the scratch memory for one design.
    ///
    /// # Errors
    /// [`Error::OutOfRange`] for a tolerance outside (0, 1), a design that does not settle within
    /// [`MAX_EXTENSION`] samples, or one made for a single pass.
    pub fn new(low_pass: LowPass, edges: Edges) -> Result<Self, Error> {
        if low_pass.passes() == Passes::Forward {
            return Err(Error::OutOfRange {
                name: "passes",
                value: 1.0,
                interval: "{2}: a design for one pass runs in a Filter".into(),
            });
        }
        let length = match edges {
            Edges::Settled { tolerance } => low_pass.settle_samples(tolerance)?,
            // sosfiltfilt: 3 ntaps, where ntaps = 2 sections + 1, less one if a section has a single pole
            Edges::Scipy => 3 * (low_pass.poles() + 1),
        };
        if length > MAX_EXTENSION {
            return Err(Error::OutOfRange {
                name: "cutoff_hz",
                value: low_pass.cutoff_hz(),
                interval: format!(
                    "the range that settles within {MAX_EXTENSION} samples (this one takes {length}; \
                     reduce the sample rate first)"
                ),
            });
        }
        Ok(Self {
            cascade: low_pass.cascade,
            edges,
            extension: vec![0.0; length],
        })
    }

    /// Prepares the scratch memory for the low pass of a decimation.
    #[must_use]
    pub fn anti_alias(filter: &AntiAlias) -> Self {
        let Edges::Settled { tolerance } = Edges::default() else {
            unreachable!("the default edges are settled");
        };
        let length = (tolerance.ln() / filter.ln_radius).ceil() as usize;
        Self {
            cascade: filter.cascade,
            edges: Edges::default(),
            extension: vec![0.0; length.max(1)],
        }
    }

    /// Filters `x` into `out`; any length from one sample. Nothing is allocated.
    ///
    /// # Errors
    /// [`Error::NonFinite`], [`Error::OutOfRange`], [`Error::Length`] (empty, lengths that differ, or too short for
    /// [`Edges::Scipy`]).
    pub fn apply(&mut self, x: &[f64], out: &mut [f64]) -> Result<(), Error> {
        require_same_length("out", out, "x", x.len())?;
        let length = self.extension.len();
        let least = match self.edges {
            Edges::Settled { .. } => 1,
            Edges::Scipy => length + 1,
        };
        if x.len() < least {
            return Err(Error::Length {
                name: "x",
                expected: format!("at least {least}"),
                got: x.len(),
            });
        }
        require_moderate("x", x)?;
        self.forward(x, out);
        self.backward(x[0], out);
        Ok(())
    }

    /// Filters records of `length` samples that lie one after the other in `x` into the same places of `out`.
    ///
    /// # Errors
    /// As [`Self::apply`]; an index in the message counts from the start of its record.
    pub fn apply_rows(&mut self, x: &[f64], length: usize, out: &mut [f64]) -> Result<(), Error> {
        require_same_length("out", out, "x", x.len())?;
        if length == 0 || x.is_empty() || !x.len().is_multiple_of(length) {
            return Err(Error::Length {
                name: "x",
                expected: format!("a positive multiple of the record length {length}"),
                got: x.len(),
            });
        }
        for (x, out) in x.chunks_exact(length).zip(out.chunks_exact_mut(length)) {
            self.apply(x, out)?;
        }
        Ok(())
    }

    /// The slope a pass starts with, from the rise over the whole extension.
    fn chord(&self, rise: f64) -> f64 {
        match self.edges {
            Edges::Settled { .. } => rise / self.extension.len() as f64,
            Edges::Scipy => 0.0,
        }
    }

    /// Filters `x - x[0]` into `out` and leaves the filtered right extension in the scratch memory.
    fn forward(&mut self, x: &[f64], out: &mut [f64]) {
        let cascade = self.cascade;
        let level = x[0];
        extend_left(x, &mut self.extension);
        let far = self.extension[0];
        let mut state = cascade.steady(far, self.chord(-far));
        cascade.run(&mut state, in_place(self.extension.iter_mut()), |y| y);
        cascade.run(&mut state, x.iter().map(|v| v - level).zip(out), |y| y);
        extend_right(x, &mut self.extension);
        cascade.run(&mut state, in_place(self.extension.iter_mut()), |y| y);
    }

    /// Filters `out` from its end to its beginning and puts the level back.
    fn backward(&mut self, level: f64, out: &mut [f64]) {
        let cascade = self.cascade;
        let (far, last) = (self.extension[self.extension.len() - 1], out[out.len() - 1]);
        let mut state = cascade.steady(far, self.chord(last - far));
        cascade.run(&mut state, in_place(self.extension.iter_mut().rev()), |y| y);
        cascade.run(&mut state, in_place(out.iter_mut().rev()), |y| y + level);
    }
}

/// Filters a record forward and backward into `out`.
///
/// One allocation, the extension; [`ZeroPhase`] keeps it for many records.
///
/// # Errors
/// As [`ZeroPhase::new`] and [`ZeroPhase::apply`].
pub fn zero_phase(
    low_pass: &LowPass,
    x: &[f64],
    edges: Edges,
    out: &mut [f64],
) -> Result<(), Error> {
    ZeroPhase::new(*low_pass, edges)?.apply(x, out)
}

/// Each value with its own place.
fn in_place<'a>(
    values: impl Iterator<Item = &'a mut f64>,
) -> impl Iterator<Item = (f64, &'a mut f64)> {
    values.map(|v| (*v, v))
}

/// The samples before the record, relative to its first: the nearest last.
fn extend_left(x: &[f64], extension: &mut [f64]) {
    let level = x[0];
    if extension.len() < x.len() {
        for (place, v) in extension.iter_mut().rev().zip(&x[1..]) {
            *place = level - v;
        }
    } else {
        for (place, t) in extension.iter_mut().rev().zip(1..) {
            *place = -reflected(x, t);
        }
    }
}

/// The samples after the record, relative to its first: the nearest first.
fn extend_right(x: &[f64], extension: &mut [f64]) {
    let (level, last) = (x[0], x.len() - 1);
    if extension.len() < x.len() {
        let twice = 2.0 * (x[last] - level);
        for (place, v) in extension.iter_mut().zip(x[..last].iter().rev()) {
            *place = twice - (v - level);
        }
    } else {
        for (place, t) in extension.iter_mut().zip(last + 1..) {
            *place = reflected(x, t);
        }
    }
}

/// Sample `t >= 0` of the record continued by reflecting it at its last point, then at its first, and so on.
///
/// Two reflections are a translation: the continuation repeats every `2 (n - 1)` samples, twice the rise higher.
fn reflected(x: &[f64], t: usize) -> f64 {
    let (level, last) = (x[0], x.len() - 1);
    if last == 0 {
        return 0.0;
    }
    let (rise, period) = (x[last] - level, 2 * last);
    let (turns, place) = (t / period, t % period);
    let base = if place <= last {
        x[place] - level
    } else {
        2.0 * rise - (x[period - place] - level)
    };
    base + 2.0 * rise * turns as f64
}
