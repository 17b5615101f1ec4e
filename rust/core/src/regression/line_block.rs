//! The sums of one block of points, by two passes about its first point.

use super::line::Sums;
use crate::stats::compensated::Compensated;
use crate::stats::simd::{self, Kernel};

/// Points centred together: two reads of 2 x 4 KiB stay in the first-level cache.
pub(super) const BLOCK: usize = 512;

/// Independent partial sums: five sums of eight lanes fit the registers of every width above the baseline.
const LANES: usize = 8;

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
    fn run(self) -> Sums {
        let Self(x, y) = self;
        let (x0, y0, n) = (x[0], y[0], x.len() as f64);
        let [sx, sy] = lane_sums([x, y], |[x, y]| [x - x0, y - y0]);
        let (mx, my) = (sx / n, sy / n);
        let [dx, dy, xx, xy, yy] = lane_sums([x, y], |[x, y]| {
            let (dx, dy) = ((x - x0) - mx, (y - y0) - my);
            [dx, dy, dx * dx, dx * dy, dy * dy]
        });
        Sums {
            count: x.len() as u64,
            weight: n,
            // The second pass corrects the means; the sums need it no more than those of the moments do.
            x_mean: Compensated::sum(x0, mx + dx / n),
            y_mean: Compensated::sum(y0, my + dy / n),
            xx: xx.into(),
            xy: xy.into(),
            yy: yy.into(),
        }
    }
}

struct Weighted<'a>(&'a [f64], &'a [f64], &'a [f64]);

impl Kernel for Weighted<'_> {
    type Output = Sums;

    #[inline(always)]
    fn run(self) -> Sums {
        let Self(x, y, w) = self;
        let count = x.len() as u64;
        let (x0, y0) = (x[0], y[0]);
        let [weight, sx, sy] = lane_sums([x, y, w], |[x, y, w]| [w, w * (x - x0), w * (y - y0)]);
        if weight <= 0.0 {
            return Sums {
                count,
                ..Sums::default()
            };
        }
        let (mx, my) = (sx / weight, sy / weight);
        let [dx, dy, xx, xy, yy] = lane_sums([x, y, w], |[x, y, w]| {
            let (dx, dy) = ((x - x0) - mx, (y - y0) - my);
            [w * dx, w * dy, w * dx * dx, w * dx * dy, w * dy * dy]
        });
        Sums {
            count,
            weight,
            x_mean: Compensated::sum(x0, mx + dx / weight),
            y_mean: Compensated::sum(y0, my + dy / weight),
            xx: xx.into(),
            xy: xy.into(),
            yy: yy.into(),
        }
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
    fn run(self) -> f64 {
        let Self(x, y, w, (xm, ym), slope) = self;
        let square = |x: f64, y: f64| {
            let dx = (x - xm.value) - xm.rest;
            let residual = ((y - ym.value) - ym.rest) - slope * dx;
            residual * residual
        };
        let [sum] = match w {
            Some(w) => lane_sums([x, y, w], |[x, y, w]| [w * square(x, y)]),
            None => lane_sums([x, y], |[x, y]| [square(x, y)]),
        };
        sum
    }
}

/// Sums of several terms per point, in independent lanes that are added at the end.
#[inline(always)]
fn lane_sums<const C: usize, const K: usize>(
    columns: [&[f64]; C],
    terms: impl Fn([f64; C]) -> [f64; K],
) -> [f64; K] {
    let mut lanes = [[0.0; LANES]; K];
    let n = columns[0].len();
    let whole = n - n % LANES;
    let columns = columns.map(|c| &c[..n]);
    let mut at = 0;
    while at < whole {
        let parts: [&[f64; LANES]; C] = columns.map(|c| c[at..].first_chunk().expect("whole"));
        for lane in 0..LANES {
            let t = terms(parts.map(|p| p[lane]));
            for k in 0..K {
                lanes[k][lane] += t[k];
            }
        }
        at += LANES;
    }
    let mut sums = [0.0; K];
    for k in 0..K {
        sums[k] = lanes[k].iter().sum();
    }
    for i in whole..n {
        let t = terms(columns.map(|c| c[i]));
        for k in 0..K {
            sums[k] += t[k];
        }
    }
    sums
}
