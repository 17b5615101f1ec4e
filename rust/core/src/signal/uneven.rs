//! A record with uneven time, read at even times.

use crate::error::{Error, require_finite, require_positive, require_same_length};

/// How the signal runs between two samples.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Between {
    /// A straight line: never beyond the samples.
    Linear,
    /// The cubic with the slopes of the parabolas through three neighbours: third order where time is smooth.
    Cubic,
}

/// An even record and where it has no data.
#[derive(Debug, Clone, PartialEq)]
pub struct Even {
    /// The values; not a number inside the gaps.
    pub x: Vec<f64>,
    /// The first and last time of each stretch without samples that is longer than allowed.
    pub gaps: Vec<(f64, f64)>,
}

/// Reads `x`, sampled at the increasing times `time`, at `time[0] + i / sample_rate_hz` up to the last time.
///
/// # Errors
/// [`Error`] naming the argument: lengths that differ, nothing, not finite, time that does not increase, more than 2^31
/// samples.
pub fn even(
    time: &[f64],
    x: &[f64],
    sample_rate_hz: f64,
    max_gap_s: f64,
    between: Between,
) -> Result<Even, Error> {
    require_same_length("x", x, "time", time.len())?;
    require_finite("time", time)?;
    require_finite("x", x)?;
    require_positive("sample_rate_hz", sample_rate_hz)?;
    if max_gap_s.is_nan() || max_gap_s <= 0.0 {
        return Err(Error::OutOfRange {
            name: "max_gap_s",
            value: max_gap_s,
            interval: "(0, inf]".into(),
        });
    }
    let (Some(first), Some(last)) = (time.first(), time.last()) else {
        return Err(Error::Length {
            name: "time",
            expected: "at least 1".into(),
            got: 0,
        });
    };
    if let Some(index) = time.windows(2).position(|pair| pair[0] >= pair[1]) {
        return Err(Error::OutOfRange {
            name: "time",
            value: time[index + 1],
            interval: format!(
                "({}, inf): time stands still or runs back at index {}",
                time[index],
                index + 1
            ),
        });
    }
    // A sample that rounding puts just beyond the last time is still meant.
    let count = ((last - first) * sample_rate_hz * (1.0 + f64::EPSILON)).floor() + 1.0;
    if count > 2_f64.powi(31) {
        return Err(Error::OutOfRange {
            name: "sample_rate_hz",
            value: sample_rate_hz,
            interval: format!("a rate that gives at most 2^31 samples (this one gives {count:e})"),
        });
    }
    let pairs = || time.windows(2).map(|pair| (pair[0], pair[1]));
    let gaps = pairs().filter(|(a, b)| b - a > max_gap_s).collect();
    let slope = slopes(time, x);
    let mut i = 0;
    let values = (0..count as usize).map(|k| {
        let t = (first + k as f64 / sample_rate_hz).min(*last);
        while i + 2 < time.len() && time[i + 1] <= t {
            i += 1;
        }
        let Some((next_t, next_x)) = time.get(i + 1).zip(x.get(i + 1)) else {
            return x[i];
        };
        let h = next_t - time[i];
        let u = (t - time[i]) / h;
        if u == 0.0 || u >= 1.0 {
            return if u == 0.0 { x[i] } else { *next_x };
        }
        if h > max_gap_s {
            return f64::NAN;
        }
        let rise = next_x - x[i];
        match between {
            Between::Linear => x[i] + u * rise,
            Between::Cubic => {
                let (a, b) = (slope[i] * h - rise, rise - slope[i + 1] * h);
                x[i] + u * rise + u * (1.0 - u) * ((1.0 - u) * a + u * b)
            }
        }
    });
    Ok(Even {
        x: values.collect(),
        gaps,
    })
}

/// The slope of the parabola through each sample and its neighbours; of the chord where there are only two.
fn slopes(time: &[f64], x: &[f64]) -> Vec<f64> {
    let n = x.len();
    let chord = |i: usize| (x[i + 1] - x[i]) / (time[i + 1] - time[i]);
    match n {
        0 | 1 => vec![0.0; n],
        2 => vec![chord(0); 2],
        _ => (0..n)
            .map(|i| {
                let m = i.clamp(1, n - 2);
                let (before, after) = (chord(m - 1), chord(m));
                let (h, k) = (time[m] - time[m - 1], time[m + 1] - time[m]);
                let curvature = (after - before) / (h + k);
                let middle = before + curvature * h;
                middle + 2.0 * curvature * (time[i] - time[m])
            })
            .collect(),
    }
}
