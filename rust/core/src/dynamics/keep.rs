//! What is kept of a lane: a row of numbers whose length does not grow with the run.

use crate::Error;

use super::events::EventKind;

/// What every row begins with.
pub const SUMMARY: [&str; 5] = [
    "last_rad",
    "last_speed_rad_s",
    "peak_rad",
    "rms_rad",
    "at_rest_share",
];

/// The energies of a row, as in a [`super::Ledger`].
pub const ENERGIES: [&str; 9] = [
    "handwheel",
    "load",
    "stored_first",
    "stored_last",
    "dry",
    "viscous",
    "curved",
    "turnover",
    "residual",
];

/// What to keep beyond [`SUMMARY`].
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Keep {
    /// How often each kind of event happened.
    pub events: bool,
    /// Where the energy went.
    pub energy: bool,
    /// Samples of one window of the envelope; 0 for none.
    pub window: usize,
    /// Samples whose angle and speed are kept, in increasing order.
    pub chosen: Vec<usize>,
}

impl Keep {
    /// Names and numbers of values of a row's parts, for a run of so many samples.
    #[must_use]
    pub fn columns(&self, samples: usize) -> Vec<(String, usize)> {
        let mut out: Vec<_> = SUMMARY.iter().map(|&name| (name.to_owned(), 1)).collect();
        if self.events {
            out.extend(EventKind::ALL.map(|kind| (format!("{}_count", kind.word()), 1)));
        }
        if self.energy {
            out.extend(ENERGIES.map(|name| (format!("energy_{name}_j"), 1)));
        }
        if self.window > 0 {
            let windows = samples.div_ceil(self.window);
            out.push(("least_rad".to_owned(), windows));
            out.push(("greatest_rad".to_owned(), windows));
        }
        if !self.chosen.is_empty() {
            out.push(("sample_rad".to_owned(), self.chosen.len()));
            out.push(("sample_speed_rad_s".to_owned(), self.chosen.len()));
        }
        out
    }

    /// Values of a row.
    #[must_use]
    pub fn width(&self, samples: usize) -> usize {
        self.columns(samples).iter().map(|(_, width)| width).sum()
    }

    /// Whether anything is kept that is found inside of steps rather than at samples.
    pub(super) fn watches_steps(&self) -> bool {
        self.events || self.energy
    }

    /// Where the event counts begin.
    pub(super) fn events_at() -> usize {
        SUMMARY.len()
    }

    /// Where the energies begin.
    pub(super) fn energy_at(&self) -> usize {
        SUMMARY.len() + if self.events { EventKind::ALL.len() } else { 0 }
    }

    /// Where the envelope begins.
    pub(super) fn envelope_at(&self) -> usize {
        self.energy_at() + if self.energy { ENERGIES.len() } else { 0 }
    }

    /// Where the chosen samples begin.
    pub(super) fn chosen_at(&self, samples: usize) -> usize {
        self.envelope_at()
            + if self.window > 0 {
                2 * samples.div_ceil(self.window)
            } else {
                0
            }
    }

    /// Refuses chosen samples that are not there or not in order.
    pub(super) fn check(&self, samples: usize) -> Result<(), Error> {
        let mut least = 0;
        for &sample in &self.chosen {
            if sample < least || sample >= samples {
                return Err(Error::OutOfRange {
                    name: "chosen sample",
                    value: sample as f64,
                    interval: format!("[{least}, {samples}), in increasing order"),
                });
            }
            least = sample + 1;
        }
        Ok(())
    }
}
