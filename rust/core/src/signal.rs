//! Low-pass Butterworth filters: one design, run causally on a stream or forward and backward on a record.

pub mod anti_alias;
pub mod butterworth;
mod cascade;
pub mod filter;
pub mod zero_phase;

pub use anti_alias::AntiAlias;
pub use butterworth::{CutoffAt, LowPass, Passes};
pub use filter::Filter;
pub use zero_phase::{Edges, ZeroPhase, zero_phase};
