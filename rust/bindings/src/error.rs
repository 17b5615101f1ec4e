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
        ParameterError::new_err(error.0.to_string())
    }
}
