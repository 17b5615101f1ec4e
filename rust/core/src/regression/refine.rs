//! The correction of a least-squares solution by residuals in twice the precision.
//!
//! The gradient `A'(y - A t)` is summed without visible rounding and sent back through the triangular factor: after two
//! corrections the coefficients are those of the data as stored, as far as a double can tell, unless the columns are
//! nearly dependent.
//!
//! Source: Björck, "Numerical Methods for Least Squares Problems" (1996), section 2.9.3 and 6.6.5 (corrected
//! semi-normal equations).

use super::linear::Solved;
use super::twofold::Twofold;
use crate::stats::compensated::Compensated;
use crate::stats::simd::{self, Kernel, PACK, Pack};

/// The most numbers (rows times columns) that are gone through again: well below a millisecond. In longer records the
/// rounding of many rows averages out.
const MOST: usize = 50_000;

/// The most looks at the data, each but the last followed by a correction. One correction is enough unless the columns
/// are nearly dependent or the fit is all but exact.
const LOOKS: usize = 3;

/// A matrix and its right-hand side, of which eight rows at a time are looked at.
pub(super) trait Design {
    /// How many rows.
    fn rows(&self) -> usize;
    /// Fills in the entries of eight rows, whose numbers are given, and returns their y.
    fn look<P: Pack>(&self, rows: [usize; PACK], entries: &mut [Twofold<P>]) -> Twofold<P>;
}

/// Corrects the coefficients and takes the sum of squared residuals anew.
pub(super) fn refine(solved: &mut Solved, weights: Option<&[f64]>, design: &impl Design) {
    if design.rows() * solved.coefficients.len() > MOST {
        return;
    }
    for look in 1..=LOOKS {
        let (gradient, squares) = simd::run(Look {
            coefficients: &solved.coefficients,
            weights,
            design,
        });
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
        // By this much the correction lowers the sum of squares.
        let lowered: f64 = step.iter().map(|v| v * v).sum();
        solved.triangle.solve(&mut step);
        let mut settled = lowered <= f64::EPSILON * squares.value;
        for (t, d) in solved.coefficients.iter_mut().zip(&step) {
            settled &= d.abs() <= SETTLED * t.value.abs();
            t.add(*d);
        }
        if settled {
            return;
        }
    }
}

/// A correction below this share was itself right to more digits than a double has left: a second one would not show.
const SETTLED: f64 = 1e-9;

struct Look<'a, D: Design> {
    coefficients: &'a [Compensated],
    weights: Option<&'a [f64]>,
    design: &'a D,
}

impl<D: Design> Kernel for Look<'_, D> {
    type Output = (Vec<Compensated>, Compensated);

    #[inline(always)]
    fn run<P: Pack>(self) -> Self::Output {
        let zero = Twofold::<P>::splat(Compensated::default());
        let coefficients: Vec<Twofold<P>> = self
            .coefficients
            .iter()
            .map(|c| Twofold::splat(*c))
            .collect();
        let mut entries = vec![zero; coefficients.len()];
        let mut gradient = entries.clone();
        let mut squares = zero;
        let n = self.design.rows();
        let mut start = 0;
        while start < n {
            // Beyond the end the last row is looked at again, with no weight.
            let rows = std::array::from_fn(|i| (start + i).min(n - 1));
            let weight: [f64; PACK] = std::array::from_fn(|i| match self.weights {
                _ if start + i >= n => 0.0,
                Some(weights) => weights[start + i],
                None => 1.0,
            });
            let mut residual = self.design.look(rows, &mut entries);
            for (t, a) in coefficients.iter().zip(&entries) {
                residual = residual.minus(t.times(*a));
            }
            let weighted = residual.times(Twofold::from(P::load(&weight)));
            for (g, a) in gradient.iter_mut().zip(&entries) {
                *g = g.plus(weighted.times(*a));
            }
            squares = squares.plus(weighted.times(residual));
            start += PACK;
        }
        (
            gradient.into_iter().map(Twofold::total).collect(),
            squares.total(),
        )
    }
}
