//! Registers of one, two, four or eight doubles behind one interface.

/// A register; every method is one instruction or none.
///
/// # Safety
/// Methods may only be called where the processor has the instruction set; pointers need room for the whole register.
pub(super) trait Lanes: Copy {
    /// Doubles in a register.
    const WIDTH: usize;
    /// How many sums of products run side by side: two hide the latency, where there are registers for them.
    const CHAINS: usize = 1;

    unsafe fn load(from: *const f64) -> Self;
    unsafe fn store(self, to: *mut f64);
    unsafe fn splat(value: f64) -> Self;
    /// Asks for the cache line of an address, which need not exist.
    #[inline(always)]
    unsafe fn fetch(_address: *const f64) {}
    /// One of the doubles in every place; `k` is known where this is inlined.
    unsafe fn lane(self, indices: &Self::Indices, k: usize) -> Self;
    /// What [`Self::lane`] needs, made once outside a loop.
    unsafe fn indices() -> Self::Indices;
    unsafe fn add(self, other: Self) -> Self;
    unsafe fn mul(self, other: Self) -> Self;
    /// `self * factor + sum`, rounded once where the processor can.
    unsafe fn mul_add(self, factor: Self, sum: Self) -> Self;
    /// All ones in every place where the magnitude is above the limit or not a number, added to those `before`.
    unsafe fn outside(self, limit: Self, before: Self::Flags) -> Self::Flags;
    /// Whether any place is flagged.
    unsafe fn any(flags: Self::Flags) -> bool;
    /// No place flagged.
    unsafe fn none() -> Self::Flags;
    /// A flag per place.
    type Flags: Copy;
    /// Where each lane is taken from.
    type Indices;
}

impl Lanes for f64 {
    const WIDTH: usize = 1;
    type Flags = bool;
    type Indices = ();

    #[inline(always)]
    unsafe fn load(from: *const f64) -> Self {
        unsafe { *from }
    }
    #[inline(always)]
    unsafe fn store(self, to: *mut f64) {
        unsafe { *to = self }
    }
    #[inline(always)]
    unsafe fn splat(value: f64) -> Self {
        value
    }
    #[inline(always)]
    unsafe fn lane(self, _indices: &(), _k: usize) -> Self {
        self
    }
    #[inline(always)]
    unsafe fn indices() {}
    #[inline(always)]
    unsafe fn add(self, other: Self) -> Self {
        self + other
    }
    #[inline(always)]
    unsafe fn mul(self, other: Self) -> Self {
        self * other
    }
    #[inline(always)]
    unsafe fn mul_add(self, factor: Self, sum: Self) -> Self {
        self * factor + sum
    }
    #[inline(always)]
    unsafe fn outside(self, limit: Self, before: bool) -> bool {
        before | (self.abs() > limit) | self.is_nan()
    }
    #[inline(always)]
    unsafe fn any(flags: bool) -> bool {
        flags
    }
    #[inline(always)]
    unsafe fn none() -> bool {
        false
    }
}

#[cfg(target_arch = "x86_64")]
mod x86 {
    use std::arch::x86_64::*;

    use super::Lanes;

    /// The methods that are one instruction of the same shape everywhere, and those given.
    macro_rules! lanes {
        ($register:ty, $width:literal, $load:ident, $store:ident, $splat:ident, $add:ident, $mul:ident, $($rest:tt)*) => {
            impl Lanes for $register {
                const WIDTH: usize = $width;

                #[inline(always)]
                unsafe fn load(from: *const f64) -> Self {
                    unsafe { $load(from) }
                }
                #[inline(always)]
                unsafe fn store(self, to: *mut f64) {
                    unsafe { $store(to, self) }
                }
                #[inline(always)]
                unsafe fn fetch(address: *const f64) {
                    unsafe { _mm_prefetch::<_MM_HINT_T0>(address.cast()) }
                }
                #[inline(always)]
                unsafe fn splat(value: f64) -> Self {
                    unsafe { $splat(value) }
                }
                #[inline(always)]
                unsafe fn add(self, other: Self) -> Self {
                    unsafe { $add(self, other) }
                }
                #[inline(always)]
                unsafe fn mul(self, other: Self) -> Self {
                    unsafe { $mul(self, other) }
                }
                $($rest)*
            }
        };
    }

    lanes! {
        __m128d, 2, _mm_loadu_pd, _mm_storeu_pd, _mm_set1_pd, _mm_add_pd, _mm_mul_pd,
        type Flags = __m128d;
        type Indices = ();

        #[inline(always)]
        unsafe fn indices() {}
        #[inline(always)]
        unsafe fn lane(self, _indices: &(), k: usize) -> Self {
            unsafe {
                if k == 0 {
                    _mm_unpacklo_pd(self, self)
                } else {
                    _mm_unpackhi_pd(self, self)
                }
            }
        }
        #[inline(always)]
        unsafe fn mul_add(self, factor: Self, sum: Self) -> Self {
            unsafe { _mm_add_pd(_mm_mul_pd(self, factor), sum) }
        }
        #[inline(always)]
        unsafe fn outside(self, limit: Self, before: __m128d) -> __m128d {
            unsafe {
                let magnitude = _mm_andnot_pd(_mm_set1_pd(-0.0), self);
                _mm_or_pd(before, _mm_cmpnle_pd(magnitude, limit))
            }
        }
        #[inline(always)]
        unsafe fn any(flags: __m128d) -> bool {
            unsafe { _mm_movemask_pd(flags) != 0 }
        }
        #[inline(always)]
        unsafe fn none() -> __m128d {
            unsafe { _mm_setzero_pd() }
        }
    }

    lanes! {
        __m256d, 4, _mm256_loadu_pd, _mm256_storeu_pd, _mm256_set1_pd, _mm256_add_pd, _mm256_mul_pd,
        type Flags = __m256d;
        type Indices = ();

        #[inline(always)]
        unsafe fn indices() {}
        #[inline(always)]
        unsafe fn lane(self, _indices: &(), k: usize) -> Self {
            unsafe {
                match k {
                    0 => _mm256_permute4x64_pd::<0x00>(self),
                    1 => _mm256_permute4x64_pd::<0x55>(self),
                    2 => _mm256_permute4x64_pd::<0xAA>(self),
                    _ => _mm256_permute4x64_pd::<0xFF>(self),
                }
            }
        }
        #[inline(always)]
        unsafe fn mul_add(self, factor: Self, sum: Self) -> Self {
            unsafe { _mm256_fmadd_pd(self, factor, sum) }
        }
        #[inline(always)]
        unsafe fn outside(self, limit: Self, before: __m256d) -> __m256d {
            unsafe {
                let magnitude = _mm256_andnot_pd(_mm256_set1_pd(-0.0), self);
                _mm256_or_pd(before, _mm256_cmp_pd::<_CMP_NLE_UQ>(magnitude, limit))
            }
        }
        #[inline(always)]
        unsafe fn any(flags: __m256d) -> bool {
            unsafe { _mm256_movemask_pd(flags) != 0 }
        }
        #[inline(always)]
        unsafe fn none() -> __m256d {
            unsafe { _mm256_setzero_pd() }
        }
    }

    lanes! {
        __m512d, 8, _mm512_loadu_pd, _mm512_storeu_pd, _mm512_set1_pd, _mm512_add_pd, _mm512_mul_pd,
        const CHAINS: usize = 2;
        type Flags = __mmask8;
        type Indices = [__m512i; 8];

        // Read where the compiler cannot see them: with known indices it prefers two shuffles to one permutation.
        #[inline(always)]
        unsafe fn indices() -> [__m512i; 8] {
            let numbers: &[i64; 8] = std::hint::black_box(&[0, 1, 2, 3, 4, 5, 6, 7]);
            std::array::from_fn(|k| unsafe { _mm512_set1_epi64(numbers[k]) })
        }
        #[inline(always)]
        unsafe fn lane(self, indices: &[__m512i; 8], k: usize) -> Self {
            unsafe { _mm512_permutexvar_pd(indices[k], self) }
        }
        #[inline(always)]
        unsafe fn mul_add(self, factor: Self, sum: Self) -> Self {
            unsafe { _mm512_fmadd_pd(self, factor, sum) }
        }
        #[inline(always)]
        unsafe fn outside(self, limit: Self, before: __mmask8) -> __mmask8 {
            unsafe { before | _mm512_cmp_pd_mask::<_CMP_NLE_UQ>(_mm512_abs_pd(self), limit) }
        }
        #[inline(always)]
        unsafe fn any(flags: __mmask8) -> bool {
            flags != 0
        }
        #[inline(always)]
        unsafe fn none() -> __mmask8 {
            0
        }
    }
}
