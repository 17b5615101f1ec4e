//! The design of low-pass Butterworth filters, straight from `g = tan(pi fc / fs)` and the dampings.
//!
//! No pole or polynomial in `z` is formed: there the coefficients crowd at `z = 1` and lose `eps / (fc/fs)^2`, here
//! only `eps / (fc/fs)`.

use std::f64::consts::{PI, SQRT_2};
use std::fmt::Write as _;

use super::cascade::{Cascade, MAX_PAIRS, Pair, Single};
use crate::error::{Error, require_positive};

/// The most poles per pass; each further pair adds ringing and no measurement standard asks for more.
pub const MAX_POLES: usize = 2 * MAX_PAIRS;

/// The lowest cut-off per sample rate: the error law `eps / (fc/fs)` leaves seven digits there.
pub const MIN_CUTOFF_PER_RATE: f64 = 1e-9;

/// What "settled" means in words and in [`LowPass::describe`]: one part in a million of a step is left.
pub const SETTLED: f64 = 1e-6;

/// How often the filter runs over the record.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Passes {
    /// Forward only: causal, with delay.
    Forward,
    /// Forward and backward: zero phase, twice the poles in the magnitude.
    ForwardBackward,
}

impl Passes {
    /// The number of passes.
    #[must_use]
    pub fn count(self) -> u32 {
        match self {
            Self::Forward => 1,
            Self::ForwardBackward => 2,
        }
    }
}

/// Where the magnitude is `1/sqrt(2)` (-3.01 dB).
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum CutoffAt {
    /// In each pass; forward and backward together are at -6.02 dB there.
    PerPass,
    /// After all passes.
    Overall,
}

/// A low-pass Butterworth filter: the coefficients and what they were made from, without any memory.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LowPass {
    poles: usize,
    cutoff_hz: f64,
    sample_rate_hz: f64,
    passes: Passes,
    cutoff_at: CutoffAt,
    g: f64,
    pub(super) cascade: Cascade,
}

/// `2 sin((2 i + 1) pi / (2 n))`: the damping of pair `i` of an `n`-pole Butterworth filter, least damped first.
fn damping(poles: usize, i: usize) -> f64 {
    2.0 * ((2 * i + 1) as f64 * PI / (2 * poles) as f64).sin()
}

impl LowPass {
    /// Designs the filter.
    ///
    /// `poles` per pass in 1..=12; `cutoff_hz` in `[1e-9, 0.5)` times `sample_rate_hz`. With [`CutoffAt::Overall`]
    /// and two passes, the design frequency is raised so that `tan(pi fc'/fs) = tan(pi fc/fs) / C` with
    /// `C = (2^(1/P) - 1)^(1/(2N))`: exact at every cut-off, unlike the usual `fc / C`.
    ///
    /// # Errors
    /// [`Error::OutOfRange`] naming the argument.
    pub fn new(
        poles: usize,
        cutoff_hz: f64,
        sample_rate_hz: f64,
        passes: Passes,
        cutoff_at: CutoffAt,
    ) -> Result<Self, Error> {
        if !(1..=MAX_POLES).contains(&poles) {
            return Err(Error::OutOfRange {
                name: "poles",
                value: poles as f64,
                interval: format!("[1, {MAX_POLES}]"),
            });
        }
        require_positive("sample_rate_hz", sample_rate_hz)?;
        let ratio = cutoff_hz / sample_rate_hz;
        if !(MIN_CUTOFF_PER_RATE..0.5).contains(&ratio) {
            return Err(Error::OutOfRange {
                name: "cutoff_hz",
                value: cutoff_hz,
                interval: format!(
                    "[{MIN_CUTOFF_PER_RATE:e}, 0.5) times the sample rate of {sample_rate_hz} Hz"
                ),
            });
        }
        let mut g = (PI * ratio).tan();
        if (passes, cutoff_at) == (Passes::ForwardBackward, CutoffAt::Overall) {
            g /= (SQRT_2 - 1.0).powf(0.5 / poles as f64);
        }
        let n_pairs = poles / 2;
        let mut pairs = [Pair::default(); MAX_PAIRS];
        for (place, i) in pairs.iter_mut().zip((0..n_pairs).rev()) {
            *place = Pair::new(g, damping(poles, i));
        }
        Ok(Self {
            poles,
            cutoff_hz,
            sample_rate_hz,
            passes,
            cutoff_at,
            g,
            cascade: Cascade {
                single: (poles % 2 == 1).then(|| Single::new(g)),
                pairs,
                n_pairs,
            },
        })
    }

    /// Poles per pass.
    #[must_use]
    pub fn poles(&self) -> usize {
        self.poles
    }

    /// The cut-off as it was asked for.
    #[must_use]
    pub fn cutoff_hz(&self) -> f64 {
        self.cutoff_hz
    }

    /// Samples per second.
    #[must_use]
    pub fn sample_rate_hz(&self) -> f64 {
        self.sample_rate_hz
    }

    /// How often the filter runs.
    #[must_use]
    pub fn passes(&self) -> Passes {
        self.passes
    }

    /// Which -3.01 dB point the cut-off means.
    #[must_use]
    pub fn cutoff_at(&self) -> CutoffAt {
        self.cutoff_at
    }

    /// The -3.01 dB frequency of a single pass.
    #[must_use]
    pub fn designed_at_hz(&self) -> f64 {
        self.g.atan() / PI * self.sample_rate_hz
    }

    /// The magnitude after all passes at a frequency, from the Butterworth law `(1 + (tan/g)^(2N))^(-P/2)`.
    ///
    /// # Errors
    /// [`Error::OutOfRange`] unless `frequency_hz` is in `[0, sample_rate_hz / 2]`.
    pub fn magnitude(&self, frequency_hz: f64) -> Result<f64, Error> {
        let ratio = frequency_hz / self.sample_rate_hz;
        if !(0.0..=0.5).contains(&ratio) {
            return Err(Error::OutOfRange {
                name: "frequency_hz",
                value: frequency_hz,
                interval: format!("[0, {}]", 0.5 * self.sample_rate_hz),
            });
        }
        if ratio == 0.5 {
            return Ok(0.0); // tan has its pole there; in f64 it would return 1.6e16
        }
        let power = ((PI * ratio).tan() / self.g).powf(2.0 * self.poles as f64);
        Ok((1.0 + power).powf(-0.5 * f64::from(self.passes.count())))
    }

    /// Samples until the slowest pole has decayed to `tolerance`, at least one.
    ///
    /// # Errors
    /// [`Error::OutOfRange`] unless `tolerance` is in `(0, 1)`.
    pub fn settle_samples(&self, tolerance: f64) -> Result<usize, Error> {
        if !(tolerance > 0.0 && tolerance < 1.0) {
            return Err(Error::OutOfRange {
                name: "tolerance",
                value: tolerance,
                interval: "(0, 1)".into(),
            });
        }
        // A float-to-integer cast saturates; callers that allocate compare the result with a limit of theirs.
        Ok(((tolerance.ln() / self.ln_radius()).ceil() as usize).max(1))
    }

    /// Seconds until one part in a million of a step is left.
    #[must_use]
    pub fn settle_s(&self) -> f64 {
        SETTLED.ln() / self.ln_radius() / self.sample_rate_hz
    }

    /// How far a slow signal comes late after one pass forward; zero after both.
    #[must_use]
    pub fn delay_s(&self) -> f64 {
        match self.passes {
            Passes::Forward => self.cascade.lag() / self.sample_rate_hz,
            Passes::ForwardBackward => 0.0,
        }
    }

    /// The logarithm of the largest pole radius, without forming `1 - radius`.
    fn ln_radius(&self) -> f64 {
        let g = self.g;
        if self.poles == 1 {
            return (-2.0 * g.min(1.0) / (1.0 + g)).ln_1p();
        }
        let gk = g * damping(self.poles, 0);
        0.5 * (-2.0 * gk / (1.0 + gk + g * g)).ln_1p()
    }

    /// What the filter does, in words.
    #[must_use]
    pub fn describe(&self) -> String {
        let (n, cutoff) = (self.poles, significant(self.cutoff_hz));
        let poles = if n == 1 { "pole" } else { "poles" };
        let mut text = String::new();
        let done = match (self.passes, self.cutoff_at) {
            (Passes::Forward, _) => write!(
                text,
                "{n} {poles} forward, {n}-pole slope, -3.01 dB at {cutoff} Hz, causal, {} s late at low frequency",
                significant(self.delay_s())
            ),
            (Passes::ForwardBackward, CutoffAt::PerPass) => write!(
                text,
                "{n} {poles} forward and {n} backward, {}-pole slope, -3.01 dB at {cutoff} Hz per pass \
                 (-6.02 dB there overall), zero phase",
                2 * n
            ),
            (Passes::ForwardBackward, CutoffAt::Overall) => write!(
                text,
                "{n} {poles} forward and {n} backward, {}-pole slope, -3.01 dB at {cutoff} Hz overall \
                 (designed at {} Hz), zero phase",
                2 * n,
                significant(self.designed_at_hz())
            ),
        };
        debug_assert!(done.is_ok(), "writing to a String cannot fail");
        text + &format!(", settles in {:.2} s", self.settle_s())
    }
}

/// Four significant digits, never in powers of ten above one.
fn significant(value: f64) -> String {
    let decimals = if value > 0.0 {
        (3.0 - value.log10().floor()).clamp(0.0, 15.0)
    } else {
        0.0
    };
    format!("{value:.*}", decimals as usize)
}

#[cfg(test)]
mod tests {
    use super::{CutoffAt, LowPass, Passes};

    fn tb038() -> LowPass {
        LowPass::new(2, 6.0, 1000.0, Passes::ForwardBackward, CutoffAt::Overall).expect("valid")
    }

    #[test]
    fn the_words_state_poles_passes_and_the_point_meant() {
        assert_eq!(
            tb038().describe(),
            "2 poles forward and 2 backward, 4-pole slope, -3.01 dB at 6.000 Hz overall (designed at 7.479 Hz), \
             zero phase, settles in 0.42 s"
        );
    }

    #[test]
    fn overall_cutoff_is_minus_three_decibel_after_both_passes() {
        let magnitude = tb038().magnitude(6.0).expect("inside");
        // one tangent, one power: a few roundings
        assert!((magnitude - 0.5_f64.sqrt()).abs() < 8.0 * f64::EPSILON);
    }

    #[test]
    fn four_poles_settle_in_5_75_periods_of_the_cutoff() {
        let four = LowPass::new(4, 6.0, 1000.0, Passes::Forward, CutoffAt::PerPass).expect("valid");
        assert_eq!(four.settle_samples(1e-6).expect("valid"), 958);
    }
}
