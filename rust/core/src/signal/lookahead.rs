//! Sixteen samples at once: the block matrices of a system, in the order the kernel reads them.
//!
//! With the state `s` before a half block of eight samples `x`, `y = T x + O s` and `s + E8 s + R x` is the state after
//! it. A block is two halves; the state passes from block to block by `E16` alone, so that the chain of dependent
//! operations is one small product per sixteen samples. Everything about the states is an increment, which keeps the
//! digits of slow filters.

use super::matrix::{MAX_POLES, Vector, apply_left, power, together};
use super::state_space::StateSpace;

/// Samples of half a block.
pub const HALF: usize = 8;
/// Samples of a block.
pub const BLOCK: usize = 16;
/// Room for the states, a whole number of the widest registers.
pub const WIDE: usize = 16;

/// The state of a running filter, as wide as the kernel's registers.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct State(pub [f64; WIDE]);

impl State {
    /// The filter at rest.
    pub const REST: Self = Self([0.0; WIDE]);

    /// The same numbers with room for the registers.
    pub fn from_vector(v: &Vector) -> Self {
        let mut state = Self::REST;
        state.0[..MAX_POLES].copy_from_slice(v);
        state
    }

    /// The numbers without the room.
    pub fn vector(&self) -> Vector {
        std::array::from_fn(|i| self.0[i])
    }
}

/// The matrices by columns: the first index is the input's.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Block {
    /// Sample to outputs of its half block.
    pub t: [[f64; HALF]; HALF],
    /// State to outputs of a half block.
    pub o: [[f64; HALF]; MAX_POLES],
    /// Sample to increments of the states over its half block.
    pub r: [[f64; WIDE]; HALF],
    /// State to its increments over a half block.
    pub e8: [[f64; WIDE]; MAX_POLES],
    /// State to its increments over a block.
    pub e16: [[f64; WIDE]; MAX_POLES],
}

impl Block {
    /// The matrices for samples in the order of memory.
    pub fn forward(space: &StateSpace) -> Self {
        let n = space.n;
        let mut block = Self {
            t: [[0.0; HALF]; HALF],
            o: [[0.0; HALF]; MAX_POLES],
            r: [[0.0; WIDE]; HALF],
            e8: [[0.0; WIDE]; MAX_POLES],
            e16: [[0.0; WIDE]; MAX_POLES],
        };
        let (mut into, mut seen) = (space.b, space.c);
        let mut impulse = [space.d; HALF];
        for i in 0..HALF {
            for (o, c) in block.o.iter_mut().zip(&seen) {
                o[i] = *c;
            }
            block.r[HALF - 1 - i][..MAX_POLES].copy_from_slice(&into);
            if i + 1 < HALF {
                impulse[i + 1] = space.c.iter().zip(&into).map(|(c, v)| c * v).sum();
            }
            let more = super::matrix::apply(n, &space.e, &into);
            into.iter_mut().zip(&more).for_each(|(v, m)| *v += m);
            let more = apply_left(n, &seen, &space.e);
            seen.iter_mut().zip(&more).for_each(|(v, m)| *v += m);
        }
        for (j, column) in block.t.iter_mut().enumerate() {
            column[j..].copy_from_slice(&impulse[..HALF - j]);
        }
        let e8 = power(n, &space.e, HALF);
        let e16 = together(n, &e8, &e8);
        for row in 0..n {
            for column in 0..n {
                block.e8[column][row] = e8[row][column];
                block.e16[column][row] = e16[row][column];
            }
        }
        block
    }

    /// The matrices for samples against the order of memory.
    pub fn reversed(&self) -> Self {
        let mut turned = *self;
        turned.t.reverse();
        turned.t.iter_mut().for_each(|column| column.reverse());
        turned.o.iter_mut().for_each(|column| column.reverse());
        turned.r.reverse();
        turned
    }
}
