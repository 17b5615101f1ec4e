//! Count, mean and sums of powers of the deviations: of one block of samples, and joined over blocks.
//!
//! Never `mean(x^2) - mean(x)^2`: that difference loses twice the digits of mean/std. Each block is centred on its own
//! mean and joined to the rest by the pairwise update; means are carried with their rounding remainder, so that the
//! difference of two nearly equal means keeps its digits.
//!
//! Source: Chan, Golub, `LeVeque`, Am. Stat. 37 (1983) 242, the pairwise update; Pébay, Sandia report SAND2008-6212
//! (2008), eqs. 2.1 and 2.6, the third and fourth powers.

use super::compensated::Compensated;
use super::simd::{self, Kernel, Width};

/// Samples centred together: two reads of 4 KiB stay in the first-level cache.
pub(crate) const BLOCK: usize = 512;

/// Independent partial sums, enough to fill the widest vector registers and hide the latency of an addition.
const LANES: usize = 16;

/// What the pairwise update joins.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(crate) struct Spread {
    pub(crate) count: u64,
    pub(crate) mean: Compensated,
    /// The sum of squared deviations from the mean.
    pub(crate) squares: Compensated,
    /// The sums of their third and fourth powers; zero where nobody asked for them.
    pub(crate) cubes: Compensated,
    pub(crate) fourths: Compensated,
}

/// The smallest and the largest of a block; they bound nothing if the block holds NaN.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Range {
    pub(crate) low: f64,
    pub(crate) high: f64,
}

impl Spread {
    /// One non-empty block, and its range; with NaN or infinities in it the mean is not finite.
    pub(crate) fn of_block(block: &[f64], shape: bool) -> (Self, Range) {
        Self::of_block_at(simd::widest(), block, shape)
    }

    pub(crate) fn of_block_at(width: Width, block: &[f64], shape: bool) -> (Self, Range) {
        if shape {
            simd::run_at(width, BlockKernel::<true>(block))
        } else {
            simd::run_at(width, BlockKernel::<false>(block))
        }
    }

    /// Joins what came later.
    pub(crate) fn merge(&mut self, later: &Self, shape: bool) {
        if later.count == 0 {
            return;
        }
        if self.count == 0 {
            *self = *later;
            return;
        }
        let (na, nb) = (self.count as f64, later.count as f64);
        let total = na + nb;
        let (share_a, share_b) = (na / total, nb / total);
        let apart = later.mean.minus(self.mean);
        if shape {
            self.merge_shape(later, apart, share_a, share_b);
        }
        self.mean.add(apart * share_b);
        self.squares.add_compensated(later.squares);
        self.squares.add(apart * apart * (na * share_b));
        self.count += later.count;
    }

    fn merge_shape(&mut self, later: &Self, apart: f64, share_a: f64, share_b: f64) {
        let (a2, b2) = (self.squares.value, later.squares.value);
        let (a3, b3) = (self.cubes.value, later.cubes.value);
        let square = apart * apart;
        // na nb / n, the weight of the distance of two means
        let weight = self.count as f64 * share_b;
        self.fourths.add_compensated(later.fourths);
        self.fourths.add(
            square * square * weight * (share_a * share_a - share_a * share_b + share_b * share_b),
        );
        self.fourths
            .add(6.0 * square * (share_a * share_a * b2 + share_b * share_b * a2));
        self.fourths
            .add(4.0 * apart * (share_a * b3 - share_b * a3));
        self.cubes.add_compensated(later.cubes);
        self.cubes
            .add(square * apart * weight * (share_a - share_b));
        self.cubes.add(3.0 * apart * (share_a * b2 - share_b * a2));
    }

    /// The sum of squared deviations; rounding never makes it negative.
    pub(crate) fn sum_of_squares(&self) -> f64 {
        self.squares.value.max(0.0)
    }
}

struct BlockKernel<'a, const SHAPE: bool>(&'a [f64]);

impl<const SHAPE: bool> Kernel for BlockKernel<'_, SHAPE> {
    type Output = (Spread, Range);

    /// Two passes about the first sample.
    #[inline(always)]
    fn run(self) -> Self::Output {
        let block = self.0;
        let origin = block[0];
        let n = block.len() as f64;
        let (sum, range) = sum_and_range(block, origin);
        let mean = sum / n;
        let (deviation, squares, cubes, fourths) = if SHAPE {
            let [a, b, c, d] = lane_sums(block, |v| {
                let d = (v - origin) - mean;
                let square = d * d;
                [d, square, square * d, square * square]
            });
            (a, b, c, d)
        } else {
            let [a, b] = lane_sums(block, |v| {
                let d = (v - origin) - mean;
                [d, d * d]
            });
            (a, b, 0.0, 0.0)
        };
        let spread = Spread {
            count: block.len() as u64,
            // The second pass corrects the mean. The squares need no such correction: it would be the square of the
            // mean's rounding, and the origin, whose distance rounds, is itself one of the samples.
            mean: Compensated::sum(origin, mean + deviation / n),
            squares: squares.into(),
            cubes: cubes.into(),
            fourths: fourths.into(),
        };
        (spread, range)
    }
}

/// The sum of the distances from the origin, the smallest and the largest, in independent lanes.
#[inline(always)]
fn sum_and_range(block: &[f64], origin: f64) -> (f64, Range) {
    // Written as comparisons: with no NaN to think of, each is one instruction.
    let smaller = |a: f64, b: f64| if b < a { b } else { a };
    let larger = |a: f64, b: f64| if b > a { b } else { a };
    let mut sums = [0.0; LANES];
    let (mut low, mut high) = ([origin; LANES], [origin; LANES]);
    let (chunks, rest) = block.as_chunks::<LANES>();
    for chunk in chunks {
        for lane in 0..LANES {
            let v = chunk[lane];
            sums[lane] += v - origin;
            low[lane] = smaller(low[lane], v);
            high[lane] = larger(high[lane], v);
        }
    }
    let mut sum = total(&sums);
    for v in rest {
        sum += v - origin;
    }
    let low = low.into_iter().chain(rest.iter().copied());
    let high = high.into_iter().chain(rest.iter().copied());
    let range = Range {
        low: low.fold(origin, smaller),
        high: high.fold(origin, larger),
    };
    (sum, range)
}

/// Sums of several terms per sample, in independent lanes that are added at the end.
#[inline(always)]
fn lane_sums<const K: usize>(block: &[f64], terms: impl Fn(f64) -> [f64; K]) -> [f64; K] {
    let mut lanes = [[0.0; LANES]; K];
    let (chunks, rest) = block.as_chunks::<LANES>();
    for chunk in chunks {
        for lane in 0..LANES {
            let t = terms(chunk[lane]);
            for k in 0..K {
                lanes[k][lane] += t[k];
            }
        }
    }
    let mut sums = [0.0; K];
    for k in 0..K {
        sums[k] = total(&lanes[k]);
    }
    for v in rest {
        let t = terms(*v);
        for k in 0..K {
            sums[k] += t[k];
        }
    }
    sums
}

/// The sum of the lanes, in pairs: the order is fixed, so every width rounds alike.
#[inline(always)]
fn total(lanes: &[f64; LANES]) -> f64 {
    let mut sums = *lanes;
    let mut width = LANES / 2;
    while width > 0 {
        for lane in 0..width {
            sums[lane] += sums[lane + width];
        }
        width /= 2;
    }
    sums[0]
}

#[cfg(test)]
mod tests {
    use super::{Spread, Width};

    #[test]
    fn every_instruction_set_gives_the_same_bits() {
        for n in [1, 2, 15, 16, 17, 100, 511, 512] {
            let x: Vec<f64> = (0..n).map(|i| 1e3 + (f64::from(i) * 0.37).sin()).collect();
            for shape in [false, true] {
                let plain = Spread::of_block_at(Width::Baseline, &x, shape);
                assert_eq!(plain, Spread::of_block_at(Width::Avx2, &x, shape));
                assert_eq!(plain, Spread::of_block_at(Width::Avx512, &x, shape));
            }
        }
    }
}
