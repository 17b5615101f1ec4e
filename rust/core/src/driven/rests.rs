//! The motion behind the noise of a position sensor: rests are held, strokes go one way, starts are drawn back.
//!
//! Friction turns with the motion, so a position that trembles at rest would turn it to and fro, and one that is
//! smoothed until it does not would move before the mechanism does. Between two turning points the motion goes one way
//! only; where it starts is read from the two instants at which it has left its rest for certain.

use super::start::{Passage, Start, gentleness};
use super::strokes::Turn;

/// A position is off its level for certain once it is this many standard deviations of the noise away: of the thousand
/// samples of a rest none is, in nine records of ten.
pub const CERTAIN: f64 = 4.0;

/// How a start is drawn back is read off this many times the travel that is certain.
const FAR: f64 = 4.0;

/// The travels, in multiples of what is certain, that tell as which power of time motions start.
const TRAVELS: [f64; 6] = [1.0, 2.0, 4.0, 6.0, 9.0, 13.0];

/// The noise of a position, its standard deviation, from what a low pass takes off; robust against the corners that it
/// takes off as well.
///
/// `kept_share` is the share of the noise's power that the low pass leaves in.
pub fn noise(position: &[f64], smooth: &[f64], kept_share: f64) -> f64 {
    let mut residual: Vec<f64> = position
        .iter()
        .zip(smooth)
        .map(|(x, s)| (x - s).abs())
        .collect();
    let middle = residual.len() / 2;
    let (_, median, _) = residual.select_nth_unstable_by(middle, f64::total_cmp);
    // the median of a normal variable's absolute value
    *median / 0.674_489_750_196_081_7 / (1.0 - kept_share).sqrt()
}

/// Returns the position with its rests held and its strokes going one way.
///
/// `certain` is the distance from a level that is no noise.
pub fn held(position: &[f64], smooth: &[f64], turns: &[Turn], certain: f64) -> Vec<f64> {
    let mut quiet = position.to_vec();
    let (Some(first), Some(last)) = (turns.first(), turns.last()) else {
        return quiet;
    };
    let levels: Vec<f64> = turns
        .iter()
        .map(|turn| rest_level(position, smooth[turn.sample], turn.sample, certain))
        .collect();
    let ways: Vec<Way> = turns
        .windows(2)
        .zip(levels.windows(2))
        .map(|(pair, level)| Way {
            samples: &position[pair[0].sample..=pair[1].sample],
            from: level[0],
            direction: (level[1] - level[0]).signum(),
            certain,
        })
        .collect();
    let power = gentleness(&ways.iter().map(Way::start).collect::<Vec<_>>());
    // The travel that is certain takes this many times what lies between it and the far one.
    let lead = 1.0 / (FAR.powf(1.0 / power) - 1.0);
    quiet[..=first.sample].fill(levels[0]);
    let mut rests_since = 0;
    for (k, way) in ways.iter().enumerate() {
        let (start, end) = (turns[k].sample, turns[k + 1].sample);
        let (from, to, direction) = (way.from, levels[k + 1], way.direction);
        let (left, well) = (
            start + way.passes(certain),
            start + way.passes(FAR * certain),
        );
        let ahead = (lead * (well - left) as f64).round() as usize;
        let begin = left.saturating_sub(ahead).max(rests_since).min(left);
        quiet[rests_since..=begin].fill(from);
        for (i, y) in quiet.iter_mut().enumerate().take(left + 1).skip(begin) {
            let share = if left > begin {
                (i - begin) as f64 / (left - begin) as f64
            } else {
                0.0
            };
            *y = from + direction * certain * share.powf(power);
        }
        let mut furthest = quiet[left];
        rests_since = end;
        for i in left + 1..=end {
            let x = position[i];
            if (x - furthest) * direction > 0.0 {
                furthest = x;
            }
            if (furthest - to) * direction >= 0.0 {
                furthest = to;
                rests_since = rests_since.min(i);
            }
            quiet[i] = furthest;
        }
        quiet[end] = to;
    }
    let rest = &mut quiet[last.sample..];
    // After the last turning point nothing moves by more than the hysteresis; what is no noise is followed.
    let mut level = levels[levels.len() - 1];
    for y in rest {
        level += crate::projections::luz(*y - level, certain);
        *y = level;
    }
    quiet
}

/// The samples between two turning points, and what is certain of them.
struct Way<'a> {
    samples: &'a [f64],
    from: f64,
    direction: f64,
    certain: f64,
}

impl Way<'_> {
    /// The sample at which a travel is passed: half-way between the first beyond it and the last not yet.
    fn passes(&self, travel: f64) -> usize {
        let end = self.samples.len() - 1;
        let gone = |i: usize| (self.samples[i] - self.from) * self.direction;
        let beyond = (0..=end).find(|i| gone(*i) > travel).unwrap_or(end);
        // Under way for certain: from there on nothing falls back below.
        let under_way = (beyond..=end)
            .find(|i| gone(*i) > travel + 2.0 * self.certain)
            .unwrap_or(end);
        let below = (0..=under_way).rev().find(|i| gone(*i) <= travel);
        // Noise passes early as often as late.
        usize::midpoint(beyond, below.unwrap_or(0))
    }

    /// The travels that tell how the motion starts, and when they were passed.
    fn start(&self) -> Start {
        TRAVELS
            .iter()
            .map(|times| Passage {
                travel: times * self.certain,
                time: self.passes(times * self.certain) as f64,
            })
            .collect()
    }
}

/// The mean of the samples next to a turning point that do not differ from it for certain.
fn rest_level(position: &[f64], level: f64, at: usize, certain: f64) -> f64 {
    let near = |x: &&f64| (**x - level).abs() <= certain;
    let (mut sum, mut count) = (0.0, 0.0);
    for x in position[..at]
        .iter()
        .rev()
        .take_while(near)
        .chain(position[at..].iter().take_while(near))
    {
        sum += x;
        count += 1.0;
    }
    if count > 0.0 { sum / count } else { level }
}

#[cfg(test)]
mod tests {
    use super::{CERTAIN, held, noise};
    use crate::driven::strokes::turning_points;

    /// Rest, a stroke that starts and ends with constant acceleration, rest, and back; with noise.
    fn record(sigma: f64) -> (Vec<f64>, Vec<f64>) {
        let stroke = |t: f64| {
            let t = t.clamp(0.0, 2.0);
            if t < 1.0 {
                5.0 * t * t
            } else {
                10.0 - 5.0 * (2.0 - t).powi(2)
            }
        };
        let truth: Vec<f64> = (0..6000)
            .map(|i| f64::from(i) * 1e-3)
            .map(|t| stroke(t - 0.5) - stroke(t - 3.2))
            .collect();
        // Twelve evenly spread numbers add up to nearly normal noise of unit variance.
        let mut state = 1_u64;
        let mut even = || {
            state = state
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1);
            (state >> 40) as f64 / f64::from(1 << 24)
        };
        let measured = truth
            .iter()
            .map(|x| x + sigma * ((0..12).map(|_| even()).sum::<f64>() - 6.0))
            .collect();
        (truth, measured)
    }

    #[test]
    fn rests_are_still_and_starts_are_where_they_were() {
        let sigma = 0.01;
        let (truth, measured) = record(sigma);
        let turns = turning_points(&truth, 1.0, 5.0);
        let quiet = held(&measured, &truth, &turns, CERTAIN * sigma);
        assert!(quiet[..450].iter().all(|x| *x == quiet[0]));
        assert!(quiet[2650..3150].iter().all(|x| *x == quiet[2650]));
        let starts = quiet.iter().position(|x| *x > quiet[0]).unwrap();
        // Four standard deviations take sqrt(2 * 0.04 / 10) = 0.09 s; the start is known to a quarter of that.
        assert!((478..=522).contains(&starts), "{starts}");
        let worst = quiet
            .iter()
            .zip(&truth)
            .map(|(a, b)| (a - b).abs())
            .fold(0.0, f64::max);
        assert!(worst < CERTAIN * sigma, "{worst}");
    }

    #[test]
    fn noise_is_measured_in_spite_of_corners() {
        let (truth, measured) = record(0.01);
        let found = noise(&measured, &truth, 0.0);
        // 6000 samples give a median to 2 %; the twelve-fold sum is normal to 3 %
        assert!((found - 0.01).abs() < 7e-4, "{found}");
    }
}
