//! Drives of which every lane has its own: sampled channels, refined where a lane is.

use crate::Error;
use crate::error::{require_finite, require_positive};

use super::drive::{Parabola, Refinement, Span};
use super::number::Pure;

/// A channel of a batch: samples of each lane one after the other, or one record for all.
#[derive(Debug, Clone, Copy)]
pub struct Channel<'a> {
    /// The samples, lane by lane.
    pub values: &'a [f64],
    /// Whether all lanes share the one record that is there.
    pub shared: bool,
}

/// The drives of a batch. Between samples runs the same cubic, with the same bits, as in a [`super::Drive`].
#[derive(Debug, Clone)]
pub struct LaneDrives<'a> {
    handwheel: Channel<'a>,
    load: Option<Channel<'a>>,
    samples: usize,
    refinement: Refinement,
    step_s: f64,
}

impl<'a> LaneDrives<'a> {
    /// Drives of `lanes` lanes of `samples` samples each.
    ///
    /// # Errors
    /// [`Error::Length`] below two samples or where a channel has another size, [`Error::NonFinite`] for NaN and
    /// infinities, [`Error::OutOfRange`] for a rate or a number of sub-steps that is not positive.
    pub fn new(
        lanes: usize,
        samples: usize,
        handwheel: Channel<'a>,
        load: Option<Channel<'a>>,
        sample_rate_hz: f64,
        substeps: usize,
    ) -> Result<Self, Error> {
        require_positive("sample_rate_hz", sample_rate_hz)?;
        let refinement = Refinement::new(substeps)?;
        if samples < 2 {
            return Err(Error::Length {
                name: "handwheel_rad",
                expected: "at least 2".to_owned(),
                got: samples,
            });
        }
        for (name, channel) in [("handwheel_rad", Some(handwheel)), ("load_nm", load)] {
            let Some(channel) = channel else { continue };
            let wanted = if channel.shared {
                samples
            } else {
                samples * lanes
            };
            if channel.values.len() != wanted {
                return Err(Error::Length {
                    name,
                    expected: format!("{wanted}"),
                    got: channel.values.len(),
                });
            }
            require_finite(name, channel.values)?;
        }
        Ok(Self {
            handwheel,
            load,
            samples,
            refinement,
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
        self.refinement.substeps()
    }

    /// Seconds of one sub-step.
    #[must_use]
    pub fn step_s(&self) -> f64 {
        self.step_s
    }

    /// The largest handwheel angle of a lane at its samples on either side, rad, with what the cubic may add.
    #[must_use]
    pub(super) fn reach_rad(&self, lane: usize) -> f64 {
        let most = |v: &[f64]| v.iter().fold(0.0, |most: f64, v| v.abs().max(most));
        // Lagrange's cubic lies within 1.25 times the largest of the four samples it goes through.
        1.25 * most(self.handwheel.record(lane, self.samples))
    }

    /// The drives of some lanes, from the first on; those beyond `lanes` repeat the last.
    pub(super) fn block<const N: usize>(&self, first: usize, lanes: usize) -> BlockDrives<'_, N> {
        BlockDrives {
            of: self,
            lane: std::array::from_fn(|k| first + k.min(lanes - 1)),
            psi: Neighbours::ZERO,
            load: Neighbours::ZERO,
        }
    }
}

impl<'a> Channel<'a> {
    fn record(&self, lane: usize, samples: usize) -> &'a [f64] {
        if self.shared {
            self.values
        } else {
            &self.values[lane * samples..(lane + 1) * samples]
        }
    }
}

/// The four samples around an interval, and the values over the current sub-step, of a block of lanes.
struct Neighbours<const N: usize> {
    around: [[f64; N]; 4],
    start: [f64; N],
    middle: [f64; N],
    end: [f64; N],
}

impl<const N: usize> Neighbours<N> {
    const ZERO: Self = Self {
        around: [[0.0; N]; 4],
        start: [0.0; N],
        middle: [0.0; N],
        end: [0.0; N],
    };

    #[inline(always)]
    fn parabola(&self, lane: usize) -> Parabola {
        Parabola {
            start: Pure(self.start[lane]),
            middle: Pure(self.middle[lane]),
            end: Pure(self.end[lane]),
        }
    }

    fn load(&mut self, channel: &Channel<'_>, lanes: &[usize; N], samples: usize, interval: usize) {
        for k in 0..N {
            let around = Refinement::around(channel.record(lanes[k], samples), interval);
            for (row, value) in self.around.iter_mut().zip(around) {
                row[k] = value;
            }
        }
        self.end = self.around[1];
    }

    #[inline(always)]
    fn advance(&mut self, refinement: &Refinement, sub: usize) {
        self.start = self.end;
        for k in 0..N {
            let around = [
                self.around[0][k],
                self.around[1][k],
                self.around[2][k],
                self.around[3][k],
            ];
            self.middle[k] = refinement.value(around, 2 * sub + 1);
            self.end[k] = refinement.value(around, 2 * sub + 2);
        }
    }
}

/// The drives of a block, one sub-step after the other.
pub(super) struct BlockDrives<'a, const N: usize> {
    of: &'a LaneDrives<'a>,
    lane: [usize; N],
    psi: Neighbours<N>,
    load: Neighbours<N>,
}

impl<const N: usize> BlockDrives<'_, N> {
    /// Goes to the sub-step of an interval; they must be asked for in order.
    #[inline(always)]
    pub fn advance(&mut self, interval: usize, sub: usize) {
        if sub == 0 {
            let samples = self.of.samples;
            self.psi
                .load(&self.of.handwheel, &self.lane, samples, interval);
            if let Some(channel) = &self.of.load {
                self.load.load(channel, &self.lane, samples, interval);
            }
        }
        self.psi.advance(&self.of.refinement, sub);
        if self.of.load.is_some() {
            self.load.advance(&self.of.refinement, sub);
        }
    }

    /// What drives a lane over the current sub-step.
    #[inline(always)]
    pub fn span(&self, lane: usize) -> Span {
        Span {
            psi: self.psi.parabola(lane),
            load: self.load.parabola(lane),
        }
    }
}
