//! Cars: handwheel angle or steering torque in, motion of the car out, many of them side by side.
//!
//! A car is a model ([`Model`]) on tyres ([`TyreLaw`]) behind a steering with freeplay and dry friction; the torque of
//! the front tyres turns the wheels back. [`drive`] runs a [`Fleet`] and keeps the terms of the paper's criterion,
//! equation (6), or whole traces. In stick the speed of the road wheels is exactly 0.

// As in `dynamics`: what is not inlined into the loop over the lanes is not compiled for its instruction set.
#![allow(
    clippy::inline_always,
    clippy::needless_bitwise_bool,
    clippy::needless_range_loop
)]

mod angle;
mod axle;
mod block;
mod body;
mod columns;
mod corridor;
mod fleet;
mod inputs;
mod lateral_roll;
mod parameters;
mod prepared;
mod signal;
mod single_track;
mod start;
mod step;
mod summary;
mod table;
mod trace;
mod turn;
mod twelve;
mod tyre;

pub use corridor::{Corridor, SECTION};
pub use fleet::{Fleet, Model, Steer, TyreLaw, drive};
pub use parameters::{NAMES, Parameters};
pub use signal::{Sampled, Segments, Signal};
pub use start::{START_NAMES, STARTS, Start};
pub use summary::{KEPT, SUMMARY};
pub use trace::CHANNELS;
