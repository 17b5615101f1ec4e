//! The causal filter on a stream: a design and its memory, fed in chunks of any size.

use std::sync::Arc;

use super::butterworth::Butterworth;
use super::lookahead::{BLOCK, State};
use super::matrix::{MAX_POLES, Vector};
use super::samples::{Sample, Scale};
use super::simd::{Affine, InstructionSet, Order};
use super::system::System;
use crate::error::{Error, LARGEST, require_moderate, require_same_length};

/// A running filter. The output does not depend on how the stream is cut into chunks, bit for bit: the memory is the
/// state at the last multiple of sixteen samples and the samples since.
///
/// A new filter starts settled at the first sample it is given, so that a record that begins at 100 units does not
/// begin with a step of 100; [`Filter::reset`] chooses another start.
#[derive(Debug, Clone, PartialEq)]
pub struct Filter {
    design: Butterworth,
    system: Arc<System>,
    memory: Memory,
}

/// What changes while a filter runs.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Memory {
    /// The level everything is relative to; None until the first sample. Rounding is then relative to the signal's
    /// excursion, not to its offset.
    origin: Option<f64>,
    /// Before the samples that wait.
    state: State,
    /// The samples of the unfinished block, less the origin; zero beyond them.
    waiting: [f64; BLOCK],
    count: usize,
}

impl Memory {
    const fn settled(origin: Option<f64>) -> Self {
        Self {
            origin,
            state: State::REST,
            waiting: [0.0; BLOCK],
            count: 0,
        }
    }
}

/// Samples converted at a time: they stay in the first cache.
const TILE: usize = 16 * BLOCK;

/// The numbers a filter remembers: the origin's presence, the origin, the states, how many samples wait, those.
pub const STATE_LEN: usize = 3 + MAX_POLES + BLOCK;

impl Filter {
    /// A filter that will settle at its first sample.
    #[must_use]
    pub fn new(design: Butterworth) -> Self {
        Self::on(design, InstructionSet::best())
    }

    /// [`Self::new`] for a chosen instruction set.
    #[must_use]
    pub fn on(design: Butterworth, set: InstructionSet) -> Self {
        Self {
            design,
            system: Arc::new(System::new(&design.cascade, set)),
            memory: Memory::settled(None),
        }
    }

    /// The filter whose output is the time derivative of the filtered stream, per second.
    ///
    /// # Errors
    /// [`Error::OutOfRange`] for a design that passes high frequencies or has a single pole.
    pub fn derivative(design: Butterworth, set: InstructionSet) -> Result<Self, Error> {
        let Some(cascade) = design.cascade.derivative() else {
            return Err(Error::OutOfRange {
                name: "poles",
                value: design.poles() as f64,
                interval: "[2, 12] of a low or band pass: a derivative of anything else grows with frequency".into(),
            });
        };
        let system = System::new(&cascade, set).scaled(design.sample_rate_hz());
        Ok(Self {
            design,
            system: Arc::new(system),
            memory: Memory::settled(None),
        })
    }

    /// The design.
    #[must_use]
    pub fn design(&self) -> &Butterworth {
        &self.design
    }

    /// Forgets the past: settled at `level`, or at the next sample if None. Zero gives the filter at rest.
    ///
    /// # Errors
    /// [`Error::NonFinite`] or [`Error::OutOfRange`] for a level that no sample may have; the memory is untouched.
    pub fn reset(&mut self, level: Option<f64>) -> Result<(), Error> {
        if let Some(level) = level {
            require_moderate("level", &[level])?;
        }
        // A negative zero would turn the sign of zeros in the output.
        self.memory = Memory::settled(level.map(|v| v + 0.0));
        Ok(())
    }

    /// Filters `x` into `out`. Nothing is allocated.
    ///
    /// # Errors
    /// [`Error::NonFinite`], [`Error::OutOfRange`] or [`Error::Length`]; the memory is untouched by a refused chunk,
    /// `out` then holds nothing of use.
    pub fn push_into(&mut self, x: &[f64], out: &mut [f64]) -> Result<(), Error> {
        require_same_length("out", out, "x", x.len())?;
        let before = self.memory;
        let Some((origin, lift)) = self.begin(x) else {
            return Ok(());
        };
        let head = self.head_length(x.len());
        let body = head + (x.len() - head) / BLOCK * BLOCK;
        let mut good = self.wait(origin, lift, &x[..head], &mut out[..head]);
        let affine = Affine::new(1.0, -origin, lift);
        let system = &self.system;
        let state = &mut self.memory.state;
        good &= system.kernel.filter(
            &system.block,
            state,
            Order::Ascending,
            affine,
            &x[head..body],
            &mut out[head..body],
        );
        good &= self.wait(origin, lift, &x[body..], &mut out[body..]);
        if good {
            return Ok(());
        }
        self.memory = before;
        require_moderate("x", x)
    }

    /// Filters a buffer in place. Nothing is allocated; a refused buffer is untouched.
    ///
    /// # Errors
    /// As [`Self::push_into`].
    pub fn push_in_place(&mut self, x: &mut [f64]) -> Result<(), Error> {
        require_moderate("x", x)?;
        let Some((origin, lift)) = self.begin(x) else {
            return Ok(());
        };
        let head = self.head_length(x.len());
        let body = head + (x.len() - head) / BLOCK * BLOCK;
        self.wait_in_place(origin, lift, &mut x[..head]);
        let affine = Affine::new(1.0, -origin, lift);
        let system = &self.system;
        let state = &mut self.memory.state;
        system.kernel.filter_in_place(
            &system.block,
            state,
            Order::Ascending,
            affine,
            &mut x[head..body],
        );
        self.wait_in_place(origin, lift, &mut x[body..]);
        Ok(())
    }

    /// Filters counts or single-precision samples, `factor x + offset` in their unit, into `out`: the same bits as
    /// [`Self::push_into`] of the converted samples. Nothing is allocated.
    ///
    /// # Errors
    /// As [`Self::push_into`]; the memory is untouched by a refused chunk, `out` then holds nothing of use.
    pub fn push_samples<T: Sample>(
        &mut self,
        x: &[T],
        scale: Scale,
        out: &mut [f64],
    ) -> Result<(), Error> {
        require_same_length("out", out, "x", x.len())?;
        let before = self.memory;
        for (start, (x, out)) in (0..)
            .step_by(TILE)
            .zip(x.chunks(TILE).zip(out.chunks_mut(TILE)))
        {
            scale.widen(x, out);
            if let Err(error) = self.push_in_place(out) {
                self.memory = before;
                return Err(error.moved(start));
            }
        }
        Ok(())
    }

    /// Filters single-precision samples into single precision; all arithmetic between is double.
    ///
    /// # Errors
    /// As [`Self::push_samples`].
    pub fn push_single(&mut self, x: &[f32], out: &mut [f32]) -> Result<(), Error> {
        if x.len() != out.len() {
            return Err(Error::Length {
                name: "out",
                expected: format!("{}, as many as x,", x.len()),
                got: out.len(),
            });
        }
        let before = self.memory;
        let mut staged = [0.0; TILE];
        for (start, (x, out)) in (0..)
            .step_by(TILE)
            .zip(x.chunks(TILE).zip(out.chunks_mut(TILE)))
        {
            let staged = &mut staged[..x.len()];
            Scale::NONE.widen(x, staged);
            if let Err(error) = self.push_in_place(staged) {
                self.memory = before;
                return Err(error.moved(start));
            }
            for (place, y) in out.iter_mut().zip(staged) {
                *place = *y as f32;
            }
        }
        Ok(())
    }

    /// Filters one chunk into a new vector.
    ///
    /// # Errors
    /// As [`Self::push_into`].
    pub fn push(&mut self, x: &[f64]) -> Result<Vec<f64>, Error> {
        let mut out = vec![0.0; x.len()];
        self.push_into(x, &mut out)?;
        Ok(out)
    }

    /// The origin and what is added to the output; None for an empty chunk.
    fn begin(&mut self, x: &[f64]) -> Option<(f64, f64)> {
        let first = x.first()?;
        let origin = *self.memory.origin.get_or_insert(first + 0.0);
        Some((origin, origin * self.system.level_gain))
    }

    /// How many of the next samples belong to the unfinished block.
    fn head_length(&self, length: usize) -> usize {
        match self.memory.count {
            0 => 0,
            count => length.min(BLOCK - count),
        }
    }

    /// Adds samples to the unfinished block: its rows are their outputs, and the state moves on when it is full.
    fn wait(&mut self, origin: f64, lift: f64, x: &[f64], out: &mut [f64]) -> bool {
        if x.is_empty() {
            return true;
        }
        // Less its origin, a sample that is far too large looks like none.
        let moderate = x.iter().all(|v| v.abs() <= LARGEST);
        let memory = &mut self.memory;
        let (from, to) = (memory.count, memory.count + x.len());
        for (place, v) in memory.waiting[from..to].iter_mut().zip(x) {
            *place = v - origin;
        }
        let mut staged = memory.waiting;
        let mut after = memory.state;
        let affine = Affine::lifted(lift);
        let system = &self.system;
        let good = system.kernel.filter_in_place(
            &system.block,
            &mut after,
            Order::Ascending,
            affine,
            &mut staged,
        );
        out.copy_from_slice(&staged[from..to]);
        memory.count = to;
        if to == BLOCK {
            memory.state = after;
            memory.waiting = [0.0; BLOCK];
            memory.count = 0;
        }
        good && moderate
    }

    fn wait_in_place(&mut self, origin: f64, lift: f64, x: &mut [f64]) {
        let mut given = [0.0; BLOCK];
        let given = &mut given[..x.len()];
        given.copy_from_slice(x);
        self.wait(origin, lift, given, x);
    }

    /// The states after the last sample, less the origin.
    pub(super) fn state_now(&self) -> Vector {
        let mut state = self.memory.state.vector();
        for v in &self.memory.waiting[..self.memory.count] {
            self.system.space.advance(&mut state, *v);
        }
        state
    }

    /// The memory as plain numbers, to be stored and given to [`Self::restore`].
    #[must_use]
    pub fn state(&self) -> [f64; STATE_LEN] {
        let mut flat = [0.0; STATE_LEN];
        let memory = &self.memory;
        flat[0] = f64::from(u8::from(memory.origin.is_some()));
        flat[1] = memory.origin.unwrap_or(0.0);
        flat[2..2 + MAX_POLES].copy_from_slice(&memory.state.vector());
        flat[2 + MAX_POLES] = memory.count as f64;
        flat[3 + MAX_POLES..].copy_from_slice(&memory.waiting);
        flat
    }

    /// Continues from a stored memory, bit for bit.
    ///
    /// # Errors
    /// [`Error::Length`], [`Error::NonFinite`] or [`Error::OutOfRange`] for numbers that [`Self::state`] did not make.
    pub fn restore(&mut self, state: &[f64]) -> Result<(), Error> {
        require_same_length("state", state, "the memory", STATE_LEN)?;
        require_moderate("state", state)?;
        let count = state[2 + MAX_POLES];
        if !(0.0..BLOCK as f64).contains(&count) || count.fract() != 0.0 {
            return Err(Error::OutOfRange {
                name: "state",
                value: count,
                interval: format!("{{0, 1, ..., {}}} waiting samples", BLOCK - 1),
            });
        }
        let mut memory = Memory::settled((state[0] != 0.0).then_some(state[1]));
        memory.state.0[..self.system.space.n].copy_from_slice(&state[2..2 + self.system.space.n]);
        memory.count = count as usize;
        let waiting = &state[3 + MAX_POLES..];
        memory.waiting[..memory.count].copy_from_slice(&waiting[..memory.count]);
        self.memory = memory;
        Ok(())
    }
}
