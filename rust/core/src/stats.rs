//! Statistics of streams: pushed in chunks, merged across parts, without cancellation.

pub(crate) mod compensated;
pub mod moments;

pub use moments::Moments;
