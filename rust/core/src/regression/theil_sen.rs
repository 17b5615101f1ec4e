//! The line whose slope is the median of the slopes of all pairs of points: a fifth of the points may be anywhere.
//!
//! Few points: all slopes are made and the middle is selected. Many: the slopes below a value are the inversions of
//! `y - slope x` in the order of x, which sorting counts, and the value is found by bisection.
//!
//! Source: Sen, J. Am. Stat. Assoc. 63 (1968) 1379 (estimate and interval); Cole, Salowe, Steiger, Szemerédi, SIAM J.
//! Comput. 18 (1989) 792 (slopes as inversions).

use crate::error::{Error, require_moderate, require_representable, require_same_length};

/// Up to so many points all pairs are made: 16 MB of slopes.
const ALL_PAIRS: usize = 2048;

/// A robust line.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TheilSen {
    /// The median slope.
    pub slope: f64,
    /// The median of `y - slope x`.
    pub intercept: f64,
    /// The confidence interval of the slope.
    pub slope_low: f64,
    /// Its upper end.
    pub slope_high: f64,
    /// How many points.
    pub n: u64,
}

/// The Theil-Sen line; the interval is that of `normal_quantile` standard deviations of Kendall's statistic.
///
/// # Errors
/// [`Error::Length`] below two points or for lengths that differ, [`Error::NonFinite`], [`Error::OutOfRange`],
/// [`Error::Singular`] for constant x.
pub fn theil_sen(x: &[f64], y: &[f64], normal_quantile: f64) -> Result<TheilSen, Error> {
    require_same_length("y", y, "x", x.len())?;
    require_moderate("x", x)?;
    require_moderate("y", y)?;
    let n = x.len();
    if n < 2 {
        return Err(Error::Length {
            name: "x",
            expected: "at least 2".into(),
            got: n,
        });
    }
    let mut points: Vec<(f64, f64)> = x.iter().copied().zip(y.iter().copied()).collect();
    points.sort_unstable_by(|a, b| a.0.total_cmp(&b.0).then(a.1.total_cmp(&b.1)));
    // About its own middle the product below rounds least.
    let (x_middle, y_middle) = (points[n / 2].0, y[n / 2]);
    for p in &mut points {
        *p = (p.0 - x_middle, p.1 - y_middle);
    }
    let tied: u64 = points
        .chunk_by(|a, b| a.0 == b.0)
        .map(|run| pairs(run.len() as u64))
        .sum();
    let total = pairs(n as u64) - tied;
    if total == 0 {
        return Err(Error::Singular {
            name: "slope",
            reason: format!("x does not vary (all {n} values are {x_middle})"),
        });
    }
    let half = normal_quantile * kendall_deviation(x, y) / 2.0;
    let middle = total as f64 / 2.0;
    // Sen's M1-th and (M2 + 1)-th slope, counted from one, cut at the first and the last.
    let cut = |rank: f64| rank.clamp(0.0, (total - 1) as f64) as u64;
    let low = cut((middle - half).round_ties_even() - 1.0);
    let high = cut((middle + half).round_ties_even());
    let ranks = [(total - 1) / 2, total / 2, low, high];
    let [a, b, slope_low, slope_high] = if n <= ALL_PAIRS {
        by_selection(&points, ranks)
    } else {
        by_bisection(&points, ranks)
    };
    let slope = 0.5 * a + 0.5 * b;
    let mut heights: Vec<f64> = points.iter().map(|(x, y)| y - slope * x).collect();
    let height = median(&mut heights);
    let intercept = (height + y_middle) - slope * x_middle;
    require_representable(
        "the line",
        [slope, intercept, slope_low, slope_high].into_iter(),
    )?;
    Ok(TheilSen {
        slope,
        intercept,
        slope_low,
        slope_high,
        n: n as u64,
    })
}

fn pairs(n: u64) -> u64 {
    n * (n - 1) / 2
}

/// The standard deviation of Kendall's S, with ties in x and in y.
fn kendall_deviation(x: &[f64], y: &[f64]) -> f64 {
    let term = |n: f64| n * (n - 1.0) * (2.0 * n + 5.0);
    let ties = |values: &[f64]| {
        let mut sorted = values.to_vec();
        sorted.sort_unstable_by(f64::total_cmp);
        sorted
            .chunk_by(|a, b| a == b)
            .map(|run| term(run.len() as f64))
            .sum::<f64>()
    };
    // a run of one adds term(1) = 0
    ((term(x.len() as f64) - ties(x) - ties(y)) / 18.0)
        .max(0.0)
        .sqrt()
}

fn by_selection(points: &[(f64, f64)], ranks: [u64; 4]) -> [f64; 4] {
    let mut slopes = Vec::with_capacity(points.len() * points.len() / 2);
    for (i, (xi, yi)) in points.iter().enumerate() {
        let later = points[i + 1..].iter().filter(|(x, _)| x > xi);
        slopes.extend(later.map(|(x, y)| (y - yi) / (x - xi)));
    }
    ranks.map(|rank| {
        *slopes
            .select_nth_unstable_by(rank as usize, f64::total_cmp)
            .1
    })
}

/// Bisection between doubles, until two neighbours are left or rounding hides the order.
fn by_bisection(points: &[(f64, f64)], ranks: [u64; 4]) -> [f64; 4] {
    let mut heights = vec![0.0; points.len()];
    let mut room = heights.clone();
    let mut below = |slope: f64| {
        // Points of one x stand in the order of y, so they are no inversion at any slope.
        for (h, (x, y)) in heights.iter_mut().zip(points) {
            *h = y - slope * x;
        }
        inversions(&mut heights, &mut room)
    };
    // Beyond it, slope times x overflows; a slope up there is a difference of rounding errors.
    let widest = points.iter().fold(1e-300_f64, |m, p| m.max(p.0.abs()));
    let steepest = (1e300 / widest).min(f64::MAX / 4.0);
    ranks.map(|rank| {
        let (mut low, mut high) = (ordered(-steepest), ordered(steepest));
        // The largest slope with at most `rank` slopes below it.
        while high - low > 1 {
            let middle = low + (high - low) / 2;
            if below(from_ordered(middle)) <= rank {
                low = middle;
            } else {
                high = middle;
            }
        }
        from_ordered(low)
    })
}

/// Doubles as integers in the same order.
fn ordered(v: f64) -> i128 {
    let bits = v.to_bits() as i64;
    i128::from(if bits < 0 { i64::MIN - bits } else { bits })
}

fn from_ordered(v: i128) -> f64 {
    let v = v as i64;
    f64::from_bits((if v < 0 { i64::MIN - v } else { v }) as u64)
}

/// How many pairs stand in falling order; sorts the values on the way.
fn inversions(values: &mut [f64], room: &mut [f64]) -> u64 {
    let n = values.len();
    if n <= 1 {
        return 0;
    }
    if n <= 16 {
        let mut count = 0;
        for i in 1..n {
            let mut j = i;
            while j > 0 && values[j - 1] > values[j] {
                values.swap(j - 1, j);
                j -= 1;
                count += 1;
            }
        }
        return count;
    }
    let (left, right) = values.split_at_mut(n / 2);
    let mut count = inversions(left, room) + inversions(right, room);
    let (mut i, mut j) = (0, 0);
    for slot in &mut room[..n] {
        if j == right.len() || (i < left.len() && left[i] <= right[j]) {
            *slot = left[i];
            i += 1;
        } else {
            *slot = right[j];
            j += 1;
            count += (left.len() - i) as u64;
        }
    }
    values.copy_from_slice(&room[..n]);
    count
}

/// The middle value, or the mean of the middle two.
pub(super) fn median(values: &mut [f64]) -> f64 {
    let n = values.len();
    let (below, upper, _) = values.select_nth_unstable_by(n / 2, f64::total_cmp);
    if n % 2 == 1 {
        return *upper;
    }
    let lower = below.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    0.5 * lower + 0.5 * *upper
}
