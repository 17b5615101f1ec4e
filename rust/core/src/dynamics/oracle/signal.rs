//! A drive that is known at every instant: cubics between breaks, and sinusoids.

use crate::Error;
use crate::error::{require_finite, require_positive};

use super::series::{ORDER, Series};

/// An instant with twice the digits: what is lost when a step is added to a time is kept.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Instant {
    /// The nearest double.
    pub hi: f64,
    /// What it lacks.
    pub lo: f64,
}

impl Instant {
    pub fn at(time_s: f64) -> Self {
        Self {
            hi: time_s,
            lo: 0.0,
        }
    }

    /// This instant and some seconds.
    pub fn after(self, seconds: f64) -> Self {
        // Knuth's exact sum.
        let hi = self.hi + seconds;
        let back = hi - self.hi;
        let lost = (self.hi - (hi - back)) + (seconds - back) + self.lo;
        let sum = hi + lost;
        Self {
            hi: sum,
            lo: lost - (sum - hi),
        }
    }

    /// Seconds until a time.
    pub fn until(self, time_s: f64) -> f64 {
        (time_s - self.hi) - self.lo
    }
}

/// One sinusoid: `amplitude * sin(frequency_rad_s * t + phase_rad)`.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Sine {
    amplitude: f64,
    frequency_rad_s: f64,
    phase_rad: f64,
}

/// A drive that is known at every instant.
#[derive(Debug, Clone, PartialEq)]
pub struct Signal {
    /// Where each cubic begins; the first holds before, the last after.
    breaks_s: Vec<f64>,
    /// Coefficients of 1, tau, tau^2, tau^3, tau the seconds since the cubic's break.
    cubics: Vec<[f64; 4]>,
    sines: Vec<Sine>,
}

impl Signal {
    /// Cubics between breaks and sinusoids (amplitude, circular frequency, phase), added.
    ///
    /// # Errors
    /// [`Error::Length`] without a cubic or where breaks and cubics differ in number, [`Error::NonFinite`],
    /// [`Error::OutOfRange`] for breaks that do not increase and frequencies below 0.
    pub fn new(breaks_s: &[f64], cubics: &[[f64; 4]], sines: &[[f64; 3]]) -> Result<Self, Error> {
        require_finite("breaks_s", breaks_s)?;
        require_finite("coefficients", cubics.as_flattened())?;
        require_finite("sines", sines.as_flattened())?;
        if cubics.is_empty() || breaks_s.len() != cubics.len() {
            return Err(Error::Length {
                name: "breaks_s",
                expected: format!("{}, one per cubic and at least 1,", cubics.len()),
                got: breaks_s.len(),
            });
        }
        if let Some(pair) = breaks_s.windows(2).find(|pair| pair[1] <= pair[0]) {
            return Err(Error::OutOfRange {
                name: "breaks_s",
                value: pair[1],
                interval: format!("({}, inf): breaks increase", pair[0]),
            });
        }
        if let Some(sine) = sines.iter().find(|sine| sine[1] < 0.0) {
            return Err(Error::OutOfRange {
                name: "frequency_rad_s",
                value: sine[1],
                interval: "[0, inf)".to_owned(),
            });
        }
        Ok(Self {
            breaks_s: breaks_s.to_vec(),
            cubics: cubics.to_vec(),
            sines: sines
                .iter()
                .map(|&[amplitude, frequency_rad_s, phase_rad]| Sine {
                    amplitude,
                    frequency_rad_s,
                    phase_rad,
                })
                .collect(),
        })
    }

    /// The same value at all times.
    #[must_use]
    pub fn constant(value: f64) -> Self {
        Self {
            breaks_s: vec![0.0],
            cubics: vec![[value, 0.0, 0.0, 0.0]],
            sines: Vec::new(),
        }
    }

    /// Even samples from the time 0 on; between them runs the cubic through the four nearest, as in [`super::super::Drive`].
    ///
    /// # Errors
    /// [`Error::Length`] below two samples, [`Error::NonFinite`], [`Error::OutOfRange`] for a rate that is not positive.
    pub fn samples(values: &[f64], sample_rate_hz: f64) -> Result<Self, Error> {
        require_positive("sample_rate_hz", sample_rate_hz)?;
        if values.len() < 2 {
            return Err(Error::Length {
                name: "values",
                expected: "at least 2".to_owned(),
                got: values.len(),
            });
        }
        require_finite("values", values)?;
        let last = values.len() - 1;
        let cubic = |i: usize| {
            let (b, c) = (values[i], values[i + 1]);
            // At the ends the parabola through the three nearest samples gives the missing neighbour.
            let a = match (i, last) {
                (0, 1) => 2.0 * b - c,
                (0, _) => 3.0 * b - 3.0 * c + values[2],
                _ => values[i - 1],
            };
            let d = match (i + 1 == last, last) {
                (true, 1) => 2.0 * c - b,
                (true, _) => 3.0 * c - 3.0 * b + values[i - 1],
                (false, _) => values[i + 2],
            };
            let r = sample_rate_hz;
            [
                b,
                (c - a / 3.0 - b / 2.0 - d / 6.0) * r,
                (0.5 * a + 0.5 * c - b) * r * r,
                ((d - a) / 6.0 + (b - c) / 2.0) * r * r * r,
            ]
        };
        Ok(Self {
            breaks_s: (0..last).map(|i| i as f64 / sample_rate_hz).collect(),
            cubics: (0..last).map(cubic).collect(),
            sines: Vec::new(),
        })
    }

    /// The cubics' coefficients of 1, tau, tau^2, tau^3.
    #[must_use]
    pub fn cubics(&self) -> &[[f64; 4]] {
        &self.cubics
    }

    /// The highest circular frequency in it.
    pub(super) fn highest_rad_s(&self) -> f64 {
        self.sines
            .iter()
            .filter(|sine| sine.amplitude != 0.0)
            .fold(0.0, |most, sine| sine.frequency_rad_s.max(most))
    }

    /// The first break after an instant.
    pub(super) fn next_break(&self, now: Instant) -> Option<f64> {
        let passed = self.breaks_s.partition_point(|&b| now.until(b) <= 0.0);
        // The first cubic holds before its break as well.
        self.breaks_s.get(passed.max(1)).copied()
    }

    /// Its power series at an instant.
    pub(super) fn series(&self, now: Instant) -> Series {
        let mut out = Series::ZERO;
        let segment = self.breaks_s.partition_point(|&b| now.until(b) <= 0.0);
        let segment = segment.saturating_sub(1);
        let t = -now.until(self.breaks_s[segment]);
        let c = self.cubics[segment];
        out.add(0, &[c[0], c[1] * t, c[2] * t * t, c[3] * t * t * t]);
        out.add(1, &[c[1], 2.0 * c[2] * t, 3.0 * c[3] * t * t]);
        out.add(2, &[c[2], 3.0 * c[3] * t]);
        out.add(3, &[c[3]]);
        for sine in &self.sines {
            let w = sine.frequency_rad_s;
            let product = w * now.hi;
            // What the product lost, and the digits that the instant keeps.
            let rest = w.mul_add(now.hi, -product) + w * now.lo + sine.phase_rad;
            let (s, c) = (product + rest).sin_cos();
            let lost = rest - ((product + rest) - product);
            let (s, c) = (s + c * lost, c - s * lost);
            let mut factor = sine.amplitude;
            for (k, turned) in [s, c, -s, -c]
                .into_iter()
                .cycle()
                .take(ORDER + 1)
                .enumerate()
            {
                out.value[k] += factor * turned;
                out.size[k] += factor.abs();
                factor *= w / (k + 1) as f64;
            }
        }
        out
    }
}

#[cfg(test)]
mod tests {
    use super::super::super::Drive;
    use super::*;

    fn at(signal: &Signal, time_s: f64) -> f64 {
        signal.series(Instant::at(time_s)).value[0]
    }

    #[test]
    fn samples_are_joined_as_the_kernels_join_them() {
        let values: Vec<f64> = (0..9).map(|i| (f64::from(i) * 0.7).sin()).collect();
        for count in [2, 3, 9] {
            let drive = Drive::new(&values[..count], None, 8.0, 1).expect("a fine record");
            let signal = Signal::samples(&values[..count], 8.0).expect("a fine record");
            for i in 0..count - 1 {
                let (middle, _) = drive.span(i).middle();
                let (end, _) = drive.span(i).end();
                let here = i as f64 / 8.0;
                assert!((at(&signal, here + 1.0 / 16.0) - middle.0).abs() < 1e-15);
                assert!((at(&signal, here + 1.0 / 8.0) - end.0).abs() < 1e-15);
            }
        }
    }

    #[test]
    fn the_series_is_that_of_the_function() {
        let signal = Signal::new(
            &[0.0, 1.0],
            &[[1.0, 2.0, 0.0, 0.0], [3.0, 0.5, -0.7, 0.2]],
            &[[0.4, 3.0, 0.9]],
        )
        .expect("a fine signal");
        let exact = |t: f64| {
            let u = t - 1.0;
            3.0 + 0.5 * u - 0.7 * u * u + 0.2 * u * u * u + 0.4 * (3.0 * t + 0.9).sin()
        };
        let series = signal.series(Instant::at(1.3));
        for step in [0.0, 0.1, 0.3] {
            assert!((series.at(step) - exact(1.3 + step)).abs() < 1e-15);
        }
        assert_eq!(signal.next_break(Instant::at(-2.0)), Some(1.0));
        assert_eq!(signal.next_break(Instant::at(1.0)), None);
    }

    #[test]
    fn an_instant_keeps_what_a_sum_loses() {
        let mut now = Instant::at(4096.0);
        for _ in 0..1000 {
            now = now.after(1e-13);
        }
        assert!((now.until(4096.0) + 1e-10).abs() < 1e-24);
    }
}
