//! Least squares.

pub mod line;

pub use line::{Line, LineSums, fit_line};
