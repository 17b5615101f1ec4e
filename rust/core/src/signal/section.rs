//! One section of a filter in state-variable form: a pair of poles or a single one, with any of its outputs.
//!
//! A pair carries the band-pass integrator and the low-pass integrator of the trapezoidal state-variable filter with
//! `g = tan(pi f / fs)` and damping `k`; its poles are those of `s^2 + k s + 1` at the pre-warped frequency. Every
//! increment vanishes with `x - low`, so a slow filter loses only `eps / (fc/fs)`.
//!
//! Source: Zavalishin, "The Art of VA Filter Design", chapters 3 and 4 (trapezoidal integrators without unit delay in
//! the loop), solved for the increments.

use nalgebra::Complex;

/// How much of each output of a pair goes on to the next section.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Mix {
    /// Of `1 / (s^2 + k s + 1)`.
    pub low: f64,
    /// Of `s / (s^2 + k s + 1)`.
    pub band: f64,
    /// Of `s^2 / (s^2 + k s + 1)`.
    pub high: f64,
}

/// The low pass.
pub const LOW: Mix = Mix {
    low: 1.0,
    band: 0.0,
    high: 0.0,
};

/// The high pass.
pub const HIGH: Mix = Mix {
    low: 0.0,
    band: 0.0,
    high: 1.0,
};

/// One section.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Section {
    /// A pair of poles, complex if `k < 2`.
    Pair {
        /// `tan(pi f / fs)` of the natural frequency.
        g: f64,
        /// Damping: the width of the resonance over its frequency.
        k: f64,
        /// What comes out.
        mix: Mix,
    },
    /// One real pole.
    Single {
        /// `tan(pi f / fs)`.
        g: f64,
        /// `s / (s + 1)` instead of `1 / (s + 1)`.
        high: bool,
    },
}

/// A section solved for the increments: at most two states.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Solved {
    /// How many states.
    pub states: usize,
    /// The matrix less the identity.
    pub e: [[f64; 2]; 2],
    /// Input to states.
    pub b: [f64; 2],
    /// States to output.
    pub c: [f64; 2],
    /// Input to output.
    pub d: f64,
}

impl Section {
    /// The increments and the output as numbers; states are `[band, low]`, or `[low]` of a single pole.
    pub fn solved(&self) -> Solved {
        match *self {
            Self::Single { g, high } => {
                let direct = 2.0 * g / (1.0 + g);
                let low_of_low = 1.0 / (1.0 + g);
                let (c, d) = if high {
                    (-low_of_low, low_of_low)
                } else {
                    (low_of_low, 0.5 * direct)
                };
                Solved {
                    states: 1,
                    e: [[-direct, 0.0], [0.0, 0.0]],
                    b: [direct, 0.0],
                    c: [c, 0.0],
                    d,
                }
            }
            Self::Pair { g, k, mix } => {
                let scale = 1.0 / (1.0 + g * (g + k));
                let (cross, direct, loss) = (
                    2.0 * g * scale,
                    2.0 * g * g * scale,
                    2.0 * g * (g + k) * scale,
                );
                // The outputs are means over the sample: low + its half increment, band likewise, and
                // high = x - k band - low.
                let low = [0.5 * cross, (1.0 + g * k) * scale, 0.5 * direct];
                let band = [scale, -0.5 * cross, 0.5 * cross];
                let high = [-(g + k) * scale, -scale, scale];
                let out = |i: usize| mix.low * low[i] + mix.band * band[i] + mix.high * high[i];
                Solved {
                    states: 2,
                    e: [[-loss, -cross], [cross, -direct]],
                    b: [cross, direct],
                    c: [out(0), out(1)],
                    d: out(2),
                }
            }
        }
    }

    /// The section with its output's time derivative as output, per sample; None where that has no finite gain.
    ///
    /// The derivative is that of the trapezoidal rule, `2 (z - 1) / (z + 1)`: at `f` it reads `2 tan(pi f / fs)`
    /// instead of `2 pi f / fs`.
    pub fn derivative(&self) -> Option<Self> {
        match *self {
            Self::Pair { g, k, mix } if mix.high == 0.0 => {
                // s times (low, band) of the section is (band, high) of the section, s in units of g.
                let mix = Mix {
                    low: 0.0,
                    band: 2.0 * g * mix.low,
                    high: 2.0 * g * mix.band,
                };
                Some(Self::Pair { g, k, mix })
            }
            _ => None,
        }
    }

    /// The response where the pre-warped frequency is `tangent = tan(pi f / fs)`.
    pub fn response(&self, tangent: f64) -> Complex<f64> {
        match *self {
            Self::Single { g, high } => {
                let s = Complex::new(0.0, tangent / g);
                (if high { s } else { Complex::new(1.0, 0.0) }) / (s + 1.0)
            }
            Self::Pair { g, k, mix } => {
                let s = Complex::new(0.0, tangent / g);
                let squared = -(tangent / g).powi(2);
                (s * mix.band + mix.low + mix.high * squared) / (s * k + 1.0 + squared)
            }
        }
    }

    /// The logarithm of the slower pole's radius, without forming `1 - radius`.
    pub fn ln_radius(&self) -> f64 {
        match *self {
            Self::Single { g, .. } => ln_radius_of_real(g),
            Self::Pair { g, k, .. } if k >= 2.0 => {
                let slow = 2.0 / (k + (k * k - 4.0).sqrt());
                ln_radius_of_real(g * slow).max(ln_radius_of_real(g / slow))
            }
            Self::Pair { g, k, .. } => 0.5 * (-2.0 * g * k / (1.0 + g * k + g * g)).ln_1p(),
        }
    }
}

/// For the pole `(1 - g) / (1 + g)`.
fn ln_radius_of_real(g: f64) -> f64 {
    (-2.0 * g.min(1.0) / (1.0 + g)).ln_1p()
}
