//! The one error type of the core: every variant names the argument, its value and what would be accepted.

use thiserror::Error;

/// What can be wrong with an input; the text is a sentence for the user.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum Error {
    /// A value that is NaN or infinite.
    #[error(
        "{name} holds {value} at index {index}; remove or split the record there, every value must be finite"
    )]
    NonFinite {
        /// The argument.
        name: &'static str,
        /// The position of the first such value.
        index: usize,
        /// The value found.
        value: f64,
    },
    /// A value outside the interval it must lie in.
    #[error("{name} is {value} but must lie in {interval}")]
    OutOfRange {
        /// The argument.
        name: &'static str,
        /// The value found.
        value: f64,
        /// The accepted interval, in mathematical notation.
        interval: String,
    },
    /// Two lengths that must agree, or a length that is too small.
    #[error("{name} has {got} values but {expected} are needed")]
    Length {
        /// The argument.
        name: &'static str,
        /// What was needed, in words.
        expected: String,
        /// The length found.
        got: usize,
    },
    /// A name that is not known.
    #[error("unknown {what} '{name}'; known are: {known}")]
    Unknown {
        /// What kind of thing was looked up.
        what: &'static str,
        /// The name that was asked for.
        name: String,
        /// The names that exist.
        known: String,
    },
    /// A mechanism that makes no sense, or a step that it does not allow.
    #[error("{place}: {problem}; {remedy}")]
    Mechanism {
        /// The body, the element or the instant.
        place: String,
        /// What is wrong with it.
        problem: String,
        /// What to do.
        remedy: String,
    },
    /// Two objects that cannot be merged.
    #[error("{what} cannot be merged; make both with the same settings")]
    Unlike {
        /// The two, in words.
        what: &'static str,
    },
    /// More of something than was allowed for.
    #[error("more than {most} {what} until {time_s} s; allow for more or shorten the run")]
    TooMany {
        /// What there is too much of.
        what: &'static str,
        /// How many were allowed.
        most: usize,
        /// When there were more.
        time_s: f64,
    },
    /// A result beyond the range of a double.
    #[error("{name} is too large or too small to be a number; choose other units for the data")]
    Unrepresentable {
        /// The result.
        name: &'static str,
    },
    /// Columns that cannot be told apart: the least-squares problem has no unique answer.
    #[error("{name} cannot be determined: {reason}")]
    Singular {
        /// The quantity.
        name: &'static str,
        /// Why it has no unique value.
        reason: String,
    },
}

impl Error {
    /// The same of a part that begins at this index of the whole.
    #[must_use]
    pub(crate) fn moved(self, by: usize) -> Self {
        match self {
            Self::NonFinite { name, index, value } => Self::NonFinite {
                name,
                index: index + by,
                value,
            },
            other => other,
        }
    }
}

/// Refuses NaN and infinities, naming the first position.
///
/// # Errors
/// [`Error::NonFinite`] with the index and value of the first offender.
pub fn require_finite(name: &'static str, values: &[f64]) -> Result<(), Error> {
    match values.iter().position(|v| !v.is_finite()) {
        None => Ok(()),
        Some(index) => Err(Error::NonFinite {
            name,
            index,
            value: values[index],
        }),
    }
}

/// Refuses a result that overflowed: extreme units, not extreme data.
///
/// # Errors
/// [`Error::Unrepresentable`].
pub(crate) fn require_representable(
    name: &'static str,
    mut values: impl Iterator<Item = f64>,
) -> Result<(), Error> {
    if values.all(f64::is_finite) {
        Ok(())
    } else {
        Err(Error::Unrepresentable { name })
    }
}

/// The largest magnitude a sample may have: its square and the sum of many squares still fit into a double.
pub const LARGEST: f64 = 1e150;

/// Refuses NaN, infinities and magnitudes above [`LARGEST`], whose squares or differences would overflow.
///
/// # Errors
/// [`Error::NonFinite`] or [`Error::OutOfRange`] with the first offender.
pub fn require_moderate(name: &'static str, values: &[f64]) -> Result<(), Error> {
    // Blocks without an early exit vectorise; the offender is looked for only if there is one.
    let moderate = |block: &[f64]| block.iter().fold(true, |ok, v| ok & (v.abs() <= LARGEST));
    if values.chunks(64).all(moderate) {
        return Ok(());
    }
    require_finite(name, values)?;
    let value = values.iter().copied().find(|v| v.abs() > LARGEST);
    Err(Error::OutOfRange {
        name,
        value: value.unwrap_or(f64::NAN),
        interval: format!("[-{LARGEST:e}, {LARGEST:e}]"),
    })
}

/// Refuses two lengths that differ.
///
/// # Errors
/// [`Error::Length`] naming the second argument.
pub fn require_same_length(
    name: &'static str,
    values: &[f64],
    of: &'static str,
    len: usize,
) -> Result<(), Error> {
    if values.len() == len {
        Ok(())
    } else {
        Err(Error::Length {
            name,
            expected: format!("{len}, as many as {of},"),
            got: values.len(),
        })
    }
}

/// Refuses a value that is not a positive finite number.
///
/// # Errors
/// [`Error::OutOfRange`].
pub fn require_positive(name: &'static str, value: f64) -> Result<(), Error> {
    if value.is_finite() && value > 0.0 {
        Ok(())
    } else {
        Err(Error::OutOfRange {
            name,
            value,
            interval: "(0, inf)".into(),
        })
    }
}
