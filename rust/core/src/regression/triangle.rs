//! The triangular factor of a tall matrix whose rows come in blocks: what least squares needs to keep of them.
//!
//! A block of rows is reflected into the factor column by column; the factor of everything so far is as accurate as a
//! Householder QR of the whole matrix. The last column is the right-hand side: its last entry is then the length of the
//! residual, found without a difference of sums.
//!
//! Source: Golub, Van Loan, "Matrix Computations", 4th ed., sections 5.1.7 (reflections), 6.5 (adding rows); Demmel,
//! Grigori, Hoemmen, Langou, SIAM J. Sci. Comput. 34 (2012) A206, the same over blocks (TSQR).

use crate::stats::simd::{self, Kernel, PACK, Pack, Terms, sums};

/// Rows reflected together: up to a dozen columns of them stay in the first-level cache.
pub(super) const ROWS: usize = 128;

/// The factor and the block of rows that waits to be reflected into it.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Triangle {
    width: usize,
    /// Row by row, the lower part zero.
    factor: Vec<f64>,
    /// Column by column, `ROWS` apart.
    waiting: Vec<f64>,
    filled: usize,
    /// By how much the waiting rows are too large: what came before fades when they are reflected.
    gain: f64,
}

/// Columns whose squares sum to less, entries below 1e-145, count as zero: their reflections would overflow.
const LEAST_SQUARES: f64 = 1e-290;

/// A gain above this is settled at once, long before squares could overflow.
const MOST_GAIN: f64 = 1e60;

impl Triangle {
    pub(super) fn new(width: usize) -> Self {
        Self {
            width,
            factor: vec![0.0; width * width],
            waiting: vec![0.0; width * ROWS],
            filled: 0,
            gain: 1.0,
        }
    }

    pub(super) fn width(&self) -> usize {
        self.width
    }

    /// Adds one row, times a factor.
    #[inline]
    pub(super) fn push(&mut self, row: impl Iterator<Item = f64>, times: f64) {
        let times = times * self.gain;
        for (column, v) in row.enumerate() {
            self.waiting[column * ROWS + self.filled] = v * times;
        }
        self.filled += 1;
        if self.filled == ROWS {
            self.reflect();
        }
    }

    /// Multiplies everything so far by a factor below one: by making what follows larger until the next reflection.
    pub(super) fn fade(&mut self, factor: f64) {
        self.gain /= factor;
        if self.gain > MOST_GAIN {
            self.reflect();
        }
    }

    /// Reflects the waiting rows into the factor.
    pub(super) fn reflect(&mut self) {
        if self.filled > 0 {
            simd::run(Reflect {
                width: self.width,
                factor: &mut self.factor,
                rows: &mut self.waiting,
                count: self.filled,
            });
            self.filled = 0;
        }
        if self.gain != 1.0 {
            let factor = 1.0 / self.gain;
            self.factor.iter_mut().for_each(|v| *v *= factor);
            self.gain = 1.0;
        }
    }

    /// Entry of the factor, once nothing waits.
    #[inline]
    pub(super) fn at(&self, row: usize, column: usize) -> f64 {
        self.factor[row * self.width + column]
    }

    pub(super) fn at_mut(&mut self, row: usize, column: usize) -> &mut f64 {
        &mut self.factor[row * self.width + column]
    }

    /// The upper part, row by row, once nothing waits.
    pub(super) fn upper(&self) -> impl Iterator<Item = f64> {
        (0..self.width).flat_map(move |i| (i..self.width).map(move |j| self.at(i, j)))
    }

    /// Solves `R t = v` in place over the leading columns; no diagonal entry may be zero.
    pub(super) fn solve(&self, v: &mut [f64]) {
        for i in (0..v.len()).rev() {
            let mut rest = v[i];
            for j in i + 1..v.len() {
                rest -= self.at(i, j) * v[j];
            }
            v[i] = rest / self.at(i, i);
        }
    }

    /// Solves `R' t = v` in place over the leading columns.
    pub(super) fn solve_transposed(&self, v: &mut [f64]) {
        for i in 0..v.len() {
            let mut rest = v[i];
            for j in 0..i {
                rest -= self.at(j, i) * v[j];
            }
            v[i] = rest / self.at(i, i);
        }
    }
}

struct Reflect<'a> {
    width: usize,
    factor: &'a mut [f64],
    rows: &'a mut [f64],
    count: usize,
}

impl Kernel for Reflect<'_> {
    type Output = ();

    #[inline(always)]
    fn run<P: Pack>(self) {
        let k = self.width;
        for j in 0..k {
            let (left, right) = self.rows.split_at_mut((j + 1) * ROWS);
            let v = &left[j * ROWS..j * ROWS + self.count];
            let squares = dot::<P>(v, v);
            if squares < LEAST_SQUARES {
                continue;
            }
            let head = self.factor[j * k + j];
            // The sign that avoids cancellation in `head - length`.
            let length = -(head * head + squares).sqrt().copysign(head);
            let v0 = head - length;
            // 2 / |v|^2 with |v|^2 = v0^2 + squares
            let scale = 2.0 / (v0 * v0 + squares);
            self.factor[j * k + j] = length;
            for (l, column) in (j + 1..k).zip(right.chunks_exact_mut(ROWS)) {
                let column = &mut column[..self.count];
                let top = &mut self.factor[j * k + l];
                let s = (v0 * *top + dot::<P>(v, column)) * scale;
                *top -= s * v0;
                subtract::<P>(column, v, s);
            }
        }
    }
}

#[inline(always)]
fn dot<P: Pack>(a: &[f64], b: &[f64]) -> f64 {
    let [sum] = sums::<P, _, 2, 1>([a, b], &Product);
    sum
}

struct Product;

impl Terms<2, 1> for Product {
    #[inline(always)]
    fn of<P: Pack>(&self, [a, b]: [P; 2]) -> [P; 1] {
        [a.mul(b)]
    }
}

/// `column -= s * v`
#[inline(always)]
fn subtract<P: Pack>(column: &mut [f64], v: &[f64], s: f64) {
    let times = P::splat(s);
    let ((columns, column_rest), (vs, v_rest)) =
        (column.as_chunks_mut::<PACK>(), v.as_chunks::<PACK>());
    for (c, v) in columns.iter_mut().zip(vs) {
        P::load(c).sub(times.mul(P::load(v))).store(c);
    }
    for (c, v) in column_rest.iter_mut().zip(v_rest) {
        *c -= s * v;
    }
}

#[cfg(test)]
mod tests {
    use super::{ROWS, Reflect};
    use crate::stats::simd::{Width, run_at};

    fn factor(width: Width) -> Vec<f64> {
        let mut factor = vec![0.0; 9];
        for block in 0..3 {
            let mut rows: Vec<f64> = (0..3 * ROWS)
                .map(|i| ((i + 1000 * block) as f64 * 0.7).sin())
                .collect();
            let reflect = Reflect {
                width: 3,
                factor: &mut factor,
                rows: &mut rows,
                count: ROWS - 11 * block,
            };
            run_at(width, reflect);
        }
        factor
    }

    #[test]
    fn every_instruction_set_gives_the_same_bits() {
        let baseline = factor(Width::Baseline);
        assert_eq!(baseline, factor(Width::Avx2));
        assert_eq!(baseline, factor(Width::Avx512));
    }
}
