//! Count, mean, spread, shape and extremes of a stream in one object that can be pushed and merged.
//!
//! Samples wait until a block is full, so that the sums are the same to the last bit whatever the chunks were.

use super::figures::Figures;
use super::spread::{BLOCK, Range, Spread};
use crate::error::{Error, LARGEST};

/// The largest magnitude where third and fourth powers are summed as well: its fourth power is [`LARGEST`]'s square.
pub const LARGEST_FOR_SHAPE: f64 = 1e75;

/// An extreme value and where it was first met.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Extreme {
    /// The value.
    pub value: f64,
    /// Its index in the stream, from zero; skipped samples count.
    pub index: u64,
}

/// What is asked of the moments.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Settings {
    /// Sum the third and fourth powers too (skew and kurtosis).
    pub shape: bool,
    /// Leave NaN out and count it, instead of refusing it. Infinities are refused in any case.
    pub skip_nan: bool,
    /// Samples at or below the first or at or above the second are counted as clipped.
    pub clipped_at: (f64, f64),
}

impl Default for Settings {
    fn default() -> Self {
        Self {
            shape: false,
            skip_nan: false,
            clipped_at: (f64::NEG_INFINITY, f64::INFINITY),
        }
    }
}

/// The moments of everything pushed so far.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Moments {
    pub(super) settings: Settings,
    pub(super) done: Done,
    /// Kept samples that do not fill a block yet.
    pub(super) waiting: [f64; BLOCK],
    pub(super) filled: usize,
}

/// Everything but the waiting samples: what a refused chunk must leave as it was.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(super) struct Done {
    pub(super) spread: Spread,
    /// Samples seen, skipped ones included.
    pub(super) seen: u64,
    pub(super) nan: u64,
    pub(super) clipped: u64,
    pub(super) min: Option<Extreme>,
    pub(super) max: Option<Extreme>,
}

impl Default for Moments {
    fn default() -> Self {
        Self::new(Settings::default())
    }
}

impl Moments {
    /// Nothing pushed yet.
    #[must_use]
    pub fn new(settings: Settings) -> Self {
        Self {
            settings,
            done: Done::default(),
            waiting: [0.0; BLOCK],
            filled: 0,
        }
    }

    /// What was asked for.
    #[must_use]
    pub fn settings(&self) -> Settings {
        self.settings
    }

    /// Adds samples.
    ///
    /// # Errors
    /// [`Error::NonFinite`] or [`Error::OutOfRange`]; nothing of a refused chunk is added.
    pub fn push(&mut self, x: &[f64]) -> Result<(), Error> {
        if self.settings.skip_nan {
            return self.push_skipping(x);
        }
        let mut done = self.done;
        let (head, rest) = if self.filled > 0 {
            x.split_at(x.len().min(BLOCK - self.filled))
        } else {
            (&[][..], x)
        };
        let mut filled = self.filled;
        if !head.is_empty() {
            done.note(head, range_of(head), &self.settings, x)?;
            // Beyond `self.filled` nothing counts until it is raised, so a later refusal needs no undoing.
            self.waiting[filled..filled + head.len()].copy_from_slice(head);
            filled += head.len();
            if filled == BLOCK {
                done.spread.merge(
                    &Spread::of_block(&self.waiting, self.settings.shape).0,
                    self.settings.shape,
                );
                filled = 0;
            }
        }
        let (blocks, tail) = rest.as_chunks::<BLOCK>();
        for block in blocks {
            let (spread, range) = Spread::of_block(block, self.settings.shape);
            // NaN hides from comparisons but not from the sum.
            let range = if spread.mean.value.is_finite() {
                range
            } else {
                NOT_FINITE
            };
            done.note(block, range, &self.settings, x)?;
            done.spread.merge(&spread, self.settings.shape);
        }
        if !tail.is_empty() {
            done.note(tail, range_of(tail), &self.settings, x)?;
            self.waiting[..tail.len()].copy_from_slice(tail);
            filled = tail.len();
        }
        self.done = done;
        self.filled = filled;
        Ok(())
    }

    /// Adds samples of another type, block by block, without a converted copy of the chunk.
    ///
    /// # Errors
    /// As [`Self::push`]; nothing of a refused chunk is added.
    pub fn push_converted<T: Copy + Into<f64>>(&mut self, x: &[T]) -> Result<(), Error> {
        let before = *self;
        let mut buffer = [0.0; BLOCK];
        for (at, part) in x.chunks(BLOCK).enumerate() {
            let converted = &mut buffer[..part.len()];
            for (to, from) in converted.iter_mut().zip(part) {
                *to = (*from).into();
            }
            if let Err(error) = self.push(converted) {
                *self = before;
                return Err(error.moved(at * BLOCK));
            }
        }
        Ok(())
    }

    /// Adds one sample.
    ///
    /// # Errors
    /// As [`Self::push`].
    #[inline]
    pub fn push_one(&mut self, v: f64) -> Result<(), Error> {
        self.push(std::slice::from_ref(&v))
    }

    /// The slower way of records with NaN: looked through before anything is added, then kept sample by sample.
    fn push_skipping(&mut self, x: &[f64]) -> Result<(), Error> {
        let most = self.settings.largest();
        if !x.iter().all(|v| v.is_nan() || v.abs() <= most) {
            return Err(refusal(x, most, true));
        }
        for part in x.chunk_by(|a, b| a.is_nan() == b.is_nan()) {
            if part[0].is_nan() {
                self.done.nan += part.len() as u64;
                self.done.seen += part.len() as u64;
            } else {
                let plain = Settings {
                    skip_nan: false,
                    ..self.settings
                };
                let policy = std::mem::replace(&mut self.settings, plain);
                let added = self.push(part);
                self.settings = policy;
                added?;
            }
        }
        Ok(())
    }

    /// Says that the next sample is the one of this index: what lies between was not for this object.
    pub(crate) fn go_to(&mut self, index: u64) {
        self.done.seen = index;
    }

    /// Adds the samples another object has seen, as if they came after this one's. The settings stay this one's.
    ///
    /// # Errors
    /// [`Error::Unlike`] where the other lacks what this one sums, or counted clipping at other limits.
    pub fn merge(&mut self, later: &Self) -> Result<(), Error> {
        if self.settings.shape && !later.settings.shape {
            return Err(Error::Unlike {
                what: "moments with shape and moments without",
            });
        }
        if self.settings.clipped_at != later.settings.clipped_at {
            return Err(Error::Unlike {
                what: "moments that count clipping at different limits",
            });
        }
        let (shape, start) = (self.settings.shape, self.done.seen);
        let other = later.done;
        let total = later.total();
        self.done.spread = self.total();
        self.filled = 0;
        self.done.spread.merge(&total, shape);
        let shift = |e: Extreme| Extreme {
            index: e.index + start,
            ..e
        };
        self.done.min = first_of(self.done.min, other.min.map(shift), |new, old| new < old);
        self.done.max = first_of(self.done.max, other.max.map(shift), |new, old| new > old);
        self.done.seen += other.seen;
        self.done.nan += other.nan;
        self.done.clipped += other.clipped;
        Ok(())
    }

    /// The sums with the waiting samples in them.
    fn total(&self) -> Spread {
        let mut spread = self.done.spread;
        if self.filled > 0 {
            let shape = self.settings.shape;
            spread.merge(
                &Spread::of_block(&self.waiting[..self.filled], shape).0,
                shape,
            );
        }
        spread
    }

    /// How many samples are in the moments: those skipped are not.
    #[must_use]
    pub fn count(&self) -> u64 {
        self.done.spread.count + self.filled as u64
    }

    /// How many NaN were skipped.
    #[must_use]
    pub fn nan_count(&self) -> u64 {
        self.done.nan
    }

    /// How many samples lay at or beyond the limits.
    #[must_use]
    pub fn clipped_count(&self) -> u64 {
        self.done.clipped
    }

    /// The smallest sample and its first index; None of nothing.
    #[must_use]
    pub fn min(&self) -> Option<Extreme> {
        self.done.min
    }

    /// The largest sample and its first index; None of nothing.
    #[must_use]
    pub fn max(&self) -> Option<Extreme> {
        self.done.max
    }

    /// Mean, deviations and shape, from one look at the sums.
    #[must_use]
    pub fn figures(&self) -> Figures {
        Figures {
            spread: self.total(),
            shape: self.settings.shape,
        }
    }
}

impl Settings {
    fn largest(&self) -> f64 {
        if self.shape {
            LARGEST_FOR_SHAPE
        } else {
            LARGEST
        }
    }
}

impl Done {
    /// Takes notice of finite samples before they are summed: extremes, clipping, position.
    fn note(
        &mut self,
        part: &[f64],
        range: Range,
        settings: &Settings,
        chunk: &[f64],
    ) -> Result<(), Error> {
        let most = settings.largest();
        if !(range.low >= -most && range.high <= most) {
            return Err(refusal(chunk, most, false));
        }
        // Positions are looked for only where an extreme is beaten.
        let at = |value: f64| {
            let inside = part.iter().position(|v| *v == value).unwrap_or(0);
            let index = self.seen + inside as u64;
            Some(Extreme { value, index })
        };
        let (mut min, mut max) = (self.min, self.max);
        if min.is_none_or(|old| range.low < old.value) {
            min = at(range.low);
        }
        if max.is_none_or(|old| range.high > old.value) {
            max = at(range.high);
        }
        (self.min, self.max) = (min, max);
        let (low, high) = settings.clipped_at;
        if range.low <= low || range.high >= high {
            self.clipped += part.iter().filter(|v| **v <= low || **v >= high).count() as u64;
        }
        self.seen += part.len() as u64;
        Ok(())
    }
}

/// A range that no limit admits.
const NOT_FINITE: Range = Range {
    low: f64::NAN,
    high: f64::NAN,
};

/// The range of a part, not a number if the part holds one that is not.
fn range_of(part: &[f64]) -> Range {
    if let [only] = part {
        // one sample at a time is a way of its own: nothing to be compared
        return Range {
            low: *only,
            high: *only,
        };
    }
    let (sum, range) = Range::of(part);
    if sum.is_finite() { range } else { NOT_FINITE }
}

/// Says which sample of the chunk cannot be taken.
fn refusal(chunk: &[f64], most: f64, nan_is_skipped: bool) -> Error {
    let refused = |v: &f64| !(v.abs() <= most || nan_is_skipped && v.is_nan());
    let index = chunk.iter().position(refused).unwrap_or(0);
    let value = chunk[index];
    if value.is_finite() {
        Error::OutOfRange {
            name: "x",
            value,
            interval: format!("[-{most:e}, {most:e}]"),
        }
    } else {
        Error::NonFinite {
            name: "x",
            index,
            value,
        }
    }
}

/// The earlier extreme unless the later one beats it.
fn first_of(
    old: Option<Extreme>,
    new: Option<Extreme>,
    beats: impl Fn(f64, f64) -> bool,
) -> Option<Extreme> {
    match (old, new) {
        (Some(old), Some(new)) if beats(new.value, old.value) => Some(new),
        (None, new) => new,
        (old, _) => old,
    }
}

#[cfg(test)]
mod tests {
    use super::{Moments, Settings};

    #[test]
    fn nothing_has_no_mean_and_one_sample_no_sample_deviation() {
        let mut m = Moments::default();
        assert_eq!(m.figures().mean(), None);
        m.push(&[3.0]).expect("finite");
        let f = m.figures();
        assert_eq!((f.mean(), f.std_population()), (Some(3.0), Some(0.0)));
        assert_eq!(f.std_sample(), None);
    }

    #[test]
    fn a_large_offset_costs_no_digits() {
        let mut m = Moments::default();
        for _ in 0..1000 {
            m.push(&[1e9 - 1.0, 1e9 + 1.0]).expect("finite");
        }
        assert_eq!(m.figures().mean(), Some(1e9));
        assert_eq!(m.figures().std_population(), Some(1.0));
    }

    #[test]
    fn extremes_keep_their_first_index_across_merges() {
        let (mut a, mut b) = (Moments::default(), Moments::default());
        a.push(&[2.0, 5.0]).expect("finite");
        b.push(&[5.0, -1.0, -1.0]).expect("finite");
        a.merge(&b).expect("alike");
        assert_eq!(a.max().map(|e| e.index), Some(1));
        assert_eq!(a.min().map(|e| e.index), Some(3));
    }

    #[test]
    fn skipped_nan_is_counted_and_keeps_its_place() {
        let settings = Settings {
            skip_nan: true,
            clipped_at: (-9.0, 9.0),
            ..Settings::default()
        };
        let mut m = Moments::new(settings);
        m.push(&[f64::NAN, 1.0, f64::NAN, 9.0, 9.5])
            .expect("no infinity");
        assert_eq!((m.count(), m.nan_count(), m.clipped_count()), (3, 2, 2));
        assert_eq!(m.max().map(|e| e.index), Some(4));
        assert!(m.push(&[0.0, f64::INFINITY]).is_err());
        assert_eq!(m.count(), 3);
    }
}
