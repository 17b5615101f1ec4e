//! Moments as numbers that can be stored, and back.

use super::compensated::Compensated;
use super::moments::{Done, Extreme, Moments, Settings};
use super::spread::{BLOCK, Spread};
use crate::error::{Error, require_finite};

impl Moments {
    /// Counts and indices, then numbers: all there is to store. The waiting samples come last.
    #[must_use]
    pub fn state(&self) -> (Vec<u64>, Vec<f64>) {
        let Done {
            spread,
            seen,
            nan,
            clipped,
            min,
            max,
        } = self.done;
        let index = |e: Option<Extreme>| e.map_or(0, |e| e.index);
        let value = |e: Option<Extreme>| e.map_or(0.0, |e| e.value);
        let Settings {
            shape,
            skip_nan,
            clipped_at,
        } = self.settings;
        let flags = u64::from(shape) + 2 * u64::from(skip_nan);
        let integers = vec![
            flags,
            spread.count,
            seen,
            nan,
            clipped,
            index(min),
            index(max),
        ];
        let mut numbers = vec![clipped_at.0, clipped_at.1, value(min), value(max)];
        for part in [spread.mean, spread.squares, spread.cubes, spread.fourths] {
            numbers.extend([part.value, part.rest]);
        }
        numbers.extend(&self.waiting[..self.filled]);
        (integers, numbers)
    }

    /// Rebuilds what [`Self::state`] stored.
    ///
    /// # Errors
    /// [`Error::Length`], [`Error::NonFinite`] or [`Error::OutOfRange`] for numbers it cannot have made.
    pub fn from_state(integers: &[u64], numbers: &[f64]) -> Result<Self, Error> {
        let short = |got| Error::Length {
            name: "state",
            expected: format!("7 integers and 12 to {} numbers", 11 + BLOCK),
            got,
        };
        let &[flags, count, seen, nan, clipped, min_at, max_at] = integers else {
            return Err(short(integers.len()));
        };
        let Some((
            &[
                low,
                high,
                min,
                max,
                mean,
                mean_rest,
                sq,
                sq_rest,
                cu,
                cu_rest,
                fo,
                fo_rest,
            ],
            waiting,
        )) = numbers.split_first_chunk::<12>()
        else {
            return Err(short(numbers.len()));
        };
        if waiting.len() >= BLOCK {
            return Err(short(numbers.len()));
        }
        require_finite("state", &numbers[2..])?;
        let settings = Settings {
            shape: flags & 1 == 1,
            skip_nan: flags & 2 == 2,
            clipped_at: (low, high),
        };
        let kept = count.saturating_add(waiting.len() as u64);
        if kept.saturating_add(nan) > seen
            || clipped > kept
            || (kept > 0 && min_at.max(max_at) >= seen)
        {
            return Err(Error::OutOfRange {
                name: "state",
                value: min_at.max(max_at) as f64,
                interval: format!("[0, {seen})"),
            });
        }
        let part = |value, rest| Compensated { value, rest };
        let extreme = |value, index| (kept > 0).then_some(Extreme { value, index });
        let mut moments = Self::new(settings);
        moments.done = Done {
            spread: Spread {
                count,
                mean: part(mean, mean_rest),
                squares: part(sq, sq_rest),
                cubes: part(cu, cu_rest),
                fourths: part(fo, fo_rest),
            },
            seen,
            nan,
            clipped,
            min: extreme(min, min_at),
            max: extreme(max, max_at),
        };
        moments.waiting[..waiting.len()].copy_from_slice(waiting);
        moments.filled = waiting.len();
        Ok(moments)
    }
}
