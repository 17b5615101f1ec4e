//! The low pass of a decimation: flat up to four fifths of the new Nyquist frequency, steep beyond it.

use std::f64::consts::{LN_10, PI};

use super::cascade::Cascade;
use super::section::{LOW, Section};
use crate::Error;

/// Poles per pass, ripple and edge as the decimation of `scipy.signal.decimate`, so that figures can be compared.
const POLES: usize = 8;
const RIPPLE_DB: f64 = 0.05;
/// The edge as a share of the new Nyquist frequency.
pub const EDGE_OVER_NYQUIST: f64 = 0.8;

/// A Chebyshev filter of the first kind with unit gain at zero frequency.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct AntiAlias {
    pub(super) cascade: Cascade,
}

impl AntiAlias {
    /// The filter to run before every `every`-th sample is kept.
    ///
    /// # Errors
    /// [`Error::OutOfRange`] unless `every` is at least 2.
    pub fn new(every: usize) -> Result<Self, Error> {
        if every < 2 {
            return Err(Error::OutOfRange {
                name: "decimate",
                value: every as f64,
                interval: "[2, inf)".into(),
            });
        }
        let g = (0.5 * PI * EDGE_OVER_NYQUIST / every as f64).tan();
        // Poles of the prototype: -sinh(mu) sin(theta) +- i cosh(mu) cos(theta).
        let epsilon = (RIPPLE_DB * LN_10 / 10.0).exp_m1().sqrt();
        let mu = (1.0 / epsilon).asinh() / POLES as f64;
        let pairs = (0..POLES / 2).map(|i| {
            // From the most damped pair (theta near a right angle) to the least.
            let theta = 0.5 * PI - PI * (2 * i + 1) as f64 / (2 * POLES) as f64;
            let (real, imaginary) = (mu.sinh() * theta.sin(), mu.cosh() * theta.cos());
            let natural = real.hypot(imaginary);
            Section::Pair {
                g: g * natural,
                k: 2.0 * real / natural,
                mix: LOW,
            }
        });
        Ok(Self {
            cascade: Cascade::new(pairs, 1.0),
        })
    }
}
