//! The motion between the steps of an encoder.
//!
//! An encoder says exactly when the position crosses the border between two steps, and nothing in between. Read as
//! it stands it is late at every start by half a step on average. Here the crossings are joined: by straight lines
//! while the motion goes on; where it pauses by a rest, with a power of time into and out of it. Where in its step the
//! motion rests is read off the crossings around it (see [`super::within_step`]), or is the middle where they are too
//! few.

use super::within_step::{Instant, MOST_PASSAGES, Passage, Rest, Settled, Settling, settle};

/// A pause this many times as long as its neighbours is a rest.
const REST_OVER_NEXT: f64 = 3.0;

/// From rest in the middle of a step the second border is three times as far as the first.
const SECOND_OVER_FIRST: f64 = 3.0;

/// Crossings come a sample early or late: a way that speeds up may seem to slow down by as much.
const SAMPLING: f64 = 1.0;

/// From so many crossings of one border in a row on the position flickers about it: up and back is a turn of the motion,
/// up, back and up again may be one that passes under a little noise.
const FLICKER: usize = 4;

/// A flicker comes again and again: what takes more than this share of all of it is a rest beside the border.
const BESIDE: f64 = 0.5;

/// Where a crossing belongs to a rest that flickers about its border.
#[derive(Clone, Copy, PartialEq)]
enum Flicker {
    Not,
    Begins,
    Ends,
}

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
    flicker: Flicker,
}

/// All crossings of a record, of those that flicker about one border the first and the last.
fn crossings(position: &[f64], step: f64) -> Vec<Crossing> {
    let all: Vec<Crossing> = (1..position.len())
        .filter(|i| position[*i] != position[i - 1])
        .map(|i| Crossing {
            time: i as f64 - 0.5,
            border: 0.5 * (position[i] + position[i - 1]),
            direction: (position[i] - position[i - 1]).signum(),
            index: i,
            flicker: Flicker::Not,
        })
        .collect();
    let mut kept = Vec::with_capacity(all.len());
    for group in all.chunk_by(|a, b| (a.border - b.border).abs() < 0.25 * step) {
        keep(group, &mut kept);
    }
    kept
}

/// Keeps the crossings of one border, of those that come again and again the first and the last.
fn keep(group: &[Crossing], kept: &mut Vec<Crossing>) {
    let [first, .., last] = group else {
        return kept.extend_from_slice(group);
    };
    if group.len() < FLICKER {
        return kept.extend_from_slice(group);
    }
    let pause = |k: &usize| group[*k].time - group[*k - 1].time;
    let longest = (1..group.len())
        .max_by(|a, b| pause(a).total_cmp(&pause(b)))
        .unwrap_or(1);
    if pause(&longest) > BESIDE * (last.time - first.time) {
        keep(&group[..longest], kept);
        return keep(&group[longest..], kept);
    }
    let marked = |crossing: &Crossing, flicker| Crossing {
        flicker,
        ..*crossing
    };
    kept.push(marked(first, Flicker::Begins));
    kept.push(marked(last, Flicker::Ends));
}

/// How well the instant of a start is known.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct KnownStart {
    /// When the first border is crossed, in samples.
    pub crossing: f64,
    /// Standard error of the instant at which the motion has come half a step far, in samples.
    pub error: f64,
}

/// A stepped position with its crossings joined.
#[derive(Debug, Clone, PartialEq)]
pub struct Joined {
    /// The position.
    pub position: Vec<f64>,
    /// The starts whose instant could be read off their crossings.
    pub starts: Vec<KnownStart>,
}

/// Joins the crossings of a position in steps of the height `step`.
pub fn join_steps(position: &[f64], step: f64) -> Joined {
    let crossings = crossings(position, step);
    // One gap before the first crossing, one after each.
    let gaps: Vec<Gap> = (0..=crossings.len())
        .map(|after| Gap {
            crossings: &crossings,
            after,
        })
        .collect();
    let paused: Vec<usize> = (0..gaps.len()).filter(|k| gaps[*k].is_pause()).collect();
    let rests: Vec<Rest> = paused
        .iter()
        .map(|k| gaps[*k].rest(position, step))
        .collect();
    let Settling {
        power,
        rests: settled,
    } = settle(&rests);
    let mut known: Vec<Option<Settled>> = vec![None; gaps.len()];
    for (k, rest) in paused.into_iter().zip(settled) {
        known[k] = rest;
    }
    let mut joined = position.to_vec();
    for (gap, known) in gaps.iter().zip(&known) {
        gap.fill(&mut joined, *known, power);
    }
    let starts = gaps
        .iter()
        .zip(&known)
        .filter_map(|(gap, known)| {
            let (starts, next) = (known.as_ref()?.starts?, gap.next()?);
            Some(KnownStart {
                crossing: next.time,
                error: starts.error,
            })
        })
        .collect();
    Joined {
        position: joined,
        starts,
    }
}

/// The time between two crossings, or before the first, or after the last.
struct Gap<'a> {
    crossings: &'a [Crossing],
    /// So many crossings lie before it.
    after: usize,
}

impl Gap<'_> {
    fn last(&self) -> Option<Crossing> {
        self.nth(0, false)
    }

    fn next(&self) -> Option<Crossing> {
        self.nth(0, true)
    }

    /// A crossing on one side, counted from the gap.
    fn nth(&self, i: usize, out: bool) -> Option<Crossing> {
        let k = if out {
            self.after + i
        } else {
            self.after.checked_sub(i + 1)?
        };
        self.crossings.get(k).copied()
    }

    /// The crossings before, the nearest first, while the motion was slowing down in one direction; and those after,
    /// while it was speeding up.
    fn way(&self, out: bool) -> Vec<Crossing> {
        let mut way: Vec<Crossing> = Vec::with_capacity(MOST_PASSAGES);
        let mut pause = f64::INFINITY;
        while way.len() < MOST_PASSAGES {
            let Some(next) = self.nth(way.len(), out) else {
                break;
            };
            if let Some(here) = way.last() {
                let took = (next.time - here.time).abs();
                let flickers = next.flicker != Flicker::Not;
                if flickers || next.direction != here.direction || took > pause + SAMPLING {
                    break;
                }
                pause = took;
            }
            way.push(next);
        }
        way
    }

    /// Whether the motion pauses here: it turns, or this takes long beside what comes before and after.
    fn is_pause(&self) -> bool {
        if self.flickers() {
            return false;
        }
        let (Some(last), Some(next)) = (self.last(), self.next()) else {
            return true;
        };
        if last.direction != next.direction {
            return true;
        }
        let took = next.time - last.time;
        let long = |out| {
            self.next_pause(out)
                .is_some_and(|pause| took > REST_OVER_NEXT * pause)
        };
        long(false) && long(true)
    }

    /// Whether a flicker ends or begins here: the position is then known to be that of its border.
    fn flickers(&self) -> bool {
        let here = |crossing: Option<Crossing>| crossing.is_some_and(|c| c.flicker != Flicker::Not);
        here(self.last()) || here(self.next())
    }

    /// The time between the two crossings next to this gap on one side, where they go the same way.
    fn next_pause(&self, out: bool) -> Option<f64> {
        let (near, far) = (self.nth(0, out)?, self.nth(1, out)?);
        (near.direction == far.direction).then(|| (far.time - near.time).abs())
    }

    /// The step in which the motion stands, as its value in the record.
    fn middle(&self, position: &[f64]) -> f64 {
        position[self.last().map_or(0, |c| c.index)]
    }

    fn rest(&self, position: &[f64], step: f64) -> Rest {
        let passages = |out: bool| -> Vec<Passage> {
            self.way(out)
                .iter()
                .map(|c| Passage {
                    border: c.border,
                    time: c.time,
                })
                .collect()
        };
        Rest {
            low: self.middle(position) - 0.5 * step,
            step,
            way_in: passages(false),
            way_out: passages(true),
        }
    }

    /// Writes the position between the two crossings.
    fn fill(&self, joined: &mut [f64], known: Option<Settled>, power: f64) {
        let from = self.last().map_or(0, |c| c.index);
        let to = self.next().map_or(joined.len(), |c| c.index);
        if self.flickers() {
            return self.fill_flicker(&mut joined[from..to], from, power);
        }
        let shown = joined[from.min(to - 1)];
        let level = known.map_or(shown, |k| k.level);
        let mut ramps = [
            self.ramp(false, known.and_then(|k| k.stops), power),
            self.ramp(true, known.and_then(|k| k.starts), power),
        ];
        if let [Some(before), Some(after)] = &mut ramps {
            let took = after.time - before.time;
            let shrink = took / (before.takes + after.takes);
            if shrink <= 1.0 {
                if before.direction == after.direction {
                    for (i, x) in joined.iter_mut().enumerate().take(to).skip(from) {
                        let share = (i as f64 - before.time) / took;
                        *x = before.border + (after.border - before.border) * share;
                    }
                    return;
                }
                before.takes *= shrink;
                after.takes *= shrink;
            }
        }
        for (i, x) in joined.iter_mut().enumerate().take(to).skip(from) {
            let away = |ramp: &Ramp| ramp.away(i as f64, level);
            *x = level + ramps.iter().flatten().map(away).sum::<f64>();
        }
    }

    /// Writes a rest at a border, or the way from it or to it.
    fn fill_flicker(&self, joined: &mut [f64], from: usize, power: f64) {
        let ends = [self.last(), self.next()];
        let [Some(a), Some(b)] = ends else {
            let border = ends.into_iter().flatten().next().map(|c| c.border);
            return joined.fill(border.unwrap_or_default());
        };
        for (i, x) in joined.iter_mut().enumerate() {
            let share = ((from + i) as f64 - a.time) / (b.time - a.time);
            let gone = match (a.flicker, b.flicker) {
                (Flicker::Begins, _) => 0.0,
                (Flicker::Ends, Flicker::Not) => share.powf(power),
                (Flicker::Not, _) => 1.0 - (1.0 - share).powf(power),
                _ => share,
            };
            *x = a.border + (b.border - a.border) * gone;
        }
    }

    /// The way between the rest and the crossing on one side.
    ///
    /// Where it could not be read off the crossings it starts in the middle of the step, and takes a time that the next
    /// pause tells; without a crossing in the same direction it takes half of the time there is, or none if that has no
    /// end.
    fn ramp(&self, out: bool, known: Option<Instant>, power: f64) -> Option<Ramp> {
        let crossing = if out { self.next() } else { self.last() }?;
        let side = if out { 1.0 } else { -1.0 };
        let takes = if let Some(instant) = known {
            (side * (crossing.time - instant.time)).max(0.5 * SAMPLING)
        } else if let Some(pause) = self.next_pause(out) {
            pause / (SECOND_OVER_FIRST.powf(1.0 / power) - 1.0)
        } else {
            let ends = self.last().zip(self.next());
            ends.map_or(0.0, |(a, b)| 0.5 * (b.time - a.time))
        };
        Some(Ramp {
            border: crossing.border,
            time: crossing.time,
            direction: crossing.direction,
            takes,
            power: known.map_or(power, |k| k.power),
        })
    }
}

/// The way between a rest and a crossing.
struct Ramp {
    border: f64,
    time: f64,
    direction: f64,
    /// Samples between the rest and the crossing.
    takes: f64,
    power: f64,
}

impl Ramp {
    /// How far from the rest at `level` the position is.
    fn away(&self, time: f64, level: f64) -> f64 {
        let left = 1.0 - (time - self.time).abs() / self.takes;
        if left > 0.0 {
            (self.border - level) * left.powf(self.power)
        } else {
            0.0
        }
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
        let joined = join_steps(&stepped(&x), STEP).position;
        for (a, b) in joined.iter().zip(&x).skip(100).take(2800) {
            // a crossing is known to half a sample: half of 0.0013
            assert!((a - b).abs() < 0.0007, "{a} {b}");
        }
    }

    /// Strokes to and fro between rests that lie anywhere in their step, constant acceleration of 3 rad/s^2 at 1 kHz.
    fn strokes() -> Vec<f64> {
        let ramp = |t: f64| 1.5 * t.max(0.0).powi(2);
        let way = |t: f64, v: f64| ramp(t) - ramp(t - v) - ramp(t - 1.0) + ramp(t - 1.0 - v);
        (0..16_000)
            .map(|i| {
                let t = f64::from(i) * 1e-3;
                (0..8).fold(0.003, |x, k| {
                    let (k, side) = (f64::from(k), if k % 2 == 0 { 1.0 } else { -1.0 });
                    x + side * way(t - 0.3 - 2.0 * k, 0.4 + 0.013 * k)
                })
            })
            .collect()
    }

    #[test]
    fn starts_are_known_better_than_to_half_a_step() {
        let x = strokes();
        let joined = join_steps(&stepped(&x), STEP);
        assert_eq!(joined.starts.len(), 8);
        for k in 0..8 {
            let (rest, start) = (200 + 2000 * k, 300 + 2000 * k);
            // Half a step takes sqrt(0.02 / 3) = 82 ms, the first border is crossed within 115: what the crossings do
            // not tell is a fifth of a step.
            for i in rest..start + 115 {
                let off = joined.position[i] - x[i];
                assert!(off.abs() < 0.2 * STEP, "{k}, {i}: {off}");
            }
            assert!(joined.starts[k].error < 30.0, "{k}: {:?}", joined.starts[k]);
            assert_eq!(
                joined.position[rest],
                joined.position[start - 40],
                "at rest"
            );
        }
    }

    #[test]
    fn a_flicker_about_a_border_is_a_rest_at_the_border() {
        // The strokes above, shifted so that they rest on a border, under noise of a twentieth of a step.
        let mut state = 1_u64;
        let mut even = || {
            state = state
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1);
            (state >> 40) as f64 / f64::from(1 << 24) - 0.5
        };
        let x: Vec<f64> = strokes().iter().map(|x| x + 0.007).collect();
        let raw = stepped(
            &x.iter()
                .map(|x| x + 0.1 * STEP * even())
                .collect::<Vec<_>>(),
        );
        let rest = 100..290;
        assert!(raw[rest.clone()].windows(2).any(|p| p[0] != p[1]));
        let joined = join_steps(&raw, STEP).position;
        assert!(joined[rest].windows(2).all(|p| p[0] == p[1]));
        for (i, (a, b)) in joined.iter().zip(&x).enumerate() {
            assert!((a - b).abs() < STEP, "{i}: {a} {b}");
        }
    }

    #[test]
    fn a_start_that_skips_counts_rests_where_it_was_read() {
        // A slow way, a rest, and thirty steps between two samples at once.
        let x: Vec<f64> = (0..400)
            .map(|i| {
                0.25 * STEP * f64::from(i.min(100)) + 30.0 * STEP * f64::from((i - 300).max(0))
            })
            .collect();
        let raw = stepped(&x);
        for (a, b) in join_steps(&raw, STEP).position[..295].iter().zip(&raw) {
            assert!((a - b).abs() <= 0.5 * STEP + 1e-9, "{a} {b}");
        }
    }

    #[test]
    fn a_turn_rests_in_its_step_and_never_leaves_it() {
        let x: Vec<f64> = (0..4000)
            .map(|i| (f64::from(i) * 1e-3 * std::f64::consts::PI / 2.0).sin())
            .collect();
        let raw = stepped(&x);
        for (a, b) in join_steps(&raw, STEP).position.iter().zip(&raw) {
            assert!((a - b).abs() <= 0.5 * STEP + 1e-12);
        }
    }
}
