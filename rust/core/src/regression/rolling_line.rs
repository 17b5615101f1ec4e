//! The straight line through the last `n` points, exactly: nothing is subtracted when a point leaves.

use super::line::{Line, Sums};
use crate::error::{Error, require_finite, require_moderate, require_same_length};
use crate::stats::compensated::Compensated;
use crate::stats::window::{Pool, Window};

/// A line over a window.
#[derive(Debug, Clone)]
pub struct RollingLine(Window<Points>);

/// Sums about an origin that is one of the points: rounding is measured by the window's own range.
#[derive(Debug, Clone, Copy)]
struct Points {
    n: f64,
    origin: (f64, f64),
    x_mean: f64,
    y_mean: f64,
    xx: f64,
    xy: f64,
    yy: f64,
}

impl Pool for Points {
    type Sample = (f64, f64);

    #[inline]
    fn of(origin: (f64, f64)) -> Self {
        Self {
            n: 1.0,
            origin,
            x_mean: 0.0,
            y_mean: 0.0,
            xx: 0.0,
            xy: 0.0,
            yy: 0.0,
        }
    }

    #[inline]
    fn join(&self, other: &Self) -> Self {
        let n = self.n + other.n;
        let share = other.n / n;
        let weight = self.n * share;
        let dx = (other.origin.0 - self.origin.0) + (other.x_mean - self.x_mean);
        let dy = (other.origin.1 - self.origin.1) + (other.y_mean - self.y_mean);
        Self {
            n,
            origin: self.origin,
            x_mean: self.x_mean + dx * share,
            y_mean: self.y_mean + dy * share,
            xx: self.xx + other.xx + dx * dx * weight,
            xy: self.xy + other.xy + dx * dy * weight,
            yy: self.yy + other.yy + dy * dy * weight,
        }
    }
}

impl RollingLine {
    /// An empty window of this many points.
    ///
    /// # Errors
    /// [`Error::OutOfRange`] for a length of 0 or above ten million.
    pub fn new(window: usize) -> Result<Self, Error> {
        Ok(Self(Window::new(window)?))
    }

    /// Adds points.
    ///
    /// # Errors
    /// [`Error::Length`], [`Error::NonFinite`] or [`Error::OutOfRange`]; nothing of a refused chunk is added.
    pub fn push(&mut self, x: &[f64], y: &[f64]) -> Result<(), Error> {
        require_same_length("y", y, "x", x.len())?;
        require_moderate("x", x)?;
        require_moderate("y", y)?;
        for point in x.iter().zip(y) {
            self.0.push((*point.0, *point.1));
        }
        Ok(())
    }

    /// The window's length.
    #[must_use]
    pub fn window(&self) -> usize {
        self.0.length()
    }

    /// How many points are in the window.
    #[must_use]
    pub fn count(&self) -> u64 {
        self.0.pool().map_or(0, |p| p.n as u64)
    }

    /// The line through the points of the window.
    ///
    /// # Errors
    /// [`Error::Length`] below two points, [`Error::Singular`] for constant x.
    pub fn fit(&self) -> Result<Line, Error> {
        let sums = self.0.pool().map_or_else(Sums::default, |p| Sums {
            count: p.n as u64,
            weight: p.n,
            x_mean: Compensated::sum(p.origin.0, p.x_mean),
            y_mean: Compensated::sum(p.origin.1, p.y_mean),
            xx: p.xx.into(),
            xy: p.xy.into(),
            yy: p.yy.into(),
        });
        sums.fit(false)
    }

    /// The window's length, and x and y of the points that rebuild the object.
    #[must_use]
    pub fn state(&self) -> (Vec<u64>, Vec<f64>) {
        let numbers = self.0.samples().flat_map(|(x, y)| [x, y]).collect();
        (vec![self.window() as u64], numbers)
    }

    /// Rebuilds what [`Self::state`] stored.
    ///
    /// # Errors
    /// As [`Self::new`] and [`Self::push`].
    pub fn from_state(integers: &[u64], numbers: &[f64]) -> Result<Self, Error> {
        let (points, odd) = numbers.as_chunks::<2>();
        let (&[window], []) = (integers, odd) else {
            return Err(Error::Length {
                name: "state",
                expected: "1 integer and pairs of numbers".into(),
                got: numbers.len(),
            });
        };
        require_finite("state", numbers)?;
        let mut line = Self::new(window as usize)?;
        for [x, y] in points {
            line.0.push((*x, *y));
        }
        Ok(line)
    }
}
