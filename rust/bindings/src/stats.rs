//! Statistics of streams.

mod moments;
mod quantiles;
mod window;

pub use moments::{Moments, moments_by_label, moments_by_window};
pub use quantiles::{Counts, QuantileSketch};
pub use window::{Rolling, rolling};

/// All there is to store of a stream: whole numbers, then floats.
type State = (Vec<u64>, Vec<f64>);
