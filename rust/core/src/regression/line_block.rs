//! The sums of one block of points, by two passes about its first point.

use super::line::Sums;
use crate::stats::compensated::Compensated;
use crate::stats::simd::{self, Kernel, Pack, Terms, sums};

/// Points centred together: two reads of 2 x 8 KiB stay in the first-level cache.
pub(super) const BLOCK: usize = 1024;

/// The sums of a non-empty block.
pub(super) fn of_block(x: &[f64], y: &[f64]) -> Sums {
    simd::run(Plain(x, y))
}

/// The same with weights; of weight zero in all, nothing but the count.
pub(super) fn of_weighted_block(x: &[f64], y: &[f64], w: &[f64]) -> Sums {
    simd::run(Weighted(x, y, w))
}

/// The weighted sum of squared distances from a line through the means.
pub(super) fn squared_residuals(
    x: &[f64],
    y: &[f64],
    w: Option<&[f64]>,
    means: (Compensated, Compensated),
    slope: f64,
) -> f64 {
    simd::run(Residuals(x, y, w, means, slope))
}

struct Plain<'a>(&'a [f64], &'a [f64]);

impl Kernel for Plain<'_> {
    type Output = Sums;

    #[inline(always)]
    fn run<P: Pack>(self) -> Sums {
        let Self(x, y) = self;
        let n = x.len() as f64;
        let origin = (x[0], y[0]);
        let [sx, sy] = sums::<P, _, 2, 2>([x, y], &Distances { origin });
        let mean = (sx / n, sy / n);
        let products: [f64; 5] = sums::<P, _, 2, 5>([x, y], &Products { origin, mean });
        assemble(x.len(), n, origin, mean, products)
    }
}

struct Weighted<'a>(&'a [f64], &'a [f64], &'a [f64]);

impl Kernel for Weighted<'_> {
    type Output = Sums;

    #[inline(always)]
    fn run<P: Pack>(self) -> Sums {
        let Self(x, y, w) = self;
        let origin = (x[0], y[0]);
        let [weight, sx, sy] = sums::<P, _, 3, 3>([x, y, w], &Distances { origin });
        if weight <= 0.0 {
            return Sums::default();
        }
        let mean = (sx / weight, sy / weight);
        let products: [f64; 5] = sums::<P, _, 3, 5>([x, y, w], &Products { origin, mean });
        // A point without weight is no observation.
        let count = w.iter().filter(|w| **w > 0.0).count();
        assemble(count, weight, origin, mean, products)
    }
}

#[inline(always)]
fn assemble(
    count: usize,
    weight: f64,
    origin: (f64, f64),
    mean: (f64, f64),
    [dx, dy, xx, xy, yy]: [f64; 5],
) -> Sums {
    Sums {
        count: count as u64,
        weight,
        // The second pass corrects the means; the sums need it no more than those of the moments do.
        x_mean: Compensated::sum(origin.0, mean.0 + dx / weight),
        y_mean: Compensated::sum(origin.1, mean.1 + dy / weight),
        xx: xx.into(),
        xy: xy.into(),
        yy: yy.into(),
    }
}

/// Distances from the first point.
struct Distances {
    origin: (f64, f64),
}

impl Terms<2, 2> for Distances {
    #[inline(always)]
    fn of<P: Pack>(&self, [x, y]: [P; 2]) -> [P; 2] {
        [
            x.sub(P::splat(self.origin.0)),
            y.sub(P::splat(self.origin.1)),
        ]
    }
}

impl Terms<3, 3> for Distances {
    #[inline(always)]
    fn of<P: Pack>(&self, [x, y, w]: [P; 3]) -> [P; 3] {
        let [dx, dy] = self.of([x, y]);
        [w, w.mul(dx), w.mul(dy)]
    }
}

/// Distances from `origin + mean` and their products.
struct Products {
    origin: (f64, f64),
    mean: (f64, f64),
}

impl Products {
    #[inline(always)]
    fn distances<P: Pack>(&self, x: P, y: P) -> (P, P) {
        let ((x0, y0), (xm, ym)) = (self.origin, self.mean);
        let dx = x.sub(P::splat(x0)).sub(P::splat(xm));
        let dy = y.sub(P::splat(y0)).sub(P::splat(ym));
        (dx, dy)
    }
}

impl Terms<2, 5> for Products {
    #[inline(always)]
    fn of<P: Pack>(&self, [x, y]: [P; 2]) -> [P; 5] {
        let (dx, dy) = self.distances(x, y);
        [dx, dy, dx.mul(dx), dx.mul(dy), dy.mul(dy)]
    }
}

impl Terms<3, 5> for Products {
    #[inline(always)]
    fn of<P: Pack>(&self, [x, y, w]: [P; 3]) -> [P; 5] {
        let (dx, dy) = self.distances(x, y);
        let (wx, wy) = (w.mul(dx), w.mul(dy));
        [wx, wy, wx.mul(dx), wx.mul(dy), wy.mul(dy)]
    }
}

struct Residuals<'a>(
    &'a [f64],
    &'a [f64],
    Option<&'a [f64]>,
    (Compensated, Compensated),
    f64,
);

impl Kernel for Residuals<'_> {
    type Output = f64;

    #[inline(always)]
    fn run<P: Pack>(self) -> f64 {
        let Self(x, y, w, means, slope) = self;
        let terms = Squares { means, slope };
        let [sum] = match w {
            Some(w) => sums::<P, _, 3, 1>([x, y, w], &terms),
            None => sums::<P, _, 2, 1>([x, y], &terms),
        };
        sum
    }
}

struct Squares {
    means: (Compensated, Compensated),
    slope: f64,
}

impl Terms<2, 1> for Squares {
    #[inline(always)]
    fn of<P: Pack>(&self, [x, y]: [P; 2]) -> [P; 1] {
        let (xm, ym) = self.means;
        let dx = x.sub(P::splat(xm.value)).sub(P::splat(xm.rest));
        let dy = y.sub(P::splat(ym.value)).sub(P::splat(ym.rest));
        let residual = dy.sub(P::splat(self.slope).mul(dx));
        [residual.mul(residual)]
    }
}

impl Terms<3, 1> for Squares {
    #[inline(always)]
    fn of<P: Pack>(&self, [x, y, w]: [P; 3]) -> [P; 1] {
        let [square] = self.of([x, y]);
        [w.mul(square)]
    }
}

#[cfg(test)]
mod tests {
    use super::{Plain, Weighted};
    use crate::stats::simd::{Width, run_at};

    #[test]
    fn every_instruction_set_gives_the_same_bits() {
        for n in [1, 2, 15, 16, 17, 100, 1023, 1024] {
            let x: Vec<f64> = (0..n).map(|i| 1e6 + (f64::from(i) * 0.37).sin()).collect();
            let y: Vec<f64> = x.iter().map(|v| (v * 1.7).cos()).collect();
            let w: Vec<f64> = y.iter().map(|v| 1.0 + v * v).collect();
            let plain = run_at(Width::Baseline, Plain(&x, &y));
            let weighted = run_at(Width::Baseline, Weighted(&x, &y, &w));
            for width in [Width::Avx2, Width::Avx512] {
                assert_eq!(plain, run_at(width, Plain(&x, &y)));
                assert_eq!(weighted, run_at(width, Weighted(&x, &y, &w)));
            }
        }
    }
}
