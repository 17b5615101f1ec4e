//! The projections luz and tar of Zardecki and the operators made of them.
//!
//! `luz(x, a) = x - clamp(x, -a, a)` is the freeplay characteristic; with a carried state it becomes the stop
//! operator (friction before break-away) and the play operator (backlash).
//!
//! Source: Wieckowski, Zardecki, "Influence of freeplay and friction in steering system on double lane change
//! manoeuvre", equations (1) to (4).

use crate::effects::Lane;

/// `x - clamp(x, -a, a)`: zero inside `[-a, a]`, the distance to it outside. Needs `a >= 0`.
#[must_use]
#[inline]
pub fn luz<L: Lane>(x: L, a: L) -> L {
    x - x.clamp(-a, a)
}

/// One step of the stop operator: adds the increment and keeps the state inside `[-radius, radius]`.
///
/// Starting from rest, the state follows the motion as an elastic spring and slips once it reaches the radius: the
/// friction state before and after break-away.
#[must_use]
#[inline]
pub fn stop<L: Lane>(state: L, increment: L, radius: L) -> L {
    (state + increment).clamp(-radius, radius)
}

/// One step of the play operator `y += luz(x - y, radius)`: what a gap of full width `2 radius` transmits.
#[must_use]
pub fn play(y: f64, x: f64, radius: f64) -> f64 {
    y + luz(x - y, radius)
}

/// tar, the inverse of luz: `x + a Sgn(x)`, an interval at 0. Returns its lower and upper end.
#[must_use]
pub fn tar(x: f64, a: f64) -> (f64, f64) {
    let low = if x > 0.0 { x + a } else { x - a };
    let high = if x < 0.0 { x - a } else { x + a };
    (low, high)
}

/// The resolvent of a friction whose levels differ: the y with `y + S(y) = x`, where S is `up` for y > 0, `-down` for
/// y < 0 and anything between at 0.
#[must_use]
pub fn asymmetric(x: f64, up: f64, down: f64) -> f64 {
    (x - up).max(0.0) + (x + down).min(0.0)
}

/// The resolvent of quadratic drag: the y with `y + c |y| y = x`, for `c >= 0`.
#[must_use]
pub fn drag(x: f64, c: f64) -> f64 {
    2.0 * x / (1.0 + (1.0 + 4.0 * c * x.abs()).sqrt())
}

#[cfg(test)]
mod tests {
    use super::{luz, play, stop};

    #[test]
    fn luz_is_zero_inside_and_the_distance_outside() {
        assert_eq!(luz(0.3, 0.5), 0.0);
        assert_eq!(luz(0.75, 0.5), 0.25);
        assert_eq!(luz(-0.75, 0.5), -0.25);
    }

    #[test]
    fn play_and_stop_share_the_input_between_them() {
        let (mut s, mut y, mut last) = (0.0, 0.0, 0.0);
        for i in 0..2000 {
            let x = 2.0 * f64::from(i).mul_add(0.01, 0.0).sin();
            s = stop(s, x - last, 0.4);
            y = play(y, x, 0.4);
            last = x;
            // 2000 additions of increments below 0.02: the running sum carries at most 2000 roundings of 2^-54
            assert!((s + y - x).abs() < 2000.0 * f64::EPSILON);
        }
    }
}
