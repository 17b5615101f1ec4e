//! Core errors become Python exceptions here and nowhere else.

use pyo3::PyErr;
use pyo3::import_exception;

import_exception!(luztar.errors, ParameterError);

/// Lets `?` turn a core error into the Python exception that names the same argument.
pub struct CoreError(pub luztar::Error);

impl From<luztar::Error> for CoreError {
    fn from(error: luztar::Error) -> Self {
        Self(error)
    }
}

impl From<CoreError> for PyErr {
    fn from(error: CoreError) -> Self {
        ParameterError::new_err(parts(error.0))
    }
}

/// A number in at most as many digits as it has: 1e308, not 309 of them.
fn shown(value: f64) -> String {
    if value != 0.0 && value.is_finite() && !(1e-4..1e16).contains(&value.abs()) {
        format!("{value:e}")
    } else {
        format!("{value}")
    }
}

/// What is wrong, where, and what to do: the three parts every error of the Python side has.
fn parts(error: luztar::Error) -> (String, String, String) {
    use luztar::Error::{
        Length, Mechanism, NonFinite, OutOfRange, Singular, TooMany, Unknown, Unlike,
        Unrepresentable,
    };
    match error {
        NonFinite { name, index, value } => (
            format!("{name} holds {value} at index {index}"),
            name.to_owned(),
            "Remove or split the record there; every value must be finite.".to_owned(),
        ),
        OutOfRange {
            name,
            value,
            interval,
        } => (
            format!("{name} is {}", shown(value)),
            name.to_owned(),
            format!("Give a value in {interval}."),
        ),
        Length {
            name,
            expected,
            got,
        } => (
            format!("{name} has {got} values but {expected} are needed"),
            name.to_owned(),
            "Give arrays of the length needed.".to_owned(),
        ),
        Unknown { what, name, known } => (
            format!("unknown {what} '{name}'"),
            what.to_owned(),
            format!("Known are: {known}."),
        ),
        Mechanism {
            place,
            problem,
            remedy,
        } => (problem, place, remedy),
        Unlike { what } => (
            format!("{what} cannot be merged"),
            "merge".to_owned(),
            "Make both with the same settings.".to_owned(),
        ),
        TooMany { what, most, time_s } => (
            format!("more than {most} {what} until {time_s} s"),
            what.to_owned(),
            format!("Allow for more {what}, or shorten the run."),
        ),
        Unrepresentable { name } => (
            format!("{name} is too large or too small to be a number"),
            name.to_owned(),
            "Choose other units for the data.".to_owned(),
        ),
        Singular { name, reason } => (
            format!("{name} cannot be determined: {reason}"),
            name.to_owned(),
            "Give data that vary in what is to be told apart.".to_owned(),
        ),
    }
}
