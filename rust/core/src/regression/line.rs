//! The straight line `y = intercept + slope x` by least squares, from centred sums that can be pushed and merged.
//!
//! Time stamps near 1e9 s keep their digits: every sum is about the means, and the means carry their rounding rest.
//!
//! Source: Chan, Golub, `LeVeque`, Am. Stat. 37 (1983) 242, the pairwise update, here with the cross product;
//! standard errors: Draper, Smith, "Applied Regression Analysis", 3rd ed., section 1.4.

use crate::error::{Error, require_finite, require_moderate, require_same_length};
use crate::stats::compensated::Compensated;

/// Pairs centred together: two reads of 2 x 4 KiB stay in the first-level cache.
const BLOCK: usize = 512;

/// Independent partial sums: five sums of four lanes fit the sixteen vector registers of the x86-64 baseline.
const LANES: usize = 4;

/// The numbers [`LineSums::state`] needs.
pub const STATE_LEN: usize = 10;

/// A fitted line.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Line {
    /// Units of y per unit of x.
    pub slope: f64,
    /// y at x = 0.
    pub intercept: f64,
    /// The standard error of the slope; None for two points, which leave nothing to estimate it from.
    pub slope_se: Option<f64>,
    /// The standard error of the intercept; None for two points.
    pub intercept_se: Option<f64>,
    /// The correlation; 0 where y is constant.
    pub r: f64,
    /// `sqrt(sum of squared residuals / (n - 2))`; None for two points.
    pub residual_std: Option<f64>,
    /// How many points.
    pub n: u64,
}

/// The centred sums of everything pushed so far.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct LineSums {
    count: u64,
    x_mean: Compensated,
    y_mean: Compensated,
    xx: Compensated,
    xy: Compensated,
    yy: Compensated,
}

impl LineSums {
    /// Nothing pushed yet.
    #[must_use]
    pub fn new() -> Self {
        Self::default()
    }

    /// How many points.
    #[must_use]
    pub fn count(&self) -> u64 {
        self.count
    }

    /// Adds points.
    ///
    /// # Errors
    /// [`Error::Length`], [`Error::NonFinite`] or [`Error::OutOfRange`]; nothing of a refused chunk is added.
    pub fn push(&mut self, x: &[f64], y: &[f64]) -> Result<(), Error> {
        require_same_length("y", y, "x", x.len())?;
        require_moderate("x", x)?;
        require_moderate("y", y)?;
        for (x, y) in x.chunks(BLOCK).zip(y.chunks(BLOCK)) {
            self.merge(&Self::of_block(x, y));
        }
        Ok(())
    }

    /// Adds the points another object has seen.
    pub fn merge(&mut self, other: &Self) {
        if other.count == 0 {
            return;
        }
        if self.count == 0 {
            *self = *other;
            return;
        }
        let (na, nb) = (self.count as f64, other.count as f64);
        let (share, weight) = (nb / (na + nb), na * (nb / (na + nb)));
        let (dx, dy) = (
            other.x_mean.minus(self.x_mean),
            other.y_mean.minus(self.y_mean),
        );
        self.x_mean.add(dx * share);
        self.y_mean.add(dy * share);
        for (sum, more, apart) in [
            (&mut self.xx, other.xx, dx * dx),
            (&mut self.xy, other.xy, dx * dy),
            (&mut self.yy, other.yy, dy * dy),
        ] {
            sum.add_compensated(more);
            sum.add(apart * weight);
        }
        self.count += other.count;
    }

    /// The sums of one non-empty block by two passes about its first point.
    fn of_block(x: &[f64], y: &[f64]) -> Self {
        let (x0, y0, n) = (x[0], y[0], x.len() as f64);
        let [sx, sy] = lane_sums(x, y, |x, y| [x - x0, y - y0]);
        let (mx, my) = (sx / n, sy / n);
        let [dx, dy, xx, xy, yy] = lane_sums(x, y, |x, y| {
            let (dx, dy) = ((x - x0) - mx, (y - y0) - my);
            [dx, dy, dx * dx, dx * dy, dy * dy]
        });
        Self {
            count: x.len() as u64,
            x_mean: Compensated::sum(x0, mx + dx / n),
            y_mean: Compensated::sum(y0, my + dy / n),
            // The second terms remove what the rounding of the block's means added.
            xx: Compensated::sum(xx, -dx * (dx / n)),
            xy: Compensated::sum(xy, -dx * (dy / n)),
            yy: Compensated::sum(yy, -dy * (dy / n)),
        }
    }

    /// The line through everything pushed. The residual sum is a difference of the centred sums: its relative
    /// rounding grows as `1 / (1 - r^2)`; [`fit_line`] reads the data a second time instead.
    ///
    /// # Errors
    /// [`Error::Length`] below two points, [`Error::Singular`] for constant x.
    pub fn fit(&self) -> Result<Line, Error> {
        let slope = self.slope()?;
        let (xx, xy, yy) = (self.xx.value, self.xy.value, self.yy.value);
        // Cauchy-Schwarz holds for the exact sums; rounding may leave the difference just below zero.
        let residual = (yy - xy * (xy / xx)).max(0.0);
        Ok(self.line(slope, residual))
    }

    /// The two means and three sums, each followed by its rounding remainder: with the count all there is to store.
    #[must_use]
    pub fn state(&self) -> [f64; STATE_LEN] {
        let parts = [self.x_mean, self.y_mean, self.xx, self.xy, self.yy];
        std::array::from_fn(|i| {
            if i % 2 == 0 {
                parts[i / 2].value
            } else {
                parts[i / 2].rest
            }
        })
    }

    /// Rebuilds what [`Self::state`] stored.
    ///
    /// # Errors
    /// [`Error::NonFinite`] for numbers it cannot have made.
    pub fn from_state(count: u64, state: [f64; STATE_LEN]) -> Result<Self, Error> {
        require_finite("state", &state)?;
        let part = |i: usize| Compensated {
            value: state[2 * i],
            rest: state[2 * i + 1],
        };
        Ok(Self {
            count,
            x_mean: part(0),
            y_mean: part(1),
            xx: part(2),
            xy: part(3),
            yy: part(4),
        })
    }

    fn slope(&self) -> Result<f64, Error> {
        if self.count < 2 {
            return Err(Error::Length {
                name: "x",
                expected: "at least 2".into(),
                got: self.count as usize,
            });
        }
        if self.xx.value <= 0.0 {
            return Err(Error::Singular {
                name: "slope",
                reason: format!(
                    "x does not vary (all {} values are near {})",
                    self.count, self.x_mean.value
                ),
            });
        }
        Ok(self.xy.value / self.xx.value)
    }

    fn line(&self, slope: f64, residual: f64) -> Line {
        let n = self.count as f64;
        let (xx, yy) = (self.xx.value, self.yy.value);
        let x_mean = self.x_mean.value;
        let variance = (self.count > 2).then(|| residual / (n - 2.0));
        Line {
            slope,
            // The product's own rounding is recovered: with time stamps near 1e9 it is larger than y's last digit.
            intercept: {
                let product = slope * x_mean;
                let lost = slope.mul_add(x_mean, -product);
                (self.y_mean.value - product) + (self.y_mean.rest - slope * self.x_mean.rest - lost)
            },
            slope_se: variance.map(|v| (v / xx).sqrt()),
            intercept_se: variance.map(|v| (v * (1.0 / n + x_mean * (x_mean / xx))).sqrt()),
            r: if yy > 0.0 {
                (slope * (xx / yy).sqrt()).clamp(-1.0, 1.0)
            } else {
                0.0
            },
            residual_std: variance.map(f64::sqrt),
            n: self.count,
        }
    }
}

/// The least-squares line through the points.
///
/// # Errors
/// [`Error::Length`] below two points or for lengths that differ, [`Error::NonFinite`], [`Error::OutOfRange`],
/// [`Error::Singular`] for constant x.
pub fn fit_line(x: &[f64], y: &[f64]) -> Result<Line, Error> {
    let mut sums = LineSums::new();
    sums.push(x, y)?;
    let slope = sums.slope()?;
    let (xm, ym) = (sums.x_mean, sums.y_mean);
    let of_point = |x: f64, y: f64| {
        let dx = (x - xm.value) - xm.rest;
        let residual = ((y - ym.value) - ym.rest) - slope * dx;
        [residual * residual]
    };
    let mut residual = Compensated::default();
    for (x, y) in x.chunks(BLOCK).zip(y.chunks(BLOCK)) {
        residual.add(lane_sums(x, y, of_point)[0]);
    }
    Ok(sums.line(slope, residual.value))
}

/// Sums of several terms per point, in independent lanes that are added at the end.
fn lane_sums<const K: usize>(
    x: &[f64],
    y: &[f64],
    terms: impl Fn(f64, f64) -> [f64; K],
) -> [f64; K] {
    let mut lanes = [[0.0; LANES]; K];
    let ((xs, x_rest), (ys, y_rest)) = (x.as_chunks::<LANES>(), y.as_chunks::<LANES>());
    for (x, y) in xs.iter().zip(ys) {
        for (lane, (x, y)) in x.iter().zip(y).enumerate() {
            let t = terms(*x, *y);
            for k in 0..K {
                lanes[k][lane] += t[k];
            }
        }
    }
    let mut sums = lanes.map(|lane| lane.iter().sum());
    for (x, y) in x_rest.iter().zip(y_rest) {
        let t = terms(*x, *y);
        for k in 0..K {
            sums[k] += t[k];
        }
    }
    sums
}

#[cfg(test)]
mod tests {
    use super::fit_line;
    use crate::Error;

    #[test]
    fn constant_y_has_slope_exactly_zero() {
        let line = fit_line(&[1.0, 2.0, 4.0], &[0.1, 0.1, 0.1]).expect("varies");
        assert_eq!((line.slope, line.intercept, line.r), (0.0, 0.1, 0.0));
    }

    #[test]
    fn constant_x_is_refused() {
        let line = fit_line(&[0.1, 0.1, 0.1], &[1.0, 2.0, 4.0]);
        assert!(matches!(line, Err(Error::Singular { .. })));
    }

    #[test]
    fn two_points_give_a_line_and_no_errors() {
        let line = fit_line(&[1.0, 3.0], &[5.0, 9.0]).expect("varies");
        assert_eq!(
            (line.slope, line.intercept, line.slope_se),
            (2.0, 3.0, None)
        );
    }
}
