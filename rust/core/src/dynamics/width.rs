//! Which instruction set a task over lanes runs on: chosen at run time, the same bits on each.

use pulp::WithSimd;

/// The instruction set to use: the widest there is, or one by name (for tests; the bits are the same).
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Width {
    /// The widest that this processor has.
    Widest,
    /// Two lanes at a time at most: what every processor of this kind has.
    Baseline,
    /// Four lanes at a time, if the processor can.
    Avx2,
    /// Eight lanes at a time, if the processor can.
    Avx512,
}

/// Runs a task with the instruction set asked for; one that the processor lacks gives way to the next below.
pub(crate) fn run(task: impl WithSimd<Output = ()>, width: Width) {
    #[cfg(any(target_arch = "x86", target_arch = "x86_64"))]
    {
        use pulp::Simd;
        if matches!(width, Width::Widest | Width::Avx512)
            && let Some(simd) = pulp::x86::V4::try_new()
        {
            return Simd::vectorize(simd, task);
        }
        if width != Width::Baseline
            && let Some(simd) = pulp::x86::V3::try_new()
        {
            return Simd::vectorize(simd, task);
        }
    }
    let _ = width;
    task.with_simd(pulp::Scalar::new());
}
