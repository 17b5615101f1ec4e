//! What drives a mechanism: angles of driven nodes and loads on bodies, sampled, refined to the sub-steps.

use crate::Error;
use crate::dynamics::{MOST_STEPS, Refinement};
use crate::error::require_positive;

use super::network::Network;

/// The channels of one record, in the order driven nodes, loads; between the samples run cubics.
#[derive(Debug, Clone)]
pub struct Channels {
    rows: Vec<Vec<f64>>,
    samples: usize,
    substeps: usize,
    step_s: f64,
}

/// One channel over one sub-step: at its start, middle and end.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Parabola {
    pub start: f64,
    pub middle: f64,
    pub end: f64,
    /// Third derivative, per sub-step cubed: what a parabola does not know of its neighbours.
    pub third: f64,
}

impl Parabola {
    fn first(self) -> f64 {
        self.middle * 4.0 - self.start * 3.0 - self.end
    }

    fn second(self) -> f64 {
        (self.start - self.middle * 2.0 + self.end) * 2.0
    }

    /// Value at a share of the sub-step.
    pub fn at(self, share: f64) -> f64 {
        self.start + share * (self.first() + share * self.second())
    }

    /// Derivative there, per sub-step.
    pub fn slope(self, share: f64) -> f64 {
        self.first() + 2.0 * share * self.second()
    }

    /// Second derivative there, per sub-step squared: that of the parabola in the middle, and its change to either side.
    pub fn bend(self, share: f64) -> f64 {
        2.0 * self.second() + self.third * (share - 0.5)
    }
}

impl Channels {
    /// Refines a record: one row of samples per channel of the network.
    ///
    /// # Errors
    /// [`Error::Mechanism`] names the channel and the sample that is not finite; [`Error::Length`] where rows are
    /// missing, differ in length or have fewer than two samples; [`Error::OutOfRange`] for a rate or a number of
    /// sub-steps that is not positive.
    pub fn new(
        network: &Network,
        rows: &[&[f64]],
        samples: usize,
        sample_rate_hz: f64,
        substeps: usize,
    ) -> Result<Self, Error> {
        require_positive("sample_rate_hz", sample_rate_hz)?;
        let refinement = Refinement::new(substeps)?;
        if samples.saturating_mul(substeps) > MOST_STEPS {
            return Err(Error::OutOfRange {
                name: "substeps",
                value: substeps as f64,
                interval: format!(
                    "[1, {}] for a record of {samples} samples",
                    (MOST_STEPS / samples.max(1)).max(1)
                ),
            });
        }
        let length = |expected: String, got| {
            Err(Error::Length {
                name: "channels",
                expected,
                got,
            })
        };
        if samples < 2 {
            return length("at least 2 samples".to_owned(), samples);
        }
        if rows.len() != network.channels() {
            return length(format!("{} rows", network.channels()), rows.len());
        }
        let loads = network.loads().iter().map(|(name, _)| name);
        for (row, name) in rows.iter().zip(network.driven().iter().chain(loads)) {
            if row.len() != samples {
                return length(format!("{samples} samples each"), row.len());
            }
            require_finite(name, row)?;
        }
        Ok(Self {
            rows: rows.iter().map(|row| refinement.refine(row)).collect(),
            samples,
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

    /// Writes the sub-step of a number.
    pub(super) fn read(&self, step: usize, out: &mut [Parabola]) {
        for (row, out) in self.rows.iter().zip(out) {
            let here = &row[2 * step..2 * step + 3];
            // Four values half a sub-step apart, the fourth from the next sub-step or, in the last one, the one before.
            let beyond = row
                .get(2 * step + 3)
                .map(|next| [here[0], here[1], here[2], *next]);
            let before = || (step > 0).then(|| [row[2 * step - 1], here[0], here[1], here[2]]);
            let third = beyond
                .or_else(before)
                .map_or(0.0, |[a, b, c, d]| 8.0 * ((d - a) - 3.0 * (c - b)));
            *out = Parabola {
                start: here[0],
                middle: here[1],
                end: here[2],
                third,
            };
        }
    }
}

/// Refuses a channel with NaN or infinities, naming it and the sample.
pub(super) fn require_finite(name: &str, row: &[f64]) -> Result<(), Error> {
    match row.iter().position(|v| !v.is_finite()) {
        None => Ok(()),
        Some(index) => Err(Error::Mechanism {
            place: name.to_owned(),
            problem: format!("the drive holds {} at sample {index}", row[index]),
            remedy: "Remove or split the record there; every value must be finite.".to_owned(),
        }),
    }
}
