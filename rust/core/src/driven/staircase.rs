//! The motion between the steps of an encoder.
//!
//! An encoder says exactly when the position crosses the border between two steps, and nothing in between. Read as
//! it stands it is late at every start by half a step on average. Here the crossings are joined: by straight lines
//! while the motion goes on, by a rest in the middle of the step where it pauses, with a parabola (constant
//! acceleration) into and out of the rest.

/// From rest in the middle of a step, constant acceleration takes `sqrt(1)` units of time to the first border and
/// `sqrt(3)` to the second: the first takes `1 / (sqrt(3) - 1)` times what lies between them.
const START_OVER_NEXT: f64 = 1.366_025_403_784_438_6;

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
        let slow_down = before.map_or(0.5 * time, |c| START_OVER_NEXT * (a.time - c.time));
        let speed_up = after.map_or(0.5 * time, |c| START_OVER_NEXT * (c.time - b.time));
        let level = position[a.index];
        let moving = a.direction == b.direction && time <= slow_down + speed_up;
        let shrink = (time / (slow_down + speed_up)).min(1.0);
        let (rest_from, rest_to) = (a.time + shrink * slow_down, b.time - shrink * speed_up);
        for (i, x) in joined.iter_mut().enumerate().take(b.index).skip(a.index) {
            let t = i as f64;
            *x = if moving {
                a.border + (b.border - a.border) * (t - a.time) / time
            } else if t < rest_from {
                level + (a.border - level) * ((rest_from - t) / (rest_from - a.time)).powi(2)
            } else if t > rest_to {
                level + (b.border - level) * ((t - rest_to) / (b.time - rest_to)).powi(2)
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
            START_OVER_NEXT * (second.time - first.time),
            -1.0,
        );
    }
    if let [.., second, last] = crossings[..]
        && second.direction == last.direction
    {
        approach(
            &mut joined,
            last,
            START_OVER_NEXT * (last.time - second.time),
            1.0,
        );
    }
    joined
}

/// Writes the parabola between a crossing and a rest `duration` away on one side of it.
fn approach(joined: &mut [f64], crossing: Crossing, duration: f64, side: f64) {
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
        *x = level + (crossing.border - level) * ((i as f64 - rest) / duration).powi(2);
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
        // from the middle of a step, so that the assumption holds exactly: 3 rad/s^2 at 1 kHz
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
