//! Multiple regression that counts large residuals by their size instead of their square.
//!
//! Weighted least squares, repeated: the weight of a row is 1 inside `threshold` scales and falls as 1/|residual|
//! beyond; the scale is the median absolute residual / 0.6745, taken anew each time.
//!
//! Source: Huber, Ronchetti, "Robust Statistics", 2nd ed., section 7.8 (iteration), eqs. 7.81-7.83 (standard errors).

use super::linear::{LinearFit, LinearSums};
use super::theil_sen::median;
use crate::error::{Error, require_positive};

/// The median of |v| of a standard normal v.
const MEDIAN_OF_NORMAL: f64 = 0.674_489_750_196_081_7;

/// Repetitions after which it is said that none was enough; some twenty are usual.
const MOST_REPETITIONS: usize = 200;

/// Coefficients have settled when predictions move by less than this share of the scale.
const SETTLED: f64 = 1e-10;

/// A robust fit.
#[derive(Debug, Clone, PartialEq)]
pub struct Huber {
    /// The last weighted fit; its standard errors are those of the robust estimate.
    pub fit: LinearFit,
    /// The robust standard deviation of the residuals.
    pub scale: f64,
    /// How many rows weigh less than 1.
    pub outliers: u64,
    /// Repetitions taken.
    pub repetitions: usize,
}

/// Fits rows of predictors robustly.
///
/// # Errors
/// As [`LinearSums::push`] and [`LinearSums::fit`]; [`Error::Singular`] where the repetitions do not settle.
pub fn huber(
    x: &[f64],
    y: &[f64],
    predictors: usize,
    intercept: bool,
    threshold: f64,
) -> Result<Huber, Error> {
    require_positive("threshold", threshold)?;
    let mut sums = LinearSums::new(predictors, intercept, 1.0)?;
    sums.push(x, y, None)?;
    let plain = sums.fit()?;
    let mut fit = plain.clone();
    let mut residuals = residuals_of(&fit, x, y, predictors, intercept);
    let mut scale = scale_of(&residuals);
    for repetition in 1..=MOST_REPETITIONS {
        let limit = threshold * scale;
        let weight = |r: f64| {
            if r.abs() <= limit {
                1.0
            } else {
                limit / r.abs()
            }
        };
        if scale == 0.0 {
            // More than half of the rows are met exactly: they decide, and there is nothing to weigh by.
            return Ok(finished(fit, &plain, scale, repetition, &residuals, limit));
        }
        let weights: Vec<f64> = residuals.iter().map(|r| weight(*r)).collect();
        let mut sums = LinearSums::new(predictors, intercept, 1.0)?;
        sums.push(x, y, Some(&weights))?;
        fit = sums.fit()?;
        let next = residuals_of(&fit, x, y, predictors, intercept);
        let moved = next
            .iter()
            .zip(&residuals)
            .fold(0.0_f64, |m, (a, b)| m.max((a - b).abs()));
        residuals = next;
        let next_scale = scale_of(&residuals);
        let changed = (next_scale - scale).abs();
        scale = next_scale;
        let rounding = f64::EPSILON * y.iter().fold(0.0_f64, |m, v| m.max(v.abs()));
        if moved.max(changed) <= (SETTLED * scale).max(16.0 * rounding) {
            let limit = threshold * scale;
            return Ok(finished(fit, &plain, scale, repetition, &residuals, limit));
        }
    }
    Err(Error::Singular {
        name: "robust fit",
        reason: format!("the weights have not settled after {MOST_REPETITIONS} repetitions"),
    })
}

fn residuals_of(
    fit: &LinearFit,
    x: &[f64],
    y: &[f64],
    predictors: usize,
    intercept: bool,
) -> Vec<f64> {
    let (constant, slopes) = if intercept {
        (fit.coefficients[0], &fit.coefficients[1..])
    } else {
        (0.0, &fit.coefficients[..])
    };
    let predicted = |i: usize| {
        let row = &x[i * predictors..(i + 1) * predictors];
        row.iter().zip(slopes).fold(constant, |s, (x, b)| s + x * b)
    };
    y.iter()
        .enumerate()
        .map(|(i, y)| y - predicted(i))
        .collect()
}

fn scale_of(residuals: &[f64]) -> f64 {
    let mut sizes: Vec<f64> = residuals.iter().map(|r| r.abs()).collect();
    median(&mut sizes) / MEDIAN_OF_NORMAL
}

/// Standard errors: `K^2 [sum psi^2 / (n - p)] / [mean psi']^2 (X'X)^-1`, the last from the plain fit.
fn finished(
    mut fit: LinearFit,
    plain: &LinearFit,
    scale: f64,
    repetitions: usize,
    residuals: &[f64],
    limit: f64,
) -> Huber {
    let n = residuals.len() as f64;
    let p = fit.coefficients.len() as f64;
    let psi_squares: f64 = residuals
        .iter()
        .map(|r| r.clamp(-limit, limit).powi(2))
        .sum();
    let outliers = residuals.iter().filter(|r| r.abs() > limit).count() as u64;
    let inside = (n - outliers as f64) / n;
    let correction = 1.0 + p / n * (1.0 - inside) / inside;
    let robust = correction * (psi_squares / (n - p)).sqrt() / inside;
    fit.standard_errors = plain
        .standard_errors
        .as_ref()
        .zip(plain.residual_std.filter(|s| *s > 0.0))
        .map(|(errors, s)| errors.iter().map(|e| e / s * robust).collect());
    Huber {
        fit,
        scale,
        outliers,
        repetitions,
    }
}
