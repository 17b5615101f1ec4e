//! The event-driven solver that the tests trust: exact between events, events located to rounding.
//!
//! A mechanism of linear springs, springs with a gap, linear dampers and dry friction is linear in each of its *modes*
//! (which gaps are closed, which body slides to which side, which is held). Between two events its state and its drive
//! are one linear system `z' = A z`, and the motion is `exp(A t) z`. The exponential is summed as its power series over
//! stretches so short that what is left out is below rounding (`series.rs`); nothing divides by an eigenvalue, so that
//! repeated ones, resonance, no stiffness and no damping are cases like any other. On a stretch the quantities whose
//! signs end a mode are polynomials, and their first change of sign is isolated by their Bernstein coefficients, which
//! prove where there is none (`crossing.rs`): an event is not looked for, it cannot be passed over.

mod crossing;
mod mode;
mod run;
mod series;
mod signal;
mod system;

pub use run::{Exact, ExactEvent, Run, exact};
pub use signal::Signal;
pub use system::{Body, Spring, System};
