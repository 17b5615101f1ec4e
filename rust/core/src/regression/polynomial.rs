//! Polynomials by least squares, in Chebyshev polynomials over the range of x and only at the end in powers of x.
//!
//! Powers of a distant x are nearly the same curve and lose all digits; Chebyshev polynomials over the range are nearly
//! orthogonal. The way back to powers is computed in twice the precision.

use super::linear::{LinearSums, Solved};
use super::refine::{Design, refine};
use super::twofold::Twofold;
use crate::error::{Error, require_moderate, require_representable, require_same_length};
use crate::stats::compensated::Compensated;
use crate::stats::simd::{PACK, Pack};

/// The highest degree.
pub const HIGHEST: usize = 30;

/// A fitted polynomial.
#[derive(Debug, Clone, PartialEq)]
pub struct PolynomialFit {
    /// Of the powers of x, from the constant up.
    pub coefficients: Vec<f64>,
    /// Their standard errors; None without degrees of freedom.
    pub standard_errors: Option<Vec<f64>>,
    /// Of the Chebyshev polynomials over the domain: the form to evaluate.
    pub chebyshev: Vec<f64>,
    /// The range of x that is mapped to [-1, 1].
    pub domain: (f64, f64),
    /// `sqrt(sum of squared residuals / degrees of freedom)`.
    pub residual_std: Option<f64>,
    /// The sum of squared residuals.
    pub residual_squares: f64,
    /// The sum of squares about the mean that is explained.
    pub explained_squares: f64,
    /// How many points.
    pub n: u64,
    /// Points (with forgetting: the sum of weights) less coefficients.
    pub degrees_of_freedom: f64,
}

impl PolynomialFit {
    fn representable(self) -> Result<Self, Error> {
        let sums = [self.residual_squares, self.explained_squares];
        let errors = self
            .standard_errors
            .iter()
            .flatten()
            .chain(&self.residual_std);
        let values = self
            .coefficients
            .iter()
            .chain(&self.chebyshev)
            .chain(&sums)
            .chain(errors);
        require_representable("the polynomial", values.copied())?;
        Ok(self)
    }
}

/// What is kept of the points pushed so far.
#[derive(Debug, Clone, PartialEq)]
pub struct PolynomialSums {
    degree: usize,
    domain: (f64, f64),
    linear: LinearSums,
}

impl PolynomialSums {
    /// Nothing pushed yet. Points outside the domain are allowed; far outside they cost digits.
    ///
    /// # Errors
    /// [`Error::OutOfRange`] for a degree above [`HIGHEST`] or a forgetting factor outside (0, 1],
    /// [`Error::Singular`] for an empty domain.
    pub fn new(degree: usize, domain: (f64, f64), forgetting: f64) -> Result<Self, Error> {
        require_degree(degree)?;
        require_moderate("domain", &[domain.0, domain.1])?;
        if domain.0 >= domain.1 && degree > 0 {
            return Err(Error::Singular {
                name: "polynomial",
                reason: format!("x does not vary (from {} to {})", domain.0, domain.1),
            });
        }
        Ok(Self {
            degree,
            domain,
            linear: LinearSums::with_origin(degree, true, forgetting, false)?,
        })
    }

    /// The degree.
    #[must_use]
    pub fn degree(&self) -> usize {
        self.degree
    }

    /// How many points.
    #[must_use]
    pub fn count(&self) -> u64 {
        self.linear.count()
    }

    /// Adds points and, if given, weights (inverse variances up to a factor).
    ///
    /// # Errors
    /// [`Error::Length`], [`Error::NonFinite`] or [`Error::OutOfRange`]; nothing of a refused chunk is added.
    pub fn push(&mut self, x: &[f64], y: &[f64], weights: Option<&[f64]>) -> Result<(), Error> {
        require_same_length("y", y, "x", x.len())?;
        require_moderate("x", x)?;
        require_moderate("y", y)?;
        if let Some(weights) = weights {
            super::require_weights(weights, x.len(), &[x, y])?;
        }
        self.require_near(x)?;
        let (centre, half) = self.mapping();
        let mut row = [0.0; HIGHEST];
        for (i, (x, y)) in x.iter().zip(y).enumerate() {
            let u = (x - centre) / half;
            let (mut before, mut now) = (1.0, u);
            for entry in &mut row[..self.degree] {
                *entry = now;
                (before, now) = (now, 2.0 * u * now - before);
            }
            self.linear
                .push_row(&row[..self.degree], *y, weights.map_or(1.0, |w| w[i]));
        }
        Ok(())
    }

    /// Powers of a point far outside the domain would overflow.
    fn require_near(&self, x: &[f64]) -> Result<(), Error> {
        let (centre, half) = self.mapping();
        let most = half * 1e150_f64.powf(1.0 / (self.degree.max(1) as f64)) / 2.0;
        match x.iter().find(|x| (**x - centre).abs() > most) {
            None => Ok(()),
            Some(x) => Err(Error::OutOfRange {
                name: "x",
                value: *x,
                interval: format!("[{}, {}], near the domain", centre - most, centre + most),
            }),
        }
    }

    fn mapping(&self) -> (f64, f64) {
        let (low, high) = self.domain;
        let half = 0.5 * high - 0.5 * low;
        (0.5 * low + 0.5 * high, if half > 0.0 { half } else { 1.0 })
    }

    /// Adds the points another object has seen.
    ///
    /// # Errors
    /// [`Error::Length`] for another degree, [`Error::OutOfRange`] for another domain.
    pub fn merge(&mut self, other: &Self) -> Result<(), Error> {
        if self.domain != other.domain {
            return Err(Error::OutOfRange {
                name: "domain of the other",
                value: other.domain.0,
                interval: format!("the same [{}, {}]", self.domain.0, self.domain.1),
            });
        }
        self.linear.merge(&other.linear)
    }

    /// The least-squares polynomial.
    ///
    /// # Errors
    /// [`Error::Length`] for fewer points than coefficients, [`Error::Singular`] for too few distinct x.
    pub fn fit(&self) -> Result<PolynomialFit, Error> {
        self.figures(&self.solve()?).representable()
    }

    fn solve(&self) -> Result<Solved, Error> {
        self.linear.solve().map_err(|e| match e {
            Error::Singular { .. } => Error::Singular {
                name: "polynomial",
                reason: format!(
                    "degree {} needs at least {} distinct x",
                    self.degree,
                    self.degree + 1
                ),
            },
            other => other,
        })
    }

    fn figures(&self, solved: &Solved) -> PolynomialFit {
        let mut theta = solved.coefficients.clone();
        theta[0].add(self.linear.y_origin());
        let powers = self.chebyshev_in_powers();
        let of_power = |k: usize| powers.iter().map(move |p| p[k]);
        let coefficient = |k: usize| {
            theta
                .iter()
                .zip(of_power(k))
                .fold(Compensated::default(), |s, (t, p)| s.plus(t.times(p)))
                .value
        };
        let error_of = |k: usize| solved.length_of(of_power(k).map(|p| p.value).collect());
        let all = 0..=self.degree;
        PolynomialFit {
            coefficients: all.clone().map(coefficient).collect(),
            standard_errors: solved
                .residual_std()
                .map(|s| all.map(|k| s * error_of(k)).collect()),
            chebyshev: theta.iter().map(|t| t.value).collect(),
            domain: self.domain,
            residual_std: solved.residual_std(),
            residual_squares: solved.residual_squares,
            explained_squares: solved.explained_squares,
            n: self.linear.count(),
            degrees_of_freedom: solved.degrees_of_freedom,
        }
    }

    /// Row j: the coefficients of the powers of x in the j-th Chebyshev polynomial of the mapped x.
    fn chebyshev_in_powers(&self) -> Vec<Vec<Compensated>> {
        let n = self.degree + 1;
        let (centre, half) = self.mapping();
        let inverse = reciprocal(half);
        let zero = Compensated::default();
        let mut rows = vec![vec![zero; n]; n];
        rows[0][0] = Compensated::from(1.0);
        for j in 1..n {
            let twice = if j == 1 { 1.0 } else { 2.0 };
            for k in 0..=j {
                // times (x - centre) / half, twice from the second on, less the one before the last
                let shifted = if k > 0 { rows[j - 1][k - 1] } else { zero };
                let stayed = rows[j - 1][k].times(Compensated::from(-centre));
                let product = shifted
                    .plus(stayed)
                    .times(inverse)
                    .times(Compensated::from(twice));
                let before = if j > 1 { -rows[j - 2][k] } else { zero };
                rows[j][k] = product.plus(before);
            }
        }
        rows
    }

    /// As of [`LinearSums::state`], the domain and the degree first.
    #[must_use]
    pub fn state(&self) -> (Vec<u64>, Vec<f64>) {
        let (mut integers, mut numbers) = self.linear.state();
        integers.insert(0, self.degree as u64);
        numbers.splice(0..0, [self.domain.0, self.domain.1]);
        (integers, numbers)
    }

    /// Rebuilds what [`Self::state`] stored.
    ///
    /// # Errors
    /// [`Error::Length`], [`Error::NonFinite`] or [`Error::OutOfRange`] for numbers it cannot have made.
    pub fn from_state(integers: &[u64], numbers: &[f64]) -> Result<Self, Error> {
        let ([degree, integers @ ..], [low, high, numbers @ ..]) = (integers, numbers) else {
            return Err(Error::Length {
                name: "state",
                expected: "5 integers and at least 2 numbers".into(),
                got: numbers.len(),
            });
        };
        let mut sums = Self::new(*degree as usize, (*low, *high), 1.0)?;
        sums.linear = LinearSums::from_state(integers, numbers)?;
        if sums.linear.predictors() != sums.degree {
            return Err(Error::Length {
                name: "state",
                expected: format!("{} predictors", sums.degree),
                got: sums.linear.predictors(),
            });
        }
        Ok(sums)
    }
}

/// The least-squares polynomial through points that are at hand; of short records it is corrected in twice the
/// precision.
///
/// # Errors
/// As [`PolynomialSums::new`], [`PolynomialSums::push`] and [`PolynomialSums::fit`].
pub fn fit_polynomial(
    x: &[f64],
    y: &[f64],
    weights: Option<&[f64]>,
    degree: usize,
) -> Result<PolynomialFit, Error> {
    require_moderate("x", x)?;
    let low = x.iter().copied().fold(f64::INFINITY, f64::min);
    let high = x.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    if x.is_empty() {
        return Err(Error::Length {
            name: "x",
            expected: format!("at least {}", degree + 1),
            got: 0,
        });
    }
    let mut sums = PolynomialSums::new(degree, (low, high), 1.0)?;
    sums.push(x, y, weights)?;
    let mut solved = sums.solve()?;
    let (centre, half) = sums.mapping();
    let points = Points {
        x,
        y,
        centre,
        inverse: reciprocal(half),
        y_origin: sums.linear.y_origin(),
    };
    refine(&mut solved, weights, &points);
    sums.figures(&solved).representable()
}

/// Chebyshev polynomials of the mapped points.
struct Points<'a> {
    x: &'a [f64],
    y: &'a [f64],
    centre: f64,
    inverse: Compensated,
    y_origin: f64,
}

impl Design for Points<'_> {
    fn rows(&self) -> usize {
        self.y.len()
    }

    #[inline(always)]
    fn look<P: Pack>(&self, rows: [usize; PACK], entries: &mut [Twofold<P>]) -> Twofold<P> {
        let x = P::load(&rows.map(|i| self.x[i]));
        let u = Twofold::difference(x, P::splat(self.centre)).times(Twofold::splat(self.inverse));
        let twice = u.plus(u);
        let (mut before, mut now) = (Twofold::from(P::splat(1.0)), u);
        entries[0] = before;
        for entry in &mut entries[1..] {
            *entry = now;
            (before, now) = (now, twice.times(now).minus(before));
        }
        let y = P::load(&rows.map(|i| self.y[i]));
        Twofold::difference(y, P::splat(self.y_origin))
    }
}

/// Refuses a degree above the highest.
pub(super) fn require_degree(degree: usize) -> Result<(), Error> {
    if degree <= HIGHEST {
        return Ok(());
    }
    Err(Error::OutOfRange {
        name: "degree",
        value: degree as f64,
        interval: format!("[0, {HIGHEST}]"),
    })
}

/// 1/h in twice the precision: one Newton step.
fn reciprocal(h: f64) -> Compensated {
    let first = 1.0 / h;
    let product = Compensated::product(first, h);
    let missing = (1.0 - product.value) - product.rest;
    Compensated::sum(first, missing * first)
}
