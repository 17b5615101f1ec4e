//! Gustafsson's edges: the start states for which forward-backward and backward-forward agree best.
//!
//! With `O` the responses to the states, `F` the filter from rest and `R` the reversal, the difference of the two orders
//! is `(O - RFRO) s - R (O - RFRO) b - (RFRF - FRFR) x`; the start states `s` and `b` are its least-squares solution.
//!
//! Source: Gustafsson, "Determining the initial states in forward-backward filtering", IEEE Transactions on Signal
//! Processing 44 (1996) 988-992.

use nalgebra::{DMatrix, DVector};

use super::matrix::Vector;
use super::simd::Affine;
use super::zero_phase::ZeroPhase;

/// A singular value below this share of the largest belongs to a combination that both orders see alike.
const RANK: f64 = 1e-13;

/// Filters a record in place.
pub fn filter(filter: &ZeroPhase, x: &mut [f64]) {
    let (n, states) = (x.len(), filter.first.space.n);
    let (first, second) = (&filter.first, &filter.second);
    let rest: Vector = [0.0; super::matrix::MAX_POLES];
    let forward = |v: &mut [f64]| first.forward_in_place(&rest, Affine::NONE, v);
    let backward = |v: &mut [f64]| second.backward_in_place(&filter.turned, &rest, Affine::NONE, v);

    // Where a constant passes it passes both orders alike; where not, the answer depends on it.
    let level = x[0] * second.level_gain;
    for v in x.iter_mut() {
        *v -= level;
    }
    let mut forward_backward = x.to_vec();
    forward(&mut forward_backward);
    backward(&mut forward_backward);
    let mut backward_forward = x.to_vec();
    backward(&mut backward_forward);
    forward(&mut backward_forward);

    let mut columns = DMatrix::zeros(n, 2 * states);
    for k in 0..states {
        let mut unit = rest;
        unit[k] = 1.0;
        let mut seen = vec![0.0; n];
        first.forward_in_place(&unit, Affine::NONE, &mut seen);
        let mut again = seen.clone();
        backward(&mut again);
        for i in 0..n {
            let difference = seen[i] - again[i];
            columns[(i, k)] = difference;
            columns[(n - 1 - i, states + k)] = -difference;
        }
    }
    let right = DVector::from_iterator(
        n,
        forward_backward
            .iter()
            .zip(&backward_forward)
            .map(|(a, b)| a - b),
    );
    let decomposed = columns.svd(true, true);
    let smallest = RANK * decomposed.singular_values.max();
    // Solving fails only without the vectors that were asked for; at rest is then the answer.
    let solution = decomposed
        .solve(&right, smallest)
        .unwrap_or_else(|_| DVector::zeros(2 * states));
    let state = |from: usize| -> Vector {
        std::array::from_fn(|i| if i < states { solution[from + i] } else { 0.0 })
    };
    first.forward_in_place(&state(0), Affine::NONE, x);
    second.backward_in_place(&filter.turned, &state(states), Affine::lifted(level), x);
}
