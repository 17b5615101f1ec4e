//! Least squares: lines, polynomials, several predictors; pushed, merged, fading, over a window, and robust.

pub mod huber;
pub mod line;
mod line_block;
pub mod linear;
pub mod polynomial;
pub mod recursive;
mod refine;
pub mod rolling_line;
pub mod rolling_polynomial;
pub mod theil_sen;
mod triangle;
mod twofold;

pub use line::{Line, LineSums, fit_line};
pub use linear::{LinearFit, LinearSums, fit_linear};
pub use polynomial::{PolynomialFit, PolynomialSums, fit_polynomial};
pub use recursive::Recursive;
pub use rolling_line::RollingLine;
pub use rolling_polynomial::RollingPolynomial;

use crate::error::{Error, LARGEST, require_finite};

/// Refuses a forgetting factor outside (0, 1].
fn require_forgetting(factor: f64) -> Result<(), Error> {
    if factor > 0.0 && factor <= 1.0 {
        return Ok(());
    }
    Err(Error::OutOfRange {
        name: "forgetting",
        value: factor,
        interval: "(0, 1]".into(),
    })
}

/// Refuses weights that are negative, not finite, of another number, or so large that weighted squares would overflow.
fn require_weights(weights: &[f64], points: usize, columns: &[&[f64]]) -> Result<(), Error> {
    crate::error::require_same_length("weights", weights, "points", points)?;
    require_finite("weights", weights)?;
    let largest = |c: &&[f64]| c.iter().fold(1.0_f64, |m, v| m.max(v.abs()));
    let largest = columns.iter().map(largest).fold(1.0, f64::max);
    let most = (LARGEST / largest).powi(2).min(LARGEST);
    match weights.iter().find(|w| !(0.0..=most).contains(*w)) {
        None => Ok(()),
        Some(w) => Err(Error::OutOfRange {
            name: "weights",
            value: *w,
            interval: format!("[0, {most:e}]"),
        }),
    }
}
