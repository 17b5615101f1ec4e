//! Count, mean, spread and extremes of a stream in one object that can be pushed and merged.
//!
//! Never `mean(x^2) - mean(x)^2`: that difference loses twice the digits of mean/std. Each block of samples is centred
//! on its own mean and joined to the rest by the pairwise update; means are carried with their rounding remainder,
//! so that the difference of two nearly equal means keeps its digits.
//!
//! Source: Chan, Golub, `LeVeque`, Am. Stat. 37 (1983) 242, the pairwise update and the corrected
//! two-pass sum.

use super::compensated::Compensated;
use crate::error::{Error, require_moderate};

/// Samples centred together: two reads of 4 KiB stay in the first-level cache.
const BLOCK: usize = 512;

/// Independent partial sums, enough to fill the widest vector registers and hide the latency of an addition.
const LANES: usize = 16;

/// An extreme value and where it was first met.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Extreme {
    /// The value.
    pub value: f64,
    /// Its index in the stream, from zero.
    pub index: u64,
}

/// The moments of everything pushed so far.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Moments {
    spread: Spread,
    min: Option<Extreme>,
    max: Option<Extreme>,
}

/// What the pairwise update joins.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
struct Spread {
    count: u64,
    mean: Compensated,
    /// The sum of squared deviations from the mean.
    squares: Compensated,
}

/// The numbers [`Moments::state`] needs.
pub const STATE_LEN: usize = 6;

impl Moments {
    /// Nothing pushed yet.
    #[must_use]
    pub fn new() -> Self {
        Self::default()
    }

    /// Adds samples.
    ///
    /// # Errors
    /// [`Error::NonFinite`] or [`Error::OutOfRange`]; nothing of a refused chunk is added.
    pub fn push(&mut self, x: &[f64]) -> Result<(), Error> {
        require_moderate("x", x)?;
        for block in x.chunks(BLOCK) {
            self.push_extremes(block);
            self.spread.merge(&Spread::of_block(block));
        }
        Ok(())
    }

    /// Updates the extremes before the block is counted; positions are looked for only where one is beaten.
    fn push_extremes(&mut self, block: &[f64]) {
        let (low, high) = lane_extremes(block);
        let at = |value: f64| {
            let inside = block.iter().position(|v| *v == value).unwrap_or(0);
            let index = self.spread.count + inside as u64;
            Some(Extreme { value, index })
        };
        if self.min.is_none_or(|old| low < old.value) {
            self.min = at(low);
        }
        if self.max.is_none_or(|old| high > old.value) {
            self.max = at(high);
        }
    }

    /// Adds the samples another object has seen, as if they came after this one's.
    pub fn merge(&mut self, later: &Self) {
        let shift = |e: Extreme| Extreme {
            index: e.index + self.spread.count,
            ..e
        };
        self.min = first_of(self.min, later.min.map(shift), |new, old| new < old);
        self.max = first_of(self.max, later.max.map(shift), |new, old| new > old);
        self.spread.merge(&later.spread);
    }

    /// How many samples.
    #[must_use]
    pub fn count(&self) -> u64 {
        self.spread.count
    }

    /// The mean; None of nothing.
    #[must_use]
    pub fn mean(&self) -> Option<f64> {
        (self.count() > 0).then_some(self.spread.mean.value)
    }

    /// The mean squared deviation, divided by `n`; None of nothing.
    #[must_use]
    pub fn variance_population(&self) -> Option<f64> {
        (self.count() > 0).then(|| self.sum_of_squares() / self.count() as f64)
    }

    /// The estimated variance, divided by `n - 1`; None below two samples.
    #[must_use]
    pub fn variance_sample(&self) -> Option<f64> {
        (self.count() > 1).then(|| self.sum_of_squares() / (self.count() - 1) as f64)
    }

    /// The population standard deviation (TB 038); None of nothing.
    #[must_use]
    pub fn std_population(&self) -> Option<f64> {
        self.variance_population().map(f64::sqrt)
    }

    /// The sample standard deviation; None below two samples.
    #[must_use]
    pub fn std_sample(&self) -> Option<f64> {
        self.variance_sample().map(f64::sqrt)
    }

    /// The root of the mean square; None of nothing.
    #[must_use]
    pub fn rms(&self) -> Option<f64> {
        let variance = self.variance_population()?;
        Some(self.spread.mean.value.hypot(variance.sqrt()))
    }

    /// The smallest sample and its first index; None of nothing.
    #[must_use]
    pub fn min(&self) -> Option<Extreme> {
        self.min
    }

    /// The largest sample and its first index; None of nothing.
    #[must_use]
    pub fn max(&self) -> Option<Extreme> {
        self.max
    }

    /// The sum of squared deviations from the mean.
    #[must_use]
    pub fn sum_of_squares(&self) -> f64 {
        self.spread.squares.value.max(0.0)
    }

    /// Mean, its remainder, squared deviations, their remainder, smallest, largest: with the count and the two
    /// indices all there is to store.
    #[must_use]
    pub fn state(&self) -> [f64; STATE_LEN] {
        let value = |e: Option<Extreme>| e.map_or(0.0, |e| e.value);
        let Spread { mean, squares, .. } = self.spread;
        [
            mean.value,
            mean.rest,
            squares.value,
            squares.rest,
            value(self.min),
            value(self.max),
        ]
    }

    /// Rebuilds what [`Self::state`] stored.
    ///
    /// # Errors
    /// [`Error::NonFinite`] for numbers it cannot have made, [`Error::OutOfRange`] for an index beyond the count.
    pub fn from_state(
        count: u64,
        state: [f64; STATE_LEN],
        min_index: u64,
        max_index: u64,
    ) -> Result<Self, Error> {
        crate::error::require_finite("state", &state)?;
        if count == 0 {
            return Ok(Self::default());
        }
        if min_index.max(max_index) >= count {
            return Err(Error::OutOfRange {
                name: "index",
                value: min_index.max(max_index) as f64,
                interval: format!("[0, {count})"),
            });
        }
        let [mean, mean_rest, squares, squares_rest, min, max] = state;
        let carried = |value, rest| Compensated { value, rest };
        let extreme = |value, index| Some(Extreme { value, index });
        Ok(Self {
            spread: Spread {
                count,
                mean: carried(mean, mean_rest),
                squares: carried(squares, squares_rest),
            },
            min: extreme(min, min_index),
            max: extreme(max, max_index),
        })
    }
}

impl Spread {
    fn merge(&mut self, later: &Self) {
        if later.count == 0 {
            return;
        }
        if self.count == 0 {
            *self = *later;
            return;
        }
        let (na, nb) = (self.count as f64, later.count as f64);
        let total = na + nb;
        let apart = later.mean.minus(self.mean);
        self.mean.add(apart * (nb / total));
        self.squares.add_compensated(later.squares);
        self.squares.add(apart * apart * (na * (nb / total)));
        self.count += later.count;
    }

    /// One non-empty block by two passes about its first sample.
    fn of_block(block: &[f64]) -> Self {
        let origin = block[0];
        let n = block.len() as f64;
        let [sum] = lane_sums(block, |v| [v - origin]);
        let mean = sum / n;
        let [deviation, squares] = lane_sums(block, |v| {
            let d = (v - origin) - mean;
            [d, d * d]
        });
        Self {
            count: block.len() as u64,
            mean: Compensated::sum(origin, mean + deviation / n),
            // The second term removes what the rounding of the block's mean added.
            squares: Compensated::sum(squares, -deviation * (deviation / n)),
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

/// Sums of several terms per sample, in independent lanes that are added at the end.
fn lane_sums<const K: usize>(block: &[f64], terms: impl Fn(f64) -> [f64; K]) -> [f64; K] {
    let mut lanes = [[0.0; LANES]; K];
    let (chunks, rest) = block.as_chunks::<LANES>();
    for chunk in chunks {
        for (lane, v) in chunk.iter().enumerate() {
            let t = terms(*v);
            for k in 0..K {
                lanes[k][lane] += t[k];
            }
        }
    }
    let mut sums = lanes.map(|lane| lane.iter().sum());
    for v in rest {
        let t = terms(*v);
        for k in 0..K {
            sums[k] += t[k];
        }
    }
    sums
}

/// The smallest and the largest value of a non-empty block of finite numbers.
fn lane_extremes(block: &[f64]) -> (f64, f64) {
    // Written as comparisons: with no NaN to think of, each is one instruction.
    let smaller = |a: f64, b: f64| if b < a { b } else { a };
    let larger = |a: f64, b: f64| if b > a { b } else { a };
    let (mut low, mut high) = ([block[0]; LANES], [block[0]; LANES]);
    let (chunks, rest) = block.as_chunks::<LANES>();
    for chunk in chunks {
        for lane in 0..LANES {
            low[lane] = smaller(low[lane], chunk[lane]);
            high[lane] = larger(high[lane], chunk[lane]);
        }
    }
    let low = low.into_iter().chain(rest.iter().copied());
    let high = high.into_iter().chain(rest.iter().copied());
    (low.fold(block[0], smaller), high.fold(block[0], larger))
}

#[cfg(test)]
mod tests {
    use super::Moments;

    #[test]
    fn nothing_has_no_mean_and_one_sample_no_sample_deviation() {
        let mut m = Moments::new();
        assert_eq!(m.mean(), None);
        m.push(&[3.0]).expect("finite");
        assert_eq!((m.mean(), m.std_population()), (Some(3.0), Some(0.0)));
        assert_eq!(m.std_sample(), None);
    }

    #[test]
    fn a_large_offset_costs_no_digits() {
        let mut m = Moments::new();
        for _ in 0..1000 {
            m.push(&[1e9 - 1.0, 1e9 + 1.0]).expect("finite");
        }
        assert_eq!(m.mean(), Some(1e9));
        assert_eq!(m.std_population(), Some(1.0));
    }

    #[test]
    fn extremes_keep_their_first_index_across_merges() {
        let (mut a, mut b) = (Moments::new(), Moments::new());
        a.push(&[2.0, 5.0]).expect("finite");
        b.push(&[5.0, -1.0, -1.0]).expect("finite");
        a.merge(&b);
        assert_eq!(a.max().map(|e| e.index), Some(1));
        assert_eq!(a.min().map(|e| e.index), Some(3));
    }
}
