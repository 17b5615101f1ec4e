//! The number of the lanes: an `f64` whose every operation is arithmetic or a select.
//!
//! No call into a mathematics library and no NaN-aware minimum stands in the way of the vectoriser, and the same bits
//! come out whatever the instruction set.

use std::ops::{Add, Div, Mul, Neg, Sub};

use crate::effects::Lane;

/// An `f64` with select-only clamp and its own exponential, sine and cosine.
#[derive(Debug, Clone, Copy, PartialEq, PartialOrd)]
#[repr(transparent)]
pub struct Pure(pub f64);

impl Add for Pure {
    type Output = Self;
    #[inline(always)]
    fn add(self, other: Self) -> Self {
        Self(self.0 + other.0)
    }
}

impl Sub for Pure {
    type Output = Self;
    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        Self(self.0 - other.0)
    }
}

impl Mul for Pure {
    type Output = Self;
    #[inline(always)]
    fn mul(self, other: Self) -> Self {
        Self(self.0 * other.0)
    }
}

impl Div for Pure {
    type Output = Self;
    #[inline(always)]
    fn div(self, other: Self) -> Self {
        Self(self.0 / other.0)
    }
}

impl Neg for Pure {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        Self(-self.0)
    }
}

/// A select by bits: an `if` would invite the compiler to branch, and a loop with a branch in it is not turned into
/// vector instructions.
#[inline(always)]
fn select(condition: bool, yes: Pure, no: Pure) -> Pure {
    let mask = u64::from(condition).wrapping_neg();
    Pure(f64::from_bits(
        (yes.0.to_bits() & mask) | (no.0.to_bits() & !mask),
    ))
}

impl Pure {
    /// 0.
    pub const ZERO: Self = Self(0.0);
    /// 1.
    pub const ONE: Self = Self(1.0);

    /// This where the condition holds, else the other; both are computed.
    #[inline(always)]
    #[must_use]
    pub fn when(self, condition: bool, otherwise: Self) -> Self {
        select(condition, self, otherwise)
    }

    /// Whether it lies in `[-limit, limit]`.
    #[inline(always)]
    #[must_use]
    pub fn abs_at_most(self, limit: Self) -> bool {
        self.0.abs() <= limit.0
    }

    /// -1 or 1, by the sign bit: 0 has a side, too.
    #[inline(always)]
    #[must_use]
    pub fn side(self) -> Self {
        Self(1.0_f64.copysign(self.0))
    }

    /// -1, 0 or 1; 0 of either sign has none.
    #[inline(always)]
    #[must_use]
    pub fn sign(self) -> Self {
        select(
            self.0 > 0.0,
            Self::ONE,
            select(self.0 < 0.0, Self(-1.0), Self::ZERO),
        )
    }
}

// 1.5 * 2^52: added and taken away again, it rounds to a whole number.
const ROUNDING: f64 = 6_755_399_441_055_744.0;
// The bits below which a double's exponent stands, and its bias.
const EXPONENT_SHIFT: u32 = 52;
const EXPONENT_BIAS: i64 = 1023;
// ln 2 in two parts: the first has 20 trailing zero bits, so that its product with a whole number below 2^20 is exact.
const LN2_HIGH: f64 = 0.693_147_180_369_123_8;
const LN2_LOW: f64 = 1.908_214_929_270_587_7e-10;
// A quarter turn in three parts, of which the first two have 33 bits: their products with a whole number below 2^20 are
// exact.
const QUARTER_HIGH: f64 = 1.570_796_326_734_125_6;
const QUARTER_MIDDLE: f64 = 6.077_100_506_303_966e-11;
const QUARTER_LOW: f64 = 2.022_266_248_795_950_6e-21;

/// `e^x = (1 + less_one) scale`, scale a power of 2: returns both.
#[inline(always)]
fn exp_parts(x: Pure) -> (f64, f64) {
    let x = x.clamp(Pure(-708.0), Pure(708.0)).0;
    let whole = x * std::f64::consts::LOG2_E + ROUNDING;
    let k = whole - ROUNDING;
    let r = (x - k * LN2_HIGH) - k * LN2_LOW;
    // Taylor's series: |r| <= ln(2)/2, so that the term of order 14 is below 4e-18.
    let mut sum = 1.0 / 6_227_020_800.0;
    for divisor in [
        479_001_600.0,
        39_916_800.0,
        3_628_800.0,
        362_880.0,
        40_320.0,
        5_040.0,
        720.0,
        120.0,
        24.0,
        6.0,
        2.0,
        1.0,
    ] {
        sum = sum * r + 1.0 / divisor;
    }
    // The low bits of the rounded sum hold the whole number.
    let bits = rounded(whole).wrapping_add(EXPONENT_BIAS);
    (
        sum * r,
        f64::from_bits((bits << EXPONENT_SHIFT).cast_unsigned()),
    )
}

/// The whole number in the low bits of a sum with [`ROUNDING`].
#[inline(always)]
fn rounded(whole: f64) -> i64 {
    (whole.to_bits().cast_signed()).wrapping_sub(ROUNDING.to_bits().cast_signed())
}

/// The sine of an angle and some quarter turns.
#[inline(always)]
fn quarter_turns(x: Pure, more: i64) -> Pure {
    let whole = x.0 * std::f64::consts::FRAC_2_PI + ROUNDING;
    let k = whole - ROUNDING;
    let r = ((x.0 - k * QUARTER_HIGH) - k * QUARTER_MIDDLE) - k * QUARTER_LOW;
    let square = r * r;
    // Taylor's series: |r| <= pi/4, so that the first terms left out, of order 17 and 18, are below 5e-17 and 2e-18.
    let series = |divisors: [f64; 8]| {
        divisors
            .into_iter()
            .fold(0.0, |sum, divisor| 1.0 / divisor - sum * square)
    };
    let sine = r * series([
        1_307_674_368_000.0,
        6_227_020_800.0,
        39_916_800.0,
        362_880.0,
        5_040.0,
        120.0,
        6.0,
        1.0,
    ]);
    let cosine = 1.0
        - square
            * series([
                20_922_789_888_000.0,
                87_178_291_200.0,
                479_001_600.0,
                3_628_800.0,
                40_320.0,
                720.0,
                24.0,
                2.0,
            ]);
    let quarter = rounded(whole).wrapping_add(more);
    let size = select(quarter & 1 == 0, Pure(sine), Pure(cosine));
    select(quarter & 2 == 0, size, -size)
}

impl Lane for Pure {
    #[inline(always)]
    fn splat(value: f64) -> Self {
        Self(value)
    }

    #[inline(always)]
    fn abs(self) -> Self {
        Self(self.0.abs())
    }

    /// Within 2 units in the last place of the exponential; 0 below -708 and capped above 708, where doubles end.
    #[inline(always)]
    fn exp(self) -> Self {
        let (less_one, scale) = exp_parts(self);
        Self((less_one + 1.0) * scale).when(self.0 >= -708.0, Self::ZERO)
    }

    /// Within 3 units in the last place.
    #[inline(always)]
    fn exp_m1(self) -> Self {
        let (less_one, scale) = exp_parts(self);
        Self(less_one * scale + (scale - 1.0))
    }

    /// Within 2 units in the last place of 1 for arguments up to 10^5.
    #[inline(always)]
    fn sin(self) -> Self {
        quarter_turns(self, 0)
    }

    /// Within 2 units in the last place of 1 for arguments up to 10^5.
    #[inline(always)]
    fn cos(self) -> Self {
        quarter_turns(self, 1)
    }

    #[inline(always)]
    fn clamp(self, low: Self, high: Self) -> Self {
        let below = select(self.0 < low.0, low, self);
        select(below.0 > high.0, high, below)
    }
}

#[cfg(test)]
mod tests {
    use super::{Lane, Pure};

    // Two roundings of the result and one of the reduced argument.
    const EXP_ULPS: f64 = 3.0;

    #[test]
    fn the_exponential_is_right_to_a_few_units_in_the_last_place() {
        for i in -70_000..70_000 {
            let x = f64::from(i) * 0.01003;
            let (own, reference) = (Pure(x).exp().0, x.exp());
            assert!(
                (own - reference).abs() <= EXP_ULPS * f64::EPSILON * reference,
                "{x}"
            );
        }
        assert_eq!(Pure(0.0).exp().0, 1.0);
        assert_eq!(Pure(-1e9).exp().0, 0.0);
    }

    // Half a unit in the last place of 1 from rounding of the sum, one from the square's error, the term left out.
    const SINE_ERROR: f64 = 2.0 * f64::EPSILON;

    #[test]
    fn sine_and_cosine_are_right_to_a_few_units_in_the_last_place() {
        for i in -200_000..200_000 {
            let x = f64::from(i) * 0.01003;
            assert!((Pure(x).sin().0 - x.sin()).abs() <= SINE_ERROR, "{x}");
            assert!((Pure(x).cos().0 - x.cos()).abs() <= SINE_ERROR, "{x}");
        }
        assert_eq!(Pure(0.0).sin().0, 0.0);
        assert_eq!(Pure(0.0).cos().0, 1.0);
    }

    #[test]
    fn the_exponential_less_one_is_exact_for_small_arguments_too() {
        for i in -2000..2000 {
            let x = f64::from(i) * 1e-3 * 1.003;
            for x in [x, x * 1e-6, x * 10.0] {
                let (own, reference) = (Pure(x).exp_m1().0, x.exp_m1());
                assert!(
                    (own - reference).abs() <= EXP_ULPS * f64::EPSILON * reference.abs(),
                    "{x}"
                );
            }
        }
    }

    #[test]
    fn the_sign_of_zero_is_zero() {
        assert_eq!(
            [-2.0, -0.0, 0.0, 3.0].map(|v| Pure(v).sign().0),
            [-1.0, 0.0, 0.0, 1.0]
        );
    }
}
