//! Where within its step an encoder rests, and when the motion stops and starts there.
//!
//! At rest an encoder tells between which two borders the motion stands, no more. The borders crossed on the way in and
//! on the way out tell the rest: from the right place, and with the right power of time, `|border - place|^(1 / power)`
//! lies on a straight line over time on either side. Places and powers are as likely as what they leave off these lines
//! allows, powers also as likely as they are at the other rests of the record; means are taken over both, and what they
//! leave open is how uncertain the start is.

use super::start::POWERS;

/// Crossings that a way in or out needs to be read: a line and a power leave one to judge by.
pub const FEWEST_PASSAGES: usize = 4;

/// Crossings that a way is read from at most. A power of time holds for the first part of a ramp only; how well a rest
/// is found changes little from five to eight, and beyond that a start that creeps before it ramps is misread.
pub const MOST_PASSAGES: usize = 6;

/// Places tried in a step.
const PLACES: usize = 24;

/// A crossing lies anywhere between two samples: the variance of its instant, in samples squared.
const SAMPLING_VARIANCE: f64 = 1.0 / 12.0;

/// Times that the powers of a record are learnt from all its rests, and how much of a chance every power keeps.
const ROUNDS: usize = 10;
const ANY_POWER: f64 = 0.1;

/// No motion starts with a power of time exactly: the instant is wrong by this share of the time between the first two
/// borders, and by a sample where a quick start crosses several borders in one.
const MISSHAPEN: f64 = 0.1;
const SAMPLE: f64 = 1.0;

/// A border between two steps and when it was crossed, in samples.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Passage {
    /// Position half-way between the two steps.
    pub border: f64,
    /// Time of the crossing.
    pub time: f64,
}

/// A rest in a step, with the crossings next to it on either side, the nearest first.
#[derive(Debug, Clone, PartialEq)]
pub struct Rest {
    /// The step's lower border.
    pub low: f64,
    /// Its height.
    pub step: f64,
    /// The way in, where it was slowing down.
    pub way_in: Vec<Passage>,
    /// The way out, where it was speeding up.
    pub way_out: Vec<Passage>,
}

/// When the motion stops or starts, and as which power of time.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Instant {
    /// In samples.
    pub time: f64,
    /// The power.
    pub power: f64,
    /// Standard error of the instant at which the motion is half a step away, in samples.
    pub error: f64,
}

/// What is known of a rest.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Settled {
    /// Its place.
    pub level: f64,
    /// When the motion stops; None where the way in is shorter than [`FEWEST_PASSAGES`].
    pub stops: Option<Instant>,
    /// When it starts.
    pub starts: Option<Instant>,
}

/// The rests of a record, and the power of time with which its motions start and stop on the whole.
#[derive(Debug, Clone, PartialEq)]
pub struct Settling {
    /// The power.
    pub power: f64,
    /// In the order of the rests; None where nothing is known but the step.
    pub rests: Vec<Option<Settled>>,
}

/// Finds out where motions rest.
pub fn settle(rests: &[Rest]) -> Settling {
    let read: Vec<Option<Read>> = rests.iter().map(Read::of).collect();
    let told: Vec<&Read> = read.iter().flatten().collect();
    if told.is_empty() {
        return Settling {
            power: POWERS[0],
            rests: vec![None; rests.len()],
        };
    }
    // The median: one start that stumbles says nothing of the others.
    let mut own: Vec<f64> = told.iter().map(|r| r.variance).collect();
    let middle = own.len() / 2;
    let (_, variance, _) = own.select_nth_unstable_by(middle, f64::total_cmp);
    let variance = variance.max(SAMPLING_VARIANCE);
    let mut powers = [1.0 / POWERS.len() as f64; POWERS.len()];
    for _ in 0..ROUNDS {
        let mut sum = [0.0; POWERS.len()];
        let mut ways = 0.0;
        for likely in told.iter().map(|r| r.likely(variance, &powers)) {
            for way in likely.ways.iter().flatten() {
                ways += 1.0;
                for (sum, row) in sum.iter_mut().zip(way) {
                    *sum += row.iter().sum::<f64>();
                }
            }
        }
        for (power, sum) in powers.iter_mut().zip(sum) {
            *power = (1.0 - ANY_POWER) * sum / ways + ANY_POWER / POWERS.len() as f64;
        }
    }
    Settling {
        power: powers.iter().zip(POWERS).map(|(w, p)| w * p).sum(),
        rests: rests
            .iter()
            .zip(&read)
            .map(|(rest, read)| Some(read.as_ref()?.settled(rest, variance, &powers)))
            .collect(),
    }
}

fn place(rest: &Rest, number: usize) -> f64 {
    rest.low + rest.step * (number as f64 + 0.5) / PLACES as f64
}

/// For every power and place a number.
type Table<T> = [[T; PLACES]; POWERS.len()];

/// A straight line of time over the root of the travel.
#[derive(Debug, Clone, Copy, Default)]
struct Line {
    /// What the crossings are off it, squared, in samples squared.
    squares: f64,
    /// When it leaves the rest.
    start: f64,
    /// When it is half a step away.
    half_way: f64,
    /// Variance of that instant for crossings of unit variance.
    looseness: f64,
}

/// The lines of a rest.
struct Read {
    /// In, out.
    ways: [Option<Table<Line>>; 2],
    /// Variance of the crossings about the best lines.
    variance: f64,
}

/// How likely powers and places are.
struct Likely {
    places: [f64; PLACES],
    ways: [Option<Table<f64>>; 2],
}

impl Read {
    fn of(rest: &Rest) -> Option<Self> {
        let ways = [&rest.way_in, &rest.way_out].map(|way| lines(way, rest));
        let mut least = f64::INFINITY;
        for number in 0..PLACES {
            let best = |way: &Table<Line>| {
                way.iter()
                    .map(|row| row[number].squares)
                    .fold(f64::INFINITY, f64::min)
            };
            least = least.min(ways.iter().flatten().map(best).sum());
        }
        // A line and a power for each way, a place for both.
        let free: usize = [&rest.way_in, &rest.way_out]
            .iter()
            .map(|way| way.len().min(MOST_PASSAGES).saturating_sub(3))
            .sum();
        ways.iter().any(Option::is_some).then(|| Self {
            ways,
            variance: least / (free as f64 - 1.0).max(1.0),
        })
    }

    fn likely(&self, variance: f64, powers: &[f64; POWERS.len()]) -> Likely {
        let variance = variance.max(self.variance);
        let mut ways = [None, None];
        let mut places = [1.0; PLACES];
        for (likely, lines) in ways.iter_mut().zip(&self.ways) {
            let Some(lines) = lines else { continue };
            let least = lines
                .iter()
                .flatten()
                .fold(f64::INFINITY, |least, line| least.min(line.squares));
            let mut table: Table<f64> = [[0.0; PLACES]; POWERS.len()];
            for ((row, lines), power) in table.iter_mut().zip(lines).zip(powers) {
                for (value, line) in row.iter_mut().zip(lines) {
                    *value = power * (-0.5 * (line.squares - least) / variance).exp();
                }
            }
            for (number, place) in places.iter_mut().enumerate() {
                *place *= table.iter().map(|row| row[number]).sum::<f64>();
            }
            *likely = Some(table);
        }
        let total: f64 = places.iter().sum();
        for place in &mut places {
            *place /= total;
        }
        // Powers within each place, places by both ways.
        for table in ways.iter_mut().flatten() {
            for (number, place) in places.iter().enumerate() {
                let sum: f64 = table.iter().map(|row| row[number]).sum();
                for row in table.iter_mut() {
                    row[number] = if sum > 0.0 {
                        row[number] * place / sum
                    } else {
                        0.0
                    };
                }
            }
        }
        Likely { places, ways }
    }

    fn settled(&self, rest: &Rest, variance: f64, powers: &[f64; POWERS.len()]) -> Settled {
        let likely = self.likely(variance, powers);
        let instant = |way: usize, passages: &[Passage]| {
            let (lines, weights) = (self.ways[way].as_ref()?, likely.ways[way].as_ref()?);
            let mean = |of: &dyn Fn(&Line, f64) -> f64| -> f64 {
                let mut sum = 0.0;
                for ((lines, weights), power) in lines.iter().zip(weights).zip(POWERS) {
                    for (line, weight) in lines.iter().zip(weights) {
                        sum += weight * of(line, power);
                    }
                }
                sum
            };
            let half_way = mean(&|line, _| line.half_way);
            let open = mean(&|line, _| (line.half_way - half_way).powi(2));
            let loose = variance.max(self.variance) * mean(&|line, _| line.looseness);
            let misshapen = MISSHAPEN * (passages[1].time - passages[0].time);
            Some(Instant {
                time: mean(&|line, _| line.start),
                power: mean(&|_, power| power),
                error: (open + loose + misshapen * misshapen + SAMPLE * SAMPLE).sqrt(),
            })
        };
        Settled {
            level: likely
                .places
                .iter()
                .enumerate()
                .map(|(number, weight)| weight * place(rest, number))
                .sum(),
            stops: instant(0, &rest.way_in),
            starts: instant(1, &rest.way_out),
        }
    }
}

/// The lines of one way for all powers and places.
fn lines(way: &[Passage], rest: &Rest) -> Option<Table<Line>> {
    if way.len() < FEWEST_PASSAGES {
        return None;
    }
    let way = &way[..way.len().min(MOST_PASSAGES)];
    let n = way.len() as f64;
    let t = way.iter().map(|p| p.time).sum::<f64>() / n;
    let tt: f64 = way.iter().map(|p| (p.time - t).powi(2)).sum();
    let mut table: Table<Line> = [[Line::default(); PLACES]; POWERS.len()];
    for (row, power) in table.iter_mut().zip(POWERS) {
        let half = (0.5 * rest.step).powf(1.0 / power);
        for (number, line) in row.iter_mut().enumerate() {
            let place = place(rest, number);
            let mut roots = [0.0; MOST_PASSAGES];
            for (root, p) in roots.iter_mut().zip(way) {
                *root = (p.border - place).abs().powf(1.0 / power);
            }
            let roots = &roots[..way.len()];
            let u = roots.iter().sum::<f64>() / n;
            let (mut uu, mut ut) = (0.0, 0.0);
            for (root, p) in roots.iter().zip(way) {
                uu += (root - u) * (root - u);
                ut += (root - u) * (p.time - t);
            }
            let slope = ut / uu;
            *line = Line {
                squares: (tt - slope * ut).max(0.0),
                start: t - slope * u,
                half_way: t + slope * (half - u),
                looseness: 1.0 / n + (half - u).powi(2) / uu,
            };
        }
    }
    Some(table)
}

#[cfg(test)]
mod tests {
    use super::{MOST_PASSAGES, Passage, Rest, settle};

    /// Rests at `places` of a step of 1 between 0 and 1, left and reached with a power of time, crossings known to a
    /// sample.
    fn rests(power: f64, places: &[f64]) -> Vec<Rest> {
        let way = |place: f64, first: f64, side: f64| -> Vec<Passage> {
            (0..MOST_PASSAGES)
                .map(|i| {
                    let border = first + (first - 0.5).signum() * i as f64;
                    let exact = 500.0 + side * 60.0 * (border - place).abs().powf(1.0 / power);
                    Passage {
                        border,
                        time: exact.floor() + 0.5,
                    }
                })
                .collect()
        };
        places
            .iter()
            .map(|place| Rest {
                low: 0.0,
                step: 1.0,
                way_in: way(*place, 0.0, -1.0),
                way_out: way(*place, 0.0, 1.0),
            })
            .collect()
    }

    #[test]
    fn the_place_the_instant_and_the_power_of_a_rest_are_found() {
        let places = [0.1, 0.25, 0.4, 0.5, 0.65, 0.8, 0.9];
        for power in [2.0, 3.0, 4.0] {
            let found = settle(&rests(power, &places));
            assert!(
                (found.power - power).abs() <= 0.6,
                "{power}: {}",
                found.power
            );
            let mut squares = 0.0;
            for (place, rest) in places.iter().zip(&found.rests) {
                let rest = rest.unwrap();
                squares += (rest.level - place).powi(2) / places.len() as f64;
                for instant in [rest.stops.unwrap(), rest.starts.unwrap()] {
                    let late = (instant.time - 500.0).abs();
                    // The fourth root of a travel hardly moves at first: a hundredth of a step takes 19 samples.
                    assert!(late < 15.0, "{power}, {place}: {rest:?}");
                    assert!(
                        instant.error > 1.0 && instant.error < 12.0,
                        "{power}, {place}: {rest:?}"
                    );
                }
            }
            // Taken for the middle of the step they would be off by 0.27.
            assert!(squares.sqrt() < 0.1, "{power}: {found:?}");
        }
    }

    #[test]
    fn a_way_too_short_tells_nothing() {
        let mut short = rests(2.0, &[0.3]);
        short[0].way_in.truncate(3);
        short[0].way_out.clear();
        assert_eq!(settle(&short).rests, vec![None]);
        assert_eq!(settle(&[]).rests, vec![]);
    }

    #[test]
    fn one_side_is_enough() {
        let mut one = rests(2.0, &[0.3]);
        one[0].way_in.clear();
        let found = settle(&one).rests[0].unwrap();
        assert_eq!(found.stops, None);
        assert!((found.level - 0.3).abs() < 0.15, "{found:?}");
    }
}
