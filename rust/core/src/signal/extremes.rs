//! Fewer points for a picture, without losing a peak.

use crate::Error;

/// The places of the least and the greatest value, and of the first that is not a number, of each of `count` stretches
/// of about equal length; increasing, each once.
///
/// # Errors
/// [`Error::OutOfRange`] without a stretch.
pub fn extremes(x: &[f64], count: usize) -> Result<Vec<usize>, Error> {
    if count == 0 {
        return Err(Error::OutOfRange {
            name: "count",
            value: 0.0,
            interval: "[1, inf)".into(),
        });
    }
    let count = count.min(x.len());
    let mut places = Vec::with_capacity(2 * count);
    // 128 bits: a count of stretches times a length does not overflow
    let edge = |i: usize| (i as u128 * x.len() as u128 / count as u128) as usize;
    for i in 0..count {
        let start = edge(i);
        let part = &x[start..edge(i + 1)];
        let (least, greatest) = part
            .iter()
            .fold((f64::INFINITY, f64::NEG_INFINITY), |(l, g), v| {
                (l.min(*v), g.max(*v))
            });
        // Two sweeps: the values without an index are found many at a time.
        let place = |wanted: f64| part.iter().position(|v| *v == wanted);
        let gap = part.iter().position(|v| v.is_nan());
        let mut found = [place(least), place(greatest), gap];
        found.sort_unstable();
        let mut last = None;
        for p in found.into_iter().flatten() {
            if last != Some(p) {
                places.push(start + p);
                last = Some(p);
            }
        }
    }
    Ok(places)
}

#[cfg(test)]
mod tests {
    use super::extremes;

    #[test]
    fn peaks_and_gaps_stay() {
        let x = [0.0, 5.0, 1.0, f64::NAN, -2.0, 3.0, 3.0, 3.0];
        assert_eq!(extremes(&x, 2).expect("stretches"), [0, 1, 3, 4, 5]);
    }
}
