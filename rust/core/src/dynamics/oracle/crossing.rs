//! The first instant at which a polynomial falls below 0, with the proof that there is none before.
//!
//! A polynomial lies between the smallest and the largest of its Bernstein coefficients, and has as many zeros as they
//! change sign, or fewer by an even number (Descartes, Bernstein; Farin 2002, Curves and Surfaces for CAGD). Stretches
//! are halved until all coefficients are positive, or change sign once.

use super::series::{ORDER, Series, horner};

/// Halvings after which a stretch is as short as rounding.
const DEEPEST: usize = 60;

/// Seconds from the start of a stretch of `length` seconds until the series falls below 0; `None` where it does not.
///
/// What cannot be told from 0 is not below it: a touch, or a start at 0 that rises, is no crossing. To that end every
/// coefficient is raised by its rounding error before the signs are looked at.
pub(super) fn first_crossing(series: &Series, length: f64) -> Option<f64> {
    let raised = series.raised_by_noise();
    // Cheap proof first: the constant term outweighs all others.
    let mut power = 1.0;
    let mut swing = 0.0;
    let mut scaled = [0.0; ORDER + 1];
    for (k, value) in raised.iter().enumerate() {
        scaled[k] = value * power;
        power *= length;
        if k > 0 {
            swing += scaled[k].abs();
        }
    }
    if scaled[0] >= swing {
        return None;
    }
    let below = isolate(&scaled, (0.0, 1.0), &bernstein(&scaled), 0)?;
    Some(zero_before(series, below * length))
}

/// Coefficients in the Bernstein basis on [0, 1]; all weights lie in [0, 1].
fn bernstein(power: &[f64; ORDER + 1]) -> [f64; ORDER + 1] {
    let mut out = [0.0; ORDER + 1];
    for (j, b) in out.iter_mut().enumerate() {
        let mut weight = 1.0;
        for (k, c) in power.iter().enumerate().take(j + 1) {
            *b += weight * c;
            // binomial(j, k) / binomial(ORDER, k), from one k to the next.
            weight *= (j - k) as f64 / (ORDER - k).max(1) as f64;
        }
    }
    out
}

/// Where in [0, 1] a polynomial first falls below 0, given its Bernstein coefficients between two places.
fn isolate(
    power: &[f64; ORDER + 1],
    (from, to): (f64, f64),
    coefficients: &[f64; ORDER + 1],
    depth: usize,
) -> Option<f64> {
    if coefficients.iter().all(|&c| c >= 0.0) {
        return None;
    }
    // From 0 on, the first coefficient that is not 0 tells to which side.
    let start = coefficients.iter().find(|&&c| c != 0.0);
    if start.is_some_and(|&c| c < 0.0) || depth == DEEPEST {
        return Some(from);
    }
    let changes = coefficients
        .windows(2)
        .filter(|pair| (pair[0] < 0.0) != (pair[1] < 0.0))
        .count();
    if changes == 1 && coefficients[0] > 0.0 {
        return Some(bracketed(&|share| horner(power, share), from, to));
    }
    let middle = 0.5 * (from + to);
    let (left, right) = halve(coefficients);
    isolate(power, (from, middle), &left, depth + 1)
        .or_else(|| isolate(power, (middle, to), &right, depth + 1))
}

/// De Casteljau's halves.
fn halve(coefficients: &[f64; ORDER + 1]) -> ([f64; ORDER + 1], [f64; ORDER + 1]) {
    let (mut left, mut right) = ([0.0; ORDER + 1], *coefficients);
    for k in 0..=ORDER {
        left[k] = right[0];
        for j in 0..ORDER - k {
            right[j] = 0.5 * (right[j] + right[j + 1]);
        }
    }
    (left, right)
}

/// The zero just before an instant at which the series is below its noise; 0 where it was never above.
fn zero_before(series: &Series, below: f64) -> f64 {
    let mut step = (2.0 * f64::EPSILON * below).max(f64::MIN_POSITIVE);
    let mut high = below;
    while high > 0.0 {
        let low = (below - step).max(0.0);
        if series.at(low) > 0.0 {
            return bracketed(&|seconds| series.at(seconds), low, high);
        }
        high = low;
        step *= 2.0;
    }
    0.0
}

/// The change of sign of a function that is positive at `low` and not at `high`, to the last bit.
///
/// Regula falsi with Illinois' weights, and a halving whenever one end stays.
fn bracketed(function: &dyn Fn(f64) -> f64, mut low: f64, mut high: f64) -> f64 {
    let (mut f_low, mut f_high) = (function(low), function(high));
    if f_low <= 0.0 {
        return low;
    }
    if f_high > 0.0 {
        return high;
    }
    let mut kept = 0_i32;
    loop {
        let width = high - low;
        let middle = low + 0.5 * width;
        if middle <= low || middle >= high {
            return high;
        }
        let secant = low + width * (f_low / (f_low - f_high));
        let inside = secant > low && secant < high;
        let next = if inside && kept.abs() < 3 {
            secant
        } else {
            middle
        };
        let f_next = function(next);
        if f_next == 0.0 {
            return next;
        }
        if f_next > 0.0 {
            low = next;
            f_low = f_next;
            kept = if kept > 0 { kept + 1 } else { 1 };
            if kept > 1 {
                f_high *= 0.5;
            }
        } else {
            high = next;
            f_high = f_next;
            kept = if kept < 0 { kept - 1 } else { -1 };
            if kept < -1 {
                f_low *= 0.5;
            }
        }
        if kept.abs() > 3 {
            kept = 0;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn series(coefficients: &[f64]) -> Series {
        let mut out = Series::ZERO;
        for (k, c) in coefficients.iter().enumerate() {
            out.add(k, &[*c]);
        }
        out
    }

    #[test]
    fn the_first_of_several_zeros_is_found_to_rounding() {
        // (0.1 - x)(0.3 - x)(0.7 - x)
        let cubic = series(&[0.021, -0.31, 1.1, -1.0]);
        let found = first_crossing(&cubic, 1.0).expect("it crosses");
        assert!((found - 0.1).abs() < 1e-15, "{found}");
    }

    #[test]
    fn a_dip_of_any_width_is_seen_and_a_touch_is_none() {
        for depth in [1e-3, 1e-6, 1e-9, 1e-12] {
            // ((x - 0.4)^2 - depth)
            let dip = series(&[0.16 - depth, -0.8, 1.0]);
            let found = first_crossing(&dip, 1.0).expect("it crosses");
            let exact = 0.4 - f64::sqrt(depth);
            // A zero of slope 2 sqrt(depth) moves by the rounding of the value over that slope.
            let allowed = 1e-15 / f64::sqrt(depth);
            assert!((found - exact).abs() < allowed, "{depth}: {found}");
        }
        assert_eq!(first_crossing(&series(&[0.16, -0.8, 1.0]), 1.0), None);
        assert_eq!(
            first_crossing(&series(&[0.16 + 1e-9, -0.8, 1.0]), 1.0),
            None
        );
    }

    #[test]
    fn a_start_at_zero_is_a_crossing_only_downwards() {
        assert_eq!(first_crossing(&series(&[0.0, -1.0]), 1.0), Some(0.0));
        assert_eq!(first_crossing(&series(&[0.0, 1.0]), 1.0), None);
        // Up from 0 and down again at 0.5.
        let arch = series(&[0.0, 0.5, -1.0]);
        let found = first_crossing(&arch, 1.0).expect("it crosses");
        assert!((found - 0.5).abs() < 1e-15, "{found}");
        assert_eq!(first_crossing(&Series::ZERO, 1.0), None);
    }

    #[test]
    fn a_zero_early_in_a_long_stretch_is_as_good_as_one_in_a_short_one() {
        let ramp = series(&[1.0, -0.7, 0.0, 1e-30]);
        let found = first_crossing(&ramp, 1e6).expect("it crosses");
        assert!((found - 1.0 / 0.7).abs() < 1e-15 * 1e3, "{found}");
    }
}
