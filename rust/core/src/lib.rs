//! luztar: the arithmetic of friction and freeplay in steering mechanisms.
//!
//! One function stands behind most of it: `luz(x, a) = x - clamp(x, -a, a)` (see [`projections`]). The crate knows
//! no Python, no files, no clock and no global state.

pub mod driven;
pub mod dynamics;
pub mod effects;
pub mod error;
pub mod mechanism;
pub mod projections;
pub mod regression;
pub mod signal;
pub mod stats;
pub mod vehicle;

pub use error::Error;
