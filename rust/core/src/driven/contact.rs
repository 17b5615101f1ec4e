//! The friction state of a contact along a record of positions.

use crate::effects::{Contact, dahl};
use crate::projections::{luz, stop};

/// Beyond this many break-aways of travel nothing is left of what was before: `exp(-40)` is below a rounding.
const FORGOTTEN: f64 = 40.0;

/// A change of the stop below this share of the break-away: its mean is that of its ends, to rounding.
const STANDSTILL: f64 = 1e-6;

/// What a contact does along a record, each value a mean around its sample.
///
/// Friction turns within less than a sample wherever the motion is quick. Between two samples the position is taken as
/// a straight line, along which the mean of the state is known exactly; both neighbouring means make the value of a
/// sample. So the record may be sampled as coarsely as the comparison allows without losing the instant of a reversal.
#[derive(Debug)]
pub struct Slide {
    /// The friction state, in `[-1, 1]` but for the sharpening of its corners.
    pub state: Vec<f64>,
    /// How much of what is behind the gap is felt, in `[0, 1]`; None without a gap.
    pub engaged: Option<Vec<f64>>,
    /// What a shift of the motion by one sample would add to the state.
    pub rate: Vec<f64>,
    /// The share of its way to its value that a level goes from one sample to the next (see [`hold_at_rest`]).
    follow: Vec<f64>,
}

/// One stretch between two samples.
struct Stretch {
    state: f64,
    engaged: f64,
    /// State at its end less state at its start.
    change: f64,
}

/// Slides a contact along positions.
///
/// It starts in the middle, unknown as it is: the caller leaves out the stretch until the first motion has run
/// through twice the radius.
pub fn slide(contact: &Contact, position: &[f64]) -> Slide {
    let n = position.len();
    let mut walk = Walk::new(contact);
    let stretches: Vec<Stretch> = position.windows(2).map(|p| walk.to(p[1] - p[0])).collect();
    let follow = std::iter::once(0.0)
        .chain(position.windows(2).map(|p| {
            let relative = (p[1] - p[0]).abs() / contact.breakaway;
            if relative > FORGOTTEN {
                1.0
            } else {
                -(-relative).exp_m1()
            }
        }))
        .collect();
    let around = |of: fn(&Stretch) -> f64| -> Vec<f64> {
        (0..n)
            .map(|i| {
                let before = &stretches[i.saturating_sub(1)];
                let after = stretches.get(i).unwrap_or(before);
                0.5 * (of(before) + of(after))
            })
            .collect()
    };
    Slide {
        state: sharpened(&around(|s| s.state)),
        engaged: (contact.gap > 0.0).then(|| sharpened(&around(|s| s.engaged))),
        rate: sharpened(&around(|s| s.change)),
        follow,
    }
}

/// Undoes what the mean over two samples takes off: `1 - w^2 / 12` at the angular frequency `w` per sample, to the
/// fourth order.
fn sharpened(mean: &[f64]) -> Vec<f64> {
    let last = mean.len() - 1;
    (0..mean.len())
        .map(|i| {
            let (a, b, c) = (mean[i.saturating_sub(1)], mean[i], mean[(i + 1).min(last)]);
            b - (a - 2.0 * b + c) / 12.0
        })
        .collect()
}

/// The state of a contact under way.
struct Walk {
    half_gap: f64,
    breakaway: f64,
    exponential: bool,
    /// The stop operator: of the gap and the break-away together, or of the gap alone with Dahl's exponential.
    stop: f64,
    dahl: f64,
}

impl Walk {
    fn new(contact: &Contact) -> Self {
        Self {
            half_gap: contact.gap / 2.0,
            breakaway: contact.breakaway,
            exponential: contact.exponential,
            stop: 0.0,
            dahl: 0.0,
        }
    }

    fn to(&mut self, travel: f64) -> Stretch {
        if self.exponential {
            self.dahl_to(travel)
        } else {
            self.stop_to(travel)
        }
    }

    /// Up to the end of the stop the state is `luz(u, gap / 2) / breakaway`, whose integral is half its square.
    fn stop_to(&mut self, travel: f64) -> Stretch {
        let (b, a) = (self.breakaway, self.half_gap);
        let before = self.stop;
        self.stop = stop(before, travel, b + a);
        let moved = self.stop - before;
        let (s0, s1) = (luz(before, a) / b, luz(self.stop, a) / b);
        if moved.abs() < STANDSTILL * b {
            return Stretch {
                state: s1,
                engaged: s1.abs(),
                change: s1 - s0,
            };
        }
        let share = moved / travel;
        let on_the_way = b * (s1 * s1 - s0 * s0) / (2.0 * moved);
        let felt_on_the_way = b * (s1 * s1.abs() - s0 * s0.abs()) / (2.0 * moved);
        Stretch {
            state: share * on_the_way + (1.0 - share) * s1,
            engaged: share * felt_on_the_way + (1.0 - share) * s1.abs(),
            change: s1 - s0,
        }
    }

    /// Dahl's law is the stop's spring with exponential approach: exact for any travel in one direction.
    fn dahl_to(&mut self, travel: f64) -> Stretch {
        let felt = |walk: &Self| {
            // Inside the gap nothing is felt; rounding of the running sum must not open it.
            if walk.stop.abs() < walk.half_gap * (1.0 - 1e-9) {
                0.0
            } else {
                walk.dahl
            }
        };
        let s0 = felt(self);
        let before = self.stop;
        self.stop = stop(before, travel, self.half_gap);
        let behind = travel - (self.stop - before);
        let relative = behind.abs() / self.breakaway;
        if relative < STANDSTILL {
            let s1 = felt(self);
            return Stretch {
                state: s1,
                engaged: s1.abs(),
                change: s1 - s0,
            };
        }
        let target = behind.signum();
        let from = self.dahl;
        self.dahl = dahl(from, target, relative.min(FORGOTTEN));
        let on_the_way = target + (from - self.dahl) / relative;
        let share = behind / travel;
        Stretch {
            state: share * on_the_way,
            engaged: share * on_the_way.abs(),
            change: felt(self) - s0,
        }
    }
}

impl Slide {
    /// Lets a level of friction take effect as the contact slides: it approaches its value over the travel of the
    /// break-away and is held at rest, where nothing slides.
    ///
    /// This is what a bristle does whose bound changes while it is loaded (`LuGre`, Dahl): a level that rises as the
    /// motion stops reaches only what the last travel allowed, and the torque at rest is the one the motion ended with.
    pub fn hold_at_rest(&self, level: &mut [f64]) {
        let mut held = level.first().copied().unwrap_or(0.0);
        for (value, follow) in level.iter_mut().zip(&self.follow) {
            held += (*value - held) * follow;
            *value = held;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::{Slide, slide};
    use crate::effects::Contact;

    const SHARP: Contact = Contact {
        breakaway: 0.1,
        exponential: false,
        gap: 0.0,
    };

    /// The mean over the stretches next to a sample, before the sharpening, from many small steps.
    fn walked(contact: &Contact, position: &[f64], pieces: usize) -> Vec<f64> {
        let fine: Vec<f64> = position
            .windows(2)
            .flat_map(|p| (0..pieces).map(move |k| p[0] + (p[1] - p[0]) * k as f64 / pieces as f64))
            .chain(position.last().copied())
            .collect();
        let mut walk = super::Walk::new(contact);
        let small: Vec<f64> = fine
            .windows(2)
            .map(|p| walk.to(p[1] - p[0]).state)
            .collect();
        small
            .chunks(pieces)
            .map(|c| c.iter().sum::<f64>() / pieces as f64)
            .collect()
    }

    #[test]
    fn the_mean_of_a_stretch_is_that_of_many_small_ones() {
        let position: Vec<f64> = (0..60).map(|i| 0.4 * (f64::from(i) * 0.37).sin()).collect();
        for contact in [
            SHARP,
            Contact { gap: 0.3, ..SHARP },
            Contact {
                exponential: true,
                ..SHARP
            },
            Contact {
                exponential: true,
                gap: 0.3,
                breakaway: 0.1,
            },
        ] {
            let whole = walked(&contact, &position, 1);
            let pieces = walked(&contact, &position, 64);
            for (a, b) in whole.iter().zip(&pieces) {
                // The mean is exact; both sum a few hundred roundings of values below 1.
                assert!((a - b).abs() < 1e-9, "{contact:?}: {a} against {b}");
            }
        }
    }

    #[test]
    fn friction_holds_at_rest_and_turns_over_twice_the_breakaway() {
        // each position three times, so that a sample in the middle has rest on both sides
        let x: Vec<f64> = [0.0, 0.3, 0.25, 0.2, 0.1]
            .iter()
            .flat_map(|x| [*x; 5])
            .collect();
        let s = slide(&SHARP, &x).state;
        for (k, expected) in [0.0, 1.0, 0.5, 0.0, -1.0].iter().enumerate() {
            // sums of a few tenths: a few units in the last place
            assert!((s[5 * k + 2] - expected).abs() < 1e-14, "{s:?}");
        }
    }

    #[test]
    fn nothing_is_felt_inside_the_gap() {
        let gap = Contact { gap: 1.0, ..SHARP };
        let x: Vec<f64> = [0.0, 2.0, 1.8, 1.0, 0.85, 0.75]
            .iter()
            .flat_map(|x| [*x; 5])
            .collect();
        let slid = slide(&gap, &x);
        let at = |k: usize| slid.state[5 * k + 2];
        assert!((at(1) - 1.0).abs() < 1e-14, "in contact while moving up");
        assert_eq!(at(2), 0.0, "inside the gap after turning");
        assert_eq!(
            at(3),
            0.0,
            "still inside after 1.0 of travel, break-away included"
        );
        assert!(
            (at(4) + 0.5).abs() < 1e-12,
            "breaking away on the other side"
        );
        assert!((at(5) + 1.0).abs() < 1e-12, "sliding on the other side");
        let engaged = slid.engaged.unwrap();
        for (k, felt) in [(1, 1.0), (2, 0.0), (3, 0.0), (4, 0.5), (5, 1.0)] {
            assert!((engaged[5 * k + 2] - felt).abs() < 1e-12, "{k}");
        }
    }

    #[test]
    fn a_level_is_held_at_rest_and_followed_while_sliding() {
        let mut level = [1.0, 2.0, 3.0, 3.0, 5.0];
        let slid: Slide = slide(&SHARP, &[0.0, 10.0, 10.0, 10.0, 20.0]);
        slid.hold_at_rest(&mut level);
        // a hundred break-aways of travel leave nothing of the difference
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
        let x: Vec<f64> = [0.0, 0.1, 0.1, 0.0].iter().flat_map(|x| [*x; 5]).collect();
        let s = slide(&dahl, &x).state;
        let up = 1.0 - (-1.0_f64).exp();
        assert!((s[7] - up).abs() < 1e-15 && (s[12] - up).abs() < 1e-15);
        assert!((s[17] - (-1.0 + (up + 1.0) * (-1.0_f64).exp())).abs() < 1e-15);
    }
}
