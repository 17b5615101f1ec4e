//! Mean, deviation and extremes of the last `n` samples.

use super::window::{Pool, Window};
use crate::error::{Error, require_moderate};

/// The figures of one window, in the order of a row of [`Rolling::push_into`].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct WindowFigures {
    /// The mean.
    pub mean: f64,
    /// The standard deviation with n.
    pub std_population: f64,
    /// The smallest sample.
    pub min: f64,
    /// The largest sample.
    pub max: f64,
    /// How many samples.
    pub count: u64,
}

/// Columns of a row: mean, population standard deviation, smallest, largest.
pub const COLUMNS: usize = 4;

/// Rolling statistics of a stream.
#[derive(Debug, Clone)]
pub struct Rolling(Window<Spread>);

/// Mean and squares about an origin that is a sample of the pool: rounding is measured by the window's own range.
#[derive(Debug, Clone, Copy)]
struct Spread {
    n: f64,
    origin: f64,
    mean: f64,
    squares: f64,
    low: f64,
    high: f64,
}

impl Pool for Spread {
    type Sample = f64;

    #[inline]
    fn of(v: f64) -> Self {
        Self {
            n: 1.0,
            origin: v,
            mean: 0.0,
            squares: 0.0,
            low: v,
            high: v,
        }
    }

    #[inline]
    fn join(&self, other: &Self) -> Self {
        let n = self.n + other.n;
        let share = other.n / n;
        let apart = (other.origin - self.origin) + (other.mean - self.mean);
        Self {
            n,
            origin: self.origin,
            mean: self.mean + apart * share,
            squares: self.squares + other.squares + apart * apart * (self.n * share),
            low: if other.low < self.low {
                other.low
            } else {
                self.low
            },
            high: if other.high > self.high {
                other.high
            } else {
                self.high
            },
        }
    }
}

impl From<Spread> for WindowFigures {
    fn from(s: Spread) -> Self {
        Self {
            mean: s.origin + s.mean,
            std_population: (s.squares / s.n).sqrt(),
            min: s.low,
            max: s.high,
            count: s.n as u64,
        }
    }
}

impl Rolling {
    /// An empty window of this many samples.
    ///
    /// # Errors
    /// [`Error::OutOfRange`] for a length of 0 or beyond [`super::window::LONGEST`].
    pub fn new(window: usize) -> Result<Self, Error> {
        Ok(Self(Window::new(window)?))
    }

    /// The window's length.
    #[must_use]
    pub fn window(&self) -> usize {
        self.0.length()
    }

    /// Adds samples.
    ///
    /// # Errors
    /// [`Error::NonFinite`] or [`Error::OutOfRange`]; nothing of a refused chunk is added.
    pub fn push(&mut self, x: &[f64]) -> Result<(), Error> {
        require_moderate("x", x)?;
        for v in x {
            self.0.push(*v);
        }
        Ok(())
    }

    /// Adds samples and writes a row of [`COLUMNS`] figures after each of them, of the window as far as it is filled.
    ///
    /// # Errors
    /// As [`Self::push`], and [`Error::Length`] for an `out` of another size.
    pub fn push_into(&mut self, x: &[f64], out: &mut [f64]) -> Result<(), Error> {
        if out.len() != COLUMNS * x.len() {
            return Err(Error::Length {
                name: "out",
                expected: format!("{COLUMNS} for each of the {} samples", x.len()),
                got: out.len(),
            });
        }
        require_moderate("x", x)?;
        for (v, row) in x.iter().zip(out.as_chunks_mut::<COLUMNS>().0) {
            self.0.push(*v);
            if let Some(f) = self.figures() {
                *row = [f.mean, f.std_population, f.min, f.max];
            }
        }
        Ok(())
    }

    /// The figures of the last samples; None of nothing.
    #[must_use]
    pub fn figures(&self) -> Option<WindowFigures> {
        self.0.pool().map(WindowFigures::from)
    }

    /// The window's length and the samples that rebuild the object.
    #[must_use]
    pub fn state(&self) -> (Vec<u64>, Vec<f64>) {
        (vec![self.window() as u64], self.0.samples().collect())
    }

    /// Rebuilds what [`Self::state`] stored.
    ///
    /// # Errors
    /// As [`Self::new`] and [`Self::push`].
    pub fn from_state(integers: &[u64], numbers: &[f64]) -> Result<Self, Error> {
        let &[window] = integers else {
            return Err(Error::Length {
                name: "state",
                expected: "1 integer".into(),
                got: integers.len(),
            });
        };
        let mut rolling = Self::new(window as usize)?;
        rolling.push(numbers)?;
        Ok(rolling)
    }
}

/// The figures of every full window of a record: rows of [`COLUMNS`], `x.len() - window + 1` of them.
///
/// # Errors
/// As [`Rolling::new`] and [`Rolling::push_into`].
pub fn rolling(x: &[f64], window: usize, out: &mut [f64]) -> Result<(), Error> {
    let mut stream = Rolling::new(window)?;
    if x.len() < window {
        return Err(Error::Length {
            name: "x",
            expected: format!("at least {window}, the window,"),
            got: x.len(),
        });
    }
    let (first, rest) = x.split_at(window - 1);
    stream.push(first)?;
    stream.push_into(rest, out)
}
