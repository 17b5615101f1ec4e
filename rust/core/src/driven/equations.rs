//! The normal equations of a driven fit, one block per stroke, and what is read off their sums.
//!
//! Fits, held-out errors and intervals are sums of these blocks, so that a fold costs a small solve and not a pass over
//! the samples.

use nalgebra::{DMatrix, DVector};

/// The square of the factor's smallest diagonal bounds the condition of the scaled equations, which is the square of
/// the columns': this leaves four digits. Below it the shortest solution is taken.
const CONDITION: f64 = 1e-12;

/// A column this much shorter than the longest is nothing: an exponential that has died away, a spot never visited.
const NOTHING: f64 = 1e-30;

/// One stroke of a run, in kept samples.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Rows {
    /// Its first sample.
    pub first: usize,
    /// One past its last.
    pub last: usize,
    /// What the square of its own shift of the start is weighed with.
    pub ridge: f64,
}

/// Square blocks of one size, one after the other, each row by row: the products of the columns and, last, of the
/// measurement; the column before the measurement is the shift that all starts have in common.
#[derive(Debug, Clone, PartialEq)]
pub struct Blocks {
    /// Columns and measurement.
    pub size: usize,
    /// `size * size` numbers per stroke.
    pub products: Vec<f64>,
}

impl Blocks {
    /// Forms the blocks of one run.
    ///
    /// The instant at which a stroke starts is uncertain: its own shift is a random effect, eliminated here.
    #[must_use]
    pub fn of(columns: &[&[f64]], strokes: &[Rows]) -> Self {
        let size = columns.len();
        let mut products = Vec::with_capacity(size * size * strokes.len());
        for rows in strokes {
            let start = products.len();
            products.resize(start + size * size, 0.0);
            let block = &mut products[start..];
            for i in 0..size {
                for j in 0..=i {
                    let product = dot(
                        &columns[i][rows.first..rows.last],
                        &columns[j][rows.first..rows.last],
                    );
                    block[i * size + j] = product;
                    block[j * size + i] = product;
                }
            }
            let shift = size - 2;
            let cross: Vec<f64> = block[shift * size..(shift + 1) * size].to_vec();
            let denominator = cross[shift] + rows.ridge;
            if denominator > 0.0 {
                for i in 0..size {
                    for j in 0..size {
                        block[i * size + j] -= cross[i] * cross[j] / denominator;
                    }
                }
            }
        }
        Self { size, products }
    }

    fn block(&self, stroke: usize) -> &[f64] {
        let length = self.size * self.size;
        &self.products[stroke * length..(stroke + 1) * length]
    }

    /// Strokes.
    #[must_use]
    pub fn len(&self) -> usize {
        self.products.len() / (self.size * self.size).max(1)
    }

    /// Whether there is no stroke.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.products.is_empty()
    }

    fn sum(&self, chosen: impl Fn(usize) -> bool) -> Vec<f64> {
        let mut sum = vec![0.0; self.size * self.size];
        for stroke in (0..self.len()).filter(|s| chosen(*s)) {
            sum.iter_mut()
                .zip(self.block(stroke))
                .for_each(|(s, b)| *s += b);
        }
        sum
    }

    /// The sum of squares that coefficients leave in every stroke.
    #[must_use]
    pub fn losses(&self, coefficients: &[f64]) -> Vec<f64> {
        (0..self.len())
            .map(|stroke| self.loss(stroke, coefficients))
            .collect()
    }

    fn loss(&self, stroke: usize, coefficients: &[f64]) -> f64 {
        let block = self.block(stroke);
        let weight = |i: usize| coefficients.get(i).copied().unwrap_or(-1.0);
        let mut loss = 0.0;
        for i in 0..self.size {
            let row = &block[i * self.size..(i + 1) * self.size];
            let along: f64 = row.iter().enumerate().map(|(j, v)| v * weight(j)).sum();
            loss += weight(i) * along;
        }
        loss.max(0.0)
    }

    /// Predicts the strokes of every fold from those of the others.
    ///
    /// Returns the sum of squares left in each stroke by coefficients that have not seen its fold, and the one left in
    /// the strokes that each fold was trained on.
    #[must_use]
    pub fn held_out(&self, fold_of: &[usize], folds: usize, bound: f64) -> (Vec<f64>, Vec<f64>) {
        let mut losses = vec![0.0; self.len()];
        let mut training = vec![0.0; folds];
        for (fold, trained) in training.iter_mut().enumerate() {
            let coefficients = solve(&self.sum(|s| fold_of[s] != fold), self.size, bound);
            for stroke in 0..self.len() {
                let loss = self.loss(stroke, &coefficients);
                if fold_of[stroke] == fold {
                    losses[stroke] = loss;
                } else {
                    *trained += loss;
                }
            }
        }
        (losses, training)
    }
}

/// The least-squares coefficients of one summed block.
///
/// Columns are scaled to unit length; where two cannot be told apart the shortest solution is taken. The last
/// coefficient, the common shift of the starts, stays within plus or minus `bound`.
#[must_use]
pub fn solve(block: &[f64], size: usize, bound: f64) -> Vec<f64> {
    let count = size - 1;
    if count == 0 {
        return Vec::new();
    }
    let products = DMatrix::from_fn(count, count, |i, j| block[i * size + j]);
    let right = DVector::from_fn(count, |i, _| block[i * size + count]);
    let free = solve_free(products.clone(), right.clone());
    let last = free[count - 1];
    if last.abs() <= bound {
        return free.as_slice().to_vec();
    }
    let last = bound.copysign(last);
    let others = count - 1;
    let mut found = if others == 0 {
        Vec::new()
    } else {
        let less = right.rows(0, others) - products.view((0, others), (others, 1)) * last;
        let products = products.view((0, 0), (others, others)).into_owned();
        solve_free(products, less.column(0).into_owned())
            .as_slice()
            .to_vec()
    };
    found.push(last);
    found
}

fn solve_free(mut products: DMatrix<f64>, mut right: DVector<f64>) -> DVector<f64> {
    let count = right.len();
    let mut scale: Vec<f64> = (0..count).map(|i| products[(i, i)].sqrt()).collect();
    let longest = scale.iter().fold(0.0_f64, |m, s| m.max(*s));
    for (i, s) in scale.iter_mut().enumerate() {
        // A column that these strokes do not show has no coefficient, whatever rounding makes of it.
        if *s <= NOTHING * longest {
            *s = 1.0;
            products.row_mut(i).fill(0.0);
            products.column_mut(i).fill(0.0);
            right[i] = 0.0;
        }
    }
    for i in 0..count {
        for j in 0..count {
            products[(i, j)] /= scale[i] * scale[j];
        }
        right[i] /= scale[i];
    }
    let certain = products
        .clone()
        .cholesky()
        .filter(|factor| factor.l_dirty().diagonal().min().powi(2) > CONDITION);
    let mut found = match certain {
        Some(factor) => factor.solve(&right),
        None => shortest(products, &right),
    };
    found.iter_mut().zip(&scale).for_each(|(x, s)| *x /= s);
    found
}

/// The shortest solution of symmetric equations, directions that carry next to nothing left out.
fn shortest(products: DMatrix<f64>, right: &DVector<f64>) -> DVector<f64> {
    let eigen = products.symmetric_eigen();
    let least = CONDITION * eigen.eigenvalues.amax();
    let mut along = eigen.eigenvectors.tr_mul(right);
    for (a, value) in along.iter_mut().zip(&eigen.eigenvalues) {
        *a = if *value > least { *a / value } else { 0.0 };
    }
    eigen.eigenvectors * along
}

/// A sum of products in eight parts side by side, joined at the end in a fixed order.
fn dot(a: &[f64], b: &[f64]) -> f64 {
    const PARTS: usize = 8;
    let mut parts = [0.0; PARTS];
    let (chunks_a, chunks_b) = (a.chunks_exact(PARTS), b.chunks_exact(PARTS));
    let rest: f64 = chunks_a
        .remainder()
        .iter()
        .zip(chunks_b.remainder())
        .map(|(x, y)| x * y)
        .sum();
    for (x, y) in chunks_a.zip(chunks_b) {
        for k in 0..PARTS {
            parts[k] += x[k] * y[k];
        }
    }
    parts.iter().sum::<f64>() + rest
}

#[cfg(test)]
mod tests {
    use super::{Blocks, Rows, solve};

    fn columns() -> [Vec<f64>; 4] {
        let n = 60;
        let a: Vec<f64> = (0..n).map(|i| (f64::from(i) * 0.31).sin()).collect();
        let b: Vec<f64> = (0..n).map(|i| 1.0 + f64::from(i % 7)).collect();
        let shift: Vec<f64> = (0..n).map(|i| f64::from(u8::from(i % 20 == 3))).collect();
        let y = (0..n as usize)
            .map(|i| 2.0 * a[i] - 0.5 * b[i] + 0.25 * shift[i])
            .collect();
        [a, b, shift, y]
    }

    fn blocks(ridge: f64) -> Blocks {
        let made = columns();
        let rows = [(0, 20), (20, 40), (40, 60)].map(|(first, last)| Rows { first, last, ridge });
        Blocks::of(&made.each_ref().map(Vec::as_slice), &rows)
    }

    #[test]
    fn what_was_put_in_comes_out() {
        // an infinite ridge leaves the strokes no shift of their own
        let found = solve(&blocks(f64::INFINITY).sum(|_| true), 4, f64::INFINITY);
        for (x, expected) in found.iter().zip([2.0, -0.5, 0.25]) {
            // 60 samples of values below 10, equations of condition 1e3
            assert!((x - expected).abs() < 1e-12, "{found:?}");
        }
    }

    #[test]
    fn the_common_shift_stays_inside_its_bound() {
        let found = solve(&blocks(f64::INFINITY).sum(|_| true), 4, 0.1);
        assert_eq!(found[2], 0.1);
    }

    #[test]
    fn equal_columns_share_their_coefficient() {
        let [a, _, shift, _] = columns();
        let y: Vec<f64> = a.iter().map(|v| 3.0 * v).collect();
        let rows = [Rows {
            first: 0,
            last: 60,
            ridge: f64::INFINITY,
        }];
        let sum = Blocks::of(&[&a, &a, &shift, &y], &rows).sum(|_| true);
        let found = solve(&sum, 4, f64::INFINITY);
        // the cut of small directions leaves half the digits of the equations
        assert!(
            (found[0] - 1.5).abs() < 1e-6 && (found[1] - 1.5).abs() < 1e-6,
            "{found:?}"
        );
    }

    #[test]
    fn a_fold_is_predicted_by_coefficients_of_the_others() {
        let all = blocks(1.0);
        let (losses, training) = all.held_out(&[0, 1, 1], 2, f64::INFINITY);
        let of_others = solve(&all.sum(|s| s != 0), 4, f64::INFINITY);
        assert_eq!(losses[0], all.losses(&of_others)[0]);
        let trained = all.losses(&of_others);
        assert_eq!(training[0], trained[1] + trained[2]);
    }
}
