//! The correction of a least-squares solution by residuals in twice the precision.
//!
//! The gradient `A'(y - A t)` is summed without visible rounding and sent back through the triangular factor: after two
//! corrections the coefficients are those of the data as stored, as far as a double can tell, unless the columns are
//! nearly dependent.
//!
//! Source: Björck, "Numerical Methods for Least Squares Problems" (1996), section 2.9.3 and 6.6.5 (corrected
//! semi-normal equations).

use super::linear::Solved;
use crate::stats::compensated::Compensated;

/// The most numbers (rows times columns) that are gone through again: some milliseconds. In longer records the rounding
/// of many rows averages out.
const MOST: usize = 50_000;

/// Two corrections; the third look only takes the residual.
const LOOKS: usize = 3;

/// Corrects coefficients and residual; `row` fills in a row of the matrix and returns its y.
pub(super) fn refine(
    solved: &mut Solved,
    rows: usize,
    weights: Option<&[f64]>,
    row: impl Fn(usize, &mut [Compensated]) -> Compensated,
) {
    let p = solved.coefficients.len();
    if rows * p > MOST {
        return;
    }
    let mut entries = vec![Compensated::default(); p];
    for look in 1..=LOOKS {
        let mut gradient = vec![Compensated::default(); p];
        let mut squares = Compensated::default();
        for i in 0..rows {
            let mut residual = row(i, &mut entries);
            for (t, a) in solved.coefficients.iter().zip(&entries) {
                residual = residual.plus(-t.times(*a));
            }
            let weighted = residual.times(Compensated::from(weights.map_or(1.0, |w| w[i])));
            for (g, a) in gradient.iter_mut().zip(&entries) {
                *g = g.plus(weighted.times(*a));
            }
            squares = squares.plus(weighted.times(residual));
        }
        // A gradient that overflowed corrects nothing.
        if !squares.value.is_finite() || gradient.iter().any(|g| !g.value.is_finite()) {
            return;
        }
        solved.residual_squares = squares.value.max(0.0);
        if look == LOOKS {
            return;
        }
        let mut step: Vec<f64> = gradient.iter().map(|g| g.value).collect();
        solved.triangle.solve_transposed(&mut step);
        solved.triangle.solve(&mut step);
        for (t, d) in solved.coefficients.iter_mut().zip(&step) {
            t.add(*d);
        }
    }
}
