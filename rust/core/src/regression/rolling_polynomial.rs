//! The polynomial through the last `n` points, fitted anew from the points themselves whenever it is asked for.

use super::polynomial::{PolynomialFit, fit_polynomial};
use crate::error::{Error, require_finite, require_moderate, require_same_length};
use crate::stats::window::LONGEST;

/// A polynomial over a window.
#[derive(Debug, Clone, PartialEq)]
pub struct RollingPolynomial {
    degree: usize,
    window: usize,
    /// The oldest point once the window is full; where the next one goes.
    next: usize,
    x: Vec<f64>,
    y: Vec<f64>,
}

impl RollingPolynomial {
    /// An empty window of this many points.
    ///
    /// # Errors
    /// [`Error::OutOfRange`] for a degree above [`super::polynomial::HIGHEST`], a window that is not longer than the
    /// degree or above ten million.
    pub fn new(degree: usize, window: usize) -> Result<Self, Error> {
        super::polynomial::require_degree(degree)?;
        if !(degree + 1..=LONGEST).contains(&window) {
            return Err(Error::OutOfRange {
                name: "window",
                value: window as f64,
                interval: format!("[{}, {LONGEST}]", degree + 1),
            });
        }
        Ok(Self {
            degree,
            window,
            next: 0,
            x: Vec::with_capacity(window),
            y: Vec::with_capacity(window),
        })
    }

    /// The window's length.
    #[must_use]
    pub fn window(&self) -> usize {
        self.window
    }

    /// The degree.
    #[must_use]
    pub fn degree(&self) -> usize {
        self.degree
    }

    /// How many points are in the window.
    #[must_use]
    pub fn count(&self) -> u64 {
        self.x.len() as u64
    }

    /// Adds points.
    ///
    /// # Errors
    /// [`Error::Length`], [`Error::NonFinite`] or [`Error::OutOfRange`]; nothing of a refused chunk is added.
    pub fn push(&mut self, x: &[f64], y: &[f64]) -> Result<(), Error> {
        require_same_length("y", y, "x", x.len())?;
        require_moderate("x", x)?;
        require_moderate("y", y)?;
        for (x, y) in x.iter().zip(y) {
            if self.x.len() < self.window {
                self.x.push(*x);
                self.y.push(*y);
            } else {
                (self.x[self.next], self.y[self.next]) = (*x, *y);
                self.next = (self.next + 1) % self.window;
            }
        }
        Ok(())
    }

    /// The polynomial through the points of the window.
    ///
    /// # Errors
    /// As [`fit_polynomial`].
    pub fn fit(&self) -> Result<PolynomialFit, Error> {
        fit_polynomial(&self.x, &self.y, None, self.degree)
    }

    /// Degree, window and place; then x and y of the points.
    #[must_use]
    pub fn state(&self) -> (Vec<u64>, Vec<f64>) {
        let integers = vec![self.degree as u64, self.window as u64, self.next as u64];
        (integers, self.x.iter().chain(&self.y).copied().collect())
    }

    /// Rebuilds what [`Self::state`] stored.
    ///
    /// # Errors
    /// [`Error::Length`], [`Error::NonFinite`] or [`Error::OutOfRange`] for numbers it cannot have made.
    pub fn from_state(integers: &[u64], numbers: &[f64]) -> Result<Self, Error> {
        require_finite("state", numbers)?;
        let foreign = || Error::Length {
            name: "state",
            expected: "3 integers, and x and y of as many points as the window holds".into(),
            got: numbers.len(),
        };
        let &[degree, window, next] = integers else {
            return Err(foreign());
        };
        let mut made = Self::new(degree as usize, window as usize)?;
        let points = numbers.len() / 2;
        if numbers.len() % 2 == 1 || points > made.window || next as usize >= made.window {
            return Err(foreign());
        }
        made.push(&numbers[..points], &numbers[points..])?;
        made.next = next as usize;
        Ok(made)
    }
}
