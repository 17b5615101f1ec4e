//! A cascade made ready to run: its linear system, its block matrices and the kernel for this processor.

use super::cascade::Cascade;
use super::lookahead::{BLOCK, Block, State};
use super::matrix::Vector;
use super::simd::{Affine, InstructionSet, Kernel, Order};
use super::state_space::{StateSpace, Steady};

/// One pass of a filter.
#[derive(Debug, Clone, PartialEq)]
pub struct System {
    pub(super) space: StateSpace,
    pub(super) kernel: Kernel,
    pub(super) block: Block,
    pub(super) steady: Steady,
    /// The gain of a constant: 1 or 0.
    pub(super) level_gain: f64,
}

impl System {
    /// Prepares a cascade for the instruction set.
    pub fn new(cascade: &Cascade, set: InstructionSet) -> Self {
        let space = cascade.space();
        Self {
            kernel: Kernel::new(space.n, set),
            block: Block::forward(&space),
            steady: space.steady(),
            level_gain: cascade.level_gain,
            space,
        }
    }

    /// The same with the output times `gain`.
    pub fn scaled(mut self, gain: f64) -> Self {
        self.space.c.iter_mut().for_each(|c| *c *= gain);
        self.space.d *= gain;
        self.block = Block::forward(&self.space);
        self.level_gain *= gain;
        self
    }

    /// Filters `x` into `out` from `state` and returns the state after the last sample; false if a sample was not of
    /// moderate magnitude.
    pub fn forward(
        &self,
        state: &Vector,
        affine: Affine,
        x: &[f64],
        out: &mut [f64],
    ) -> (Vector, bool) {
        let whole = x.len() / BLOCK * BLOCK;
        let mut state = State::from_vector(state);
        let mut good = self.kernel.filter(
            &self.block,
            &mut state,
            Order::Ascending,
            affine,
            &x[..whole],
            &mut out[..whole],
        );
        let (after, rest_good) = self.rest(&state, affine, &x[whole..], |y| {
            out[whole..].copy_from_slice(y);
        });
        good &= rest_good;
        (after, good)
    }

    /// [`Self::forward`] in place.
    pub fn forward_in_place(
        &self,
        state: &Vector,
        affine: Affine,
        x: &mut [f64],
    ) -> (Vector, bool) {
        let whole = x.len() / BLOCK * BLOCK;
        let mut state = State::from_vector(state);
        let (blocks, last) = x.split_at_mut(whole);
        let mut good =
            self.kernel
                .filter_in_place(&self.block, &mut state, Order::Ascending, affine, blocks);
        let given: [f64; BLOCK] = std::array::from_fn(|i| last.get(i).copied().unwrap_or(0.0));
        let (after, rest_good) = self.rest(&state, affine, &given[..last.len()], |y| {
            last.copy_from_slice(y);
        });
        good &= rest_good;
        (after, good)
    }

    /// The last samples, fewer than a block: the first rows of the block product, and the state after them.
    fn rest(
        &self,
        state: &State,
        affine: Affine,
        x: &[f64],
        put: impl FnOnce(&[f64]),
    ) -> (Vector, bool) {
        let mut after = state.vector();
        if x.is_empty() {
            return (after, true);
        }
        let mut staged = [0.0; BLOCK];
        staged[..x.len()].copy_from_slice(x);
        let good = self.kernel.filter_in_place(
            &self.block,
            &mut state.clone(),
            Order::Ascending,
            affine,
            &mut staged,
        );
        put(&staged[..x.len()]);
        for x in x {
            self.space.advance(&mut after, affine.way_in(*x));
        }
        (after, good)
    }

    /// Filters in place from the last sample to the first; `turned` are the reversed matrices of this system.
    pub fn backward_in_place(&self, turned: &Block, state: &Vector, affine: Affine, x: &mut [f64]) {
        let short = x.len() % BLOCK;
        let mut state = State::from_vector(state);
        let (first, blocks) = x.split_at_mut(short);
        self.kernel
            .filter_in_place(turned, &mut state, Order::Descending, affine, blocks);
        if short > 0 {
            let mut staged = [0.0; BLOCK];
            staged[BLOCK - short..].copy_from_slice(first);
            self.kernel
                .filter_in_place(turned, &mut state, Order::Descending, affine, &mut staged);
            first.copy_from_slice(&staged[BLOCK - short..]);
        }
    }
}
