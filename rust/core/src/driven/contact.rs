//! The friction state of a contact along a record of positions.

use crate::effects::Contact;
use crate::projections::{luz, stop};

/// The friction state `s` in `[-1, 1]` at every sample.
///
/// It starts in the middle, unknown as it is: the caller leaves out the stretch until the first motion has run
/// through twice the radius.
pub fn friction_state(contact: &Contact, position: &[f64]) -> Vec<f64> {
    let half_gap = contact.gap / 2.0;
    let radius = contact.breakaway + half_gap;
    let mut state = 0.0;
    let mut last = position.first().copied().unwrap_or(0.0);
    // Dahl's law is the stop's spring with exponential approach: exact for any travel in one direction.
    let mut dahl = 0.0_f64;
    position
        .iter()
        .map(|x| {
            let travel = x - last;
            last = *x;
            if contact.exponential {
                let before = state;
                state = stop(state, travel, half_gap);
                let behind = travel - (state - before);
                let target = if behind < 0.0 { -1.0 } else { 1.0 };
                dahl = target + (dahl - target) * (-behind.abs() / contact.breakaway).exp();
                // Inside the gap nothing is felt; rounding of the running sum must not open it.
                if state.abs() < half_gap * (1.0 - 1e-9) {
                    0.0
                } else {
                    dahl
                }
            } else {
                state = stop(state, travel, radius);
                luz(state, half_gap) / contact.breakaway
            }
        })
        .collect()
}

/// Lets a level of friction take effect as the contact slides: it approaches its value over the travel of the
/// break-away and is held at rest, where nothing slides.
///
/// This is what a bristle does whose bound changes while it is loaded (`LuGre`, Dahl): a level that rises as the motion
/// stops reaches only what the last travel allowed, and the torque at rest is the one the motion ended with.
pub fn hold_at_rest(level: &mut [f64], contact: &Contact, position: &[f64]) {
    let mut held = level.first().copied().unwrap_or(0.0);
    let mut last = position.first().copied().unwrap_or(0.0);
    for (value, x) in level.iter_mut().zip(position) {
        let travel = (x - last).abs();
        last = *x;
        if travel > 0.0 {
            held += (*value - held) * -(-travel / contact.breakaway).exp_m1();
        }
        *value = held;
    }
}

/// How much of what is behind the gap is felt at every sample, in `[0, 1]`: 1 throughout without a gap.
pub fn engagement(contact: &Contact, state: &[f64]) -> Option<Vec<f64>> {
    (contact.gap > 0.0).then(|| state.iter().map(|s| s.abs().min(1.0)).collect())
}

#[cfg(test)]
mod tests {
    use super::{friction_state, hold_at_rest};
    use crate::effects::Contact;

    const SHARP: Contact = Contact {
        breakaway: 0.1,
        exponential: false,
        gap: 0.0,
    };

    #[test]
    fn friction_holds_at_rest_and_turns_over_twice_the_breakaway() {
        let x = [0.0, 0.3, 0.3, 0.25, 0.2, 0.1, 0.1];
        let s = friction_state(&SHARP, &x);
        let expected = [0.0, 1.0, 1.0, 0.5, 0.0, -1.0, -1.0];
        for (a, b) in s.iter().zip(expected) {
            // sums of a few tenths: a few units in the last place
            assert!((a - b).abs() < 1e-14, "{s:?}");
        }
    }

    #[test]
    fn nothing_is_felt_inside_the_gap() {
        let gap = Contact { gap: 1.0, ..SHARP };
        let x = [0.0, 2.0, 1.8, 1.0, 0.85, 0.75];
        let s = friction_state(&gap, &x);
        assert!((s[1] - 1.0).abs() < 1e-14, "in contact while moving up");
        assert_eq!(s[2], 0.0, "inside the gap after turning");
        assert_eq!(
            s[3], 0.0,
            "still inside after 1.0 of travel, break-away included"
        );
        assert!(
            (s[4] + 0.5).abs() < 1e-12,
            "breaking away on the other side"
        );
        assert!((s[5] + 1.0).abs() < 1e-12, "sliding on the other side");
    }

    #[test]
    fn a_level_is_held_at_rest_and_followed_while_sliding() {
        let mut level = [1.0, 2.0, 3.0, 3.0, 5.0];
        hold_at_rest(&mut level, &SHARP, &[0.0, 10.0, 10.0, 10.0, 20.0]);
        // a hundred break-aways of travel leave exp(-100) of the difference
        for (a, b) in level.iter().zip([1.0, 2.0, 2.0, 2.0, 5.0]) {
            assert!((a - b).abs() < 1e-14, "{level:?}");
        }
    }

    #[test]
    fn dahl_approaches_full_friction_by_the_exponential() {
        let dahl = Contact {
            exponential: true,
            ..SHARP
        };
        let s = friction_state(&dahl, &[0.0, 0.1, 0.1, 0.0]);
        let up = 1.0 - (-1.0_f64).exp();
        assert!((s[1] - up).abs() < 1e-15 && (s[2] - up).abs() < 1e-15);
        assert!((s[3] - (-1.0 + (up + 1.0) * (-1.0_f64).exp())).abs() < 1e-15);
    }
}
