//! How much of what is far away still acts: the tail of the zero-phase impulse response.

use super::extension::Around;
use super::matrix::{Vector, apply, power};
use super::state_space::StateSpace;

/// The tail is summed over at most this many points of the response.
const POINTS: usize = 1 << 12;
/// Points every few samples instead of all of them cost this share at most; the sum is raised by it, to stay a bound.
const MARGIN: f64 = 1.01;

/// `sum of |h(k)|` over `k > distance`, at a grid of distances.
#[derive(Debug, Clone, PartialEq)]
pub struct Tail {
    stride: usize,
    /// Beyond `0, stride, 2 stride, ...` samples.
    beyond: Vec<f64>,
}

impl Tail {
    /// The response at lag `m + 1` is `C A^m G`; `length` is where nothing is left.
    pub fn new(second: &StateSpace, around: &Around, length: usize) -> Self {
        let n = second.n;
        let stride = length.div_ceil(POINTS).max(1);
        let step = power(n, &second.e, stride);
        let mut state: Vector = around.g;
        let response = |s: &Vector| {
            second
                .c
                .iter()
                .zip(s)
                .map(|(c, s)| c * s)
                .sum::<f64>()
                .abs()
        };
        let mut values = vec![response(&state)];
        for _ in 0..length.div_ceil(stride) {
            let more = apply(n, &step, &state);
            state.iter_mut().zip(&more).for_each(|(s, m)| *s += m);
            values.push(response(&state));
        }
        let margin = if stride > 1 { MARGIN } else { 1.0 };
        let mut beyond = vec![0.0; values.len()];
        let mut sum = 0.0;
        for (place, pair) in beyond.iter_mut().zip(values.windows(2)).rev() {
            // every sample once; between points the mean of both ends
            let mean = if stride > 1 {
                0.5 * (pair[0] + pair[1])
            } else {
                pair[0]
            };
            sum += margin * stride as f64 * mean;
            *place = sum;
        }
        Self { stride, beyond }
    }

    /// The tail beyond a distance in samples.
    pub fn beyond(&self, distance: usize) -> f64 {
        self.beyond
            .get(distance / self.stride)
            .copied()
            .unwrap_or(0.0)
    }

    /// The least distance beyond which no more than `tolerance` is left.
    pub fn distance(&self, tolerance: f64) -> usize {
        self.beyond.partition_point(|b| *b > tolerance) * self.stride
    }
}
