//! Statistics of streams: pushed in chunks, merged across parts, without cancellation.

pub(crate) mod compensated;
pub mod counts;
pub mod figures;
pub mod groups;
pub mod moments;
mod moments_state;
pub mod rolling;
pub(crate) mod simd;
pub mod sketch;
pub(crate) mod spread;
pub mod window;

pub use counts::Counts;
pub use moments::{Moments, Settings};
pub use rolling::Rolling;
pub use sketch::QuantileSketch;
