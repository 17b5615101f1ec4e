//! What the driver does: a piecewise sinusoidal or constant signal given by its parameters, or samples.

use std::f64::consts::PI;

use crate::Error;
use crate::dynamics::Pure;
use crate::error::{require_finite, require_positive};

use super::angle::{cos, sin};

/// Pieces of `level + amplitude sin(2 pi f (t - start) + phase)`, each from its start to that of the next; 0 before
/// the first. One row for all lanes or one per lane, `count` pieces each, starts ascending.
#[derive(Debug, Clone, Copy)]
pub struct Segments<'a> {
    count: usize,
    start_s: &'a [f64],
    level: &'a [f64],
    amplitude: &'a [f64],
    frequency_hz: &'a [f64],
    phase_rad: &'a [f64],
}

/// Samples, one row for all lanes or one per lane; between them runs the cubic through the four nearest, after the
/// last the last one is held.
#[derive(Debug, Clone, Copy)]
pub struct Sampled<'a> {
    samples: usize,
    values: &'a [f64],
    sample_rate_hz: f64,
}

/// Handwheel angle (rad), steering torque (Nm) or speed (m/s) over time.
#[derive(Debug, Clone, Copy)]
pub enum Signal<'a> {
    /// By parameters.
    Segments(Segments<'a>),
    /// By samples.
    Sampled(Sampled<'a>),
}

impl<'a> Segments<'a> {
    /// Pieces of `count` per row.
    ///
    /// # Errors
    /// [`Error::Length`], [`Error::NonFinite`], [`Error::OutOfRange`] for starts that do not ascend or a frequency
    /// below 0.
    pub fn new(
        count: usize,
        start_s: &'a [f64],
        level: &'a [f64],
        amplitude: &'a [f64],
        frequency_hz: &'a [f64],
        phase_rad: &'a [f64],
    ) -> Result<Self, Error> {
        if count == 0 || start_s.is_empty() || !start_s.len().is_multiple_of(count) {
            return Err(Error::Length {
                name: "start_s",
                expected: "at least 1".to_owned(),
                got: start_s.len(),
            });
        }
        for (name, values) in [
            ("start_s", start_s),
            ("level", level),
            ("amplitude", amplitude),
            ("frequency_hz", frequency_hz),
            ("phase_rad", phase_rad),
        ] {
            crate::error::require_same_length(name, values, "start_s", start_s.len())?;
            require_finite(name, values)?;
        }
        for row in start_s.chunks_exact(count) {
            for pair in row.windows(2) {
                if pair[1] < pair[0] {
                    return Err(Error::OutOfRange {
                        name: "start_s",
                        value: pair[1],
                        interval: format!("[{}, inf): pieces follow each other in time", pair[0]),
                    });
                }
            }
        }
        if let Some(&value) = frequency_hz.iter().find(|f| **f < 0.0) {
            return Err(super::parameters::out("frequency_hz", value, "[0, inf)"));
        }
        Ok(Self {
            count,
            start_s,
            level,
            amplitude,
            frequency_hz,
            phase_rad,
        })
    }

    /// Where the row of a lane begins.
    fn row(&self, lane: usize) -> usize {
        if self.start_s.len() == self.count {
            0
        } else {
            lane * self.count
        }
    }

    /// Between which values every piece stays.
    fn bounds(&self) -> (f64, f64) {
        let each = self.level.iter().zip(self.amplitude);
        each.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), (l, a)| {
            (low.min(l - a.abs()), high.max(l + a.abs()))
        })
    }

    /// The integral of the square of the rate from 0 to `duration_s`, in closed form; jumps between pieces have no
    /// rate and count nothing.
    #[must_use]
    pub fn rate_square_integral(&self, lane: usize, duration_s: f64) -> f64 {
        let row = self.row(lane);
        let mut sum = 0.0;
        for piece in row..row + self.count {
            let start = self.start_s[piece];
            let end = if piece + 1 < row + self.count {
                self.start_s[piece + 1].min(duration_s)
            } else {
                duration_s
            };
            let (from, to) = (start.max(0.0), end);
            let omega = 2.0 * PI * self.frequency_hz[piece];
            if to <= from || omega == 0.0 {
                continue;
            }
            let angle = |t: f64| omega * (t - start) + self.phase_rad[piece];
            let wave = sin(Pure(2.0 * angle(to))).0 - sin(Pure(2.0 * angle(from))).0;
            let speed = self.amplitude[piece] * omega;
            sum += 0.5 * speed * speed * (to - from + wave / (2.0 * omega));
        }
        sum
    }
}

impl<'a> Sampled<'a> {
    /// Rows of `samples` values.
    ///
    /// # Errors
    /// [`Error::Length`] below four samples, [`Error::NonFinite`], [`Error::OutOfRange`] for a rate that is not
    /// positive.
    pub fn new(samples: usize, values: &'a [f64], sample_rate_hz: f64) -> Result<Self, Error> {
        require_positive("sample_rate_hz", sample_rate_hz)?;
        if samples < 4 || values.is_empty() || !values.len().is_multiple_of(samples) {
            return Err(Error::Length {
                name: "samples",
                expected: "at least 4".to_owned(),
                got: samples,
            });
        }
        require_finite("samples", values)?;
        Ok(Self {
            samples,
            values,
            sample_rate_hz,
        })
    }

    /// The least and the largest value.
    #[must_use]
    pub fn range(&self) -> (f64, f64) {
        self.values
            .iter()
            .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), v| {
                (low.min(*v), high.max(*v))
            })
    }

    /// First of the four samples at a time, and their weights for the value and for the rate.
    fn weights(&self, time_s: f64) -> (usize, [f64; 4], [f64; 4]) {
        let last = (self.samples - 1) as f64;
        let at = (time_s * self.sample_rate_hz).clamp(0.0, last);
        let first = (at as usize).saturating_sub(1).min(self.samples - 4);
        let t = at - first as f64;
        let value = [
            -(t - 1.0) * (t - 2.0) * (t - 3.0) / 6.0,
            t * (t - 2.0) * (t - 3.0) / 2.0,
            -t * (t - 1.0) * (t - 3.0) / 2.0,
            t * (t - 1.0) * (t - 2.0) / 6.0,
        ];
        let rate = if time_s * self.sample_rate_hz > last {
            [0.0; 4]
        } else {
            [
                -(3.0 * t * t - 12.0 * t + 11.0) / 6.0,
                0.5 * (3.0 * t * t - 10.0 * t + 6.0),
                -0.5 * (3.0 * t * t - 8.0 * t + 3.0),
                (3.0 * t * t - 6.0 * t + 2.0) / 6.0,
            ]
            .map(|w| w * self.sample_rate_hz)
        };
        (first, value, rate)
    }
}

impl Signal<'_> {
    /// The latest time at which a row begins; before it its value is 0.
    pub(super) fn begins_s(&self) -> f64 {
        match self {
            Self::Segments(s) => {
                let firsts = s.start_s.iter().step_by(s.count);
                firsts.fold(f64::NEG_INFINITY, |late, start| late.max(*start))
            }
            Self::Sampled(_) => f64::NEG_INFINITY,
        }
    }

    /// Whether it keeps its first values for ever.
    pub(super) fn is_constant(&self) -> bool {
        match self {
            Self::Segments(s) => {
                let still = s.start_s.iter().all(|start| *start <= 0.0);
                s.count == 1 && still && s.amplitude.iter().all(|a| *a == 0.0)
            }
            Self::Sampled(_) => false,
        }
    }

    /// A lower bound of its values.
    pub(super) fn least(&self) -> f64 {
        match self {
            Self::Segments(s) => s.bounds().0,
            Self::Sampled(s) => s.range().0,
        }
    }

    /// An upper bound of its values.
    pub(super) fn most(&self) -> f64 {
        match self {
            Self::Segments(s) => s.bounds().1,
            Self::Sampled(s) => s.range().1,
        }
    }

    /// The rows it has: 1, or one per lane.
    pub(super) fn rows(&self) -> usize {
        match self {
            Self::Segments(s) => s.start_s.len() / s.count,
            Self::Sampled(s) => s.values.len() / s.samples,
        }
    }
}

/// A signal played for a block of lanes, forward in time.
pub(super) struct Player<'a, const N: usize> {
    signal: Signal<'a>,
    lanes: [usize; N],
    piece: [usize; N],
    next_s: [f64; N],
    soonest_s: f64,
    start_s: [f64; N],
    level: [f64; N],
    amplitude: [f64; N],
    omega: [f64; N],
    phase: [f64; N],
}

impl<'a, const N: usize> Player<'a, N> {
    /// Plays the rows of these lanes.
    pub fn new(signal: Signal<'a>, lanes: [usize; N]) -> Self {
        let mut player = Self {
            signal,
            lanes,
            piece: [0; N],
            next_s: [f64::NEG_INFINITY; N],
            soonest_s: f64::NEG_INFINITY,
            start_s: [0.0; N],
            level: [0.0; N],
            amplitude: [0.0; N],
            omega: [0.0; N],
            phase: [0.0; N],
        };
        if let Signal::Segments(s) = signal {
            for lane in 0..N {
                player.next_s[lane] = s.start_s[s.row(lanes[lane])];
            }
            player.soonest_s = least(&player.next_s);
        }
        player
    }

    /// Takes up every piece that starts before `until_s` (or at it).
    fn forward(&mut self, until_s: f64) {
        let Signal::Segments(s) = self.signal else {
            return;
        };
        for lane in 0..N {
            let row = s.row(self.lanes[lane]);
            while self.next_s[lane] <= until_s {
                let at = row + self.piece[lane];
                self.start_s[lane] = s.start_s[at];
                self.level[lane] = s.level[at];
                self.amplitude[lane] = s.amplitude[at];
                self.omega[lane] = 2.0 * PI * s.frequency_hz[at];
                self.phase[lane] = s.phase_rad[at];
                self.piece[lane] += 1;
                self.next_s[lane] = if self.piece[lane] < s.count {
                    s.start_s[at + 1]
                } else {
                    f64::INFINITY
                };
            }
        }
        self.soonest_s = least(&self.next_s);
    }

    /// Values at a time; a piece that starts within `slack_s` of it counts as started. A negative slack gives the limit
    /// from the left. Times must not go back.
    #[inline(always)]
    pub fn values(&mut self, time_s: f64, slack_s: f64, out: &mut [f64; N]) {
        if let Signal::Sampled(s) = self.signal {
            let (first, weights, _) = s.weights(time_s);
            self.weigh(&s, first, &weights, out);
            return;
        }
        if self.soonest_s <= time_s + slack_s {
            self.forward(time_s + slack_s);
        }
        for lane in 0..N {
            let angle = self.omega[lane] * (time_s - self.start_s[lane]) + self.phase[lane];
            out[lane] = self.level[lane] + self.amplitude[lane] * sin(Pure(angle)).0;
        }
    }

    /// Whether a piece starts at a time that [`Player::values`] took from the left.
    #[inline(always)]
    pub fn jumps(&self, time_s: f64, slack_s: f64) -> bool {
        self.soonest_s <= time_s + slack_s
    }

    /// Rates of change at a time, after [`Player::values`] at that time.
    #[inline(always)]
    pub fn rates(&self, time_s: f64, out: &mut [f64; N]) {
        if let Signal::Sampled(s) = self.signal {
            let (first, _, weights) = s.weights(time_s);
            self.weigh(&s, first, &weights, out);
            return;
        }
        for lane in 0..N {
            let angle = self.omega[lane] * (time_s - self.start_s[lane]) + self.phase[lane];
            out[lane] = self.omega[lane] * self.amplitude[lane] * cos(Pure(angle)).0;
        }
    }

    fn weigh(&self, s: &Sampled<'_>, first: usize, weights: &[f64; 4], out: &mut [f64; N]) {
        let shared = s.values.len() == s.samples;
        for lane in 0..N {
            let row = if shared {
                0
            } else {
                self.lanes[lane] * s.samples
            };
            let four = &s.values[row + first..row + first + 4];
            out[lane] = weights[0] * four[0]
                + weights[1] * four[1]
                + (weights[2] * four[2] + weights[3] * four[3]);
        }
    }
}

fn least(values: &[f64]) -> f64 {
    values.iter().fold(f64::INFINITY, |low, v| low.min(*v))
}
