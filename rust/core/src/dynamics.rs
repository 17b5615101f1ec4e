//! Free runs: torque or handwheel angle in, motion out.
//!
//! One body with spring, freeplay and dry friction ([`OneMass`]) advanced by a step of fixed cost ([`Kernel`]), many
//! parameter sets side by side ([`simulate`]). In stick the speed is exactly 0.

mod drive;
mod lanes;
mod moreau;
mod number;
mod one_mass;
mod split;

pub use drive::Drive;
pub use lanes::{Batch, Kernel, Start, Width, simulate};
pub use number::Pure;
pub use one_mass::{NAMES, OneMass, PARAMETERS};
