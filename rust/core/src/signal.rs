//! Butterworth filters: one design, run causally on a stream or forward and backward on a record.

pub mod anti_alias;
pub mod bank;
pub mod butterworth;
mod cascade;
mod extension;
mod extremes;
pub mod filter;
pub mod fixed_lag;
mod gustafsson;
mod lookahead;
mod matrix;
pub mod samples;
mod section;
pub mod simd;
mod state_space;
mod system;
mod tail;
pub mod uneven;
mod words;
pub mod zero_phase;
mod zero_phase_frames;

pub use anti_alias::AntiAlias;
pub use bank::Bank;
pub use butterworth::{Band, Butterworth, CutoffAt, Passes};
pub use extremes::extremes;
pub use filter::Filter;
pub use fixed_lag::FixedLag;
pub use samples::{Sample, Scale};
pub use simd::InstructionSet;
pub use zero_phase::{Edges, ZeroPhase, zero_phase};
