//! Recursive least squares.

use luztar::regression as core;
use numpy::{PyArray1, PyReadwriteArray1};
use pyo3::prelude::*;

use super::State;
use crate::door;
use crate::error::CoreError;

/// Recursive least squares in square-root form.
#[pyclass(module = "luztar._core", subclass)]
pub struct Recursive(core::Recursive);

#[pymethods]
impl Recursive {
    #[new]
    #[pyo3(signature = (start=vec![0.0], *, start_error=1e6, forgetting=1.0))]
    fn new(start: Vec<f64>, start_error: f64, forgetting: f64) -> Result<Self, CoreError> {
        Ok(Self(core::Recursive::new(&start, start_error, forgetting)?))
    }

    fn push_rows(
        &mut self,
        py: Python<'_>,
        x: &Bound<'_, PyAny>,
        y: &Bound<'_, PyAny>,
        errors: Option<PyReadwriteArray1<'_, f64>>,
    ) -> PyResult<()> {
        let mut errors = errors;
        let (xs, ys) = (
            door::rows("x", x, Some(self.0.size()))?,
            door::vector("y", y)?,
        );
        let (x, y) = (xs.as_slice()?, ys.as_slice()?);
        let errors = errors.as_mut().map(|e| e.as_slice_mut()).transpose()?;
        Ok(door::run(py, x.len(), || self.0.push(x, y, errors)).map_err(CoreError)?)
    }

    /// The coefficients now.
    #[getter]
    fn coefficients<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        PyArray1::from_vec(py, self.0.coefficients())
    }

    /// How many coefficients.
    #[getter]
    fn size(&self) -> usize {
        self.0.size()
    }

    /// How many rows were pushed.
    #[getter]
    fn count(&self) -> u64 {
        self.0.count()
    }

    /// All there is to store: whole numbers, then floats.
    fn state(&self) -> State {
        self.0.state()
    }

    /// Go on from a stored state.
    fn restore(&mut self, integers: Vec<u64>, numbers: Vec<f64>) -> Result<(), CoreError> {
        self.0 = core::Recursive::from_state(&integers, &numbers)?;
        Ok(())
    }
}
