//! The straight line `y = intercept + slope x` by least squares, from centred sums that can be pushed and merged.
//!
//! Time stamps near 1e9 s keep their digits: every sum is about the means, and the means carry their rounding rest.
//!
//! Source: Chan, Golub, `LeVeque`, Am. Stat. 37 (1983) 242, the pairwise update, here with the cross product;
//! standard errors: Draper, Smith, "Applied Regression Analysis", 3rd ed., section 1.4.

use super::line_block::{BLOCK, of_block, of_weighted_block, squared_residuals};
use crate::error::{
    Error, LARGEST, require_finite, require_moderate, require_representable, require_same_length,
};
use crate::stats::compensated::Compensated;

/// The numbers of [`LineSums::state`].
const STATE_LEN: usize = 12;

/// A fitted line.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Line {
    /// Units of y per unit of x.
    pub slope: f64,
    /// y at x = 0.
    pub intercept: f64,
    /// The standard error of the slope; None where two points or less leave nothing to estimate it from.
    pub slope_se: Option<f64>,
    /// The standard error of the intercept; None as above.
    pub intercept_se: Option<f64>,
    /// The correlation; 0 where y is constant.
    pub r: f64,
    /// `sqrt(sum of squared residuals / degrees of freedom)`; None as above.
    pub residual_std: Option<f64>,
    /// How many points.
    pub n: u64,
    /// Points less two; with forgetting the sum of the weights less two.
    pub degrees_of_freedom: f64,
    /// The weighted mean of x, through which, with that of y, the line goes.
    pub x_mean: f64,
    /// What rounding took off that mean: a time stamp of today holds a ten-millionth of a second.
    pub x_mean_rest: f64,
    /// The weighted mean of y.
    pub y_mean: f64,
    /// The standard error of the line at the mean of x; None as above.
    pub mean_se: Option<f64>,
}

impl Line {
    fn representable(self) -> Result<Self, Error> {
        let errors = [
            self.slope_se,
            self.intercept_se,
            self.residual_std,
            self.mean_se,
        ];
        let values = [self.slope, self.intercept, self.r, self.x_mean, self.y_mean];
        require_representable(
            "the line",
            values.into_iter().chain(errors.into_iter().flatten()),
        )?;
        Ok(self)
    }

    /// The same line over `origin + step * x`: from sample numbers to times.
    ///
    /// # Errors
    /// [`Error::Unrepresentable`] where the new slope or intercept is no number any more.
    pub fn stretched(self, origin: f64, step: f64) -> Result<Self, Error> {
        let slope = self.slope / step;
        let slope_se = self.slope_se.map(|se| se / step.abs());
        let mut mean = Compensated::product(step, self.x_mean);
        mean.add(step * self.x_mean_rest);
        mean.add(origin);
        let x_mean = mean.value;
        let mean_se = self.mean_se.zip(slope_se);
        Self {
            slope,
            intercept: self.y_mean - slope * x_mean,
            slope_se,
            intercept_se: mean_se.map(|(m, s)| m.hypot(s * x_mean)),
            r: self.r * step.signum(),
            x_mean,
            x_mean_rest: mean.rest,
            ..self
        }
        .representable()
    }
}

/// The centred sums of everything pushed so far.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LineSums {
    /// Each point weighs this much less than the one after it.
    forgetting: f64,
    pub(super) sums: Sums,
}

/// Weighted sums about the weighted means.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(super) struct Sums {
    pub(super) count: u64,
    pub(super) weight: f64,
    pub(super) x_mean: Compensated,
    pub(super) y_mean: Compensated,
    pub(super) xx: Compensated,
    pub(super) xy: Compensated,
    pub(super) yy: Compensated,
}

impl Default for LineSums {
    fn default() -> Self {
        Self {
            forgetting: 1.0,
            sums: Sums::default(),
        }
    }
}

impl LineSums {
    /// Nothing pushed yet; everything will weigh the same.
    #[must_use]
    pub fn new() -> Self {
        Self::default()
    }

    /// Nothing pushed yet; each point will weigh `factor` times what the one after it weighs.
    ///
    /// # Errors
    /// [`Error::OutOfRange`] for a factor outside (0, 1].
    pub fn with_forgetting(factor: f64) -> Result<Self, Error> {
        super::require_forgetting(factor)?;
        Ok(Self {
            forgetting: factor,
            sums: Sums::default(),
        })
    }

    /// How many points.
    #[must_use]
    pub fn count(&self) -> u64 {
        self.sums.count
    }

    /// Adds points.
    ///
    /// # Errors
    /// [`Error::Length`], [`Error::NonFinite`] or [`Error::OutOfRange`]; nothing of a refused chunk is added.
    pub fn push(&mut self, x: &[f64], y: &[f64]) -> Result<(), Error> {
        require_same_length("y", y, "x", x.len())?;
        let mut sums = self.sums;
        for (at, (bx, by)) in x.chunks(BLOCK).zip(y.chunks(BLOCK)).enumerate() {
            let block = if self.forgetting == 1.0 {
                of_block(bx, by)
            } else {
                self.forget(&mut sums, bx.len());
                of_weighted_block(bx, by, &self.fading(bx.len())[..bx.len()])
            };
            block.require_moderate(at * BLOCK, (bx, by))?;
            sums.merge(&block);
        }
        self.sums = sums;
        Ok(())
    }

    /// Adds points with weights, which are taken as inverse variances up to a common factor.
    ///
    /// # Errors
    /// As [`Self::push`]; [`Error::OutOfRange`] for a weight below 0.
    pub fn push_weighted(&mut self, x: &[f64], y: &[f64], weights: &[f64]) -> Result<(), Error> {
        require_same_length("y", y, "x", x.len())?;
        require_moderate("x", x)?;
        require_moderate("y", y)?;
        super::require_weights(weights, x.len(), &[x, y])?;
        let blocks = x
            .chunks(BLOCK)
            .zip(y.chunks(BLOCK))
            .zip(weights.chunks(BLOCK));
        for ((x, y), w) in blocks {
            let mut sums = self.sums;
            self.forget(&mut sums, x.len());
            let mut faded = self.fading(x.len());
            faded.iter_mut().zip(w).for_each(|(f, w)| *f *= w);
            sums.merge(&of_weighted_block(x, y, &faded[..x.len()]));
            self.sums = sums;
        }
        Ok(())
    }

    /// Adds samples of y whose x is their number in the stream, from 0.
    ///
    /// # Errors
    /// As [`Self::push`].
    pub fn push_series(&mut self, y: &[f64]) -> Result<(), Error> {
        let mut next = *self;
        let mut number = [0.0; BLOCK];
        for (at, block) in y.chunks(BLOCK).enumerate() {
            let first = next.sums.count;
            for (i, x) in number[..block.len()].iter_mut().enumerate() {
                *x = (first + i as u64) as f64;
            }
            next.push(&number[..block.len()], block)
                .map_err(|e| e.moved(at * BLOCK))?;
        }
        *self = next;
        Ok(())
    }

    fn forget(&self, sums: &mut Sums, points: usize) {
        if self.forgetting < 1.0 {
            let factor = self.forgetting.powi(points as i32);
            sums.weight *= factor;
            for sum in [&mut sums.xx, &mut sums.xy, &mut sums.yy] {
                *sum = Compensated::sum(sum.value * factor, sum.rest * factor);
            }
        }
    }

    /// The weights of a block's points: 1 for the last.
    fn fading(&self, points: usize) -> [f64; BLOCK] {
        let mut weights = [1.0; BLOCK];
        if self.forgetting < 1.0 {
            let mut weight = 1.0;
            for w in weights[..points].iter_mut().rev() {
                *w = weight;
                weight *= self.forgetting;
            }
        }
        weights
    }

    /// Adds the points another object has seen. With forgetting, the other's are as fresh as this one's.
    pub fn merge(&mut self, other: &Self) {
        self.sums.merge(&other.sums);
    }

    /// The line through everything pushed. The residual sum is a difference of the centred sums: its relative
    /// rounding grows as `1 / (1 - r^2)`; [`fit_line`] reads the data a second time instead.
    ///
    /// # Errors
    /// [`Error::Length`] below two points, [`Error::Singular`] for constant x.
    pub fn fit(&self) -> Result<Line, Error> {
        self.sums.fit(self.forgetting < 1.0)
    }

    /// Count, then forgetting, weight, the two means and three sums with their remainders: all there is to store.
    #[must_use]
    pub fn state(&self) -> (Vec<u64>, Vec<f64>) {
        let s = &self.sums;
        let mut numbers = vec![self.forgetting, s.weight];
        for part in [s.x_mean, s.y_mean, s.xx, s.xy, s.yy] {
            numbers.extend([part.value, part.rest]);
        }
        (vec![s.count], numbers)
    }

    /// Rebuilds what [`Self::state`] stored.
    ///
    /// # Errors
    /// [`Error::Length`], [`Error::NonFinite`] or [`Error::OutOfRange`] for numbers it cannot have made.
    pub fn from_state(integers: &[u64], numbers: &[f64]) -> Result<Self, Error> {
        require_finite("state", numbers)?;
        let (&[count], Ok([forgetting, weight, means @ ..])) =
            (integers, <&[f64; STATE_LEN]>::try_from(numbers))
        else {
            return Err(Error::Length {
                name: "state",
                expected: format!("1 integer and {STATE_LEN} numbers"),
                got: numbers.len(),
            });
        };
        let part = |i: usize| Compensated {
            value: means[2 * i],
            rest: means[2 * i + 1],
        };
        // Beyond this a count of points is no longer exact as a double, and no stream is as long.
        if count > 1 << 53 {
            return Err(Error::OutOfRange {
                name: "state",
                value: count as f64,
                interval: "[0, 2^53]".into(),
            });
        }
        let mut sums = Self::with_forgetting(*forgetting)?;
        sums.sums = Sums {
            count,
            weight: *weight,
            x_mean: part(0),
            y_mean: part(1),
            xx: part(2),
            xy: part(3),
            yy: part(4),
        };
        Ok(sums)
    }
}

impl Sums {
    pub(super) fn merge(&mut self, other: &Self) {
        if other.weight <= 0.0 {
            self.count += other.count;
            return;
        }
        if self.weight <= 0.0 {
            let count = self.count + other.count;
            *self = Self { count, ..*other };
            return;
        }
        let (wa, wb) = (self.weight, other.weight);
        let share = wb / (wa + wb);
        let weight = wa * share;
        let dx = other.x_mean.minus(self.x_mean);
        let dy = other.y_mean.minus(self.y_mean);
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
        self.weight += other.weight;
    }

    /// Refuses a block with NaN, infinities or magnitudes beyond [`LARGEST`]; the sums tell whether to look for one.
    fn require_moderate(&self, start: usize, (x, y): (&[f64], &[f64])) -> Result<(), Error> {
        // |v| <= |mean| + sqrt(sum of squares): far below the limit nothing needs to be looked at.
        let most = LARGEST / 4.0;
        let small = |mean: f64, squares: f64| mean.abs() <= most && squares <= most * most;
        if small(self.x_mean.value, self.xx.value) && small(self.y_mean.value, self.yy.value) {
            return Ok(());
        }
        require_moderate("x", x).map_err(|e| e.moved(start))?;
        require_moderate("y", y).map_err(|e| e.moved(start))
    }

    pub(super) fn slope(&self) -> Result<f64, Error> {
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

    pub(super) fn fit(&self, by_weight: bool) -> Result<Line, Error> {
        let slope = self.slope()?;
        let (xx, xy, yy) = (self.xx.value, self.xy.value, self.yy.value);
        // Cauchy-Schwarz holds for the exact sums; rounding may leave the difference just below zero.
        let residual = (yy - xy * (xy / xx)).max(0.0);
        self.line(slope, residual, by_weight).representable()
    }

    pub(super) fn line(&self, slope: f64, residual: f64, by_weight: bool) -> Line {
        let n = if by_weight {
            self.weight
        } else {
            self.count as f64
        };
        let (xx, yy) = (self.xx.value, self.yy.value);
        let x_mean = self.x_mean.value;
        let variance = (n > 2.0).then(|| residual / (n - 2.0));
        Line {
            slope,
            intercept: self.y_mean.value - slope * x_mean,
            slope_se: variance.map(|v| (v / xx).sqrt()),
            intercept_se: variance
                .map(|v| (v * (1.0 / self.weight + x_mean * (x_mean / xx))).sqrt()),
            r: if yy > 0.0 {
                (slope * (xx / yy).sqrt()).clamp(-1.0, 1.0)
            } else {
                0.0
            },
            residual_std: variance.map(f64::sqrt),
            n: self.count,
            degrees_of_freedom: n - 2.0,
            x_mean,
            x_mean_rest: self.x_mean.rest,
            y_mean: self.y_mean.value,
            mean_se: variance.map(|v| (v / self.weight).sqrt()),
        }
    }
}

/// The least-squares line through the points.
///
/// # Errors
/// [`Error::Length`] below two points or for lengths that differ, [`Error::NonFinite`], [`Error::OutOfRange`],
/// [`Error::Singular`] for constant x.
pub fn fit_line(x: &[f64], y: &[f64], weights: Option<&[f64]>) -> Result<Line, Error> {
    let mut all = LineSums::new();
    match weights {
        Some(weights) => all.push_weighted(x, y, weights)?,
        None => all.push(x, y)?,
    }
    let sums = all.sums;
    let slope = sums.slope()?;
    let means = (sums.x_mean, sums.y_mean);
    let mut residual = Compensated::default();
    for (at, (x, y)) in x.chunks(BLOCK).zip(y.chunks(BLOCK)).enumerate() {
        let w = weights.map(|w| &w[at * BLOCK..at * BLOCK + x.len()]);
        residual.add(squared_residuals(x, y, w, means, slope));
    }
    sums.line(slope, residual.value, false).representable()
}

#[cfg(test)]
mod tests {
    use super::fit_line;
    use crate::Error;

    #[test]
    fn constant_y_has_slope_exactly_zero() {
        let line = fit_line(&[1.0, 2.0, 4.0], &[0.1, 0.1, 0.1], None).expect("varies");
        assert_eq!((line.slope, line.intercept, line.r), (0.0, 0.1, 0.0));
    }

    #[test]
    fn constant_x_is_refused() {
        let line = fit_line(&[0.1, 0.1, 0.1], &[1.0, 2.0, 4.0], None);
        assert!(matches!(line, Err(Error::Singular { .. })));
    }

    #[test]
    fn two_points_give_a_line_and_no_errors() {
        let line = fit_line(&[1.0, 3.0], &[5.0, 9.0], None).expect("varies");
        assert_eq!(
            (line.slope, line.intercept, line.slope_se),
            (2.0, 3.0, None)
        );
    }
}
