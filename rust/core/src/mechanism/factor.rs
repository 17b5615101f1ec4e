//! Cholesky's factors of a small symmetric matrix that may be singular, in place and without allocation.

// A pivot below this share of its diagonal element is a dependent row: rounding leaves less than the number of rows
// times 2e-16, and inertias that differ by less than 1e12 leave more.
const DEPENDENT: f64 = 1e-12;

/// Room for the factors of matrices of up to `room` rows.
#[derive(Debug, Clone)]
pub(super) struct Factor {
    lower: Vec<f64>,
    rows: usize,
}

impl Factor {
    pub fn new(room: usize) -> Self {
        Self {
            lower: vec![0.0; room * room],
            rows: 0,
        }
    }

    /// Factors the matrix of which `of(i, j)` is the element, `i >= j`. Returns whether it is regular.
    pub fn set(&mut self, rows: usize, of: impl Fn(usize, usize) -> f64) -> bool {
        self.rows = rows;
        let mut regular = true;
        for j in 0..rows {
            let diagonal = of(j, j);
            let mut pivot = diagonal;
            for k in 0..j {
                pivot -= self.lower[j * rows + k] * self.lower[j * rows + k];
            }
            let root = if pivot > DEPENDENT * diagonal {
                pivot.sqrt()
            } else {
                regular = false;
                0.0
            };
            self.lower[j * rows + j] = root;
            for i in j + 1..rows {
                self.lower[i * rows + j] = if root > 0.0 {
                    let mut sum = of(i, j);
                    for k in 0..j {
                        sum -= self.lower[i * rows + k] * self.lower[j * rows + k];
                    }
                    sum / root
                } else {
                    0.0
                };
            }
        }
        regular
    }

    /// Solves in place. The unknowns of dependent rows are 0; where the right side is consistent, as that of an
    /// equilibrium is, the others make up for them.
    pub fn solve(&self, x: &mut [f64]) {
        let rows = self.rows;
        for i in 0..rows {
            let mut sum = x[i];
            for k in 0..i {
                sum -= self.lower[i * rows + k] * x[k];
            }
            let pivot = self.lower[i * rows + i];
            x[i] = if pivot > 0.0 { sum / pivot } else { 0.0 };
        }
        for i in (0..rows).rev() {
            let mut sum = x[i];
            for k in i + 1..rows {
                sum -= self.lower[k * rows + i] * x[k];
            }
            let pivot = self.lower[i * rows + i];
            x[i] = if pivot > 0.0 { sum / pivot } else { 0.0 };
        }
    }
}
