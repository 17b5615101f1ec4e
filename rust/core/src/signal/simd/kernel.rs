//! The block kernel: sixteen samples per step, generic over the registers.

use super::lanes::Lanes;
use super::{Order, Work};
use crate::error::LARGEST;
use crate::signal::lookahead::{BLOCK, HALF};

/// One block of samples on its way through the registers.
#[repr(align(64))]
struct Staged([f64; BLOCK]);

/// Filters `work.blocks` blocks; false if a sample was not of moderate magnitude.
///
/// `N` states in `S` registers, half a block of outputs in `P` registers.
#[inline(always)]
unsafe fn filter<V: Lanes, const N: usize, const S: usize, const P: usize, const UP: bool>(
    work: Work<'_>,
) -> bool {
    unsafe {
        let block = work.block;
        let mut s: [V; S] = load_all(work.state.0.as_ptr());
        let (scale, shift) = (V::splat(work.affine.scale), V::splat(work.affine.shift));
        let (lift, limit) = (V::splat(work.affine.lift), V::splat(LARGEST));
        let mut bad = V::none();
        for i in 0..work.blocks {
            let at = BLOCK * if UP { i } else { work.blocks - 1 - i };
            let (input, output) = (work.input.add(at), work.output.add(at));
            let mut staged = Staged([0.0; BLOCK]);
            for p in 0..2 * P {
                let x = V::load(input.add(p * V::WIDTH));
                bad = x.outside(limit, bad);
                x.mul_add(scale, shift)
                    .store(staged.0.as_mut_ptr().add(p * V::WIDTH));
            }
            // The half that comes first in time.
            let (early, late) = if UP { (0, HALF) } else { (HALF, 0) };
            let first = staged.0.as_ptr().add(early);
            let second = staged.0.as_ptr().add(late);
            let through_first = increments::<V, S>(block, first);
            let through_second = increments::<V, S>(block, second);
            let middle = add_all(s, with_states::<V, N, S>(&block.e8, s, through_first));
            let carried = with_states::<V, N, S>(
                &block.e8,
                through_first,
                add_all(through_first, through_second),
            );
            let next = add_all(s, with_states::<V, N, S>(&block.e16, s, carried));
            outputs::<V, N, S, P, UP>(work.block, s, first, output.add(early), lift);
            outputs::<V, N, S, P, UP>(work.block, middle, second, output.add(late), lift);
            s = next;
        }
        for (i, register) in s.iter().enumerate() {
            register.store(work.state.0.as_mut_ptr().add(i * V::WIDTH));
        }
        !V::any(bad)
    }
}

/// [`filter`] without the outputs.
#[inline(always)]
unsafe fn advance<V: Lanes, const N: usize, const S: usize, const P: usize, const UP: bool>(
    work: Work<'_>,
) -> bool {
    unsafe {
        let block = work.block;
        let mut s: [V; S] = load_all(work.state.0.as_ptr());
        let (scale, shift) = (V::splat(work.affine.scale), V::splat(work.affine.shift));
        for i in 0..work.blocks {
            let input = work
                .input
                .add(BLOCK * if UP { i } else { work.blocks - 1 - i });
            let mut staged = Staged([0.0; BLOCK]);
            for p in 0..2 * P {
                let x = V::load(input.add(p * V::WIDTH)).mul_add(scale, shift);
                x.store(staged.0.as_mut_ptr().add(p * V::WIDTH));
            }
            let (early, late) = if UP { (0, HALF) } else { (HALF, 0) };
            let through_first = increments::<V, S>(block, staged.0.as_ptr().add(early));
            let through_second = increments::<V, S>(block, staged.0.as_ptr().add(late));
            let carried = with_states::<V, N, S>(
                &block.e8,
                through_first,
                add_all(through_first, through_second),
            );
            s = add_all(s, with_states::<V, N, S>(&block.e16, s, carried));
        }
        for (i, register) in s.iter().enumerate() {
            register.store(work.state.0.as_mut_ptr().add(i * V::WIDTH));
        }
        true
    }
}

#[inline(always)]
unsafe fn load_all<V: Lanes, const S: usize>(from: *const f64) -> [V; S] {
    std::array::from_fn(|i| unsafe { V::load(from.add(i * V::WIDTH)) })
}

#[inline(always)]
unsafe fn add_all<V: Lanes, const S: usize>(a: [V; S], b: [V; S]) -> [V; S] {
    std::array::from_fn(|i| unsafe { a[i].add(b[i]) })
}

/// What half a block adds to the states that were at rest.
#[inline(always)]
unsafe fn increments<V: Lanes, const S: usize>(
    block: &crate::signal::lookahead::Block,
    samples: *const f64,
) -> [V; S] {
    unsafe {
        let x = V::splat(*samples);
        let mut sum: [V; S] =
            std::array::from_fn(|i| x.mul(V::load(block.r[0].as_ptr().add(i * V::WIDTH))));
        for j in 1..HALF {
            let x = V::splat(*samples.add(j));
            for (i, sum) in sum.iter_mut().enumerate() {
                *sum = x.mul_add(V::load(block.r[j].as_ptr().add(i * V::WIDTH)), *sum);
            }
        }
        sum
    }
}

/// `sum` and the states' own increments, in two chains that run side by side.
#[inline(always)]
unsafe fn with_states<V: Lanes, const N: usize, const S: usize>(
    e: &[[f64; crate::signal::lookahead::WIDE]; crate::signal::matrix::MAX_POLES],
    s: [V; S],
    sum: [V; S],
) -> [V; S] {
    unsafe {
        let mut even = sum;
        let mut odd = [V::splat(0.0); S];
        for k in 0..N {
            let state = s[k / V::WIDTH].lane(k % V::WIDTH);
            for i in 0..S {
                let column = V::load(e[k].as_ptr().add(i * V::WIDTH));
                if k == 1 {
                    odd[i] = state.mul(column);
                } else if k % 2 == 0 {
                    even[i] = state.mul_add(column, even[i]);
                } else {
                    odd[i] = state.mul_add(column, odd[i]);
                }
            }
        }
        add_all(even, odd)
    }
}

/// The outputs of half a block.
#[inline(always)]
unsafe fn outputs<V: Lanes, const N: usize, const S: usize, const P: usize, const UP: bool>(
    block: &crate::signal::lookahead::Block,
    s: [V; S],
    samples: *const f64,
    output: *mut f64,
    lift: V,
) {
    unsafe {
        let mut y: [V; P] = [V::splat(0.0); P];
        // A sample acts on the outputs that are not before it: the registers above or below the diagonal are skipped.
        for j in 0..HALF {
            let x = V::splat(*samples.add(j));
            for (p, y) in y.iter_mut().enumerate() {
                let skipped = if UP {
                    (p + 1) * V::WIDTH <= j
                } else {
                    p * V::WIDTH > j
                };
                if !skipped {
                    let column = V::load(block.t[j].as_ptr().add(p * V::WIDTH));
                    *y = x.mul_add(column, *y);
                }
            }
        }
        for k in 0..N {
            let state = s[k / V::WIDTH].lane(k % V::WIDTH);
            for (p, y) in y.iter_mut().enumerate() {
                *y = state.mul_add(V::load(block.o[k].as_ptr().add(p * V::WIDTH)), *y);
            }
        }
        for (p, y) in y.iter().enumerate() {
            y.add(lift).store(output.add(p * V::WIDTH));
        }
    }
}

/// The kernel of an instruction set for any number of states: rounded up to 2, 4, 8 or 12.
macro_rules! on {
    ($name:ident, $register:ty, $width:literal, $($feature:literal)?) => {
        $(#[target_feature(enable = $feature)])?
        pub(super) unsafe fn $name(states: usize, order: Order, wanted: bool, work: Work<'_>) -> bool {
            const P: usize = HALF / $width;
            unsafe {
                match (states, order, wanted) {
                    (0..=2, Order::Ascending, true) => filter::<$register, 2, { 2_usize.div_ceil($width) }, P, true>(work),
                    (0..=2, Order::Descending, true) => filter::<$register, 2, { 2_usize.div_ceil($width) }, P, false>(work),
                    (0..=2, Order::Ascending, false) => advance::<$register, 2, { 2_usize.div_ceil($width) }, P, true>(work),
                    (0..=2, Order::Descending, false) => advance::<$register, 2, { 2_usize.div_ceil($width) }, P, false>(work),
                    (3..=4, Order::Ascending, true) => filter::<$register, 4, { 4_usize.div_ceil($width) }, P, true>(work),
                    (3..=4, Order::Descending, true) => filter::<$register, 4, { 4_usize.div_ceil($width) }, P, false>(work),
                    (3..=4, Order::Ascending, false) => advance::<$register, 4, { 4_usize.div_ceil($width) }, P, true>(work),
                    (3..=4, Order::Descending, false) => advance::<$register, 4, { 4_usize.div_ceil($width) }, P, false>(work),
                    (5..=8, Order::Ascending, true) => filter::<$register, 8, { 8_usize.div_ceil($width) }, P, true>(work),
                    (5..=8, Order::Descending, true) => filter::<$register, 8, { 8_usize.div_ceil($width) }, P, false>(work),
                    (5..=8, Order::Ascending, false) => advance::<$register, 8, { 8_usize.div_ceil($width) }, P, true>(work),
                    (5..=8, Order::Descending, false) => advance::<$register, 8, { 8_usize.div_ceil($width) }, P, false>(work),
                    (_, Order::Ascending, true) => filter::<$register, 12, { 12_usize.div_ceil($width) }, P, true>(work),
                    (_, Order::Descending, true) => filter::<$register, 12, { 12_usize.div_ceil($width) }, P, false>(work),
                    (_, Order::Ascending, false) => advance::<$register, 12, { 12_usize.div_ceil($width) }, P, true>(work),
                    (_, Order::Descending, false) => advance::<$register, 12, { 12_usize.div_ceil($width) }, P, false>(work),
                }
            }
        }
    };
}

on!(on_scalar, f64, 1,);
#[cfg(target_arch = "x86_64")]
on!(on_sse2, std::arch::x86_64::__m128d, 2, "sse2");
#[cfg(target_arch = "x86_64")]
on!(on_avx2, std::arch::x86_64::__m256d, 4, "avx2,fma");
#[cfg(target_arch = "x86_64")]
on!(
    on_avx512,
    std::arch::x86_64::__m512d,
    8,
    "avx512f,avx512vl,avx512dq,avx2,fma"
);
