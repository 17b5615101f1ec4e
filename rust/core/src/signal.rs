//! Butterworth filters: one design, run causally on a stream or forward and backward on a record.

pub mod anti_alias;
pub mod butterworth;
mod cascade;
mod extension;
pub mod filter;
mod gustafsson;
mod lookahead;
mod matrix;
mod section;
pub mod simd;
mod state_space;
mod system;
mod tail;
mod words;
pub mod zero_phase;

pub use anti_alias::AntiAlias;
pub use butterworth::{Band, Butterworth, CutoffAt, Passes};
pub use filter::Filter;
pub use simd::InstructionSet;
pub use zero_phase::{Edges, ZeroPhase, zero_phase};
