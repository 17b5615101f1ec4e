//! What drives a body: sampled channels, refined to the middles and ends of the sub-steps.

use crate::Error;
use crate::error::{require_finite, require_positive, require_same_length};

use super::number::Pure;

/// The drive of one record: handwheel angle and road-wheel load at every half sub-step.
///
/// Between the samples runs the cubic through the four nearest ones (Lagrange); its error is of fourth order in the
/// sampling interval.
#[derive(Debug, Clone)]
pub struct Drive {
    /// Handwheel angle, rad.
    handwheel: Vec<f64>,
    /// Torque on the road wheel, Nm; empty where there is none.
    load: Vec<f64>,
    /// Samples of the record.
    samples: usize,
    /// Sub-steps per sampling interval.
    substeps: usize,
    /// Seconds of one sub-step.
    step_s: f64,
}

/// Sub-steps of a record: both channels refined are 4 GiB.
pub(crate) const MOST_STEPS: usize = 1 << 27;

/// One channel over one sub-step: at its start, middle and end.
#[derive(Debug, Clone, Copy)]
pub(super) struct Parabola {
    pub start: Pure,
    pub middle: Pure,
    pub end: Pure,
}

/// The drive over one sub-step.
#[derive(Debug, Clone, Copy)]
pub(super) struct Span {
    pub psi: Parabola,
    pub load: Parabola,
}

impl Span {
    /// Angle and load at a share of the sub-step, by the parabola through its three values.
    #[inline(always)]
    pub fn at(&self, share: Pure) -> (Pure, Pure) {
        (self.psi.at(share), self.load.at(share))
    }

    /// Angle and load at the start.
    #[inline(always)]
    pub fn start(&self) -> (Pure, Pure) {
        (self.psi.start, self.load.start)
    }

    /// Angle and load in the middle.
    #[inline(always)]
    pub fn middle(&self) -> (Pure, Pure) {
        (self.psi.middle, self.load.middle)
    }

    /// Angle and load at the end.
    #[inline(always)]
    pub fn end(&self) -> (Pure, Pure) {
        (self.psi.end, self.load.end)
    }
}

impl Parabola {
    const ZERO: Self = Self {
        start: Pure::ZERO,
        middle: Pure::ZERO,
        end: Pure::ZERO,
    };

    #[inline(always)]
    fn at(&self, share: Pure) -> Pure {
        let slope = self.middle * Pure(4.0) - self.start * Pure(3.0) - self.end;
        let bend = (self.start - self.middle * Pure(2.0) + self.end) * Pure(2.0);
        self.start + share * (slope + share * bend)
    }
}

impl Drive {
    /// Refines a record.
    ///
    /// # Errors
    /// [`Error::Length`] below two samples or where the channels differ in length, [`Error::NonFinite`] for NaN and
    /// infinities, [`Error::OutOfRange`] for a rate or a number of sub-steps that is not positive.
    pub fn new(
        handwheel_rad: &[f64],
        load_nm: Option<&[f64]>,
        sample_rate_hz: f64,
        substeps: usize,
    ) -> Result<Self, Error> {
        require_positive("sample_rate_hz", sample_rate_hz)?;
        let refinement = Refinement::new(substeps)?;
        if handwheel_rad.len().saturating_mul(substeps) > MOST_STEPS {
            return Err(Error::OutOfRange {
                name: "substeps",
                value: substeps as f64,
                interval: format!(
                    "[1, {}] for a record of {} samples",
                    (MOST_STEPS / handwheel_rad.len()).max(1),
                    handwheel_rad.len()
                ),
            });
        }
        if handwheel_rad.len() < 2 {
            return Err(Error::Length {
                name: "handwheel_rad",
                expected: "at least 2".to_owned(),
                got: handwheel_rad.len(),
            });
        }
        require_finite("handwheel_rad", handwheel_rad)?;
        if let Some(load) = load_nm {
            require_same_length("load_nm", load, "handwheel_rad", handwheel_rad.len())?;
            require_finite("load_nm", load)?;
        }
        Ok(Self {
            handwheel: refinement.refine(handwheel_rad),
            load: load_nm.map_or_else(Vec::new, |load| refinement.refine(load)),
            samples: handwheel_rad.len(),
            substeps,
            step_s: 1.0 / (sample_rate_hz * substeps as f64),
        })
    }

    /// Samples of the record.
    #[must_use]
    pub fn samples(&self) -> usize {
        self.samples
    }

    /// Sub-steps per sampling interval.
    #[must_use]
    pub fn substeps(&self) -> usize {
        self.substeps
    }

    /// Seconds of one sub-step.
    #[must_use]
    pub fn step_s(&self) -> f64 {
        self.step_s
    }

    /// The largest handwheel angle on either side, rad.
    #[must_use]
    pub fn reach_rad(&self) -> f64 {
        self.handwheel.iter().fold(0.0, |most, v| v.abs().max(most))
    }

    /// The sub-step of a number.
    #[inline(always)]
    pub(super) fn span(&self, step: usize) -> Span {
        let three = |of: &[f64]| {
            let here = &of[2 * step..2 * step + 3];
            Parabola {
                start: Pure(here[0]),
                middle: Pure(here[1]),
                end: Pure(here[2]),
            }
        };
        Span {
            psi: three(&self.handwheel),
            load: if self.load.is_empty() {
                Parabola::ZERO
            } else {
                three(&self.load)
            },
        }
    }
}

/// The cubic through the four nearest samples at the starts, middles and ends of the sub-steps of an interval.
#[derive(Debug, Clone)]
pub(crate) struct Refinement {
    /// Lagrange's weights of the four samples at every half sub-step.
    weights: Vec<[f64; 4]>,
}

impl Refinement {
    /// For so many sub-steps per interval.
    pub fn new(substeps: usize) -> Result<Self, Error> {
        if substeps == 0 {
            return Err(Error::OutOfRange {
                name: "substeps",
                value: 0.0,
                interval: "[1, inf)".to_owned(),
            });
        }
        let parts = 2 * substeps;
        let weights = (0..parts)
            .map(|k| {
                let t = k as f64 / parts as f64;
                [
                    -t * (t - 1.0) * (t - 2.0) / 6.0,
                    (t * t - 1.0) * (t - 2.0) / 2.0,
                    -t * (t + 1.0) * (t - 2.0) / 2.0,
                    t * (t * t - 1.0) / 6.0,
                ]
            })
            .collect();
        Ok(Self { weights })
    }

    /// Sub-steps per interval.
    pub fn substeps(&self) -> usize {
        self.weights.len() / 2
    }

    /// The four samples at -1, 0, 1 and 2 of an interval; at the ends of the record the parabola through the three
    /// nearest samples gives the missing one.
    pub fn around(samples: &[f64], interval: usize) -> [f64; 4] {
        let last = samples.len() - 1;
        let (b, c) = (samples[interval], samples[interval + 1]);
        let a = if interval > 0 {
            samples[interval - 1]
        } else if last > 1 {
            3.0 * b - 3.0 * c + samples[2]
        } else {
            2.0 * b - c
        };
        let d = if interval + 2 <= last {
            samples[interval + 2]
        } else if last > 1 {
            3.0 * c - 3.0 * b + samples[interval - 1]
        } else {
            2.0 * c - b
        };
        [a, b, c, d]
    }

    /// The value at a half sub-step, the sample itself at the start of the interval.
    fn value(&self, [a, b, c, d]: [f64; 4], part: usize) -> f64 {
        if part == 0 {
            return b;
        }
        let [p, q, r, s] = self.weights[part];
        p * a + q * b + r * c + s * d
    }

    /// The weights at the middle and the end of a sub-step; none at the end of the interval, which is a sample.
    #[inline(always)]
    pub fn half_steps(&self, sub: usize) -> [Option<[f64; 4]>; 2] {
        [2 * sub + 1, 2 * sub + 2].map(|part| self.weights.get(part).copied())
    }

    /// All values of a record and its last sample.
    pub fn refine(&self, samples: &[f64]) -> Vec<f64> {
        let (last, parts) = (samples.len() - 1, self.weights.len());
        let mut out = Vec::with_capacity(last * parts + 1);
        for interval in 0..last {
            let around = Self::around(samples, interval);
            out.extend((0..parts).map(|part| self.value(around, part)));
        }
        out.push(samples[last]);
        out
    }
}

#[cfg(test)]
mod tests {
    use super::Refinement;

    #[test]
    fn a_cubic_passes_through_the_refinement() {
        let f = |t: f64| 0.3 - 1.2 * t + 0.7 * t * t - 0.05 * t * t * t;
        let samples: Vec<f64> = (0..12).map(|i| f(f64::from(i))).collect();
        let fine = Refinement::new(2).unwrap().refine(&samples);
        assert_eq!(fine.len(), 45);
        // The first and the last interval lean on a parabola.
        for (i, value) in fine.iter().enumerate().skip(4).take(36) {
            assert!((value - f(i as f64 / 4.0)).abs() < 1e-12, "{i}");
        }
    }
}
