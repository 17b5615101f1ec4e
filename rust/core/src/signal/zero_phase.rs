//! Forward and backward over a record: zero phase, with edges that are said and defined.
//!
//! Two passes over the result's own memory; the extensions beyond the ends are read from the record itself and act only
//! through the state a pass starts with (see `extension`).

use std::sync::OnceLock;

use super::anti_alias::AntiAlias;
use super::butterworth::{Butterworth, Passes, require_tolerance};
use super::cascade::Cascade;
use super::extension::{Around, Starts};
use super::gustafsson;
use super::lookahead::Block;
use super::matrix::Vector;
use super::samples::{Sample, Scale};
use super::section::{Section, Solved};
use super::simd::{Affine, InstructionSet};
use super::system::System;
use super::tail::Tail;
use crate::error::{Error, require_moderate, require_same_length};

/// What is left of a filter's past when nothing is: below the rounding of a sum of its response.
const NOTHING: f64 = 1e-18;

/// What happens at the ends of the record.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Edges {
    /// The record is continued by point reflection, `x(-t) = 2 x(0) - x(t)`, as often as needed, until the filter's
    /// slowest pole has decayed to the tolerance; a record shorter than that is continued forever, in closed form.
    Settled {
        /// In (0, 1).
        tolerance: f64,
    },
    /// What `scipy.signal.sosfiltfilt` does by default: `3 (poles + 1)` samples whatever the cut-off, started at the
    /// steady state of a constant. For comparison only: low cut-offs are wrong at both ends.
    Scipy,
    /// What MATLAB's `filtfilt(b, a, x)` does: as scipy with `3 poles` samples.
    Matlab,
    /// Nothing is continued: the start states for which forward-backward and backward-forward agree best (Gustafsson,
    /// 1996).
    Gustafsson,
}

impl Default for Edges {
    /// A tolerance of 1e-9: below the 24 bits of an acquisition card, for 1.5 times the length of one in a million.
    fn default() -> Self {
        Self::Settled { tolerance: 1e-9 }
    }
}

/// A zero-phase filter, for many records of any length; it remembers nothing between them.
#[derive(Debug, Clone)]
pub struct ZeroPhase {
    pub(super) first: System,
    pub(super) second: System,
    pub(super) turned: Block,
    pub(super) around: Around,
    pub(super) edges: Edges,
    /// The longest extension of settled edges, the only one of scipy's and MATLAB's.
    pub(super) pad: usize,
    /// The sections of both passes, for channels side by side.
    pub(super) sections: [Sections; 2],
    /// Samples after which nothing is left of the past.
    memory: usize,
    /// Summed when it is first asked for.
    tail: OnceLock<Tail>,
}

impl ZeroPhase {
    /// Prepares one design for the widest registers of this processor.
    ///
    /// # Errors
    /// [`Error::OutOfRange`] for a tolerance outside (0, 1) or a design made for a single pass.
    pub fn new(design: &Butterworth, edges: Edges) -> Result<Self, Error> {
        Self::on(design, edges, InstructionSet::best())
    }

    /// [`Self::new`] for a chosen instruction set.
    ///
    /// # Errors
    /// As [`Self::new`].
    pub fn on(design: &Butterworth, edges: Edges, set: InstructionSet) -> Result<Self, Error> {
        require_both_ways(design)?;
        Self::of_cascades(&design.cascade, &design.cascade, edges, set)
    }

    /// The filter whose result is the time derivative of the filtered record, per second.
    ///
    /// # Errors
    /// As [`Self::new`]; [`Error::OutOfRange`] for a design that passes high frequencies or has a single pole.
    pub fn derivative(
        design: &Butterworth,
        edges: Edges,
        set: InstructionSet,
    ) -> Result<Self, Error> {
        require_both_ways(design)?;
        let Some(first) = design.cascade.derivative() else {
            return Err(Error::OutOfRange {
                name: "poles",
                value: design.poles() as f64,
                interval: "[2, 12] of a low or band pass: a derivative of anything else grows with frequency".into(),
            });
        };
        let mut filter = Self::of_cascades(&first, &design.cascade, edges, set)?;
        filter.second = filter.second.scaled(design.sample_rate_hz());
        filter.second.level_gain = 0.0;
        if let Some(last) = filter.sections[1].last_mut() {
            last.c = last.c.map(|c| c * design.sample_rate_hz());
            last.d *= design.sample_rate_hz();
        }
        filter.turned = filter.second.block.reversed();
        Ok(filter)
    }

    /// Prepares the low pass of a decimation.
    ///
    /// # Errors
    /// None for the default edges it uses.
    pub fn anti_alias(filter: &AntiAlias) -> Result<Self, Error> {
        Self::of_cascades(
            &filter.cascade,
            &filter.cascade,
            Edges::default(),
            InstructionSet::best(),
        )
    }

    fn of_cascades(
        first: &Cascade,
        second: &Cascade,
        edges: Edges,
        set: InstructionSet,
    ) -> Result<Self, Error> {
        let poles = first.space().n;
        let pad = match edges {
            Edges::Settled { tolerance } => {
                require_tolerance(tolerance)?;
                first.settle_samples(tolerance)
            }
            // sosfiltfilt: 3 ntaps, where ntaps = 2 sections + 1, less one if a section has a single pole
            Edges::Scipy => 3 * (poles + 1),
            Edges::Matlab => 3 * poles,
            Edges::Gustafsson => 0,
        };
        let (first_system, second_system) = (System::new(first, set), System::new(second, set));
        let around = Around::new(&first_system.space, &first_system.block);
        Ok(Self {
            turned: second_system.block.reversed(),
            tail: OnceLock::new(),
            memory: first.settle_samples(NOTHING),
            sections: [sections_of(first), sections_of(second)],
            first: first_system,
            second: second_system,
            around,
            edges,
            pad,
        })
    }

    /// The instruction set the kernel runs on.
    #[must_use]
    pub fn instruction_set(&self) -> InstructionSet {
        self.first.kernel.set()
    }

    /// What happens at the ends.
    #[must_use]
    pub fn edges(&self) -> Edges {
        self.edges
    }

    fn tail(&self) -> &Tail {
        self.tail
            .get_or_init(|| Tail::new(&self.second.space, &self.around, self.memory))
    }

    /// How much of what lies more than `distance` samples away acts on a sample: the sum of the magnitudes of the
    /// zero-phase impulse response beyond that distance.
    #[must_use]
    pub fn weight_beyond(&self, distance: usize) -> f64 {
        self.tail().beyond(distance)
    }

    /// The samples of a record of `length` that what lies beyond its ends moves by at most `tolerance` times the
    /// difference between the assumed and the true continuation.
    ///
    /// # Errors
    /// [`Error::OutOfRange`] unless `tolerance` is in (0, 1).
    pub fn trusted(&self, length: usize, tolerance: f64) -> Result<std::ops::Range<usize>, Error> {
        require_tolerance(tolerance)?;
        let edge = self.tail().distance(tolerance);
        Ok(if 2 * edge < length {
            edge..length - edge
        } else {
            0..0
        })
    }

    /// Filters `x` into `out`; any length from one sample, unless the edges are scipy's or MATLAB's. After an error
    /// `out` holds nothing of use.
    ///
    /// # Errors
    /// [`Error::NonFinite`], [`Error::OutOfRange`], [`Error::Length`] (empty, lengths that differ, or too short for
    /// the edges).
    pub fn apply(&self, x: &[f64], out: &mut [f64]) -> Result<(), Error> {
        require_same_length("out", out, "x", x.len())?;
        self.require_length(x.len())?;
        if self.is_closed(x.len()) || self.edges == Edges::Gustafsson {
            require_moderate("x", x)?;
            out.copy_from_slice(x);
            self.whole(out);
            return Ok(());
        }
        let (level, starts) = (x[0], self.starts(x));
        // What is not moderate shows at the end of the pass; it is looked for only then.
        let (after, good) = self.first.forward(&starts.first, subtract(level), x, out);
        if !good {
            return require_moderate("x", x);
        }
        self.backward(&starts, &after, level, out);
        Ok(())
    }

    /// Filters `x` in place; `x` is untouched if it is refused.
    ///
    /// # Errors
    /// As [`Self::apply`].
    pub fn apply_in_place(&self, x: &mut [f64]) -> Result<(), Error> {
        self.require_length(x.len())?;
        require_moderate("x", x)?;
        if self.is_closed(x.len()) || self.edges == Edges::Gustafsson {
            self.whole(x);
            return Ok(());
        }
        let (level, starts) = (x[0], self.starts(x));
        let (after, _) = self
            .first
            .forward_in_place(&starts.first, subtract(level), x);
        self.backward(&starts, &after, level, x);
        Ok(())
    }

    /// Filters counts or single-precision samples, `factor x + offset` in their unit, into `out`.
    ///
    /// # Errors
    /// As [`Self::apply`]; `out` then holds nothing of use.
    pub fn apply_samples<T: Sample>(
        &self,
        x: &[T],
        scale: Scale,
        out: &mut [f64],
    ) -> Result<(), Error> {
        require_same_length("out", out, "x", x.len())?;
        scale.widen(x, out);
        self.apply_in_place(out)
    }

    /// Filters records of `length` samples that lie one after the other in `x` into the same places of `out`, on
    /// `threads` threads.
    ///
    /// # Errors
    /// As [`Self::apply`]; an index in the message counts from the start of its record.
    pub fn apply_rows(
        &self,
        x: &[f64],
        length: usize,
        out: &mut [f64],
        threads: usize,
    ) -> Result<(), Error> {
        require_same_length("out", out, "x", x.len())?;
        if length == 0 || x.is_empty() || !x.len().is_multiple_of(length) {
            return Err(Error::Length {
                name: "x",
                expected: format!("a positive multiple of the record length {length}"),
                got: x.len(),
            });
        }
        let one_after_another = |x: &[f64], out: &mut [f64]| {
            let mut rows = x.chunks_exact(length).zip(out.chunks_exact_mut(length));
            rows.try_for_each(|(x, out)| self.apply(x, out))
        };
        let rows = x.len() / length;
        if threads <= 1 || rows == 1 {
            return one_after_another(x, out);
        }
        let share = rows.div_ceil(threads) * length;
        std::thread::scope(|scope| {
            let parts = x.chunks(share).zip(out.chunks_mut(share));
            let running: Vec<_> = parts
                .map(|(x, out)| scope.spawn(move || one_after_another(x, out)))
                .collect();
            let mut results = running.into_iter().map(|thread| match thread.join() {
                Ok(result) => result,
                Err(panic) => std::panic::resume_unwind(panic),
            });
            results.try_for_each(|result| result)
        })
    }

    /// Whether the record is shorter than its extension, so that the closed form is due.
    pub(super) fn is_closed(&self, length: usize) -> bool {
        matches!(self.edges, Edges::Settled { .. }) && self.pad >= length
    }

    pub(super) fn require_length(&self, length: usize) -> Result<(), Error> {
        let least = match self.edges {
            Edges::Settled { .. } | Edges::Gustafsson => 1,
            Edges::Scipy | Edges::Matlab => self.pad + 1,
        };
        if length >= least {
            return Ok(());
        }
        Err(Error::Length {
            name: "x",
            expected: format!("at least {least}"),
            got: length,
        })
    }

    /// The states both passes start with, from the record alone.
    fn starts(&self, x: &[f64]) -> Starts {
        match self.edges {
            Edges::Settled { .. } => self.around.settled(&self.first, x, self.pad),
            _ => Starts::padded(&self.first, x, self.pad),
        }
    }

    /// The second pass, from the state `after` the first.
    fn backward(&self, starts: &Starts, after: &Vector, level: f64, out: &mut [f64]) {
        let start = starts.second(&self.first, &self.second, &self.around, after);
        let lift = level * self.second.level_gain;
        let affine = Affine::lifted(lift);
        self.second
            .backward_in_place(&self.turned, &start, affine, out);
    }

    /// A record that is filtered as a whole in its own memory.
    fn whole(&self, x: &mut [f64]) {
        if self.edges == Edges::Gustafsson {
            gustafsson::filter(self, x);
            return;
        }
        // The chord is taken out, filtered in the head and put back: what is left repeats itself without growing.
        let (n, level) = (x.len(), x[0]);
        let slope = if n > 1 {
            (x[n - 1] - level) / (n - 1) as f64
        } else {
            0.0
        };
        for (i, v) in x.iter_mut().enumerate() {
            *v = (*v - level) - slope * i as f64;
        }
        if n > 1 {
            x[n - 1] = 0.0;
            let starts = self.around.repeated(&self.first, x, self.pad);
            let (after, _) = self.first.forward_in_place(&starts.first, Affine::NONE, x);
            self.backward(&starts, &after, 0.0, x);
        }
        let (constant, rise) = self.of_ramp(level, slope);
        for (i, v) in x.iter_mut().enumerate() {
            *v += constant + rise * i as f64;
        }
    }

    /// What becomes of a ramp in both passes: its constant and its slope.
    fn of_ramp(&self, level: f64, slope: f64) -> (f64, f64) {
        let gain = self.second.level_gain;
        if gain != 0.0 {
            return (level, slope);
        }
        // The steady output of the first pass, a constant, through the second.
        let first = self
            .first
            .space
            .output(&self.first.steady.at(0.0, slope), 0.0);
        (
            self.second
                .space
                .output(&self.second.steady.at(first, 0.0), first),
            0.0,
        )
    }
}

/// The sections of one pass, solved for their increments.
pub(super) type Sections = Vec<Solved>;

fn sections_of(cascade: &Cascade) -> Sections {
    cascade.sections().iter().map(Section::solved).collect()
}

/// Takes the level out on the way in.
fn subtract(level: f64) -> Affine {
    Affine::new(1.0, -level, 0.0)
}

fn require_both_ways(design: &Butterworth) -> Result<(), Error> {
    if design.passes() == Passes::ForwardBackward {
        return Ok(());
    }
    Err(Error::OutOfRange {
        name: "passes",
        value: 1.0,
        interval: "{2}: a design for one pass runs in a Filter".into(),
    })
}

/// Filters a record forward and backward into `out`.
///
/// # Errors
/// As [`ZeroPhase::new`] and [`ZeroPhase::apply`].
pub fn zero_phase(
    design: &Butterworth,
    x: &[f64],
    edges: Edges,
    out: &mut [f64],
) -> Result<(), Error> {
    ZeroPhase::new(design, edges)?.apply(x, out)
}
