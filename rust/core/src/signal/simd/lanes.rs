//! Registers of one, two, four or eight doubles behind one interface.

/// A register; every method is one instruction or none.
///
/// # Safety
/// Methods may only be called where the processor has the instruction set; pointers need room for the whole register.
pub(super) trait Lanes: Copy {
    /// Doubles in a register.
    const WIDTH: usize;

    unsafe fn load(from: *const f64) -> Self;
    unsafe fn store(self, to: *mut f64);
    unsafe fn splat(value: f64) -> Self;
    /// One of the doubles in every place; `k` is known where this is inlined.
    unsafe fn lane(self, k: usize) -> Self;
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
}

impl Lanes for f64 {
    const WIDTH: usize = 1;
    type Flags = bool;

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
    unsafe fn lane(self, _k: usize) -> Self {
        self
    }
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
        before | !(self.abs() <= limit)
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

    /// `$load..$and_not` of a register type whose comparisons give a register.
    macro_rules! lanes {
        ($register:ty, $width:literal, $load:ident, $store:ident, $splat:ident, $add:ident, $mul:ident,
         |$a:ident, $b:ident, $c:ident| $mul_add:expr, |$v:ident, $k:ident| $lane:expr,
         $flags:ty, |$x:ident, $limit:ident, $before:ident| $outside:expr, |$f:ident| $any:expr, $none:expr) => {
            impl Lanes for $register {
                const WIDTH: usize = $width;
                type Flags = $flags;

                #[inline(always)]
                unsafe fn load(from: *const f64) -> Self {
                    unsafe { $load(from) }
                }
                #[inline(always)]
                unsafe fn store(self, to: *mut f64) {
                    unsafe { $store(to, self) }
                }
                #[inline(always)]
                unsafe fn splat(value: f64) -> Self {
                    unsafe { $splat(value) }
                }
                #[inline(always)]
                unsafe fn lane(self, $k: usize) -> Self {
                    let $v = self;
                    unsafe { $lane }
                }
                #[inline(always)]
                unsafe fn add(self, other: Self) -> Self {
                    unsafe { $add(self, other) }
                }
                #[inline(always)]
                unsafe fn mul(self, other: Self) -> Self {
                    unsafe { $mul(self, other) }
                }
                #[inline(always)]
                unsafe fn mul_add(self, $b: Self, $c: Self) -> Self {
                    let $a = self;
                    unsafe { $mul_add }
                }
                #[inline(always)]
                unsafe fn outside(self, $limit: Self, $before: Self::Flags) -> Self::Flags {
                    let $x = self;
                    unsafe { $outside }
                }
                #[inline(always)]
                unsafe fn any($f: Self::Flags) -> bool {
                    unsafe { $any }
                }
                #[inline(always)]
                unsafe fn none() -> Self::Flags {
                    unsafe { $none }
                }
            }
        };
    }

    lanes!(
        __m128d,
        2,
        _mm_loadu_pd,
        _mm_storeu_pd,
        _mm_set1_pd,
        _mm_add_pd,
        _mm_mul_pd,
        |a, b, c| _mm_add_pd(_mm_mul_pd(a, b), c),
        |v, k| if k == 0 {
            _mm_unpacklo_pd(v, v)
        } else {
            _mm_unpackhi_pd(v, v)
        },
        __m128d,
        |x, limit, before| _mm_or_pd(
            before,
            _mm_cmpnle_pd(_mm_andnot_pd(_mm_set1_pd(-0.0), x), limit)
        ),
        |f| _mm_movemask_pd(f) != 0,
        _mm_setzero_pd()
    );
    lanes!(
        __m256d,
        4,
        _mm256_loadu_pd,
        _mm256_storeu_pd,
        _mm256_set1_pd,
        _mm256_add_pd,
        _mm256_mul_pd,
        |a, b, c| _mm256_fmadd_pd(a, b, c),
        |v, k| match k {
            0 => _mm256_permute4x64_pd::<0x00>(v),
            1 => _mm256_permute4x64_pd::<0x55>(v),
            2 => _mm256_permute4x64_pd::<0xAA>(v),
            _ => _mm256_permute4x64_pd::<0xFF>(v),
        },
        __m256d,
        |x, limit, before| {
            let magnitude = _mm256_andnot_pd(_mm256_set1_pd(-0.0), x);
            _mm256_or_pd(before, _mm256_cmp_pd::<_CMP_NLE_UQ>(magnitude, limit))
        },
        |f| _mm256_movemask_pd(f) != 0,
        _mm256_setzero_pd()
    );
    lanes!(
        __m512d,
        8,
        _mm512_loadu_pd,
        _mm512_storeu_pd,
        _mm512_set1_pd,
        _mm512_add_pd,
        _mm512_mul_pd,
        |a, b, c| _mm512_fmadd_pd(a, b, c),
        |v, k| _mm512_permutexvar_pd(_mm512_set1_epi64(k as i64), v),
        __mmask8,
        |x, limit, before| before | _mm512_cmp_pd_mask::<_CMP_NLE_UQ>(_mm512_abs_pd(x), limit),
        |f| f != 0,
        0
    );
}
