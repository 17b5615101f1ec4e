//! How a motion starts: as which power of time.
//!
//! A position sensor shows nothing of the first half step of a motion; where it began is extrapolated from what
//! follows. A drive that is switched on moves with the square of time, a hand begins more gently. The record tells: the
//! travels that a start passes, and when, lie on a straight line of `travel^(1 / power)` over time for the right power
//! only.

/// A travel from rest and when it was passed, in samples.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Passage {
    /// Distance from the rest.
    pub travel: f64,
    /// When it was reached.
    pub time: f64,
}

/// The passages of one start.
pub type Start = Vec<Passage>;

/// Constant acceleration, what is assumed where the record says nothing, up to a minimum-jerk ramp of the speed.
pub const POWERS: [f64; 9] = [2.0, 2.25, 2.5, 2.75, 3.0, 3.25, 3.5, 3.75, 4.0];

/// From so few starts nothing is read.
const FEWEST_STARTS: usize = 4;

/// The power of time with which motions start in this record.
pub fn gentleness(starts: &[Start]) -> f64 {
    if starts.len() < FEWEST_STARTS {
        return POWERS[0];
    }
    let mut best = (f64::INFINITY, POWERS[0]);
    for power in POWERS {
        let mut rests: Vec<f64> = starts.iter().map(|s| off_the_line(s, power)).collect();
        // The median: one start that stumbles says nothing of the others.
        let middle = rests.len() / 2;
        let (_, rest, _) = rests.select_nth_unstable_by(middle, f64::total_cmp);
        if *rest < best.0 {
            best = (*rest, power);
        }
    }
    best.1
}

/// By how much, as a share of its duration squared, a start is off a straight line of `travel^(1 / power)` over time.
fn off_the_line(start: &[Passage], power: f64) -> f64 {
    let points = || start.iter().map(|p| (p.travel.powf(1.0 / power), p.time));
    let n = start.len() as f64;
    let (x, t) = points().fold((0.0, 0.0), |(x, t), (a, b)| (x + a / n, t + b / n));
    let (mut xx, mut xt, mut tt) = (0.0, 0.0, 0.0);
    for (a, b) in points() {
        xx += (a - x) * (a - x);
        xt += (a - x) * (b - t);
        tt += (b - t) * (b - t);
    }
    if xx > 0.0 && tt > 0.0 {
        (1.0 - xt * xt / (xx * tt)).max(0.0)
    } else {
        0.0
    }
}

#[cfg(test)]
mod tests {
    use super::{Passage, Start, gentleness};

    fn starts(power: f64) -> Vec<Start> {
        (0..8)
            .map(|k| {
                // the rest is anywhere in its step
                let offset = 0.1 * f64::from(k) - 0.35;
                (0..6)
                    .map(|i| {
                        let travel = f64::from(i) + 0.5 + offset;
                        Passage {
                            travel: f64::from(i) + 0.5,
                            time: 30.0 * travel.powf(1.0 / power),
                        }
                    })
                    .collect()
            })
            .collect()
    }

    #[test]
    fn the_power_of_a_start_is_read_off_its_passages() {
        for power in [2.0, 3.0, 4.0] {
            let found = gentleness(&starts(power));
            // rests that lie anywhere in their step leave most of a power of doubt
            assert!((found - power).abs() <= 0.75, "{power}: {found}");
        }
    }

    #[test]
    fn few_starts_are_taken_for_constant_acceleration() {
        assert_eq!(gentleness(&starts(4.0)[..3]), 2.0);
    }
}
