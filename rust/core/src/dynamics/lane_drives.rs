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
            psi: [[0.0; N]; 4],
            load: [[0.0; N]; 4],
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

/// What drives a block of lanes over one sub-step: both channels at its start, middle and end.
pub(super) struct Spans<const N: usize> {
    psi: [[f64; N]; 3],
    load: [[f64; N]; 3],
}

impl<const N: usize> Spans<N> {
    pub fn new() -> Self {
        Self {
            psi: [[0.0; N]; 3],
            load: [[0.0; N]; 3],
        }
    }

    /// The same for all lanes.
    #[inline(always)]
    pub fn share(&mut self, span: &Span) {
        for (rows, parabola) in [(&mut self.psi, span.psi), (&mut self.load, span.load)] {
            let values = [parabola.start, parabola.middle, parabola.end];
            for (row, value) in rows.iter_mut().zip(values) {
                *row = [value.0; N];
            }
        }
    }

    /// What drives a lane.
    #[inline(always)]
    pub fn of(&self, lane: usize) -> Span {
        let parabola = |rows: &[[f64; N]; 3]| Parabola {
            start: Pure(rows[0][lane]),
            middle: Pure(rows[1][lane]),
            end: Pure(rows[2][lane]),
        };
        Span {
            psi: parabola(&self.psi),
            load: parabola(&self.load),
        }
    }
}

/// The drives of a block, one sub-step after the other.
pub(super) struct BlockDrives<'a, const N: usize> {
    of: &'a LaneDrives<'a>,
    lane: [usize; N],
    psi: [[f64; N]; 4],
    load: [[f64; N]; 4],
}

impl<const N: usize> BlockDrives<'_, N> {
    /// Goes to a sub-step of an interval; they must be asked for in order.
    #[inline(always)]
    pub fn advance(&mut self, spans: &mut Spans<N>, interval: usize, sub: usize) {
        let Self {
            of,
            lane,
            psi,
            load,
        } = self;
        let weights = of.refinement.half_steps(sub);
        for (channel, around, rows) in [
            (Some(of.handwheel), psi, &mut spans.psi),
            (of.load, load, &mut spans.load),
        ] {
            let Some(channel) = channel else { continue };
            if sub == 0 {
                for k in 0..N {
                    let record = channel.record(lane[k], of.samples);
                    let four = Refinement::around(record, interval);
                    for (row, value) in around.iter_mut().zip(four) {
                        row[k] = value;
                    }
                }
                rows[2] = around[1];
            }
            rows[0] = rows[2];
            for (row, weights) in rows[1..].iter_mut().zip(weights) {
                match weights {
                    Some([p, q, r, s]) => {
                        for k in 0..N {
                            row[k] = p * around[0][k]
                                + q * around[1][k]
                                + r * around[2][k]
                                + s * around[3][k];
                        }
                    }
                    None => *row = around[2],
                }
            }
        }
    }
}
