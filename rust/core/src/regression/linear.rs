//! Multiple regression `y = b0 + b1 x1 + ... + bp xp` by a triangular factor that rows are pushed into and merged.
//!
//! With an intercept, every column is taken relative to its first value, so that large offsets (a year, a time stamp)
//! cost no digits; the coefficients are put back at the end.

use super::refine::{Design, refine};
use super::triangle::Triangle;
use super::twofold::Twofold;
use crate::error::{Error, require_finite, require_moderate, require_representable};
use crate::stats::compensated::Compensated;
use crate::stats::simd::{PACK, Pack};

/// A diagonal entry this much smaller than its column says that the column is a combination of those before it:
/// rounding leaves some ten epsilons.
const DEPENDENT: f64 = 1e-13;

/// The most predictors.
pub const MOST_PREDICTORS: usize = 512;

/// A fitted model.
#[derive(Debug, Clone, PartialEq)]
pub struct LinearFit {
    /// The intercept first, if there is one.
    pub coefficients: Vec<f64>,
    /// Their standard errors; None without degrees of freedom.
    pub standard_errors: Option<Vec<f64>>,
    /// `sqrt(sum of squared residuals / degrees of freedom)`.
    pub residual_std: Option<f64>,
    /// The sum of squared residuals.
    pub residual_squares: f64,
    /// The sum of squares that is explained: about the mean with an intercept, about zero without.
    pub explained_squares: f64,
    /// Rows.
    pub n: u64,
    /// Rows (with forgetting: the sum of weights) less coefficients.
    pub degrees_of_freedom: f64,
}

impl LinearFit {
    fn representable(self) -> Result<Self, Error> {
        let sums = [self.residual_squares, self.explained_squares];
        let errors = self
            .standard_errors
            .iter()
            .flatten()
            .chain(&self.residual_std);
        let values = self.coefficients.iter().chain(&sums).chain(errors);
        require_representable("the fit", values.copied())?;
        Ok(self)
    }
}

/// What is kept of the rows pushed so far.
#[derive(Debug, Clone, PartialEq)]
pub struct LinearSums {
    predictors: usize,
    intercept: bool,
    /// Whether the predictors are taken relative to their first row; y always is, if there is an intercept.
    relative: bool,
    forgetting: f64,
    count: u64,
    weight: f64,
    /// Of the predictors and of y.
    origin: Vec<f64>,
    triangle: Triangle,
}

impl LinearSums {
    /// Nothing pushed yet.
    ///
    /// # Errors
    /// [`Error::OutOfRange`] for no or too many predictors, or a forgetting factor outside (0, 1].
    pub fn new(predictors: usize, intercept: bool, forgetting: f64) -> Result<Self, Error> {
        Self::with_origin(predictors, intercept, forgetting, intercept)
    }

    pub(super) fn with_origin(
        predictors: usize,
        intercept: bool,
        forgetting: f64,
        relative: bool,
    ) -> Result<Self, Error> {
        super::require_forgetting(forgetting)?;
        let least = usize::from(!intercept);
        if !(least..=MOST_PREDICTORS).contains(&predictors) {
            return Err(Error::OutOfRange {
                name: "predictors",
                value: predictors as f64,
                interval: format!("[{least}, {MOST_PREDICTORS}]"),
            });
        }
        Ok(Self {
            predictors,
            intercept,
            relative,
            forgetting,
            count: 0,
            weight: 0.0,
            origin: vec![0.0; predictors + 1],
            triangle: Triangle::new(predictors + 1 + usize::from(intercept)),
        })
    }

    /// How many predictors a row has.
    #[must_use]
    pub fn predictors(&self) -> usize {
        self.predictors
    }

    /// How many rows.
    #[must_use]
    pub fn count(&self) -> u64 {
        self.count
    }

    /// Adds rows of predictors, one after another, with y and, if given, weights (inverse variances up to a factor).
    ///
    /// # Errors
    /// [`Error::Length`], [`Error::NonFinite`] or [`Error::OutOfRange`]; nothing of a refused chunk is added.
    pub fn push(&mut self, x: &[f64], y: &[f64], weights: Option<&[f64]>) -> Result<(), Error> {
        if x.len() != y.len() * self.predictors {
            return Err(Error::Length {
                name: "x",
                expected: format!(
                    "{} for each of the {} values of y",
                    self.predictors,
                    y.len()
                ),
                got: x.len(),
            });
        }
        require_moderate("x", x)?;
        require_moderate("y", y)?;
        if let Some(weights) = weights {
            super::require_weights(weights, y.len(), &[x, y])?;
        }
        for (i, y) in y.iter().enumerate() {
            let row = &x[i * self.predictors..(i + 1) * self.predictors];
            self.push_row(row, *y, weights.map_or(1.0, |w| w[i]));
        }
        Ok(())
    }

    #[inline]
    pub(super) fn push_row(&mut self, row: &[f64], y: f64, weight: f64) {
        if self.count == 0 {
            if self.relative {
                self.origin[..self.predictors].copy_from_slice(row);
            }
            if self.intercept {
                self.origin[self.predictors] = y;
            }
        }
        if self.forgetting < 1.0 {
            self.triangle.fade(self.forgetting.sqrt());
            self.weight *= self.forgetting;
        }
        let values = row.iter().chain(std::iter::once(&y));
        let relative = values.zip(&self.origin).map(|(v, o)| v - o);
        let root = if weight == 1.0 { 1.0 } else { weight.sqrt() };
        if self.intercept {
            self.triangle
                .push(std::iter::once(1.0).chain(relative), root);
        } else {
            self.triangle.push(relative, root);
        }
        // A row without weight is no observation.
        self.count += u64::from(weight > 0.0);
        self.weight += weight;
    }

    /// Adds the rows another object has seen.
    ///
    /// # Errors
    /// [`Error::Length`] for another number of columns.
    pub fn merge(&mut self, other: &Self) -> Result<(), Error> {
        if (self.predictors, self.intercept) != (other.predictors, other.intercept) {
            return Err(Error::Length {
                name: "other",
                expected: format!("{} predictors and the same intercept", self.predictors),
                got: other.predictors,
            });
        }
        if other.count == 0 {
            return Ok(());
        }
        if self.count == 0 {
            self.origin.clone_from(&other.origin);
        }
        let mut theirs = other.triangle.clone();
        theirs.reflect();
        if self.intercept {
            // Another origin adds a multiple of the constant column, which is the first.
            for (i, (own, other)) in self.origin.iter().zip(&other.origin).enumerate() {
                *theirs.at_mut(0, i + 1) += theirs.at(0, 0) * (other - own);
            }
        }
        for i in 0..theirs.width() {
            self.triangle
                .push((0..theirs.width()).map(|j| theirs.at(i, j)), 1.0);
        }
        self.count += other.count;
        self.weight += other.weight;
        Ok(())
    }

    /// The least-squares fit.
    ///
    /// # Errors
    /// [`Error::Length`] for fewer rows than coefficients, [`Error::Singular`] for dependent columns.
    pub fn fit(&self) -> Result<LinearFit, Error> {
        self.figures(&self.solve()?).representable()
    }

    fn figures(&self, solved: &Solved) -> LinearFit {
        let mut coefficients: Vec<f64> = solved.coefficients.iter().map(|c| c.value).collect();
        let mut transform = vec![];
        if self.intercept {
            // b0 = y0 + t0 - sum of t_j o_j
            let mut at_zero = solved.coefficients[0];
            at_zero.add(self.origin[self.predictors]);
            transform.push(1.0);
            for (t, o) in solved.coefficients[1..].iter().zip(&self.origin) {
                at_zero.add_compensated(t.times(Compensated::from(-o)));
                transform.push(-o);
            }
            coefficients[0] = at_zero.value;
        }
        let standard_errors = solved.residual_std().map(|s| {
            let p = coefficients.len();
            (0..p)
                .map(|i| {
                    let unit = |j: usize| f64::from(u8::from(i == j));
                    let row: Vec<f64> = if self.intercept && i == 0 {
                        transform.clone()
                    } else {
                        (0..p).map(unit).collect()
                    };
                    s * solved.length_of(row)
                })
                .collect()
        });
        LinearFit {
            coefficients,
            standard_errors,
            residual_std: solved.residual_std(),
            residual_squares: solved.residual_squares,
            explained_squares: solved.explained_squares,
            n: self.count,
            degrees_of_freedom: solved.degrees_of_freedom,
        }
    }

    /// Coefficients in the columns as they are kept, and the factor.
    pub(super) fn solve(&self) -> Result<Solved, Error> {
        let mut triangle = self.triangle.clone();
        triangle.reflect();
        let p = triangle.width() - 1;
        if self.count < p as u64 {
            return Err(Error::Length {
                name: "y",
                expected: format!("at least {p}, as many as coefficients,"),
                got: self.count as usize,
            });
        }
        for j in 0..p {
            let from = usize::from(self.intercept && j > 0);
            let size = (from..=j).fold(0.0_f64, |s, i| s.hypot(triangle.at(i, j)));
            if triangle.at(j, j).abs() <= DEPENDENT * size {
                let column = j + usize::from(!self.intercept);
                let reason = if size == 0.0 && from == 0 {
                    format!("predictor {column} is zero throughout, or below 1e-145")
                } else if size == 0.0 {
                    format!("predictor {column} does not vary")
                } else {
                    format!("predictor {column} is a combination of those before it")
                };
                return Err(Error::Singular {
                    name: "coefficients",
                    reason,
                });
            }
        }
        let mut coefficients: Vec<f64> = (0..p).map(|i| triangle.at(i, p)).collect();
        let explained = coefficients[usize::from(self.intercept)..]
            .iter()
            .map(|v| v * v)
            .sum();
        triangle.solve(&mut coefficients);
        let rows = if self.forgetting < 1.0 {
            self.weight
        } else {
            self.count as f64
        };
        Ok(Solved {
            coefficients: coefficients.into_iter().map(Compensated::from).collect(),
            residual_squares: triangle.at(p, p).powi(2),
            explained_squares: explained,
            degrees_of_freedom: rows - p as f64,
            triangle,
        })
    }

    pub(super) fn y_origin(&self) -> f64 {
        self.origin[self.predictors]
    }

    /// Predictors, intercept, whether relative, count; then forgetting, weight, origins, the factor's upper part.
    #[must_use]
    pub fn state(&self) -> (Vec<u64>, Vec<f64>) {
        let mut triangle = self.triangle.clone();
        triangle.reflect();
        let integers = vec![
            self.predictors as u64,
            u64::from(self.intercept),
            u64::from(self.relative),
            self.count,
        ];
        let mut numbers = vec![self.forgetting, self.weight];
        numbers.extend(&self.origin);
        numbers.extend(triangle.upper());
        (integers, numbers)
    }

    /// Rebuilds what [`Self::state`] stored.
    ///
    /// # Errors
    /// [`Error::Length`], [`Error::NonFinite`] or [`Error::OutOfRange`] for numbers it cannot have made.
    pub fn from_state(integers: &[u64], numbers: &[f64]) -> Result<Self, Error> {
        require_finite("state", numbers)?;
        let foreign = || Error::Length {
            name: "state",
            expected: "4 integers and the numbers of that many predictors".into(),
            got: numbers.len(),
        };
        let (&[predictors, intercept, relative, count], &[forgetting, weight, ref rest @ ..]) =
            (integers, numbers)
        else {
            return Err(foreign());
        };
        let mut sums = Self::with_origin(
            predictors as usize,
            intercept == 1,
            forgetting,
            relative == 1,
        )?;
        let k = sums.triangle.width();
        if rest.len() != sums.origin.len() + k * (k + 1) / 2 {
            return Err(foreign());
        }
        let (origin, upper) = rest.split_at(sums.origin.len());
        sums.origin.copy_from_slice(origin);
        let mut upper = upper.iter();
        for i in 0..k {
            for j in i..k {
                *sums.triangle.at_mut(i, j) = *upper.next().ok_or_else(foreign)?;
            }
        }
        (sums.count, sums.weight) = (count, weight);
        Ok(sums)
    }
}

/// The least-squares fit of rows that are at hand; of short records it is corrected in twice the precision.
///
/// # Errors
/// As [`LinearSums::push`] and [`LinearSums::fit`].
pub fn fit_linear(
    x: &[f64],
    y: &[f64],
    weights: Option<&[f64]>,
    predictors: usize,
    intercept: bool,
) -> Result<LinearFit, Error> {
    let mut sums = LinearSums::new(predictors, intercept, 1.0)?;
    sums.push(x, y, weights)?;
    let mut solved = sums.solve()?;
    let rows = Rows {
        x,
        y,
        predictors,
        intercept,
        origin: &sums.origin,
    };
    refine(&mut solved, weights, &rows);
    sums.figures(&solved).representable()
}

/// Rows relative to the first one, the constant in front.
struct Rows<'a> {
    x: &'a [f64],
    y: &'a [f64],
    predictors: usize,
    intercept: bool,
    origin: &'a [f64],
}

impl Design for Rows<'_> {
    fn rows(&self) -> usize {
        self.y.len()
    }

    #[inline(always)]
    fn look<P: Pack>(&self, rows: [usize; PACK], entries: &mut [Twofold<P>]) -> Twofold<P> {
        let constant = usize::from(self.intercept);
        entries[..constant].fill(Twofold::from(P::splat(1.0)));
        for (j, entry) in entries[constant..].iter_mut().enumerate() {
            let column = P::load(&rows.map(|i| self.x[i * self.predictors + j]));
            *entry = Twofold::difference(column, P::splat(self.origin[j]));
        }
        let y = P::load(&rows.map(|i| self.y[i]));
        Twofold::difference(y, P::splat(self.origin[self.predictors]))
    }
}

/// A solution with its factor.
pub(super) struct Solved {
    pub(super) triangle: Triangle,
    pub(super) coefficients: Vec<Compensated>,
    pub(super) residual_squares: f64,
    pub(super) explained_squares: f64,
    pub(super) degrees_of_freedom: f64,
}

impl Solved {
    pub(super) fn residual_std(&self) -> Option<f64> {
        (self.degrees_of_freedom > 0.0)
            .then(|| (self.residual_squares / self.degrees_of_freedom).sqrt())
    }

    /// `sqrt(row' (R'R)^-1 row)`: the standard error of a combination of the coefficients, for residuals of one.
    pub(super) fn length_of(&self, mut row: Vec<f64>) -> f64 {
        self.triangle.solve_transposed(&mut row);
        row.iter().fold(0.0_f64, |s, v| s.hypot(*v))
    }
}
