//! Zero phase for live use: every sample comes out a fixed time late, with an error that is known in advance.
//!
//! The forward pass runs as the samples come. For each hop of samples the backward pass starts at the newest one, as if
//! the signal stayed where it is, and has forgotten that by the time it reaches them; what is left is the tail of the
//! zero-phase impulse response beyond the delay, times how far the signal moves away from its newest sample.

use super::butterworth::Butterworth;
use super::filter::Filter;
use super::lookahead::{BLOCK, State};
use super::matrix::Vector;
use super::simd::{Affine, InstructionSet, Order};
use super::zero_phase::{Edges, ZeroPhase};
use crate::error::{Error, require_moderate, require_same_length};

/// Outputs are made for a 64th of the delay at a time: the last of them sees 63/64 of it.
const HOPS_PER_DELAY: usize = 64;
/// The longest delay in samples: 2^24 of them are kept in memory twice.
pub const MAX_DELAY: usize = 1 << 24;

/// A zero-phase filter on a stream, late by a fixed number of samples.
#[derive(Debug, Clone)]
pub struct FixedLag {
    filter: ZeroPhase,
    forward: Filter,
    delay: usize,
    hop: usize,
    origin: Option<f64>,
    /// Results of the first pass less the origin: the newest last, at least a delay of them.
    history: Vec<f64>,
    end: usize,
    /// The results of the present hop less the origin, and how many of them are out.
    ready: Vec<f64>,
    out: usize,
    latest: f64,
}

impl FixedLag {
    /// A filter that is `delay` samples late, settled at its first sample.
    ///
    /// # Errors
    /// [`Error::OutOfRange`] for a delay outside `[1, 2^24]`, or a design for one pass.
    pub fn new(design: &Butterworth, delay: usize, set: InstructionSet) -> Result<Self, Error> {
        if !(1..=MAX_DELAY).contains(&delay) {
            return Err(Error::OutOfRange {
                name: "delay",
                value: delay as f64,
                interval: format!("[1, {MAX_DELAY}] samples"),
            });
        }
        let filter = ZeroPhase::on(design, Edges::default(), set)?;
        let hop = (delay / HOPS_PER_DELAY).max(1);
        let mut forward = Filter::on(*design, set);
        forward.reset(Some(0.0))?;
        Ok(Self {
            filter,
            forward,
            delay,
            hop,
            origin: None,
            history: vec![0.0; 2 * (delay + 1) + hop],
            end: delay + 1,
            ready: vec![0.0; hop],
            out: hop,
            latest: 0.0,
        })
    }

    /// How late the output is, in samples.
    #[must_use]
    pub fn delay(&self) -> usize {
        self.delay
    }

    /// The largest error per unit the signal moves away from its newest sample, after the delay and as long as the
    /// filter remembers; a bound, and reached by the worst signal.
    #[must_use]
    pub fn error_bound(&self) -> f64 {
        self.filter.weight_beyond(self.delay + 1 - self.hop)
    }

    /// Forgets the past: settled at `level`, or at the next sample if None.
    ///
    /// # Errors
    /// [`Error::NonFinite`] or [`Error::OutOfRange`] for a level that no sample may have.
    pub fn reset(&mut self, level: Option<f64>) -> Result<(), Error> {
        if let Some(level) = level {
            require_moderate("level", &[level])?;
        }
        self.origin = level.map(|v| v + 0.0);
        self.forward.reset(Some(0.0))?;
        self.history.fill(0.0);
        self.end = self.delay + 1;
        self.out = self.hop;
        self.latest = 0.0;
        Ok(())
    }

    /// Takes `x` in and writes as many results, each `delay` samples late. Nothing is allocated; the results do not
    /// depend on how the stream is cut, bit for bit.
    ///
    /// # Errors
    /// [`Error::NonFinite`], [`Error::OutOfRange`] or [`Error::Length`]; the memory is untouched by a refused chunk.
    pub fn push_into(&mut self, x: &[f64], out: &mut [f64]) -> Result<(), Error> {
        require_same_length("out", out, "x", x.len())?;
        require_moderate("x", x)?;
        let Some(first) = x.first() else {
            return Ok(());
        };
        let origin = *self.origin.get_or_insert(first + 0.0);
        let lift = origin * self.filter.second.level_gain;
        let mut done = 0;
        while done < x.len() {
            let fresh = self.out == self.hop;
            let count = if fresh {
                1
            } else {
                (self.hop - self.out).min(x.len() - done)
            };
            self.take_in(&x[done..done + count], origin)?;
            if fresh {
                self.turn_back();
                self.out = 0;
            }
            for (place, y) in out[done..]
                .iter_mut()
                .zip(&self.ready[self.out..self.out + count])
            {
                *place = y + lift;
            }
            self.out += count;
            done += count;
        }
        Ok(())
    }

    /// The first pass.
    fn take_in(&mut self, x: &[f64], origin: f64) -> Result<(), Error> {
        if self.end + x.len() > self.history.len() {
            self.history
                .copy_within(self.end - self.delay - 1..self.end, 0);
            self.end = self.delay + 1;
        }
        let place = &mut self.history[self.end..self.end + x.len()];
        for (p, v) in place.iter_mut().zip(x) {
            *p = v - origin;
        }
        self.latest = place[x.len() - 1];
        self.forward.push_in_place(place)?;
        self.end += x.len();
        Ok(())
    }

    /// The second pass, from the newest sample to the hop that is due.
    fn turn_back(&mut self) {
        let (first, second) = (&self.filter.first, &self.filter.second);
        let mut start: Vector =
            self.filter
                .around
                .held(first, &self.forward.state_now(), self.latest);
        let from = self.end - 1 - self.delay;
        let (hop, between) = self.history[from..self.end].split_at(self.hop);
        let (rest, blocks) = between.split_at(between.len() % BLOCK);
        let mut state = State::from_vector(&start);
        second.kernel.advance(
            &self.filter.turned,
            &mut state,
            Order::Descending,
            Affine::NONE,
            blocks,
        );
        start = state.vector();
        for f in rest.iter().rev() {
            second.space.advance(&mut start, *f);
        }
        self.ready.copy_from_slice(hop);
        second.backward_in_place(&self.filter.turned, &start, Affine::NONE, &mut self.ready);
    }
}
