//! The one place that chooses an instruction set: a kernel written once over packs of eight numbers is compiled for each
//! width, and the widest that the machine has is taken at run time.
//!
//! No fused multiply-add and a fixed number of lanes: every width gives the same bits. The packs are spelt in
//! intrinsics, because the compiler builds vectors of two out of plain arrays whatever the width.
#![allow(unsafe_code)] // intrinsics of a set are unsafe to call; the machine was asked before

/// Numbers in a pack.
pub(crate) const PACK: usize = 8;

/// Eight numbers side by side.
pub(crate) trait Pack: Copy {
    /// The same number in every lane.
    fn splat(v: f64) -> Self;
    /// Eight neighbours.
    fn load(from: &[f64; PACK]) -> Self;
    /// Back into memory.
    fn store(self, to: &mut [f64; PACK]);
    /// The sum.
    fn add(self, other: Self) -> Self;
    /// The difference.
    fn sub(self, other: Self) -> Self;
    /// The product.
    fn mul(self, other: Self) -> Self;
    /// `other` where it is less, else this.
    fn lower(self, other: Self) -> Self;
    /// `other` where it is greater, else this.
    fn upper(self, other: Self) -> Self;

    /// The lanes.
    #[inline(always)]
    fn lanes(self) -> [f64; PACK] {
        let mut lanes = [0.0; PACK];
        self.store(&mut lanes);
        lanes
    }

    /// The sum of the lanes, in pairs.
    #[inline(always)]
    fn total(self) -> f64 {
        let [a, b, c, d, e, f, g, h] = self.lanes();
        ((a + e) + (c + g)) + ((b + f) + (d + h))
    }
}

/// A piece of work over packs; its `run` must be `#[inline(always)]`.
pub(crate) trait Kernel {
    /// What it returns.
    type Output;
    /// The work.
    fn run<P: Pack>(self) -> Self::Output;
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
        if is_x86_feature_detected!("avx512f") {
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
        // SAFETY: `widest` found the feature on this machine.
        Width::Avx512 => unsafe { x86::avx512(kernel) },
        #[cfg(target_arch = "x86_64")]
        // SAFETY: as above.
        Width::Avx2 => unsafe { x86::avx2(kernel) },
        _ => kernel.run::<[f64; PACK]>(),
    }
}

impl Pack for [f64; PACK] {
    #[inline(always)]
    fn splat(v: f64) -> Self {
        [v; PACK]
    }

    #[inline(always)]
    fn load(from: &[f64; PACK]) -> Self {
        *from
    }

    #[inline(always)]
    fn store(self, to: &mut [f64; PACK]) {
        *to = self;
    }

    #[inline(always)]
    fn add(self, other: Self) -> Self {
        std::array::from_fn(|i| self[i] + other[i])
    }

    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        std::array::from_fn(|i| self[i] - other[i])
    }

    #[inline(always)]
    fn mul(self, other: Self) -> Self {
        std::array::from_fn(|i| self[i] * other[i])
    }

    #[inline(always)]
    fn lower(self, other: Self) -> Self {
        std::array::from_fn(|i| {
            if other[i] < self[i] {
                other[i]
            } else {
                self[i]
            }
        })
    }

    #[inline(always)]
    fn upper(self, other: Self) -> Self {
        std::array::from_fn(|i| {
            if other[i] > self[i] {
                other[i]
            } else {
                self[i]
            }
        })
    }
}

#[cfg(target_arch = "x86_64")]
mod x86 {
    use super::{Kernel, PACK, Pack};
    use std::arch::x86_64::{
        __m256d, __m512d, _mm256_add_pd, _mm256_loadu_pd, _mm256_max_pd, _mm256_min_pd,
        _mm256_mul_pd, _mm256_set1_pd, _mm256_storeu_pd, _mm256_sub_pd, _mm512_add_pd,
        _mm512_loadu_pd, _mm512_max_pd, _mm512_min_pd, _mm512_mul_pd, _mm512_set1_pd,
        _mm512_storeu_pd, _mm512_sub_pd,
    };

    #[target_feature(enable = "avx512f")]
    pub(super) fn avx512<K: Kernel>(kernel: K) -> K::Output {
        kernel.run::<One512>()
    }

    #[target_feature(enable = "avx2")]
    pub(super) fn avx2<K: Kernel>(kernel: K) -> K::Output {
        kernel.run::<Two256>()
    }

    /// Only made inside [`avx512`], where the set is there; that is why its methods are sound.
    #[derive(Clone, Copy)]
    struct One512(__m512d);

    /// Only made inside [`avx2`].
    #[derive(Clone, Copy)]
    struct Two256(__m256d, __m256d);

    // SAFETY of every block below: packs are made by kernels alone, and kernels run with these packs only inside the
    // two functions above, which `run_at` calls where the machine has the set. Loads and stores need no alignment and
    // stay inside arrays of eight.
    impl Pack for One512 {
        #[inline(always)]
        fn splat(v: f64) -> Self {
            Self(unsafe { _mm512_set1_pd(v) })
        }

        #[inline(always)]
        fn load(from: &[f64; PACK]) -> Self {
            Self(unsafe { _mm512_loadu_pd(from.as_ptr()) })
        }

        #[inline(always)]
        fn store(self, to: &mut [f64; PACK]) {
            unsafe { _mm512_storeu_pd(to.as_mut_ptr(), self.0) }
        }

        #[inline(always)]
        fn add(self, other: Self) -> Self {
            Self(unsafe { _mm512_add_pd(self.0, other.0) })
        }

        #[inline(always)]
        fn sub(self, other: Self) -> Self {
            Self(unsafe { _mm512_sub_pd(self.0, other.0) })
        }

        #[inline(always)]
        fn mul(self, other: Self) -> Self {
            Self(unsafe { _mm512_mul_pd(self.0, other.0) })
        }

        // min(a, b) is b unless a is less: the second operand where they do not compare.
        #[inline(always)]
        fn lower(self, other: Self) -> Self {
            Self(unsafe { _mm512_min_pd(other.0, self.0) })
        }

        #[inline(always)]
        fn upper(self, other: Self) -> Self {
            Self(unsafe { _mm512_max_pd(other.0, self.0) })
        }
    }

    impl Pack for Two256 {
        #[inline(always)]
        fn splat(v: f64) -> Self {
            let one = unsafe { _mm256_set1_pd(v) };
            Self(one, one)
        }

        #[inline(always)]
        fn load(from: &[f64; PACK]) -> Self {
            unsafe {
                Self(
                    _mm256_loadu_pd(from.as_ptr()),
                    _mm256_loadu_pd(from[4..].as_ptr()),
                )
            }
        }

        #[inline(always)]
        fn store(self, to: &mut [f64; PACK]) {
            unsafe {
                _mm256_storeu_pd(to.as_mut_ptr(), self.0);
                _mm256_storeu_pd(to[4..].as_mut_ptr(), self.1);
            }
        }

        #[inline(always)]
        fn add(self, other: Self) -> Self {
            unsafe {
                Self(
                    _mm256_add_pd(self.0, other.0),
                    _mm256_add_pd(self.1, other.1),
                )
            }
        }

        #[inline(always)]
        fn sub(self, other: Self) -> Self {
            unsafe {
                Self(
                    _mm256_sub_pd(self.0, other.0),
                    _mm256_sub_pd(self.1, other.1),
                )
            }
        }

        #[inline(always)]
        fn mul(self, other: Self) -> Self {
            unsafe {
                Self(
                    _mm256_mul_pd(self.0, other.0),
                    _mm256_mul_pd(self.1, other.1),
                )
            }
        }

        #[inline(always)]
        fn lower(self, other: Self) -> Self {
            unsafe {
                Self(
                    _mm256_min_pd(other.0, self.0),
                    _mm256_min_pd(other.1, self.1),
                )
            }
        }

        #[inline(always)]
        fn upper(self, other: Self) -> Self {
            unsafe {
                Self(
                    _mm256_max_pd(other.0, self.0),
                    _mm256_max_pd(other.1, self.1),
                )
            }
        }
    }
}

/// Sums of several terms over the entries of equally long columns: in sixteen lanes, then the rest one by one.
///
/// `terms` is written twice, over packs and over numbers, by [`Terms`].
#[inline(always)]
pub(crate) fn sums<P: Pack, T: Terms<C, K>, const C: usize, const K: usize>(
    columns: [&[f64]; C],
    terms: &T,
) -> [f64; K] {
    let n = columns[0].len();
    let columns = columns.map(|c| &c[..n]);
    let mut even = [P::splat(0.0); K];
    let mut odd = [P::splat(0.0); K];
    let mut at = 0;
    while at + 2 * PACK <= n {
        for (lanes, from) in [(&mut even, at), (&mut odd, at + PACK)] {
            let loaded = columns.map(|c| match c[from..].first_chunk() {
                Some(eight) => P::load(eight),
                None => P::splat(0.0),
            });
            let found = terms.of(loaded);
            for k in 0..K {
                lanes[k] = lanes[k].add(found[k]);
            }
        }
        at += 2 * PACK;
    }
    let mut total = [0.0; K];
    for k in 0..K {
        total[k] = even[k].add(odd[k]).total();
    }
    for i in at..n {
        let found = terms.of::<[f64; PACK]>(columns.map(|c| [c[i]; PACK]));
        for k in 0..K {
            total[k] += found[k][0];
        }
    }
    total
}

/// Terms to be summed, computed alike for every pack.
pub(crate) trait Terms<const C: usize, const K: usize> {
    /// The terms of one pack of entries.
    fn of<P: Pack>(&self, entries: [P; C]) -> [P; K];
}
