//! Zero phase of many channels that lie side by side: both passes in place, one channel per place of a register.

use super::cascade::MAX_SECTIONS;
use super::matrix::{MAX_POLES, Vector};
use super::section::Solved;
use super::simd::{Frames, GROUP, GroupState, run_frames};
use super::zero_phase::{Edges, ZeroPhase};
use crate::error::{Error, require_moderate};

/// The states of a group in the order of its sections, from those of its channels.
fn group_state(sections: &[Solved], channels: &[Vector]) -> GroupState {
    let mut state = [[[0.0; GROUP]; 2]; MAX_SECTIONS];
    for (lane, vector) in channels.iter().enumerate() {
        let mut values = vector.iter();
        for (section, place) in sections.iter().zip(&mut state) {
            for (place, value) in place.iter_mut().zip(values.by_ref().take(section.states)) {
                place[lane] = *value;
            }
        }
    }
    state
}

/// One channel's states, as [`group_state`] put them.
fn vector_of(sections: &[Solved], state: &GroupState, lane: usize) -> Vector {
    let mut vector = [0.0; MAX_POLES];
    let mut places = vector.iter_mut();
    for (section, values) in sections.iter().zip(state) {
        for (place, value) in places.by_ref().take(section.states).zip(values) {
            *place = value[lane];
        }
    }
    vector
}

impl ZeroPhase {
    /// Filters `channels` records in place that lie side by side, frame after frame.
    ///
    /// Results are those of [`ZeroPhase::apply`] to rounding. Records that outlast the filter's memory run sixteen
    /// channels at a time; shorter ones and other edges one channel after another.
    ///
    /// # Errors
    /// As [`ZeroPhase::apply`]; the frames are untouched if they are refused.
    pub fn apply_frames(&self, frames: &mut [f64], channels: usize) -> Result<(), Error> {
        if channels == 0 || frames.is_empty() || !frames.len().is_multiple_of(channels) {
            return Err(Error::Length {
                name: "x",
                expected: format!("a positive multiple of the {channels} channels"),
                got: frames.len(),
            });
        }
        let length = frames.len() / channels;
        self.require_length(length)?;
        require_moderate("x", frames)?;
        let side_by_side = matches!(self.edges, Edges::Settled { .. }) && !self.is_closed(length);
        let whole = if side_by_side {
            channels / GROUP * GROUP
        } else {
            0
        };
        for first in (0..whole).step_by(GROUP) {
            self.group(frames, first, channels);
        }
        let mut column = vec![0.0; if whole < channels { length } else { 0 }];
        for channel in whole..channels {
            let at = || (channel..).step_by(channels);
            for (v, i) in column.iter_mut().zip(at()) {
                *v = frames[i];
            }
            self.apply_in_place(&mut column)?;
            for (v, i) in column.iter().zip(at()) {
                frames[i] = *v;
            }
        }
        Ok(())
    }

    /// Sixteen channels from `first` on.
    fn group(&self, frames: &mut [f64], first: usize, stride: usize) {
        let length = frames.len() / stride;
        let set = self.first.kernel.set();
        let gather = |channel: usize, from: usize| -> Vec<f64> {
            (from..=from + self.pad)
                .map(|t| frames[t * stride + channel])
                .collect()
        };
        let starts: Vec<_> = (first..first + GROUP)
            .map(|channel| {
                let (head, tail) = (gather(channel, 0), gather(channel, length - 1 - self.pad));
                self.around.settled_ends(&self.first, &head, &tail)
            })
            .collect();
        let level: [f64; GROUP] = std::array::from_fn(|lane| frames[first + lane]);
        let ahead: Vec<Vector> = starts.iter().map(|start| start.first).collect();
        let mut state = group_state(&self.sections[0], &ahead);
        let mut work = Frames {
            sections: &self.sections[0],
            state: &mut state,
            origin: &level,
            lift: &[0.0; GROUP],
        };
        run_frames(set, &mut work, frames, first, stride, length, false);
        let back: Vec<Vector> = starts
            .iter()
            .enumerate()
            .map(|(lane, start)| {
                let after = vector_of(&self.sections[0], &state, lane);
                start.second(&self.first, &self.second, &self.around, &after)
            })
            .collect();
        let mut state = group_state(&self.sections[1], &back);
        let mut work = Frames {
            sections: &self.sections[1],
            state: &mut state,
            origin: &[0.0; GROUP],
            lift: &level.map(|v| v * self.second.level_gain),
        };
        run_frames(set, &mut work, frames, first, stride, length, true);
    }
}
