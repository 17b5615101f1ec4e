//! The motion between the steps of an encoder.
//!
//! An encoder says exactly when the position crosses the border between two steps, and nothing in between. Read as
//! it stands it is late at every start by half a step on average. Here the crossings are joined: by straight lines
//! while the motion goes on, by a rest in the middle of the step where it pauses, with a power of time into and out of
//! the rest (see [`super::start`]).

use super::start::{Passage, Start, gentleness};

/// A pause this many times as long as what follows is a rest from which a motion starts.
const REST_OVER_NEXT: f64 = 3.0;

/// So many crossings at most tell how a motion starts, so few at least.
const MOST_PASSAGES: usize = 8;
const FEWEST_PASSAGES: usize = 4;

/// From rest in the middle of a step the second border is three times as far as the first.
const SECOND_OVER_FIRST: f64 = 3.0;

/// One crossing of a border between steps.
#[derive(Clone, Copy)]
struct Crossing {
    /// Samples, half-way between the two that differ.
    time: f64,
    /// Half-way between the two values.
    border: f64,
    /// +1 upward, -1 downward.
    direction: f64,
    /// First sample after the crossing.
    index: usize,
}

/// Joins the crossings of a stepped position.
pub fn join_steps(position: &[f64]) -> Vec<f64> {
    let crossings: Vec<Crossing> = (1..position.len())
        .filter(|i| position[*i] != position[i - 1])
        .map(|i| Crossing {
            time: i as f64 - 0.5,
            border: 0.5 * (position[i] + position[i - 1]),
            direction: (position[i] - position[i - 1]).signum(),
            index: i,
        })
        .collect();
    let power = gentleness(&starts(&crossings, position));
    // The first border takes this many times what lies between the first two.
    let start_over_next = 1.0 / (SECOND_OVER_FIRST.powf(1.0 / power) - 1.0);
    let mut joined = position.to_vec();
    for (k, pair) in crossings.windows(2).enumerate() {
        let (a, b) = (pair[0], pair[1]);
        let before = k
            .checked_sub(1)
            .map(|k| crossings[k])
            .filter(|c| c.direction == a.direction);
        let after = crossings.get(k + 2).filter(|c| c.direction == b.direction);
        let time = b.time - a.time;
        // Without a neighbour in the same direction nothing is known of the speed: half of the time each.
        let slow_down = before.map_or(0.5 * time, |c| start_over_next * (a.time - c.time));
        let speed_up = after.map_or(0.5 * time, |c| start_over_next * (c.time - b.time));
        let level = position[a.index];
        let moving = a.direction == b.direction && time <= slow_down + speed_up;
        let shrink = (time / (slow_down + speed_up)).min(1.0);
        let (rest_from, rest_to) = (a.time + shrink * slow_down, b.time - shrink * speed_up);
        for (i, x) in joined.iter_mut().enumerate().take(b.index).skip(a.index) {
            let t = i as f64;
            *x = if moving {
                a.border + (b.border - a.border) * (t - a.time) / time
            } else if t < rest_from {
                level + (a.border - level) * ((rest_from - t) / (rest_from - a.time)).powf(power)
            } else if t > rest_to {
                level + (b.border - level) * ((t - rest_to) / (b.time - rest_to)).powf(power)
            } else {
                level
            };
        }
    }
    // Before the first crossing and after the last the position rests in its step, but for the way in and out.
    if let [first, second, ..] = crossings[..]
        && first.direction == second.direction
    {
        approach(
            &mut joined,
            first,
            start_over_next * (second.time - first.time),
            power,
            -1.0,
        );
    }
    if let [.., second, last] = crossings[..]
        && second.direction == last.direction
    {
        approach(
            &mut joined,
            last,
            start_over_next * (last.time - second.time),
            power,
            1.0,
        );
    }
    joined
}

/// The passages of every start of a motion from rest.
fn starts(crossings: &[Crossing], position: &[f64]) -> Vec<Start> {
    (0..crossings.len())
        .filter(|k| {
            let here = crossings[*k];
            let Some(next) = crossings.get(k + 1) else {
                return false;
            };
            k.checked_sub(1).is_none_or(|before| {
                let before = crossings[before];
                before.direction != here.direction
                    || here.time - before.time > REST_OVER_NEXT * (next.time - here.time)
            })
        })
        .map(|k| {
            let level = position[crossings[k].index - 1];
            let mut last = f64::INFINITY;
            let under_way = crossings[k + 1..]
                .iter()
                .zip(&crossings[k..])
                .take(MOST_PASSAGES - 1)
                .take_while(|(next, here)| {
                    let pause = next.time - here.time;
                    let faster = pause <= last;
                    last = pause;
                    faster && next.direction == crossings[k].direction
                })
                .map(|(next, _)| next);
            std::iter::once(&crossings[k])
                .chain(under_way)
                .map(|c| Passage {
                    travel: (c.border - level).abs(),
                    time: c.time,
                })
                .collect::<Start>()
        })
        .filter(|start| start.len() >= FEWEST_PASSAGES)
        .collect()
}

/// Writes the way between a crossing and a rest `duration` away on one side of it.
fn approach(joined: &mut [f64], crossing: Crossing, duration: f64, power: f64, side: f64) {
    let level = if side < 0.0 {
        joined[crossing.index - 1]
    } else {
        joined[crossing.index]
    };
    let rest = crossing.time + side * duration;
    let (from, to) = if side < 0.0 {
        (rest, crossing.time)
    } else {
        (crossing.time, rest)
    };
    let first = from.ceil().max(0.0) as usize;
    let last = (to.floor().max(0.0) as usize + 1).min(joined.len());
    for (i, x) in joined.iter_mut().enumerate().take(last).skip(first) {
        *x = level + (crossing.border - level) * ((i as f64 - rest) / duration).abs().powf(power);
    }
}

#[cfg(test)]
mod tests {
    use super::join_steps;

    const STEP: f64 = 0.02;

    fn stepped(x: &[f64]) -> Vec<f64> {
        x.iter().map(|v| (v / STEP).round() * STEP).collect()
    }

    #[test]
    fn an_even_motion_comes_back_within_what_sampling_leaves() {
        let x: Vec<f64> = (0..3000).map(|i| 0.0013 * f64::from(i)).collect();
        let joined = join_steps(&stepped(&x));
        for (a, b) in joined.iter().zip(&x).skip(100).take(2800) {
            // a crossing is known to half a sample: half of 0.0013
            assert!((a - b).abs() < 0.0007, "{a} {b}");
        }
    }

    #[test]
    fn a_start_from_rest_is_not_late() {
        // from the middle of a step, constant acceleration: 3 rad/s^2 at 1 kHz
        let x: Vec<f64> = (0..2000)
            .map(|i| (f64::from(i) - 1000.0).max(0.0) * 1e-3)
            .map(|t| 1.5 * t * t)
            .collect();
        let joined = join_steps(&stepped(&x));
        let start = joined.iter().position(|v| *v > 1e-9).unwrap();
        assert!((998..=1006).contains(&start), "{start}");
        assert!(joined[..990].iter().all(|v| *v == 0.0), "at rest before");
    }

    #[test]
    fn a_turn_rests_in_its_step_and_never_leaves_it() {
        let x: Vec<f64> = (0..4000)
            .map(|i| (f64::from(i) * 1e-3 * std::f64::consts::PI / 2.0).sin())
            .collect();
        let raw = stepped(&x);
        for (a, b) in join_steps(&raw).iter().zip(&raw) {
            assert!((a - b).abs() <= 0.5 * STEP + 1e-12);
        }
    }
}
