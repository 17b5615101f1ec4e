//! The design of Butterworth filters, straight from `tan(pi fc / fs)` and the dampings.
//!
//! No pole or polynomial in `z` is formed: there the coefficients crowd at `z = 1` and lose `eps / (fc/fs)^2`, here
//! only `eps / (fc/fs)`.

use std::f64::consts::{PI, SQRT_2};

use nalgebra::Complex;

use super::cascade::Cascade;
use super::matrix::MAX_POLES as ROOM;
use super::section::{HIGH, LOW, Mix, Section};
use crate::error::{Error, require_positive};

/// The most poles per pass; each further pair adds ringing and no measurement standard asks for more.
pub const MAX_POLES: usize = ROOM;

/// The lowest cut-off per sample rate: the error law `eps / (fc/fs)` leaves seven digits there.
pub const MIN_CUTOFF_PER_RATE: f64 = 1e-9;

/// What "settled" means in words: one part in a million of a step is left.
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

/// What passes, with the -3.01 dB points in hertz.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Band {
    /// Everything below.
    Low {
        /// The upper end.
        cutoff_hz: f64,
    },
    /// Everything above.
    High {
        /// The lower end.
        cutoff_hz: f64,
    },
    /// Everything between.
    Pass {
        /// The lower end.
        low_hz: f64,
        /// The upper end.
        high_hz: f64,
    },
    /// Everything but what is between.
    Stop {
        /// The lower end.
        low_hz: f64,
        /// The upper end.
        high_hz: f64,
    },
}

impl Band {
    /// The gain of a constant.
    fn level_gain(self) -> f64 {
        match self {
            Self::Low { .. } | Self::Stop { .. } => 1.0,
            Self::High { .. } | Self::Pass { .. } => 0.0,
        }
    }
}

/// A Butterworth filter: the coefficients and what they were made from, without any memory.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Butterworth {
    poles: usize,
    band: Band,
    sample_rate_hz: f64,
    passes: Passes,
    cutoff_at: CutoffAt,
    /// `tan(pi f / fs)` of the cut-off of a single pass, or of the middle of the band.
    g: f64,
    /// The width of the band of a single pass over its middle, in the same tangents.
    width: f64,
    pub(super) cascade: Cascade,
}

/// `2 sin((2 i + 1) pi / (2 n))`: the damping of pair `i` of an `n`-pole Butterworth filter, least damped first.
fn damping(poles: usize, i: usize) -> f64 {
    2.0 * ((2 * i + 1) as f64 * PI / (2 * poles) as f64).sin()
}

impl Butterworth {
    /// Designs the filter.
    ///
    /// `poles` per pass in 1..=12, an even number for a band; the edges in `[1e-9, 0.5)` times `sample_rate_hz`. With
    /// [`CutoffAt::Overall`] and two passes the design is moved in the prototype's frequency by
    /// `C = (2^(1/P) - 1)^(1/(2N))`, `N` the prototype's poles: `tan(pi fc'/fs) = tan(pi fc/fs) / C` for the low pass,
    /// times `C` for the high pass, and the width of a band likewise. That is exact at every cut-off, unlike the usual
    /// `fc / C`.
    ///
    /// # Errors
    /// [`Error::OutOfRange`] naming the argument.
    pub fn new(
        poles: usize,
        band: Band,
        sample_rate_hz: f64,
        passes: Passes,
        cutoff_at: CutoffAt,
    ) -> Result<Self, Error> {
        let two_sided = matches!(band, Band::Pass { .. } | Band::Stop { .. });
        if !(1..=MAX_POLES).contains(&poles) || (two_sided && poles % 2 == 1) {
            return Err(Error::OutOfRange {
                name: "poles",
                value: poles as f64,
                interval: if two_sided {
                    format!("{{2, 4, ..., {MAX_POLES}}}: half of them shape each side of the band")
                } else {
                    format!("[1, {MAX_POLES}]")
                },
            });
        }
        require_positive("sample_rate_hz", sample_rate_hz)?;
        let tangent = |name, hertz: f64| {
            let ratio = hertz / sample_rate_hz;
            if (MIN_CUTOFF_PER_RATE..0.5).contains(&ratio) {
                return Ok((PI * ratio).tan());
            }
            Err(Error::OutOfRange {
                name,
                value: hertz,
                interval: format!(
                    "[{MIN_CUTOFF_PER_RATE:e}, 0.5) times the sample rate of {sample_rate_hz} Hz"
                ),
            })
        };
        let prototype = if two_sided { poles / 2 } else { poles };
        let shift = match (passes, cutoff_at) {
            (Passes::ForwardBackward, CutoffAt::Overall) => {
                (SQRT_2 - 1.0).powf(0.5 / prototype as f64)
            }
            _ => 1.0,
        };
        let (g, width) = match band {
            Band::Low { cutoff_hz } => (tangent("cutoff_hz", cutoff_hz)? / shift, 0.0),
            Band::High { cutoff_hz } => (tangent("cutoff_hz", cutoff_hz)? * shift, 0.0),
            Band::Pass { low_hz, high_hz } | Band::Stop { low_hz, high_hz } => {
                let (low, high) = (tangent("low_hz", low_hz)?, tangent("high_hz", high_hz)?);
                if low_hz >= high_hz {
                    return Err(Error::OutOfRange {
                        name: "high_hz",
                        value: high_hz,
                        interval: format!("({low_hz}, {})", 0.5 * sample_rate_hz),
                    });
                }
                let middle = (low * high).sqrt();
                // tan a - tan b = sin(a - b) / (cos a cos b): no cancellation for a narrow band
                let per_hertz = PI / sample_rate_hz;
                let apart = ((high_hz - low_hz) * per_hertz).sin()
                    / ((high_hz * per_hertz).cos() * (low_hz * per_hertz).cos());
                let width = apart / middle;
                let narrower = matches!(band, Band::Stop { .. });
                (
                    middle,
                    if narrower {
                        width * shift
                    } else {
                        width / shift
                    },
                )
            }
        };
        let list: Vec<Section> = match band {
            Band::Low { .. } => one_sided(poles, g, false),
            Band::High { .. } => one_sided(poles, g, true),
            Band::Pass { .. } => two_sided_sections(prototype, g, width, false),
            Band::Stop { .. } => two_sided_sections(prototype, g, width, true),
        };
        Ok(Self {
            poles,
            band,
            sample_rate_hz,
            passes,
            cutoff_at,
            g,
            width,
            cascade: Cascade::new(list, band.level_gain()),
        })
    }

    /// Poles per pass.
    #[must_use]
    pub fn poles(&self) -> usize {
        self.poles
    }

    /// What passes, as it was asked for.
    #[must_use]
    pub fn band(&self) -> Band {
        self.band
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

    /// The -3.01 dB frequencies of a single pass: one, or both ends of the band.
    #[must_use]
    pub fn designed_at_hz(&self) -> Vec<f64> {
        let hertz = |tangent: f64| tangent.atan() / PI * self.sample_rate_hz;
        match self.band {
            Band::Low { .. } | Band::High { .. } => vec![hertz(self.g)],
            Band::Pass { .. } | Band::Stop { .. } => {
                let half = 0.5 * self.width;
                let upper = half + half.hypot(1.0);
                vec![hertz(self.g / upper), hertz(self.g * upper)]
            }
        }
    }

    /// The magnitude after all passes at a frequency, from the Butterworth law `(1 + W^(2N))^(-P/2)`.
    ///
    /// # Errors
    /// [`Error::OutOfRange`] unless `frequency_hz` is in `[0, sample_rate_hz / 2]`.
    pub fn magnitude(&self, frequency_hz: f64) -> Result<f64, Error> {
        let t = self.tangent(frequency_hz)?;
        let u = t / self.g;
        // The prototype's frequency; the ends of the axis are where a quotient has no value.
        let (prototype, frequency) = match self.band {
            Band::Low { .. } => (self.poles, u),
            Band::High { .. } => (self.poles, 1.0 / u),
            Band::Pass { .. } => (self.poles / 2, (u - 1.0 / u) / self.width),
            Band::Stop { .. } => (self.poles / 2, self.width / (u - 1.0 / u)),
        };
        let power = (frequency * frequency).powi(i32::try_from(prototype).unwrap_or(i32::MAX));
        Ok((1.0 + power).powf(-0.5 * f64::from(self.passes.count())))
    }

    /// The response of all passes at a frequency: complex for one pass, real and positive for both.
    ///
    /// # Errors
    /// As [`Self::magnitude`].
    pub fn response(&self, frequency_hz: f64) -> Result<[f64; 2], Error> {
        let t = self.tangent(frequency_hz)?;
        if self.passes == Passes::ForwardBackward || t.is_infinite() {
            return Ok([self.magnitude(frequency_hz)?, 0.0]);
        }
        let all = self.cascade.sections().iter().map(|s| s.response(t));
        let response: Complex<f64> = all.product();
        Ok([response.re, response.im])
    }

    /// `tan(pi f / fs)`, infinite at half the sample rate.
    fn tangent(&self, frequency_hz: f64) -> Result<f64, Error> {
        let ratio = frequency_hz / self.sample_rate_hz;
        if !(0.0..=0.5).contains(&ratio) {
            return Err(Error::OutOfRange {
                name: "frequency_hz",
                value: frequency_hz,
                interval: format!("[0, {}]", 0.5 * self.sample_rate_hz),
            });
        }
        // tan has its pole there; in f64 it would return 1.6e16
        Ok(if ratio == 0.5 {
            f64::INFINITY
        } else {
            (PI * ratio).tan()
        })
    }

    /// Samples until the slowest pole has decayed to `tolerance`, at least one.
    ///
    /// # Errors
    /// [`Error::OutOfRange`] unless `tolerance` is in `(0, 1)`.
    pub fn settle_samples(&self, tolerance: f64) -> Result<usize, Error> {
        require_tolerance(tolerance)?;
        Ok(self.cascade.settle_samples(tolerance))
    }

    /// Seconds until one part in a million of a step is left.
    #[must_use]
    pub fn settle_s(&self) -> f64 {
        SETTLED.ln() / self.cascade.ln_radius() / self.sample_rate_hz
    }

    /// How far the middle of the pass band comes late after one pass forward; zero after both.
    ///
    /// The middle is zero frequency for the low pass and the band stop, half the sample rate for the high pass.
    #[must_use]
    pub fn delay_s(&self) -> f64 {
        let samples = match (self.passes, self.band) {
            (Passes::ForwardBackward, _) => 0.0,
            (_, Band::Low { .. } | Band::Stop { .. }) => self.cascade.lag(),
            // The mirror image in frequency, g -> 1/g, is a low pass with the same lag.
            (_, Band::High { .. }) => one_sided_lag(self.poles, 1.0 / self.g),
            // The prototype's lag at zero frequency, 1/w in its own frequency, through the slope of the transformation.
            (_, Band::Pass { .. }) => {
                let prototype = 2.0 * one_sided_lag(self.poles / 2, 1.0);
                prototype * (1.0 + self.g * self.g) / (2.0 * self.g * self.width) * 2.0
            }
        };
        samples / self.sample_rate_hz
    }
}

/// Refuses a tolerance that is no share of a signal.
///
/// # Errors
/// [`Error::OutOfRange`] unless in (0, 1).
pub(super) fn require_tolerance(tolerance: f64) -> Result<(), Error> {
    if tolerance > 0.0 && tolerance < 1.0 {
        return Ok(());
    }
    Err(Error::OutOfRange {
        name: "tolerance",
        value: tolerance,
        interval: "(0, 1)".into(),
    })
}

/// The lag at zero frequency of a low pass: half the sum of its dampings over `g`, in samples.
fn one_sided_lag(poles: usize, g: f64) -> f64 {
    let pairs: f64 = (0..poles / 2).map(|i| damping(poles, i)).sum();
    (pairs + f64::from(u8::from(poles % 2 == 1))) / (2.0 * g)
}

/// Low or high pass: the real pole, then the pairs from the most damped to the least.
fn one_sided(poles: usize, g: f64, high: bool) -> Vec<Section> {
    let single = (poles % 2 == 1).then_some(Section::Single { g, high });
    let mix = if high { HIGH } else { LOW };
    let pairs = (0..poles / 2).rev().map(|i| Section::Pair {
        g,
        k: damping(poles, i),
        mix,
    });
    single.into_iter().chain(pairs).collect()
}

/// Band pass or band stop: each pole of the prototype becomes two by `s -> (s + 1/s) / width` or its reciprocal.
fn two_sided_sections(prototype: usize, g: f64, width: f64, stop: bool) -> Vec<Section> {
    let pair = |natural: f64, k: f64| {
        let mix = if stop {
            Mix {
                low: 1.0 / (natural * natural),
                band: 0.0,
                high: 1.0,
            }
        } else {
            Mix {
                low: 0.0,
                band: width / natural,
                high: 0.0,
            }
        };
        Section::Pair {
            g: g * natural,
            k,
            mix,
        }
    };
    let mut list = Vec::new();
    if prototype % 2 == 1 {
        list.push(pair(1.0, width));
    }
    for i in (0..prototype / 2).rev() {
        // Half of width times the pole -k/2 + i sqrt(1 - k^2/4), then the root s of s^2 - 2 h s + 1.
        let half_k = 0.5 * damping(prototype, i);
        let (re, im) = (
            -0.5 * width * half_k,
            0.5 * width * (1.0 - half_k * half_k).sqrt(),
        );
        let root = Complex::new(re * re - im * im - 1.0, 2.0 * re * im).sqrt();
        // Of the two, 1/s and s, the one whose parts add up without cancellation.
        let (a, b) = (Complex::new(re, im) + root, Complex::new(re, im) - root);
        let s = if a.norm_sqr() >= b.norm_sqr() { a } else { b };
        let natural = s.norm();
        let k = -2.0 * s.re / natural;
        list.push(pair(natural, k));
        list.push(pair(1.0 / natural, k));
    }
    list
}
