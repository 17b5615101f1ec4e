//! Small matrices of a filter: room for twelve states, powers kept as differences from the identity.
//!
//! The matrix `A` of a slow filter is nearly the identity; what matters is `E = A - I`, which is stored to its own
//! relative accuracy. Powers follow from `E_(a+b) = E_a + E_b + E_a E_b` without cancellation.

/// Room for twelve poles.
pub const MAX_POLES: usize = 12;

/// A vector of states; what is beyond the filter's own count is zero.
pub type Vector = [f64; MAX_POLES];

/// Row by row; what is beyond the filter's own count is zero.
pub type Matrix = [Vector; MAX_POLES];

/// The zero matrix.
pub const ZERO: Matrix = [[0.0; MAX_POLES]; MAX_POLES];

/// Calls a function of a known size, the count of states rounded up: what lies between is zero.
macro_rules! sized {
    ($n:expr, $name:ident($($argument:expr),*)) => {
        match $n {
            0..=2 => $name::<2>($($argument),*),
            3..=4 => $name::<4>($($argument),*),
            5..=8 => $name::<8>($($argument),*),
            _ => $name::<MAX_POLES>($($argument),*),
        }
    };
}

/// `a b` of the leading `n`.
pub fn product(n: usize, a: &Matrix, b: &Matrix) -> Matrix {
    sized!(n, product_of(a, b))
}

fn product_of<const N: usize>(a: &Matrix, b: &Matrix) -> Matrix {
    let mut result = ZERO;
    for (row, of_a) in result.iter_mut().zip(a).take(N) {
        let mut sum = [0.0; N];
        for k in 0..N {
            for j in 0..N {
                sum[j] += of_a[k] * b[k][j];
            }
        }
        row[..N].copy_from_slice(&sum);
    }
    result
}

/// `a v`.
pub fn apply(n: usize, a: &Matrix, v: &Vector) -> Vector {
    sized!(n, apply_of(a, v))
}

fn apply_of<const N: usize>(a: &Matrix, v: &Vector) -> Vector {
    let mut result = [0.0; MAX_POLES];
    for (r, row) in result.iter_mut().zip(a).take(N) {
        *r = (0..N).map(|j| row[j] * v[j]).sum();
    }
    result
}

/// `v a`, a row times a matrix.
pub fn apply_left(n: usize, v: &Vector, a: &Matrix) -> Vector {
    let mut result = [0.0; MAX_POLES];
    for (factor, row) in v.iter().zip(a).take(n) {
        for (r, a) in result.iter_mut().zip(row).take(n) {
            *r += factor * a;
        }
    }
    result
}

/// The difference of a product of powers from the identity, `E_a + E_b + E_a E_b`.
pub fn together(n: usize, a: &Matrix, b: &Matrix) -> Matrix {
    sized!(n, together_of(a, b))
}

fn together_of<const N: usize>(a: &Matrix, b: &Matrix) -> Matrix {
    let mut result = product_of::<N>(a, b);
    for i in 0..N {
        for j in 0..N {
            result[i][j] += a[i][j] + b[i][j];
        }
    }
    result
}

/// `A^power - I` from `A - I`.
pub fn power(n: usize, e: &Matrix, mut power: usize) -> Matrix {
    let (mut square, mut result) = (*e, ZERO);
    while power > 0 {
        if power % 2 == 1 {
            result = together(n, &result, &square);
        }
        power /= 2;
        if power > 0 {
            square = together(n, &square, &square);
        }
    }
    result
}

/// Solves `a v = right` by elimination with row exchanges.
pub fn solve(n: usize, a: &Matrix, right: &Vector) -> Vector {
    let (mut a, mut v) = (*a, *right);
    for column in 0..n {
        let largest = (column..n)
            .max_by(|i, j| a[*i][column].abs().total_cmp(&a[*j][column].abs()))
            .unwrap_or(column);
        a.swap(column, largest);
        v.swap(column, largest);
        let pivot = a[column];
        for row in column + 1..n {
            let factor = a[row][column] / pivot[column];
            for (place, p) in a[row].iter_mut().zip(&pivot).take(n).skip(column) {
                *place -= factor * p;
            }
            v[row] -= factor * v[column];
        }
    }
    for row in (0..n).rev() {
        let known: f64 = (row + 1..n).map(|k| a[row][k] * v[k]).sum();
        v[row] = (v[row] - known) / a[row][row];
    }
    v
}

#[cfg(test)]
mod tests {
    use super::{MAX_POLES, ZERO, apply, power, solve};

    #[test]
    fn a_solution_solves() {
        let mut a = ZERO;
        for (i, row) in a.iter_mut().enumerate() {
            for (j, v) in row.iter_mut().enumerate() {
                *v = ((3 * i + 7 * j) as f64).sin()
                    + if i == (j + 1) % MAX_POLES { 3.0 } else { 0.0 };
            }
        }
        let wanted = std::array::from_fn(|i| i as f64 - 4.0);
        let found = solve(MAX_POLES, &a, &apply(MAX_POLES, &a, &wanted));
        for (f, w) in found.iter().zip(&wanted) {
            // a few roundings of a well-conditioned system
            assert!((f - w).abs() < 1e-12);
        }
    }

    #[test]
    fn a_power_of_nearly_the_identity_keeps_its_digits() {
        let mut e = ZERO;
        e[0][0] = -1e-9;
        let found = power(1, &e, 1000)[0][0];
        assert!((found / (1000.0 * (-1e-9_f64).ln_1p()).exp_m1() - 1.0).abs() < 1e-14);
    }
}
