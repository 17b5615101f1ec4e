//! A bank of equal filters for a stream of frames: one channel per place of a register.

use super::butterworth::Butterworth;
use super::section::{Section, Solved};
use super::simd::{Frames, GROUP, GroupState, InstructionSet, run_frames};
use crate::error::{Error, require_moderate, require_same_length};

/// Frames of sixteen channels that fit into the first cache.
const TILE: usize = 64;

/// Equal causal filters, one per channel; frames of samples in, frames out.
///
/// The results of a channel do not depend on how the stream is cut nor on its neighbours, bit for bit; they are those of
/// a [`super::Filter`] to rounding.
#[derive(Debug, Clone)]
pub struct Bank {
    design: Butterworth,
    set: InstructionSet,
    sections: Vec<Solved>,
    channels: usize,
    level_gain: f64,
    memory: Memory,
}

/// What changes while a bank runs, padded to whole groups.
#[derive(Debug, Clone)]
struct Memory {
    settled: bool,
    origin: Vec<[f64; GROUP]>,
    states: Vec<GroupState>,
}

impl Bank {
    /// A bank that will settle at its first frame.
    ///
    /// # Errors
    /// [`Error::OutOfRange`] without a channel.
    pub fn new(design: Butterworth, channels: usize, set: InstructionSet) -> Result<Self, Error> {
        if channels == 0 {
            return Err(Error::OutOfRange {
                name: "channels",
                value: 0.0,
                interval: "[1, inf)".into(),
            });
        }
        let groups = channels.div_ceil(GROUP);
        let memory = Memory {
            settled: false,
            origin: vec![[0.0; GROUP]; groups],
            states: vec![[[[0.0; GROUP]; 2]; 6]; groups],
        };
        Ok(Self {
            design,
            set: if set.available() {
                set
            } else {
                InstructionSet::best()
            },
            sections: design
                .cascade
                .sections()
                .iter()
                .map(Section::solved)
                .collect(),
            channels,
            level_gain: design.cascade.level_gain,
            memory,
        })
    }

    /// The design.
    #[must_use]
    pub fn design(&self) -> &Butterworth {
        &self.design
    }

    /// How many channels.
    #[must_use]
    pub fn channels(&self) -> usize {
        self.channels
    }

    /// Forgets the past: each channel settled at its level, or at the next frame if None.
    ///
    /// # Errors
    /// [`Error::Length`], [`Error::NonFinite`] or [`Error::OutOfRange`]; the memory is untouched.
    pub fn reset(&mut self, levels: Option<&[f64]>) -> Result<(), Error> {
        if let Some(levels) = levels {
            require_same_length("level", levels, "channels", self.channels)?;
            require_moderate("level", levels)?;
            self.settle_at(levels);
        }
        self.memory.settled = levels.is_some();
        for group in &mut self.memory.states {
            *group = [[[0.0; GROUP]; 2]; 6];
        }
        Ok(())
    }

    fn settle_at(&mut self, levels: &[f64]) {
        for (group, levels) in self.memory.origin.iter_mut().zip(levels.chunks(GROUP)) {
            for (origin, level) in group.iter_mut().zip(levels) {
                *origin = level + 0.0;
            }
        }
        self.memory.settled = true;
    }

    /// Filters frames, channel after channel in each, in place. Nothing is allocated; refused frames and the memory
    /// are as they were.
    ///
    /// # Errors
    /// [`Error::Length`] unless whole frames, [`Error::NonFinite`], [`Error::OutOfRange`].
    pub fn push_in_place(&mut self, frames: &mut [f64]) -> Result<(), Error> {
        if !frames.len().is_multiple_of(self.channels) {
            return Err(Error::Length {
                name: "frames",
                expected: format!("a multiple of the {} channels", self.channels),
                got: frames.len(),
            });
        }
        require_moderate("frames", frames)?;
        if frames.is_empty() {
            return Ok(());
        }
        if !self.memory.settled {
            self.settle_at(&frames[..self.channels]);
        }
        let count = frames.len() / self.channels;
        for start in (0..count).step_by(TILE) {
            let tile = TILE.min(count - start);
            let part = &mut frames[start * self.channels..(start + tile) * self.channels];
            for group in 0..self.memory.states.len() {
                self.run(part, group, tile);
            }
        }
        Ok(())
    }

    /// One group over one tile; channels that do not fill a group go through memory of its width.
    fn run(&mut self, part: &mut [f64], group: usize, count: usize) {
        let (first, stride) = (group * GROUP, self.channels);
        let width = GROUP.min(stride - first);
        let origin = self.memory.origin[group];
        let mut work = Frames {
            sections: &self.sections,
            state: &mut self.memory.states[group],
            lift: &origin.map(|v| v * self.level_gain),
            origin: &origin,
        };
        if width == GROUP {
            run_frames(self.set, &mut work, part, first, stride, count, false);
            return;
        }
        let mut staged = [[0.0; GROUP]; TILE];
        for (frame, row) in staged.iter_mut().zip(part.chunks_exact(stride)) {
            *frame = origin;
            frame[..width].copy_from_slice(&row[first..first + width]);
        }
        run_frames(
            self.set,
            &mut work,
            staged.as_flattened_mut(),
            0,
            GROUP,
            count,
            false,
        );
        for (frame, row) in staged.iter().zip(part.chunks_exact_mut(stride)) {
            row[first..first + width].copy_from_slice(&frame[..width]);
        }
    }

    /// The memory as plain numbers: whether settled, then per channel the origin and twelve states.
    #[must_use]
    pub fn state(&self) -> Vec<f64> {
        let mut flat = vec![f64::from(u8::from(self.memory.settled))];
        for channel in 0..self.channels {
            let (group, lane) = (channel / GROUP, channel % GROUP);
            flat.push(self.memory.origin[group][lane]);
            flat.extend(
                self.memory.states[group]
                    .as_flattened()
                    .iter()
                    .map(|s| s[lane]),
            );
        }
        flat
    }

    /// Continues from a stored memory, bit for bit.
    ///
    /// # Errors
    /// [`Error::Length`] or [`Error::NonFinite`] for numbers that [`Self::state`] did not make.
    pub fn restore(&mut self, state: &[f64]) -> Result<(), Error> {
        require_same_length("state", state, "the memory", 1 + 13 * self.channels)?;
        require_moderate("state", state)?;
        self.memory.settled = state[0] != 0.0;
        for (channel, stored) in state[1..].chunks_exact(13).enumerate() {
            let (group, lane) = (channel / GROUP, channel % GROUP);
            self.memory.origin[group][lane] = stored[0];
            for (place, v) in self.memory.states[group]
                .as_flattened_mut()
                .iter_mut()
                .zip(&stored[1..])
            {
                place[lane] = *v;
            }
        }
        Ok(())
    }
}
