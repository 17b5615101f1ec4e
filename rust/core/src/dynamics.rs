//! Free runs: torque or handwheel angle in, motion out.
//!
//! One body with spring, freeplay and dry friction ([`OneMass`]) advanced by a step of fixed cost ([`Kernel`]), many
//! parameter sets side by side ([`simulate`]). In stick the speed is exactly 0.

// What is not inlined into the loop over the lanes is not compiled for the instruction set of that loop; and the loops
// over lanes walk several arrays at once. `&` in place of `&&`: no branch.
#![allow(
    clippy::inline_always,
    clippy::needless_bitwise_bool,
    clippy::needless_range_loop
)]

mod drive;
mod events;
mod lanes;
mod ledger;
mod moreau;
mod number;
mod one_mass;
pub mod oracle;
mod split;
mod trace;

pub use drive::Drive;
pub use events::{Event, EventKind};
pub use lanes::{Batch, Kernel, SUMMARY, Start, Width, simulate, summarise};
pub use ledger::Ledger;
pub use number::Pure;
pub use one_mass::{NAMES, OneMass, PARAMETERS};
pub use trace::{Trace, trace};
