//! Recursive least squares with forgetting, in square-root form: row by row, coefficients at any time.
//!
//! What is kept is the triangular factor of the information, never its inverse: rotations add a row without subtracting
//! anything, so that nothing can lose its sign as the classical covariance update does.
//!
//! Source: Björck, "Numerical Methods for Least Squares Problems" (1996), section 3.3.3 (rotations); Åström,
//! Wittenmark, "Adaptive Control", 2nd ed., section 11.5 (square-root form, estimator windup).

use crate::error::{Error, require_finite, require_moderate, require_positive};

/// Recursive least squares.
#[derive(Debug, Clone, PartialEq)]
pub struct Recursive {
    forgetting: f64,
    /// The square root of the information there was at the start, in every direction.
    floor: f64,
    /// Row by row, `size` columns of the factor and the right-hand side.
    rows: Vec<f64>,
    size: usize,
    count: u64,
    scratch: Vec<f64>,
}

impl Recursive {
    /// Starts from coefficients that are trusted as if each had been measured with a standard error of `start_error`
    /// residual standard deviations.
    ///
    /// # Errors
    /// [`Error::Length`] without coefficients, [`Error::OutOfRange`] for a factor outside (0, 1] or an error that is
    /// not positive.
    pub fn new(start: &[f64], start_error: f64, forgetting: f64) -> Result<Self, Error> {
        super::require_forgetting(forgetting)?;
        require_positive("start_error", start_error)?;
        require_moderate("start", start)?;
        let size = start.len();
        if size == 0 {
            return Err(Error::Length {
                name: "start",
                expected: "at least 1".into(),
                got: 0,
            });
        }
        let floor = 1.0 / start_error;
        if !(1e-100..=1e100).contains(&floor) {
            return Err(Error::OutOfRange {
                name: "start_error",
                value: start_error,
                interval: "[1e-100, 1e100]".into(),
            });
        }
        let width = size + 1;
        let mut rows = vec![0.0; size * width];
        for (i, b) in start.iter().enumerate() {
            rows[i * width + i] = floor;
            rows[i * width + size] = floor * b;
        }
        Ok(Self {
            forgetting,
            floor,
            rows,
            size,
            count: 0,
            scratch: vec![0.0; width],
        })
    }

    /// How many coefficients.
    #[must_use]
    pub fn size(&self) -> usize {
        self.size
    }

    /// How many rows were pushed.
    #[must_use]
    pub fn count(&self) -> u64 {
        self.count
    }

    /// Adds rows of regressors, one after another, with y; `errors` takes what y was off the prediction before each.
    ///
    /// # Errors
    /// [`Error::Length`], [`Error::NonFinite`] or [`Error::OutOfRange`]; nothing of a refused chunk is added.
    pub fn push(
        &mut self,
        x: &[f64],
        y: &[f64],
        mut errors: Option<&mut [f64]>,
    ) -> Result<(), Error> {
        let lengths = [
            ("x", x.len(), y.len() * self.size),
            (
                "errors",
                errors.as_ref().map_or(y.len(), |e| e.len()),
                y.len(),
            ),
        ];
        for (name, got, expected) in lengths {
            if got != expected {
                return Err(Error::Length {
                    name,
                    expected: format!("{expected} for {} values of y", y.len()),
                    got,
                });
            }
        }
        require_moderate("x", x)?;
        require_moderate("y", y)?;
        for (i, (row, y)) in x.chunks_exact(self.size).zip(y).enumerate() {
            if let Some(errors) = &mut errors {
                self.coefficients_into_scratch();
                let predicted: f64 = row.iter().zip(&self.scratch).map(|(x, b)| x * b).sum();
                errors[i] = y - predicted;
            }
            self.add(row, *y);
        }
        self.count += y.len() as u64;
        Ok(())
    }

    fn add(&mut self, row: &[f64], y: f64) {
        let width = self.size + 1;
        let least = (0..self.size)
            .map(|i| self.rows[i * width + i].abs())
            .fold(f64::INFINITY, f64::min);
        // Without this a direction that nothing excites would be forgotten until the estimate there is noise.
        let fading = self.forgetting.sqrt();
        if self.forgetting < 1.0 && least * fading >= self.floor {
            self.rows.iter_mut().for_each(|v| *v *= fading);
        }
        self.scratch[..self.size].copy_from_slice(row);
        self.scratch[self.size] = y;
        for i in 0..self.size {
            let own = &mut self.rows[i * width..(i + 1) * width];
            let (a, b) = (own[i], self.scratch[i]);
            if b == 0.0 {
                continue;
            }
            let length = a.hypot(b);
            let (c, s) = (a / length, b / length);
            for j in i..width {
                let (r, v) = (own[j], self.scratch[j]);
                own[j] = c * r + s * v;
                self.scratch[j] = c * v - s * r;
            }
        }
    }

    fn coefficients_into_scratch(&mut self) {
        let (n, width) = (self.size, self.size + 1);
        for i in (0..n).rev() {
            let row = &self.rows[i * width..(i + 1) * width];
            let known: f64 = (i + 1..n).map(|j| row[j] * self.scratch[j]).sum();
            self.scratch[i] = (row[n] - known) / row[i];
        }
    }

    /// The coefficients now.
    #[must_use]
    pub fn coefficients(&self) -> Vec<f64> {
        let mut twin = self.clone();
        twin.coefficients_into_scratch();
        twin.scratch.truncate(self.size);
        twin.scratch
    }

    /// Writes the coefficients now; allocates nothing.
    ///
    /// # Errors
    /// [`Error::Length`].
    pub fn coefficients_into(&mut self, out: &mut [f64]) -> Result<(), Error> {
        if out.len() != self.size {
            return Err(Error::Length {
                name: "out",
                expected: self.size.to_string(),
                got: out.len(),
            });
        }
        self.coefficients_into_scratch();
        out.copy_from_slice(&self.scratch[..self.size]);
        Ok(())
    }

    /// Size and count; then forgetting, floor and the rows of the factor.
    #[must_use]
    pub fn state(&self) -> (Vec<u64>, Vec<f64>) {
        let mut numbers = vec![self.forgetting, self.floor];
        numbers.extend(&self.rows);
        (vec![self.size as u64, self.count], numbers)
    }

    /// Rebuilds what [`Self::state`] stored.
    ///
    /// # Errors
    /// [`Error::Length`], [`Error::NonFinite`] or [`Error::OutOfRange`] for numbers it cannot have made.
    pub fn from_state(integers: &[u64], numbers: &[f64]) -> Result<Self, Error> {
        require_finite("state", numbers)?;
        let foreign = || Error::Length {
            name: "state",
            expected: "2 integers and 2 + n (n + 1) numbers".into(),
            got: numbers.len(),
        };
        let (&[size, count], &[forgetting, floor, ref rows @ ..]) = (integers, numbers) else {
            return Err(foreign());
        };
        let size = usize::try_from(size).map_err(|_| foreign())?;
        if size > rows.len() || rows.len() != size * (size + 1) {
            return Err(foreign());
        }
        let mut recursive = Self::new(&vec![0.0; size], 1.0 / floor, forgetting)?;
        recursive.floor = floor;
        recursive.rows.copy_from_slice(rows);
        recursive.count = count;
        Ok(recursive)
    }
}
