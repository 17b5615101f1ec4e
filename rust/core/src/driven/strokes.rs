//! Strokes: the motion between two reversals, with the dwell that follows it.

use super::staircase::KnownStart;

/// One stroke of a recording, in samples of the smoothed position.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Stroke {
    /// The last sample at rest before the motion starts.
    pub onset: usize,
    /// The sample where the motion turns.
    pub turn: usize,
    /// +1 where the position increases, -1 where it decreases.
    pub direction: f64,
    /// The time that the sensor's first whole step after the onset takes.
    pub first_step_s: f64,
    /// By how much the instant of the motion's start is uncertain: its standard error where the crossings of an encoder
    /// tell it, else half of the first step's time.
    pub onset_uncertainty_s: f64,
}

/// What a stroke knows of itself at every sample.
#[derive(Debug, Clone, PartialEq)]
pub struct Phases {
    /// Seconds of rest before the present stroke; 0 before the first.
    pub rest_s: Vec<f64>,
    /// Travel since the present stroke started, as a share of the range.
    pub travelled: Vec<f64>,
    /// Direction of the present stroke; 0 before the first.
    pub direction: Vec<f64>,
}

impl Phases {
    /// Reads the phases off the position as the contact follows it.
    pub fn of(seen: &[f64], strokes: &[Stroke], step: f64, sample_rate_hz: f64) -> Self {
        let n = seen.len();
        let (low, high) = seen
            .iter()
            .fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), x| {
                (l.min(*x), h.max(*x))
            });
        let range = if high > low { high - low } else { 1.0 };
        let mut phases = Self {
            rest_s: vec![0.0; n],
            travelled: vec![0.0; n],
            direction: vec![0.0; n],
        };
        for (k, stroke) in strokes.iter().enumerate() {
            let start = seen[stroke.onset];
            let rest = seen[..stroke.onset]
                .iter()
                .rev()
                .take_while(|x| (**x - start).abs() <= step)
                .count();
            let end = strokes.get(k + 1).map_or(n, |next| next.onset);
            let inside = stroke.onset..end;
            // On its way into the rest and out of it the position was within half a step of it as well.
            let rest_s = rest as f64 / sample_rate_hz - stroke.first_step_s;
            phases.rest_s[inside.clone()].fill(rest_s.max(0.0));
            phases.direction[inside.clone()].fill(stroke.direction);
            for (travelled, x) in phases.travelled[inside.clone()]
                .iter_mut()
                .zip(&seen[inside])
            {
                *travelled = (x - start).abs() / range;
            }
        }
        phases
    }

    /// Every `stride`-th sample.
    pub fn strided(&self, stride: usize) -> Self {
        let kept = |v: &[f64]| v.iter().step_by(stride).copied().collect();
        Self {
            rest_s: kept(&self.rest_s),
            travelled: kept(&self.travelled),
            direction: kept(&self.direction),
        }
    }
}

/// The turning points of `position`: extremes that are followed by a return of more than `hysteresis`.
fn turns(position: &[f64], hysteresis: f64) -> Vec<usize> {
    let (mut high, mut low) = (0, 0);
    let mut direction = 0.0;
    let mut found = Vec::new();
    for (i, x) in position.iter().enumerate() {
        if *x > position[high] {
            high = i;
        }
        if *x < position[low] {
            low = i;
        }
        if direction >= 0.0 && position[high] - x > hysteresis {
            found.push(high);
            direction = -1.0;
            low = i;
        } else if direction <= 0.0 && x - position[low] > hysteresis {
            found.push(low);
            direction = 1.0;
            high = i;
        }
    }
    if direction > 0.0 {
        found.push(high);
    } else if direction < 0.0 {
        found.push(low);
    }
    found
}

/// Drops pairs of turning points that enclose less than `minimum_travel`, so that a small hesitation stays part of
/// the stroke it interrupts.
fn merge_short(position: &[f64], mut turns: Vec<usize>, minimum_travel: f64) -> Vec<usize> {
    while turns.len() > 1 {
        let travel = |k: usize| (position[turns[k + 1]] - position[turns[k]]).abs();
        let Some(short) = (0..turns.len() - 1)
            .filter(|k| travel(*k) < minimum_travel)
            .min_by(|a, b| travel(*a).total_cmp(&travel(*b)))
        else {
            break;
        };
        if short == 0 {
            turns.remove(0);
        } else if short + 2 == turns.len() {
            turns.pop();
        } else {
            turns.drain(short..short + 2);
        }
    }
    turns
}

/// A point where the motion turns, or where it begins or ends.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Turn {
    /// Its sample.
    pub sample: usize,
    /// The position there.
    pub position: f64,
}

/// Finds the turning points of a smoothed position: those of strokes of at least `minimum_travel`.
pub fn turning_points(smooth: &[f64], hysteresis: f64, minimum_travel: f64) -> Vec<Turn> {
    merge_short(smooth, turns(smooth, hysteresis), minimum_travel)
        .into_iter()
        .map(|sample| Turn {
            sample,
            position: smooth[sample],
        })
        .collect()
}

/// Finds the strokes between turning points.
///
/// `seen` is the position as the contact follows it, `step` its resolution: onsets are looked for on it. `known` are the
/// starts whose instants are known better than that.
pub fn strokes(
    turns: &[Turn],
    seen: &[f64],
    known: &[KnownStart],
    step: f64,
    sample_rate_hz: f64,
) -> Vec<Stroke> {
    turns
        .windows(2)
        .map(|pair| {
            let direction = (pair[1].position - pair[0].position).signum();
            let (from, to) = (pair[0].sample, pair[1].sample);
            let (onset, first_step) = onset(&seen[from..=to], direction, step);
            let onset = from + onset;
            // Within half a step of its rest the motion has crossed the first border, or is about to.
            let uncertain = known
                .iter()
                .filter(|k| (k.crossing - onset as f64).abs() <= first_step as f64)
                .map(|k| k.error)
                .fold(0.5 * first_step as f64, f64::min);
            Stroke {
                onset,
                turn: to,
                direction,
                first_step_s: first_step as f64 / sample_rate_hz,
                onset_uncertainty_s: uncertain / sample_rate_hz,
            }
        })
        .collect()
}

/// Where the motion of one stroke starts, and the samples between its first and second step of the sensor.
///
/// Looked for backward from the point where the motion is a few steps under way, so that a flutter of one step
/// during the dwell is not taken for the start.
fn onset(seen: &[f64], direction: f64, step: f64) -> (usize, usize) {
    let start = seen[0];
    let travelled = |i: usize| (seen[i] - start) * direction;
    let under_way = (0..seen.len())
        .find(|i| travelled(*i) > 3.5 * step)
        .unwrap_or(seen.len() - 1);
    let last_at_or_below = |level: f64| {
        (0..=under_way)
            .rev()
            .find(|i| travelled(*i) <= level * step)
            .unwrap_or(0)
    };
    let first_step = last_at_or_below(0.5);
    let second_step = last_at_or_below(1.5);
    (first_step, second_step.saturating_sub(first_step).max(1))
}

#[cfg(test)]
mod tests {
    use super::{Stroke, turning_points};

    fn strokes(x: &[f64]) -> Vec<Stroke> {
        super::strokes(&turning_points(x, 1.0, 5.0), x, &[], 0.1, 100.0)
    }

    #[test]
    fn dwells_belong_to_the_stroke_before_them() {
        let mut x = vec![0.0; 10];
        x.extend((0..=100).map(|i| f64::from(i) * 0.1));
        x.extend(vec![10.0; 50]);
        x.extend((0..=100).map(|i| 10.0 - f64::from(i) * 0.1));
        let found = strokes(&x);
        assert_eq!(found.len(), 2);
        assert_eq!(found[0].direction, 1.0);
        assert_eq!(found[1].direction, -1.0);
        assert!((160..=162).contains(&found[1].onset), "{}", found[1].onset);
        assert_eq!(found[1].onset_uncertainty_s, 0.005);
    }

    #[test]
    fn a_hesitation_does_not_split_a_stroke() {
        let up = (0..100).map(|i| f64::from(i) * 0.1);
        let back = (0..15).map(|i| 9.9 - f64::from(i) * 0.1);
        let on = (0..100).map(|i| 8.5 + f64::from(i) * 0.1);
        let x: Vec<f64> = up.chain(back).chain(on).collect();
        assert_eq!(strokes(&x).len(), 1);
    }
}
