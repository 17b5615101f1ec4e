//! Count, mean and sums of powers of the deviations: of one block of samples, and joined over blocks.
//!
//! Never `mean(x^2) - mean(x)^2`: that difference loses twice the digits of mean/std. Each block is centred on its own
//! mean and joined to the rest by the pairwise update; means are carried with their rounding remainder, so that the
//! difference of two nearly equal means keeps its digits.
//!
//! Source: Chan, Golub, `LeVeque`, Am. Stat. 37 (1983) 242, the pairwise update; Pébay, Sandia report SAND2008-6212
//! (2008), eqs. 2.1 and 2.6, the third and fourth powers.

use super::compensated::Compensated;
use super::simd::{self, Kernel, PACK, Pack, Terms, Width, sums};

/// Samples centred together: two reads of 8 KiB stay in the first-level cache.
pub(crate) const BLOCK: usize = 1024;

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

impl Range {
    /// The sum of the distances from the first sample, which is not finite if one of the samples is not, and the range.
    pub(crate) fn of(part: &[f64]) -> (f64, Self) {
        simd::run(RangeKernel(part))
    }
}

struct RangeKernel<'a>(&'a [f64]);

impl Kernel for RangeKernel<'_> {
    type Output = (f64, Range);

    #[inline(always)]
    fn run<P: Pack>(self) -> Self::Output {
        sum_and_range::<P>(self.0, self.0[0])
    }
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
    fn run<P: Pack>(self) -> Self::Output {
        let block = self.0;
        let origin = block[0];
        let n = block.len() as f64;
        let (sum, range) = sum_and_range::<P>(block, origin);
        let mean = sum / n;
        let (deviation, squares, cubes, fourths) = if SHAPE {
            let [a, b, c, d] = sums::<P, _, 1, 4>([block], &Powers { origin, mean });
            (a, b, c, d)
        } else {
            let [a, b] = sums::<P, _, 1, 2>([block], &Powers { origin, mean });
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

/// Powers of the deviation from `origin + mean`.
struct Powers {
    origin: f64,
    mean: f64,
}

impl Terms<1, 2> for Powers {
    #[inline(always)]
    fn of<P: Pack>(&self, [v]: [P; 1]) -> [P; 2] {
        let d = v.sub(P::splat(self.origin)).sub(P::splat(self.mean));
        [d, d.mul(d)]
    }
}

impl Terms<1, 4> for Powers {
    #[inline(always)]
    fn of<P: Pack>(&self, [v]: [P; 1]) -> [P; 4] {
        let d = v.sub(P::splat(self.origin)).sub(P::splat(self.mean));
        let square = d.mul(d);
        [d, square, square.mul(d), square.mul(square)]
    }
}

/// The sum of the distances from the origin, the smallest and the largest.
#[inline(always)]
fn sum_and_range<P: Pack>(block: &[f64], origin: f64) -> (f64, Range) {
    let first = P::splat(origin);
    let mut sum = [P::splat(0.0); 2];
    let (mut low, mut high) = ([first; 2], [first; 2]);
    let (chunks, rest) = block.as_chunks::<PACK>();
    let (pairs, odd) = chunks.as_chunks::<2>();
    for pair in pairs {
        for i in 0..2 {
            let v = P::load(&pair[i]);
            sum[i] = sum[i].add(v.sub(first));
            low[i] = low[i].lower(v);
            high[i] = high[i].upper(v);
        }
    }
    for chunk in odd {
        let v = P::load(chunk);
        sum[0] = sum[0].add(v.sub(first));
        low[0] = low[0].lower(v);
        high[0] = high[0].upper(v);
    }
    let mut total = sum[0].add(sum[1]).total();
    let mut range = Range {
        low: origin,
        high: origin,
    };
    let lows = low[0].lower(low[1]).lanes();
    let highs = high[0].upper(high[1]).lanes();
    for v in rest {
        total += v - origin;
    }
    for v in lows.iter().chain(&highs).chain(rest) {
        range.low = if *v < range.low { *v } else { range.low };
        range.high = if *v > range.high { *v } else { range.high };
    }
    (total, range)
}

#[cfg(test)]
mod tests {
    use super::super::simd::Width;
    use super::Spread;

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
