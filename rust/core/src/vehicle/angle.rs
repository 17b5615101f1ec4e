//! Sine, cosine and arc tangent for lanes: arithmetic and selects only, the same bits with every instruction set.

use crate::dynamics::Pure;
use crate::effects::Lane;

// 1.5 * 2^52: added and taken away again, it rounds to a whole number.
const ROUNDING: f64 = 6_755_399_441_055_744.0;
// pi in three parts; the last 24 bits of the first are zero, so that its product with a whole number below 2^24 is
// exact.
const PI_HIGH: f64 = 3.141_592_651_605_606;
const PI_MIDDLE: f64 = 1.984_187_154_857_597_3e-9;
const PI_LOW: f64 = 4.503_483_548_312_435e-18;
// A whole number's last bit, moved onto the sign.
const SIGN_SHIFT: u32 = 63;

/// Sine: absolute error below 3e-16 for angles up to 1e6 rad.
#[inline(always)]
#[must_use]
pub(super) fn sin(angle: Pure) -> Pure {
    let whole = angle.0 * std::f64::consts::FRAC_1_PI + ROUNDING;
    let k = whole - ROUNDING;
    let r = ((angle.0 - k * PI_HIGH) - k * PI_MIDDLE) - k * PI_LOW;
    signed(taylor(r), whole)
}

/// Cosine: absolute error below 4e-16 for angles up to 1e6 rad.
#[inline(always)]
#[must_use]
pub(super) fn cos(angle: Pure) -> Pure {
    // cos x = sin(x + pi/2): the shift is taken off after the reduction, where it costs no digits.
    let whole = angle.0 * std::f64::consts::FRAC_1_PI + 0.5 + ROUNDING;
    let k = whole - ROUNDING - 0.5;
    let r = ((angle.0 - k * PI_HIGH) - k * PI_MIDDLE) - k * PI_LOW;
    signed(taylor(r), whole)
}

/// Turns the sign where the whole number in the low bits is odd.
#[inline(always)]
fn signed(value: f64, whole: f64) -> Pure {
    let sign = whole.to_bits() << SIGN_SHIFT;
    Pure(f64::from_bits(value.to_bits() ^ sign))
}

// (sin(r)/r - 1)/r^2 by Taylor's series for |r| <= pi/2, where the term of order 23 is below 2e-18.
const SIN: [f64; 10] = [
    -1.0 / 6.0,
    1.0 / 120.0,
    -1.0 / 5_040.0,
    1.0 / 362_880.0,
    -1.0 / 39_916_800.0,
    1.0 / 6_227_020_800.0,
    -1.0 / 1_307_674_368_000.0,
    1.0 / 355_687_428_096_000.0,
    -1.0 / 121_645_100_408_832_000.0,
    1.0 / 51_090_942_171_709_440_000.0,
];

#[inline(always)]
fn taylor(r: f64) -> f64 {
    let z = r * r;
    let w = z * z;
    let even = SIN[0] + w * (SIN[2] + w * (SIN[4] + w * (SIN[6] + w * SIN[8])));
    let odd = SIN[1] + w * (SIN[3] + w * (SIN[5] + w * (SIN[7] + w * SIN[9])));
    // Even and odd terms are two chains that do not wait for each other.
    r + r * z * (even + z * odd)
}

// tan(pi/8) and tan(3 pi/8): between them the angle is measured from pi/4.
const TAN_EIGHTH: f64 = 0.414_213_562_373_095_03;
const TAN_THREE_EIGHTHS: f64 = 2.414_213_562_373_095;
// (atan(x)/x - 1)/x^2 over x^2 in [0, tan(pi/8)^2], Chebyshev's fit of degree 10: within 4e-17.
const ATAN: [f64; 11] = [
    -0.333_333_333_333_333_3,
    0.199_999_999_999_955_2,
    -0.142_857_142_846_665_42,
    0.111_111_110_152_563_61,
    -0.090_909_045_781_239_03,
    0.076_921_831_908_260_87,
    -0.066_645_114_473_819_48,
    0.058_581_489_128_022_1,
    -0.050_854_497_379_402_6,
    0.039_231_658_295_587_19,
    -0.019_176_887_119_062_26,
];

/// Arc tangent: relative error below 1e-15.
#[inline(always)]
#[must_use]
pub(super) fn atan(x: Pure) -> Pure {
    let size = x.abs();
    let middle = size.0 > TAN_EIGHTH;
    let steep = size.0 > TAN_THREE_EIGHTHS;
    let above = Pure(-1.0).when(steep, (size - Pure::ONE).when(middle, size));
    let below = size.when(steep, (size + Pure::ONE).when(middle, Pure::ONE));
    let base = Pure(std::f64::consts::FRAC_PI_2).when(
        steep,
        Pure(std::f64::consts::FRAC_PI_4).when(middle, Pure::ZERO),
    );
    let t = above / below;
    let z = t * t;
    let w = z * z;
    let c = |i: usize| Pure(ATAN[i]);
    let even = c(0) + w * (c(2) + w * (c(4) + w * (c(6) + w * (c(8) + w * c(10)))));
    let odd = c(1) + w * (c(3) + w * (c(5) + w * (c(7) + w * c(9))));
    let angle = base + (t + t * z * (even + z * odd));
    (-angle).when(x.0 < 0.0, angle)
}

#[cfg(test)]
mod tests {
    use super::{Pure, atan, cos, sin};

    #[test]
    fn they_are_those_of_the_mathematics_library_to_their_stated_errors() {
        for i in -40_000..40_000 {
            let x = f64::from(i) * 0.01237;
            assert!((sin(Pure(x)).0 - x.sin()).abs() < 3e-16, "sin {x}");
            assert!((cos(Pure(x)).0 - x.cos()).abs() < 4e-16, "cos {x}");
            let t = x * x * x * 1e-5;
            assert!(
                (atan(Pure(t)).0 - t.atan()).abs() <= 1e-15 * t.atan().abs(),
                "atan {t}"
            );
        }
        assert_eq!(sin(Pure(0.0)).0, 0.0);
        assert_eq!(cos(Pure(0.0)).0, 1.0);
        assert_eq!(atan(Pure(0.0)).0, 0.0);
    }
}
