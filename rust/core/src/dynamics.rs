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

mod bristle;
mod control;
mod drive;
mod events;
mod ground;
mod inside;
mod keep;
mod lane_check;
mod lane_drives;
mod lanes;
mod ledger;
mod level;
mod march;
mod moreau;
mod number;
mod observe;
mod one_mass;
pub mod oracle;
mod parameters;
mod split;
mod tile;
mod trace;
mod watched;
mod width;

pub use bristle::Bristle;
pub use control::Control;
pub use drive::Drive;
pub(crate) use drive::{MOST_STEPS, Refinement};
pub use events::{Event, EventKind};
pub use ground::Ground;
pub use keep::{ENERGIES, Keep, SUMMARY};
pub use lane_check::check_lanes;
pub use lane_drives::{Channel, LaneDrives};
pub use lanes::{Batch, Drives, Kernel, Results, Start, run_lanes, simulate};
pub use ledger::Ledger;
pub use level::Level;
pub use number::Pure;
pub use one_mass::OneMass;
pub use parameters::{NAMES, PARAMETERS};
pub use trace::{Trace, trace};
pub use width::Width;
pub(crate) use width::run;
