//! Many channels side by side in one register: the sections' recursion, sample by sample.

use super::InstructionSet;
use super::lanes::Lanes;
use crate::signal::section::Solved;

/// The most channels one run takes: two of the widest registers.
pub const GROUP: usize = 16;
/// The states of a group: of each section two, of each of those one number per channel.
pub type GroupState = [[[f64; GROUP]; 2]; 6];

/// Frames of a group of channels, and where they lie.
pub struct Frames<'a> {
    /// At most six.
    pub sections: &'a [Solved],
    /// The group's memory.
    pub state: &'a mut GroupState,
    /// Subtracted from each channel's samples.
    pub origin: &'a [f64; GROUP],
    /// Added to each channel's results.
    pub lift: &'a [f64; GROUP],
}

/// Filters frames of sixteen neighbouring channels in place: the first at `first`, the next `stride` doubles further;
/// from the last frame to the first if `descending`.
///
/// # Panics
/// Where the last frame does not lie in `samples`: the caller cuts them.
pub fn run_frames(
    set: InstructionSet,
    work: &mut Frames<'_>,
    samples: &mut [f64],
    first: usize,
    stride: usize,
    frames: usize,
    descending: bool,
) {
    if frames == 0 {
        return;
    }
    let end = (frames - 1)
        .checked_mul(stride)
        .and_then(|last| last.checked_add(first + GROUP));
    assert!(
        end.is_some_and(|end| end <= samples.len()),
        "frames beyond the samples"
    );
    assert!(set.available() && work.sections.len() <= work.state.len());
    let (start, step) = if descending {
        (first + (frames - 1) * stride, -stride.cast_signed())
    } else {
        (first, stride.cast_signed())
    };
    // Sound: every frame of sixteen doubles lies in `samples`, checked above, and the set is available.
    unsafe {
        let at = samples.as_mut_ptr().add(start);
        match set {
            #[cfg(target_arch = "x86_64")]
            InstructionSet::Avx512 => on_avx512(work, at, step, frames),
            #[cfg(target_arch = "x86_64")]
            InstructionSet::Avx2 => on_avx2(work, at, step, frames),
            #[cfg(target_arch = "x86_64")]
            InstructionSet::Sse2 => on_sse2(work, at, step, frames),
            _ => on_scalar(work, at, step, frames),
        }
    }
}

/// `S` sections over `U` registers of channels, `GROUP / (U * WIDTH)` times side by side.
#[inline(always)]
unsafe fn recur<V: Lanes, const S: usize, const U: usize>(
    work: &mut Frames<'_>,
    at: *mut f64,
    step: isize,
    frames: usize,
) {
    unsafe {
        for group in 0..GROUP / (U * V::WIDTH) {
            let lane = group * U * V::WIDTH;
            let load =
                |from: &[f64; GROUP], u: usize| V::load(from.as_ptr().add(lane + u * V::WIDTH));
            let minus = V::splat(-1.0);
            let origin: [V; U] = std::array::from_fn(|u| load(work.origin, u).mul(minus));
            let lift: [V; U] = std::array::from_fn(|u| load(work.lift, u));
            let mut state: [[[V; U]; 2]; S] = std::array::from_fn(|i| {
                std::array::from_fn(|j| std::array::from_fn(|u| load(&work.state[i][j], u)))
            });
            for frame in 0..frames {
                let place = at.offset(step * frame.cast_signed()).add(lane);
                let mut signal: [V; U] = std::array::from_fn(|u| {
                    let x = V::load(place.add(u * V::WIDTH));
                    x.add(origin[u])
                });
                for (section, state) in work.sections.iter().zip(&mut state) {
                    let ([e00, e01], [e10, e11]) = (
                        section.e[0].map(|v| V::splat(v)),
                        section.e[1].map(|v| V::splat(v)),
                    );
                    let ([b0, b1], [c0, c1]) = (
                        section.b.map(|v| V::splat(v)),
                        section.c.map(|v| V::splat(v)),
                    );
                    let d = V::splat(section.d);
                    for (u, signal) in signal.iter_mut().enumerate() {
                        let (x, s0, s1) = (*signal, state[0][u], state[1][u]);
                        *signal = x.mul_add(d, s1.mul_add(c1, s0.mul(c0)));
                        state[0][u] = s0.add(x.mul_add(b0, s1.mul_add(e01, s0.mul(e00))));
                        state[1][u] = s1.add(x.mul_add(b1, s1.mul_add(e11, s0.mul(e10))));
                    }
                }
                for (u, signal) in signal.iter().enumerate() {
                    signal.add(lift[u]).store(place.add(u * V::WIDTH));
                }
            }
            for (i, section) in state.iter().enumerate() {
                for (j, registers) in section.iter().enumerate() {
                    for (u, register) in registers.iter().enumerate() {
                        register.store(work.state[i][j].as_mut_ptr().add(lane + u * V::WIDTH));
                    }
                }
            }
        }
    }
}

/// The recursion of an instruction set for every number of sections.
macro_rules! on {
    ($name:ident, $register:ty, $registers:literal, $($feature:literal)?) => {
        $(#[target_feature(enable = $feature)])?
        unsafe fn $name(work: &mut Frames<'_>, at: *mut f64, step: isize, frames: usize) {
            unsafe {
                match work.sections.len() {
                    0 | 1 => recur::<$register, 1, $registers>(work, at, step, frames),
                    2 => recur::<$register, 2, $registers>(work, at, step, frames),
                    3 => recur::<$register, 3, $registers>(work, at, step, frames),
                    4 => recur::<$register, 4, $registers>(work, at, step, frames),
                    5 => recur::<$register, 5, $registers>(work, at, step, frames),
                    _ => recur::<$register, 6, $registers>(work, at, step, frames),
                }
            }
        }
    };
}

on!(on_scalar, f64, 2,);
#[cfg(target_arch = "x86_64")]
on!(on_sse2, std::arch::x86_64::__m128d, 2, "sse2");
#[cfg(target_arch = "x86_64")]
on!(on_avx2, std::arch::x86_64::__m256d, 2, "avx2,fma");
#[cfg(target_arch = "x86_64")]
on!(
    on_avx512,
    std::arch::x86_64::__m512d,
    2,
    "avx512f,avx512vl,avx512dq,avx2,fma"
);
