//! The block kernel in the registers of the processor at hand: the only place of the crate with unsafe code.
//!
//! One generic kernel (`kernel`) is compiled for every instruction set over the registers of `lanes`; which one runs is
//! a value ([`InstructionSet`]), found once per design and never global.
#![allow(unsafe_code)]
// A register passed by value through a call is a register lost: everything here is one function after inlining, its
// loops of known length are unrolled, and the intrinsics come by the dozen.
#![allow(
    clippy::inline_always,
    clippy::needless_range_loop,
    clippy::needless_pass_by_value,
    clippy::wildcard_imports
)]

mod frames;
mod kernel;
mod lanes;

use super::lookahead::{BLOCK, Block, State};

pub(super) use frames::{Frames, GROUP, GroupState, run_frames};

/// The registers a kernel runs in.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum InstructionSet {
    /// One number at a time, on every processor.
    Scalar,
    /// Two at a time, without fused multiply-add.
    Sse2,
    /// Four at a time.
    Avx2,
    /// Eight at a time.
    Avx512,
}

impl InstructionSet {
    /// All of them, the narrowest first.
    pub const ALL: [Self; 4] = [Self::Scalar, Self::Sse2, Self::Avx2, Self::Avx512];

    /// Whether this processor has it.
    #[must_use]
    pub fn available(self) -> bool {
        #[cfg(target_arch = "x86_64")]
        match self {
            Self::Scalar | Self::Sse2 => true,
            Self::Avx2 => is_x86_feature_detected!("avx2") && is_x86_feature_detected!("fma"),
            Self::Avx512 => {
                Self::Avx2.available()
                    && is_x86_feature_detected!("avx512f")
                    && is_x86_feature_detected!("avx512vl")
                    && is_x86_feature_detected!("avx512dq")
            }
        }
        #[cfg(not(target_arch = "x86_64"))]
        {
            self == Self::Scalar
        }
    }

    /// The widest this processor has.
    #[must_use]
    pub fn best() -> Self {
        let mut found = Self::ALL.into_iter().filter(|set| set.available());
        found.next_back().unwrap_or(Self::Scalar)
    }

    /// The name as users write it.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Scalar => "scalar",
            Self::Sse2 => "sse2",
            Self::Avx2 => "avx2",
            Self::Avx512 => "avx512",
        }
    }
}

/// The order in which samples are taken.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Order {
    /// As they lie in memory.
    Ascending,
    /// Against it, with the [`Block::reversed`] matrices.
    Descending,
}

/// What happens to a sample on its way in and out: `scale x + shift` is filtered, `lift` is added to the result.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Affine {
    scale: f64,
    shift: f64,
    lift: f64,
    /// Samples known to be moderate that go in as they are: they are read where they lie.
    as_they_are: bool,
}

impl Affine {
    /// Samples known to be moderate, nothing happens to them.
    pub const NONE: Self = Self::lifted(0.0);

    /// Samples known to be moderate; `lift` is added to what comes out.
    pub const fn lifted(lift: f64) -> Self {
        Self {
            scale: 1.0,
            shift: 0.0,
            lift,
            as_they_are: true,
        }
    }

    /// `scale x + shift` goes in, `lift` is added to what comes out; samples are looked at.
    pub const fn new(scale: f64, shift: f64, lift: f64) -> Self {
        Self {
            scale,
            shift,
            lift,
            as_they_are: false,
        }
    }

    /// What goes in for a sample.
    pub fn way_in(&self, x: f64) -> f64 {
        self.scale * x + self.shift
    }
}

/// Where a kernel reads and writes.
struct Work<'a> {
    block: &'a Block,
    state: &'a mut State,
    /// The first sample in memory, whatever the order.
    input: *const f64,
    /// The first result in memory; not written by [`kernel::advance`].
    output: *mut f64,
    blocks: usize,
    affine: Affine,
}

/// A kernel for one number of states on one instruction set.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Kernel {
    set: InstructionSet,
    states: usize,
}

impl Kernel {
    /// The kernel for a system of `states` on `set`, or the widest set there is if `set` is not available.
    pub fn new(states: usize, set: InstructionSet) -> Self {
        let set = if set.available() {
            set
        } else {
            InstructionSet::best()
        };
        Self { set, states }
    }

    /// The instruction set it runs on.
    pub fn set(&self) -> InstructionSet {
        self.set
    }

    /// Filters the whole blocks of `x` into `out`; false if a sample was not of moderate magnitude
    /// (unless they are taken as they are).
    ///
    /// # Panics
    /// Lengths that differ or are no multiple of a block: the callers cut them.
    pub fn filter(
        &self,
        block: &Block,
        state: &mut State,
        order: Order,
        affine: Affine,
        x: &[f64],
        out: &mut [f64],
    ) -> bool {
        assert!(x.len() == out.len() && x.len().is_multiple_of(BLOCK));
        let work = Work {
            block,
            state,
            input: x.as_ptr(),
            output: out.as_mut_ptr(),
            blocks: x.len() / BLOCK,
            affine,
        };
        // Sound: both slices hold `blocks` blocks and do not overlap.
        unsafe { self.run(work, order, true) }
    }

    /// [`Self::filter`] in place.
    ///
    /// # Panics
    /// A length that is no multiple of a block.
    pub fn filter_in_place(
        &self,
        block: &Block,
        state: &mut State,
        order: Order,
        affine: Affine,
        x: &mut [f64],
    ) -> bool {
        assert!(x.len().is_multiple_of(BLOCK));
        let output = x.as_mut_ptr();
        let work = Work {
            block,
            state,
            input: output,
            output,
            blocks: x.len() / BLOCK,
            affine,
        };
        // Sound: the slice holds `blocks` blocks; a block is read whole before it is written.
        unsafe { self.run(work, order, true) }
    }

    /// Moves only the state over the whole blocks of `x`.
    ///
    /// # Panics
    /// A length that is no multiple of a block.
    pub fn advance(
        &self,
        block: &Block,
        state: &mut State,
        order: Order,
        affine: Affine,
        x: &[f64],
    ) {
        assert!(x.len().is_multiple_of(BLOCK));
        let work = Work {
            block,
            state,
            input: x.as_ptr(),
            output: std::ptr::null_mut(),
            blocks: x.len() / BLOCK,
            affine,
        };
        // Sound: the slice holds `blocks` blocks and `advance` does not write.
        unsafe { self.run(work, order, false) };
    }

    /// # Safety
    /// `input` holds `blocks` blocks; `output` too if the results are `wanted`. The set is available: see [`Self::new`].
    unsafe fn run(&self, work: Work<'_>, order: Order, wanted: bool) -> bool {
        unsafe {
            match self.set {
                #[cfg(target_arch = "x86_64")]
                InstructionSet::Avx512 => kernel::on_avx512(self.states, order, wanted, work),
                #[cfg(target_arch = "x86_64")]
                InstructionSet::Avx2 => kernel::on_avx2(self.states, order, wanted, work),
                #[cfg(target_arch = "x86_64")]
                InstructionSet::Sse2 => kernel::on_sse2(self.states, order, wanted, work),
                _ => kernel::on_scalar(self.states, order, wanted, work),
            }
        }
    }
}
