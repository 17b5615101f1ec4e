//! The block kernel: sixteen samples per step, generic over the registers.

use super::lanes::Lanes;
use super::{Affine, Order, Work};
use crate::error::LARGEST;
use crate::signal::lookahead::{BLOCK, HALF};

/// Samples taken in at once: a sample must lie in memory to be broadcast, and two kilobytes stay in the first cache.
const TILE: usize = 16 * BLOCK;

/// Samples on their way through the registers.
#[repr(align(64))]
struct Tile([f64; TILE]);

/// Filters `work.blocks` blocks; false if a sample was not of moderate magnitude.
///
/// `N` states in `S` registers, half a block of outputs in `P` registers; `UP` takes the samples as they lie in memory.
#[inline(always)]
unsafe fn filter<V: Lanes, const N: usize, const S: usize, const P: usize, const UP: bool>(
    work: Work<'_>,
) -> bool {
    unsafe {
        let block = work.block;
        let indices = V::indices();
        let mut s: [V; S] = load_all(work.state.0.as_ptr());
        let r: [[V; S]; HALF] = std::array::from_fn(|j| load_all(block.r[j].as_ptr()));
        let t: [[V; P]; HALF] = std::array::from_fn(|j| load_all(block.t[j].as_ptr()));
        let o: [[V; P]; N] = std::array::from_fn(|k| load_all(block.o[k].as_ptr()));
        let e8: [[V; S]; N] = std::array::from_fn(|k| load_all(block.e8[k].as_ptr()));
        let e16: [[V; S]; N] = std::array::from_fn(|k| load_all(block.e16[k].as_ptr()));
        let lift = V::splat(work.affine.lift);
        let mut bad = V::none();
        let mut tile = Tile([0.0; TILE]);
        let mut done = 0;
        while done < work.blocks {
            let blocks = (work.blocks - done).min(TILE / BLOCK);
            let at = BLOCK
                * if UP {
                    done
                } else {
                    work.blocks - done - blocks
                };
            let samples_at = if work.affine.as_they_are {
                work.input.add(at)
            } else {
                bad = take_in::<V>(
                    &mut tile,
                    work.input.add(at),
                    blocks * BLOCK,
                    &work.affine,
                    bad,
                );
                tile.0.as_ptr()
            };
            fetch_ahead::<V, UP>(work.input.wrapping_add(at));
            if !std::ptr::eq(work.input, work.output) {
                fetch_ahead::<V, UP>(work.output.wrapping_add(at));
            }
            for i in 0..blocks {
                let place = BLOCK * if UP { i } else { blocks - 1 - i };
                let samples = samples_at.add(place);
                let output = work.output.add(at + place);
                // The half that comes first in time.
                let (early, late) = if UP { (0, HALF) } else { (HALF, 0) };
                // Sums of products in one chain or two, whichever the registers hold: [chain][half][register].
                let zero = V::splat(0.0);
                let mut into = [[[zero; S]; 2]; 2];
                let mut y = [[[lift; P]; 2], [[zero; P]; 2]];
                for j in 0..HALF {
                    let chain = j % V::CHAINS;
                    let x = [
                        V::splat(*samples.add(early + j)),
                        V::splat(*samples.add(late + j)),
                    ];
                    for half in 0..2 {
                        for q in 0..S {
                            into[chain][half][q] = x[half].mul_add(r[j][q], into[chain][half][q]);
                        }
                        // A sample acts on the outputs that are not before it.
                        for p in 0..P {
                            let before = if UP {
                                (p + 1) * V::WIDTH <= j
                            } else {
                                p * V::WIDTH > j
                            };
                            if !before {
                                y[chain][half][p] = x[half].mul_add(t[j][p], y[chain][half][p]);
                            }
                        }
                    }
                }
                let into = joined::<V, S>(&into);
                let middle = add_all(s, with_states::<V, N, S>(&indices, &e8, s, into[0]));
                let carried =
                    with_states::<V, N, S>(&indices, &e8, into[0], add_all(into[0], into[1]));
                let next = add_all(s, with_states::<V, N, S>(&indices, &e16, s, carried));
                for k in 0..N {
                    let (chain, register, lane) = (k % V::CHAINS, k / V::WIDTH, k % V::WIDTH);
                    let states = [
                        s[register].lane(&indices, lane),
                        middle[register].lane(&indices, lane),
                    ];
                    for half in 0..2 {
                        for p in 0..P {
                            y[chain][half][p] = states[half].mul_add(o[k][p], y[chain][half][p]);
                        }
                    }
                }
                let y = joined::<V, P>(&y);
                for p in 0..P {
                    y[0][p].store(output.add(early + p * V::WIDTH));
                    y[1][p].store(output.add(late + p * V::WIDTH));
                }
                s = next;
            }
            done += blocks;
        }
        store_all(&s, work.state.0.as_mut_ptr());
        !V::any(bad)
    }
}

/// [`filter`] without the outputs.
#[inline(always)]
unsafe fn advance<V: Lanes, const N: usize, const S: usize, const UP: bool>(
    work: Work<'_>,
) -> bool {
    unsafe {
        let block = work.block;
        let indices = V::indices();
        let mut s: [V; S] = load_all(work.state.0.as_ptr());
        let r: [[V; S]; HALF] = std::array::from_fn(|j| load_all(block.r[j].as_ptr()));
        let e8: [[V; S]; N] = std::array::from_fn(|k| load_all(block.e8[k].as_ptr()));
        let e16: [[V; S]; N] = std::array::from_fn(|k| load_all(block.e16[k].as_ptr()));
        let mut bad = V::none();
        let mut tile = Tile([0.0; TILE]);
        let mut done = 0;
        while done < work.blocks {
            let blocks = (work.blocks - done).min(TILE / BLOCK);
            let at = BLOCK
                * if UP {
                    done
                } else {
                    work.blocks - done - blocks
                };
            bad = take_in::<V>(
                &mut tile,
                work.input.add(at),
                blocks * BLOCK,
                &work.affine,
                bad,
            );
            for i in 0..blocks {
                let samples = tile
                    .0
                    .as_ptr()
                    .add(BLOCK * if UP { i } else { blocks - 1 - i });
                let (early, late) = if UP { (0, HALF) } else { (HALF, 0) };
                let mut into = [[[V::splat(0.0); S]; 2]; 2];
                for j in 0..HALF {
                    let chain = j % V::CHAINS;
                    let x = [
                        V::splat(*samples.add(early + j)),
                        V::splat(*samples.add(late + j)),
                    ];
                    for half in 0..2 {
                        for q in 0..S {
                            into[chain][half][q] = x[half].mul_add(r[j][q], into[chain][half][q]);
                        }
                    }
                }
                let into = joined::<V, S>(&into);
                let carried =
                    with_states::<V, N, S>(&indices, &e8, into[0], add_all(into[0], into[1]));
                s = add_all(s, with_states::<V, N, S>(&indices, &e16, s, carried));
            }
            done += blocks;
        }
        store_all(&s, work.state.0.as_mut_ptr());
        !V::any(bad)
    }
}

/// Brings samples into the tile, less their level; flags those that are not moderate.
#[inline(always)]
unsafe fn take_in<V: Lanes>(
    tile: &mut Tile,
    input: *const f64,
    count: usize,
    affine: &Affine,
    mut bad: V::Flags,
) -> V::Flags {
    unsafe {
        let (scale, shift) = (V::splat(affine.scale), V::splat(affine.shift));
        let limit = V::splat(LARGEST);
        for i in (0..count).step_by(V::WIDTH) {
            let x = V::load(input.add(i));
            bad = x.outside(limit, bad);
            x.mul_add(scale, shift).store(tile.0.as_mut_ptr().add(i));
        }
        bad
    }
}

/// Asks for the tile after the next, which may lie beyond the record: a request never faults.
#[inline(always)]
unsafe fn fetch_ahead<V: Lanes, const UP: bool>(tile: *const f64) {
    let ahead = if UP {
        tile.wrapping_add(2 * TILE)
    } else {
        tile.wrapping_sub(2 * TILE)
    };
    for line in (0..TILE).step_by(8) {
        unsafe { V::fetch(ahead.wrapping_add(line)) };
    }
}

#[inline(always)]
unsafe fn load_all<V: Lanes, const S: usize>(from: *const f64) -> [V; S] {
    std::array::from_fn(|i| unsafe { V::load(from.add(i * V::WIDTH)) })
}

#[inline(always)]
unsafe fn store_all<V: Lanes, const S: usize>(s: &[V; S], to: *mut f64) {
    for (i, register) in s.iter().enumerate() {
        unsafe { register.store(to.add(i * V::WIDTH)) };
    }
}

#[inline(always)]
unsafe fn add_all<V: Lanes, const S: usize>(a: [V; S], b: [V; S]) -> [V; S] {
    std::array::from_fn(|i| unsafe { a[i].add(b[i]) })
}

/// The sum of both chains of each half.
#[inline(always)]
unsafe fn joined<V: Lanes, const R: usize>(chains: &[[[V; R]; 2]; 2]) -> [[V; R]; 2] {
    if V::CHAINS == 1 {
        return chains[0];
    }
    std::array::from_fn(|half| unsafe { add_all(chains[0][half], chains[1][half]) })
}

/// `sum` and the states' own increments, in two chains that run side by side.
#[inline(always)]
unsafe fn with_states<V: Lanes, const N: usize, const S: usize>(
    indices: &V::Indices,
    e: &[[V; S]; N],
    s: [V; S],
    sum: [V; S],
) -> [V; S] {
    unsafe {
        let mut even = sum;
        let mut odd = [V::splat(0.0); S];
        for k in 0..N {
            let state = s[k / V::WIDTH].lane(indices, k % V::WIDTH);
            for i in 0..S {
                if k == 1 {
                    odd[i] = state.mul(e[k][i]);
                } else if k % 2 == 0 {
                    even[i] = state.mul_add(e[k][i], even[i]);
                } else {
                    odd[i] = state.mul_add(e[k][i], odd[i]);
                }
            }
        }
        add_all(even, odd)
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
                    (0..=2, Order::Ascending, false) => advance::<$register, 2, { 2_usize.div_ceil($width) }, true>(work),
                    (0..=2, Order::Descending, false) => advance::<$register, 2, { 2_usize.div_ceil($width) }, false>(work),
                    (3..=4, Order::Ascending, true) => filter::<$register, 4, { 4_usize.div_ceil($width) }, P, true>(work),
                    (3..=4, Order::Descending, true) => filter::<$register, 4, { 4_usize.div_ceil($width) }, P, false>(work),
                    (3..=4, Order::Ascending, false) => advance::<$register, 4, { 4_usize.div_ceil($width) }, true>(work),
                    (3..=4, Order::Descending, false) => advance::<$register, 4, { 4_usize.div_ceil($width) }, false>(work),
                    (5..=8, Order::Ascending, true) => filter::<$register, 8, { 8_usize.div_ceil($width) }, P, true>(work),
                    (5..=8, Order::Descending, true) => filter::<$register, 8, { 8_usize.div_ceil($width) }, P, false>(work),
                    (5..=8, Order::Ascending, false) => advance::<$register, 8, { 8_usize.div_ceil($width) }, true>(work),
                    (5..=8, Order::Descending, false) => advance::<$register, 8, { 8_usize.div_ceil($width) }, false>(work),
                    (_, Order::Ascending, true) => filter::<$register, 12, { 12_usize.div_ceil($width) }, P, true>(work),
                    (_, Order::Descending, true) => filter::<$register, 12, { 12_usize.div_ceil($width) }, P, false>(work),
                    (_, Order::Ascending, false) => advance::<$register, 12, { 12_usize.div_ceil($width) }, true>(work),
                    (_, Order::Descending, false) => advance::<$register, 12, { 12_usize.div_ceil($width) }, false>(work),
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
