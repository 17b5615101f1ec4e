//! Quantiles of a stream with a hard bound on their relative error, in memory that does not grow with the stream.
//!
//! The buckets are the leading bits of the number itself: every power of two is cut into `2^m` equal parts, so the
//! middle of a bucket is within `2^-(m+1)` of everything in it. Ranks are exact, merging adds counts and is exact, and
//! the order of the samples plays no part.
//!
//! Source of the guarantee: Masson, Rim, Lee, `DDSketch`, VLDB 12 (2019) 2195, sections 2.1 and 2.2 (there with
//! logarithmic buckets; linear ones inside a power of two need no logarithm and 1.44 times as many).

use crate::error::{Error, require_finite};

/// Bits of the mantissa of a double.
const MANTISSA: u32 = 52;

/// Magnitudes that have their buckets from the start; outside, a row is made when such a sample is first met.
const PREPARED: (f64, f64) = (1e-9, 1e9);

/// The finest and coarsest accuracies: 2^-14 takes 2^13 buckets, 64 KiB, a power of two.
const ACCURACIES: (f64, f64) = (6.2e-5, 0.25);

/// Counts of magnitudes of one sign: for every power of two a row of buckets, empty until it is met.
#[derive(Debug, Clone)]
struct Buckets {
    bits: u32,
    rows: Vec<Vec<u64>>,
}

/// Exponents of a double, those of subnormal numbers and of infinity included.
const EXPONENTS: usize = 2048;

/// Quantiles of everything pushed so far.
#[derive(Debug, Clone)]
pub struct QuantileSketch {
    /// Each power of two has `2^bits` buckets.
    bits: u32,
    count: u64,
    zeros: u64,
    negative: Buckets,
    positive: Buckets,
    min: f64,
    max: f64,
}

impl Buckets {
    fn prepared(bits: u32) -> Self {
        let mut buckets = Self {
            bits,
            rows: vec![vec![]; EXPONENTS],
        };
        let (low, high) = PREPARED;
        for row in key(low, 0)..=key(high, 0) {
            buckets.rows[row as usize] = vec![0; 1 << bits];
        }
        buckets
    }

    #[inline]
    fn add(&mut self, key: u64, n: u64) {
        let (row, column) = ((key >> self.bits) as usize, key & ((1 << self.bits) - 1));
        if self.rows[row].is_empty() {
            self.rows[row] = vec![0; 1 << self.bits];
        }
        self.rows[row][column as usize] += n;
    }

    fn filled(&self) -> impl DoubleEndedIterator<Item = (u64, u64)> {
        self.rows.iter().enumerate().flat_map(move |(row, counts)| {
            let first = (row as u64) << self.bits;
            let numbered = counts.iter().enumerate();
            numbered
                .filter(|(_, n)| **n > 0)
                .map(move |(i, n)| (first + i as u64, *n))
        })
    }
}

/// Sign aside, the leading bits: exponent and the first bits of the mantissa.
#[inline]
fn key(v: f64, bits: u32) -> u64 {
    (v.to_bits() & !(1 << 63)) >> (MANTISSA - bits)
}

/// The middle of a bucket.
fn middle(key: u64, bits: u32) -> f64 {
    let half = 1_u64 << (MANTISSA - bits - 1);
    f64::from_bits((key << (MANTISSA - bits)) | half)
}

impl QuantileSketch {
    /// An empty sketch whose quantiles are within this relative error of a sample of exactly the asked rank.
    ///
    /// # Errors
    /// [`Error::OutOfRange`].
    pub fn new(relative_error: f64) -> Result<Self, Error> {
        let (finest, coarsest) = ACCURACIES;
        if !(finest..=coarsest).contains(&relative_error) {
            return Err(Error::OutOfRange {
                name: "relative_error",
                value: relative_error,
                interval: format!("[{finest}, {coarsest}]"),
            });
        }
        let bits = (-relative_error.log2() - 1.0).ceil().max(1.0) as u32;
        Ok(Self {
            bits,
            count: 0,
            zeros: 0,
            negative: Buckets::prepared(bits),
            positive: Buckets::prepared(bits),
            min: f64::INFINITY,
            max: f64::NEG_INFINITY,
        })
    }

    /// The bound that holds: a power of two, at most what was asked for.
    #[must_use]
    pub fn relative_error(&self) -> f64 {
        0.5_f64.powi(self.bits as i32 + 1)
    }

    /// Adds samples.
    ///
    /// # Errors
    /// [`Error::NonFinite`]; nothing of a refused chunk is added.
    pub fn push(&mut self, x: &[f64]) -> Result<(), Error> {
        require_finite("x", x)?;
        for v in x {
            let key = key(*v, self.bits);
            // Subnormal numbers have no leading bit: they count as zero, which is wrong by 2.3e-308 at most.
            if v.abs() < f64::MIN_POSITIVE {
                self.zeros += 1;
            } else if *v < 0.0 {
                self.negative.add(key, 1);
            } else {
                self.positive.add(key, 1);
            }
            self.min = self.min.min(*v);
            self.max = self.max.max(*v);
        }
        self.count += x.len() as u64;
        Ok(())
    }

    /// Adds what another sketch has seen; the counts are then those of the joined stream, exactly.
    ///
    /// # Errors
    /// [`Error::OutOfRange`] for a sketch of another accuracy.
    pub fn merge(&mut self, other: &Self) -> Result<(), Error> {
        if self.bits != other.bits {
            return Err(Error::OutOfRange {
                name: "relative_error of the other sketch",
                value: other.relative_error(),
                interval: format!("{{{}}}", self.relative_error()),
            });
        }
        for (key, n) in other.negative.filled() {
            self.negative.add(key, n);
        }
        for (key, n) in other.positive.filled() {
            self.positive.add(key, n);
        }
        self.zeros += other.zeros;
        self.count += other.count;
        self.min = self.min.min(other.min);
        self.max = self.max.max(other.max);
        Ok(())
    }

    /// How many samples.
    #[must_use]
    pub fn count(&self) -> u64 {
        self.count
    }

    /// The smallest and the largest sample, exactly (their places are not kept); None of nothing.
    #[must_use]
    pub fn extremes(&self) -> Option<(f64, f64)> {
        (self.count > 0).then_some((self.min, self.max))
    }

    /// Close to the sample of rank `floor(q (n - 1))` counted from zero; None of nothing.
    ///
    /// # Errors
    /// [`Error::OutOfRange`] for q outside [0, 1].
    pub fn quantile(&self, q: f64) -> Result<Option<f64>, Error> {
        let rank = rank(q, self.count)?;
        if self.count == 0 {
            return Ok(None);
        }
        let bits = self.bits;
        let low = self
            .negative
            .filled()
            .rev()
            .map(|(k, n)| (-middle(k, bits), n));
        let zero = std::iter::once((0.0, self.zeros));
        let high = self.positive.filled().map(|(k, n)| (middle(k, bits), n));
        let mut below = 0;
        for (value, n) in low.chain(zero).chain(high) {
            below += n;
            if below > rank {
                return Ok(Some(value.clamp(self.min, self.max)));
            }
        }
        Ok(Some(self.max))
    }

    /// Counts (accuracy, zeros, then key and count of every filled bucket) and extremes: all there is to store.
    #[must_use]
    pub fn state(&self) -> (Vec<u64>, Vec<f64>) {
        let mut integers = vec![
            u64::from(self.bits),
            self.zeros,
            self.negative.filled().count() as u64,
        ];
        for (key, n) in self.negative.filled().chain(self.positive.filled()) {
            integers.extend([key, n]);
        }
        let numbers = self
            .extremes()
            .map_or(vec![], |(low, high)| vec![low, high]);
        (integers, numbers)
    }

    /// Rebuilds what [`Self::state`] stored.
    ///
    /// # Errors
    /// [`Error::Length`], [`Error::NonFinite`] or [`Error::OutOfRange`] for numbers it cannot have made.
    pub fn from_state(integers: &[u64], numbers: &[f64]) -> Result<Self, Error> {
        let foreign = |got: usize| Error::Length {
            name: "state",
            expected: "3 integers, 2 for each bucket and the 2 extremes".into(),
            got,
        };
        let Some((&[bits, zeros, negative], buckets)) = integers.split_first_chunk::<3>() else {
            return Err(foreign(integers.len()));
        };
        let (pairs, odd) = buckets.as_chunks::<2>();
        if !odd.is_empty() || negative as usize > pairs.len() || !(1..=13).contains(&bits) {
            return Err(foreign(integers.len()));
        }
        let mut sketch = Self::new(0.5_f64.powi(bits as i32 + 1))?;
        let highest = key(f64::MAX, sketch.bits);
        for (i, [key, n]) in pairs.iter().enumerate() {
            if *key > highest {
                return Err(foreign(*key as usize));
            }
            let side = if (i as u64) < negative {
                &mut sketch.negative
            } else {
                &mut sketch.positive
            };
            side.add(*key, *n);
            sketch.count = sketch.count.saturating_add(*n);
        }
        sketch.zeros = zeros;
        sketch.count = sketch.count.saturating_add(zeros);
        require_finite("state", numbers)?;
        match numbers {
            &[low, high] if low <= high => (sketch.min, sketch.max) = (low, high),
            [] if sketch.count == 0 => {}
            _ => return Err(foreign(numbers.len())),
        }
        Ok(sketch)
    }
}

/// The rank, from zero, that stands for q.
pub(super) fn rank(q: f64, count: u64) -> Result<u64, Error> {
    if !(0.0..=1.0).contains(&q) {
        return Err(Error::OutOfRange {
            name: "q",
            value: q,
            interval: "[0, 1]".into(),
        });
    }
    Ok((q * count.saturating_sub(1) as f64).floor() as u64)
}
