//! Driven runs: the motion is given, the torque follows. A recording is prepared once; every model is then a set of
//! columns, each through the measurement's own low pass, whose sum with coefficients is the model's torque.

mod cache;
mod columns;
mod contact;
mod equations;
mod kinematics;
mod recording;
mod resolution;
mod rests;
mod staircase;
mod start;
mod strokes;
mod whitening;
mod within_step;

pub use columns::{Term, inner_of};
pub use equations::{Blocks, Rows, solve};
pub use recording::{Band, Recording, Travel};
pub use strokes::Stroke;
pub use whitening::Whitening;
