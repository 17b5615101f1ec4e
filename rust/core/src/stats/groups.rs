//! Moments of several groups of one record: by direction of motion, by stroke, by window.

use std::collections::BTreeMap;

use super::moments::{Moments, Settings};
use crate::error::Error;

/// The moments of the samples of every label, in the order of the labels; extremes carry the index in the record.
///
/// # Errors
/// [`Error::Length`] for labels of another number, and what [`Moments::push`] refuses.
pub fn by_label(
    x: &[f64],
    labels: &[i64],
    settings: Settings,
) -> Result<BTreeMap<i64, Moments>, Error> {
    if labels.len() != x.len() {
        return Err(Error::Length {
            name: "labels",
            expected: format!("{}, as many as x,", x.len()),
            got: labels.len(),
        });
    }
    let mut groups: BTreeMap<i64, Moments> = BTreeMap::new();
    let mut start = 0;
    // Stretches of one label: motion reverses seldom.
    for stretch in labels.chunk_by(|a, b| a == b) {
        let end = start + stretch.len();
        let group = groups
            .entry(stretch[0])
            .or_insert_with(|| Moments::new(settings));
        group.go_to(start as u64);
        group.push(&x[start..end]).map_err(|e| e.moved(start))?;
        start = end;
    }
    Ok(groups)
}

/// The moments of every window `[start, end)`; extremes carry the index in the record.
///
/// # Errors
/// [`Error::OutOfRange`] for a window that is not part of the record, and what [`Moments::push`] refuses.
pub fn by_window(
    x: &[f64],
    windows: &[(usize, usize)],
    settings: Settings,
) -> Result<Vec<Moments>, Error> {
    let of_window = |&(start, end): &(usize, usize)| {
        let part = x.get(start..end).ok_or_else(|| Error::OutOfRange {
            name: "windows",
            value: start.max(end) as f64,
            interval: format!("[0, {}], start before end", x.len()),
        })?;
        let mut moments = Moments::new(settings);
        moments.go_to(start as u64);
        moments.push(part).map_err(|e| e.moved(start))?;
        Ok(moments)
    };
    windows.iter().map(of_window).collect()
}
