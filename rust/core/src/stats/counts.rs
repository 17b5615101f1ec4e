//! Every value of integer data counted: exact quantiles, and exact sums, of converter counts.
//!
//! Counts lie in pages of neighbouring values that are made when one of them is first met, so that 16 bits, or a narrow
//! band of 24 or 32, take little memory.

use std::collections::BTreeMap;

use super::sketch::rank;
use crate::error::Error;

/// Values on one page: 32 KiB of counts.
const PAGE_BITS: u32 = 12;
const PAGE: usize = 1 << PAGE_BITS;

/// The most pages, 256 MiB: twice a 24-bit converter's range. Data that spread wider want a sketch.
const MOST_PAGES: usize = 8192;

/// An integer that can be counted.
pub trait Countable: Copy {
    /// The same number, wide enough for all.
    fn wide(self) -> i32;
}

impl Countable for i16 {
    fn wide(self) -> i32 {
        i32::from(self)
    }
}

impl Countable for i32 {
    fn wide(self) -> i32 {
        self
    }
}

/// How often every value occurred.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Counts {
    /// Where the page of these leading bits lies.
    index: BTreeMap<i32, usize>,
    pages: Vec<Vec<u64>>,
    total: u64,
}

/// The pages met last, by the last bits of their number: a signal near the border of two pages would look one up for
/// every sample.
struct Met([(i32, usize); 64]);

impl Met {
    fn new() -> Self {
        Self([(i32::MAX, usize::MAX); 64]) // no value has this page: it would begin above the largest
    }
}

impl Counts {
    /// Nothing counted yet.
    #[must_use]
    pub fn new() -> Self {
        Self::default()
    }

    /// Counts samples.
    ///
    /// # Errors
    /// [`Error::OutOfRange`] where the values spread over more than 8192 pages of 4096 neighbours; nothing of a
    /// refused chunk is counted.
    pub fn push<T: Countable>(&mut self, x: &[T]) -> Result<(), Error> {
        let mut met = Met::new();
        for (i, v) in x.iter().enumerate() {
            match self.count_of(v.wide(), &mut met) {
                Ok(count) => *count += 1,
                Err(error) => {
                    for v in &x[..i] {
                        if let Ok(count) = self.count_of(v.wide(), &mut met) {
                            *count -= 1;
                        }
                    }
                    return Err(error);
                }
            }
        }
        self.total += x.len() as u64;
        Ok(())
    }

    /// The count of a value; its page is made if need be.
    #[inline]
    fn count_of(&mut self, value: i32, met: &mut Met) -> Result<&mut u64, Error> {
        let at = value >> PAGE_BITS;
        let slot = &mut met.0[at as usize & 63];
        if slot.0 != at {
            *slot = (at, self.page(at)?);
        }
        Ok(&mut self.pages[slot.1][value as usize & (PAGE - 1)])
    }

    #[cold]
    fn page(&mut self, at: i32) -> Result<usize, Error> {
        if let Some(found) = self.index.get(&at) {
            return Ok(*found);
        }
        if self.pages.len() == MOST_PAGES {
            return Err(Error::OutOfRange {
                name: "x",
                value: f64::from(at << PAGE_BITS),
                interval: format!(
                    "one of {MOST_PAGES} pages of {PAGE} neighbours; use a QuantileSketch"
                ),
            });
        }
        self.pages.push(vec![0; PAGE]);
        self.index.insert(at, self.pages.len() - 1);
        Ok(self.pages.len() - 1)
    }

    /// Adds what another object has counted.
    ///
    /// # Errors
    /// As [`Self::push`]; then nothing was added.
    pub fn merge(&mut self, other: &Self) -> Result<(), Error> {
        for at in other.index.keys() {
            self.page(*at)?;
        }
        for (at, theirs) in &other.index {
            let own = self.page(*at)?;
            for (mine, more) in self.pages[own].iter_mut().zip(&other.pages[*theirs]) {
                *mine += more;
            }
        }
        self.total += other.total;
        Ok(())
    }

    /// How many samples.
    #[must_use]
    pub fn count(&self) -> u64 {
        self.total
    }

    /// The values that occurred, in order, and how often.
    #[must_use]
    pub fn values(&self) -> impl DoubleEndedIterator<Item = (i32, u64)> {
        self.index.iter().flat_map(|(at, page)| {
            let numbered = self.pages[*page].iter().enumerate();
            numbered
                .filter(|(_, n)| **n > 0)
                .map(move |(i, n)| ((at << PAGE_BITS) + i as i32, *n))
        })
    }

    /// The smallest and the largest value; None of nothing.
    #[must_use]
    pub fn extremes(&self) -> Option<(i32, i32)> {
        Some((self.values().next()?.0, self.values().next_back()?.0))
    }

    /// The value of rank `floor(q (n - 1))` and the one after it, from which any kind of quantile follows, and how
    /// far between them q lies; None of nothing.
    ///
    /// # Errors
    /// [`Error::OutOfRange`] for q outside [0, 1].
    pub fn quantile(&self, q: f64) -> Result<Option<(i32, i32, f64)>, Error> {
        let rank = rank(q, self.total)?;
        let between = q * self.total.saturating_sub(1) as f64 - rank as f64;
        let mut below = 0;
        let mut found = None;
        for (value, n) in self.values() {
            below += n;
            if let Some(low) = found {
                return Ok(Some((low, value, between)));
            }
            if below > rank + 1 {
                return Ok(Some((value, value, between)));
            }
            if below > rank {
                found = Some(value);
            }
        }
        Ok(found.map(|value| (value, value, between)))
    }

    /// The mean and the population standard deviation, from sums without any rounding; None of nothing.
    #[must_use]
    pub fn mean_and_std(&self) -> Option<(f64, f64)> {
        if self.total == 0 {
            return None;
        }
        let (n, origin) = (i128::from(self.total), i128::from(self.values().next()?.0));
        let (mut sum, mut squares) = (0_i128, 0_i128);
        for (value, times) in self.values() {
            let (d, times) = (i128::from(value) - origin, i128::from(times));
            sum += d * times;
            squares += d * d * times;
        }
        // n^2 times the variance; below 2^64 * 2^64 it fits for fewer than 2^32 samples of full 32 bits.
        let scaled = n
            .checked_mul(squares)
            .zip(sum.checked_mul(sum))
            .map(|(a, b)| a - b);
        let variance = scaled.map_or_else(
            || squares as f64 / n as f64 - (sum as f64 / n as f64).powi(2),
            |exact| exact as f64 / (n as f64 * n as f64),
        );
        // Towards zero, so that the fraction is rounded before nothing but a part of the same sign is added.
        let all = origin * n + sum;
        Some((
            (all / n) as f64 + (all % n) as f64 / n as f64,
            variance.max(0.0).sqrt(),
        ))
    }

    /// Value and count of everything that occurred (values shifted by 2^31): all there is to store.
    #[must_use]
    pub fn state(&self) -> (Vec<u64>, Vec<f64>) {
        let shifted = |v: i32| (i64::from(v) - i64::from(i32::MIN)) as u64;
        (
            self.values().flat_map(|(v, n)| [shifted(v), n]).collect(),
            vec![],
        )
    }

    /// Rebuilds what [`Self::state`] stored.
    ///
    /// # Errors
    /// [`Error::Length`] or [`Error::OutOfRange`] for numbers it cannot have made.
    pub fn from_state(integers: &[u64], _numbers: &[f64]) -> Result<Self, Error> {
        let (pairs, odd) = integers.as_chunks::<2>();
        if !odd.is_empty() {
            return Err(Error::Length {
                name: "state",
                expected: "pairs of value and count".into(),
                got: integers.len(),
            });
        }
        let (mut counts, mut met) = (Self::new(), Met::new());
        for [shifted, n] in pairs {
            let value = i64::from(i32::MIN).saturating_add_unsigned(*shifted);
            let value = i32::try_from(value).map_err(|_| Error::OutOfRange {
                name: "state",
                value: value as f64,
                interval: "32 bits".into(),
            })?;
            *counts.count_of(value, &mut met)? = *n;
            counts.total = counts.total.saturating_add(*n);
        }
        Ok(counts)
    }
}
