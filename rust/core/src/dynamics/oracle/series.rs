//! Power series of a quantity over a stretch of time, each coefficient with the size of what it was summed from.

/// Terms kept beyond the constant.
///
/// On a stretch of length `h` with `h * rate <= 1` (see [`super::mode::Mode::rate_rad_s`]) the terms `T_n` of a motion
/// obey `T_(n+2) <= T_n / ((n+1)(n+2)) + T_(n+1) / (n+2)` plus the drive's, which fall like `1 / n!`: after 24 the next
/// is below 1e-19 of the first ones, far below rounding (2^-53 = 1.1e-16).
pub(super) const ORDER: usize = 24;

/// Rounding errors per sum: terms of a coefficient, of a value and of the state they start from.
const ROUNDINGS: f64 = 32.0;

/// A power series in the seconds since the start of a stretch.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Series {
    /// Coefficients.
    pub value: [f64; ORDER + 1],
    /// For each, the sum of the magnitudes that it was added up from: its rounding error is a few ulps of that.
    pub size: [f64; ORDER + 1],
}

impl Series {
    pub const ZERO: Self = Self {
        value: [0.0; ORDER + 1],
        size: [0.0; ORDER + 1],
    };

    /// Adds terms to one coefficient.
    pub fn add(&mut self, order: usize, terms: &[f64]) {
        for term in terms {
            self.value[order] += term;
            self.size[order] += term.abs();
        }
    }

    /// Adds a multiple of another series.
    pub fn add_times(&mut self, factor: f64, other: &Self) {
        if factor == 0.0 {
            return;
        }
        for k in 0..=ORDER {
            self.value[k] += factor * other.value[k];
            self.size[k] += factor.abs() * other.size[k];
        }
    }

    /// The derivative.
    pub fn rate(&self) -> Self {
        let mut out = Self::ZERO;
        for k in 0..ORDER {
            let factor = (k + 1) as f64;
            out.value[k] = factor * self.value[k + 1];
            out.size[k] = factor * self.size[k + 1];
        }
        out
    }

    /// Its value after some seconds.
    pub fn at(&self, seconds: f64) -> f64 {
        horner(&self.value, seconds)
    }

    /// How far from 0 a value at the start is that cannot be told from 0.
    pub fn noise(&self) -> f64 {
        ROUNDINGS * f64::EPSILON * self.size[0]
    }

    /// Takes it that the start may be off by the rounding of so many seconds: an event is placed within its stretch to
    /// the rounding of the stretch, and what it set to 0 has moved since.
    pub fn doubt(&mut self, seconds: f64) {
        self.size[0] += self.size[1] * seconds;
    }

    /// Its coefficients, each raised by its rounding error: what is below 0 then is so beyond doubt.
    pub fn raised_by_noise(&self) -> [f64; ORDER + 1] {
        let mut out = self.value;
        for (value, size) in out.iter_mut().zip(&self.size) {
            *value += ROUNDINGS * f64::EPSILON * size;
        }
        out
    }
}

/// The polynomial with these coefficients at a place.
pub(super) fn horner(coefficients: &[f64], x: f64) -> f64 {
    coefficients.iter().rev().fold(0.0, |sum, c| sum * x + c)
}
