//! What lies beyond the ends of a record, told to the two passes by the states they start with.
//!
//! With the first pass `f = C1 s + D1 x`, `s += E s + B x` and the second run backward over `f`, the state of the second
//! at the record's last sample is `Q s_end + sum over m of A^m G e_m`: `s_end` the first's state after the record, `e_m`
//! the extension, `Q = sum of A^k B C1 A^k` and `G = B D1 + A Q B`. So the extension to the right is never filtered: one
//! run of the system with `G` in place of `B`, from far to near and without outputs, is enough, as one of `B` is to the
//! left. By point reflection both read the record itself.

use super::lookahead::{Block, State};
use super::matrix::{Matrix, Vector, ZERO, apply, power, product, solve, together};
use super::simd::{Affine, Order};
use super::state_space::{StateSpace, Steady};
use super::system::System;

/// Everything about the extensions that depends on the filter alone.
#[derive(Debug, Clone, PartialEq)]
pub struct Around {
    /// State after the record to the state the second pass starts with.
    q: Matrix,
    /// The extension's way into the second pass.
    pub(super) g: Vector,
    /// The first pass, against the order of memory.
    left: Block,
    /// `G` in place of `B`, as the samples lie.
    right: Block,
    /// `G` in place of `B`, against the order of memory.
    right_turned: Block,
    right_steady: Steady,
}

/// The states the passes start with, as far as the record tells.
#[derive(Debug, Clone)]
pub struct Starts {
    /// Before the first sample of the first pass.
    pub first: Vector,
    rest: Rest,
}

#[derive(Debug, Clone)]
enum Rest {
    /// The extension's part of the second's start.
    Infinite(Vector),
    /// The extension itself, which ends in a constant.
    Padded(Vec<f64>),
}

impl Starts {
    /// The record reflected for `pad` samples on each side, and a constant beyond.
    pub fn padded(first: &System, x: &[f64], pad: usize) -> Self {
        let (n, level, last) = (x.len(), x[0], x[x.len() - 1]);
        let mut state = first.steady.at(level - x[pad], 0.0);
        for v in x[1..=pad].iter().rev() {
            first.space.advance(&mut state, level - v);
        }
        let end = (last - level) + last;
        let extension = x[n - 1 - pad..n - 1]
            .iter()
            .rev()
            .map(|v| end - v)
            .collect();
        Self {
            first: state,
            rest: Rest::Padded(extension),
        }
    }

    /// The state the second pass starts with, from the state `after` the first.
    pub fn second(
        &self,
        first: &System,
        second: &System,
        around: &Around,
        after: &Vector,
    ) -> Vector {
        match &self.rest {
            Rest::Infinite(part) => {
                let own = apply(first.space.n, &around.q, after);
                std::array::from_fn(|i| own[i] + part[i])
            }
            Rest::Padded(extension) => {
                let mut state = *after;
                let through: Vec<f64> = extension
                    .iter()
                    .map(|e| first.space.step(&mut state, *e))
                    .collect();
                let mut state = second.steady.at(through[through.len() - 1], 0.0);
                for f in through.iter().rev() {
                    second.space.advance(&mut state, *f);
                }
                state
            }
        }
    }
}

impl Around {
    /// Sums the doubling series for `Q` until nothing is added.
    pub fn new(first: &StateSpace, block: &Block) -> Self {
        let n = first.n;
        let mut q = ZERO;
        for (row, b) in q.iter_mut().zip(&first.b) {
            *row = first.c.map(|c| b * c);
        }
        let mut e = first.e;
        // Q of 2m terms is Q + A^m Q A^m; ninety doublings outlast any design.
        for _ in 0..90 {
            let aq = plus(&q, &product(n, &e, &q));
            let more = plus(&aq, &product(n, &aq, &e));
            q = plus(&q, &more);
            if more.as_flattened().iter().all(|v| v.abs() < 1e-30) {
                break;
            }
            e = together(n, &e, &e);
        }
        let qb = apply(n, &q, &first.b);
        let eqb = apply(n, &first.e, &qb);
        let g: Vector = std::array::from_fn(|i| first.b[i] * first.d + qb[i] + eqb[i]);
        let right_space = StateSpace { b: g, ..*first };
        let right = Block::forward(&right_space);
        Self {
            q,
            g,
            left: block.reversed(),
            right_turned: right.reversed(),
            right,
            right_steady: right_space.steady(),
        }
    }

    /// Where the second pass starts if the signal stays at its newest sample.
    pub fn held(&self, first: &System, after: &Vector, newest: f64) -> Vector {
        let own = apply(first.space.n, &self.q, after);
        let to_come = self.right_steady.at(newest, 0.0);
        std::array::from_fn(|i| own[i] + to_come[i])
    }

    /// The record reflected once on each side, for `pad` samples; the filter has settled on the chord of the extension
    /// where it begins.
    pub fn settled(&self, first: &System, x: &[f64], pad: usize) -> Starts {
        self.settled_ends(first, &x[..=pad], &x[x.len() - 1 - pad..])
    }

    /// [`Self::settled`] from the first and the last `pad + 1` samples alone.
    pub fn settled_ends(&self, first: &System, head: &[f64], tail: &[f64]) -> Starts {
        let pad = head.len() - 1;
        let (level, last) = (head[0], tail[pad]);
        let reflected = |shift| Affine::new(-1.0, shift, 0.0);
        let far = level - head[pad];
        let mut left = Run::new(first, first.space.b);
        left.state = first.steady.at(far, -far / pad as f64);
        left.descending(&self.left, reflected(level), &head[1..]);

        let end = (last - level) + last;
        let far = end - tail[0];
        let mut right = Run::new(first, self.g);
        right.state = self
            .right_steady
            .at(far, ((last - level) - far) / pad as f64);
        right.ascending(&self.right, reflected(end), &tail[..pad]);
        Starts {
            first: left.state,
            rest: Rest::Infinite(right.state),
        }
    }

    /// The record, which begins and ends at zero, reflected again and again: it repeats every `2 (n - 1)` samples. As
    /// far as `pad` if that is within one period, else forever: then the state repeats, too.
    pub fn repeated(&self, first: &System, x: &[f64], pad: usize) -> Starts {
        let (states, n) = (first.space.n, x.len());
        let period = 2 * (n - 1);
        // Of the first half of the period, which is the record itself, what lies within the pad.
        let from = period.saturating_sub(pad).min(n - 1);
        let turned = Affine::new(-1.0, 0.0, 0.0);
        let mut left = Run::new(first, first.space.b);
        left.ascending(&first.block, Affine::NONE, &x[from..]);
        left.descending(&self.left, turned, &x[1..n - 1]);
        let mut right = Run::new(first, self.g);
        right.descending(&self.right_turned, Affine::NONE, &x[..n - from]);
        right.ascending(&self.right, turned, &x[1..n - 1]);
        if pad > period {
            // s = A^P s + u, so that (A^P - I) s = -u
            let again = power(states, &first.space.e, period);
            for run in [&mut left, &mut right] {
                run.state = solve(states, &again, &run.state.map(|v| -v));
            }
        }
        Starts {
            first: left.state,
            rest: Rest::Infinite(right.state),
        }
    }
}

/// A state on its way over parts of any length, from rest.
struct Run<'a> {
    system: &'a System,
    into: Vector,
    state: Vector,
}

impl<'a> Run<'a> {
    fn new(system: &'a System, into: Vector) -> Self {
        Self {
            system,
            into,
            state: [0.0; super::matrix::MAX_POLES],
        }
    }

    fn ascending(&mut self, block: &Block, affine: Affine, x: &[f64]) {
        let (blocks, rest) = x.split_at(x.len() / 16 * 16);
        self.blocks(block, Order::Ascending, affine, blocks);
        for v in rest {
            self.step(affine.way_in(*v));
        }
    }

    fn descending(&mut self, block: &Block, affine: Affine, x: &[f64]) {
        let (rest, blocks) = x.split_at(x.len() % 16);
        self.blocks(block, Order::Descending, affine, blocks);
        for v in rest.iter().rev() {
            self.step(affine.way_in(*v));
        }
    }

    fn blocks(&mut self, block: &Block, order: Order, affine: Affine, x: &[f64]) {
        let mut state = State::from_vector(&self.state);
        self.system
            .kernel
            .advance(block, &mut state, order, affine, x);
        self.state = state.vector();
    }

    fn step(&mut self, x: f64) {
        let space = &self.system.space;
        let increments = apply(space.n, &space.e, &self.state);
        for (s, (increment, b)) in self.state.iter_mut().zip(increments.iter().zip(&self.into)) {
            *s += increment + b * x;
        }
    }
}

fn plus(a: &Matrix, b: &Matrix) -> Matrix {
    std::array::from_fn(|i| std::array::from_fn(|j| a[i][j] + b[i][j]))
}
