//! Arrays come in here: an aligned, contiguous float64 vector as it is, anything else by way of `luztar._arrays`.

use numpy::{
    Element, PyArray1, PyArray2, PyArrayMethods, PyReadonlyArray1, PyReadonlyArray2,
    PyUntypedArray, PyUntypedArrayMethods,
};
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::error::CoreError;

/// Work on fewer samples is done with the interpreter lock held: releasing it would cost more than the work.
pub const LONG: usize = 8192;

/// Runs work on this many samples, without the interpreter lock if they are many.
pub fn run<R: Send>(py: Python<'_>, samples: usize, work: impl FnOnce() -> R + Send) -> R {
    if samples < LONG {
        work()
    } else {
        py.detach(work)
    }
}

/// The array itself if it is contiguous, aligned and of this type.
pub fn as_it_lies<'py, T: Element>(value: &Bound<'py, PyAny>) -> Option<PyReadonlyArray1<'py, T>> {
    // A subclass may mean more than its numbers: a masked array comes in by the Python door, which refuses it.
    if !value.is_exact_instance_of::<PyUntypedArray>() {
        return None;
    }
    let array = value.cast::<PyArray1<T>>().ok()?;
    let lies_well = array.data().is_aligned() && array.is_c_contiguous();
    if lies_well {
        array.try_readonly().ok()
    } else {
        None
    }
}

/// A float64 vector, converted if need be; NaN is for the core to refuse or to skip.
pub fn vector<'py>(name: &str, value: &Bound<'py, PyAny>) -> PyResult<PyReadonlyArray1<'py, f64>> {
    match as_it_lies(value) {
        Some(array) => Ok(array),
        None => Ok(by_the_python_door(name, value, false)?.extract()?),
    }
}

/// A vector of whole numbers of at most 32 bits.
pub fn integers<'py>(
    name: &str,
    value: &Bound<'py, PyAny>,
) -> PyResult<PyReadonlyArray1<'py, i32>> {
    if let Some(array) = as_it_lies(value) {
        return Ok(array);
    }
    let door = value.py().import("luztar._arrays")?.getattr("integers")?;
    door.call1((name, value))?.extract()
}

/// Rows of float64 numbers, converted by `luztar._arrays` if need be.
pub fn rows<'py>(
    name: &str,
    value: &Bound<'py, PyAny>,
    columns: Option<usize>,
) -> PyResult<PyReadonlyArray2<'py, f64>> {
    if value.is_exact_instance_of::<PyUntypedArray>()
        && let Ok(array) = value.cast::<PyArray2<f64>>()
    {
        let fits = columns.is_none_or(|columns| array.shape()[1] == columns);
        if fits && array.data().is_aligned() && array.is_c_contiguous() {
            return Ok(array.try_readonly()?);
        }
    }
    let door = value.py().import("luztar._arrays")?.getattr("rows")?;
    door.call1((name, value, columns))?.extract()
}

/// The core's error, or, for NaN and infinities, the same with all their positions.
pub fn explained(error: luztar::Error, name: &str, value: &Bound<'_, PyAny>) -> PyErr {
    if matches!(error, luztar::Error::NonFinite { .. })
        && let Err(positions) = by_the_python_door(name, value, true)
    {
        return positions;
    }
    CoreError(error).into()
}

/// The same where either of several arrays may be the culprit.
pub fn explained_of(error: luztar::Error, arrays: &[(&str, &Bound<'_, PyAny>)]) -> PyErr {
    let luztar::Error::NonFinite { name: culprit, .. } = &error else {
        return CoreError(error).into();
    };
    match arrays.iter().find(|(name, _)| name == culprit) {
        Some((name, value)) => explained(error, name, value),
        None => CoreError(error).into(),
    }
}

fn by_the_python_door<'py>(
    name: &str,
    value: &Bound<'py, PyAny>,
    finite: bool,
) -> PyResult<Bound<'py, PyAny>> {
    let py = value.py();
    let options = PyDict::new(py);
    options.set_item("minimum", 0)?;
    options.set_item("finite", finite)?;
    py.import("luztar._arrays")?
        .getattr("vector")?
        .call((name, value), Some(&options))
}
