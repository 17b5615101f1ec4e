//! The one place that chooses an instruction set: a kernel written once in plain arrays is compiled for each width and
//! the widest that the machine has is taken at run time.
//!
//! No fused multiply-add and a fixed number of lanes: every width gives the same bits.
#![allow(unsafe_code)] // calling a function compiled for a wider set is unsafe; the machine was asked before

/// A piece of work that may be compiled for several instruction sets; its `run` must be `#[inline(always)]`.
pub(crate) trait Kernel {
    /// What it returns.
    type Output;
    /// The work.
    fn run(self) -> Self::Output;
}

/// The instruction sets a kernel is compiled for.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Width {
    /// What the build assumes (SSE2 on x86-64).
    Baseline,
    /// 256 bits.
    Avx2,
    /// 512 bits.
    Avx512,
}

/// The widest set this machine has; the standard library asks the processor once and remembers.
#[inline]
pub(crate) fn widest() -> Width {
    #[cfg(target_arch = "x86_64")]
    {
        if is_x86_feature_detected!("avx512f")
            && is_x86_feature_detected!("avx512dq")
            && is_x86_feature_detected!("avx512vl")
        {
            return Width::Avx512;
        }
        if is_x86_feature_detected!("avx2") {
            return Width::Avx2;
        }
    }
    Width::Baseline
}

/// Runs a kernel at the widest set.
#[inline]
pub(crate) fn run<K: Kernel>(kernel: K) -> K::Output {
    run_at(widest(), kernel)
}

/// Runs a kernel at one width, or at the widest below it that the machine has.
#[inline]
pub(crate) fn run_at<K: Kernel>(width: Width, kernel: K) -> K::Output {
    match width.min(widest()) {
        #[cfg(target_arch = "x86_64")]
        // SAFETY: `widest` found the features on this machine.
        Width::Avx512 => unsafe { avx512(kernel) },
        #[cfg(target_arch = "x86_64")]
        // SAFETY: as above.
        Width::Avx2 => unsafe { avx2(kernel) },
        _ => kernel.run(),
    }
}

#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx512f,avx512dq,avx512vl,avx2")]
fn avx512<K: Kernel>(kernel: K) -> K::Output {
    kernel.run()
}

#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx2")]
fn avx2<K: Kernel>(kernel: K) -> K::Output {
    kernel.run()
}
