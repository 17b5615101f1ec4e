//! Statistics of the last samples.

use luztar::stats as core;
use numpy::{PyReadonlyArray1, PyReadwriteArray2};
use pyo3::prelude::*;
use pyo3::types::PyFloat;

use super::State;
use crate::door;
use crate::error::CoreError;

/// Statistics of the last samples.
#[pyclass(module = "luztar._core", subclass)]
pub struct Rolling(core::Rolling);

#[pymethods]
impl Rolling {
    #[new]
    #[pyo3(signature = (window=1))]
    fn new(window: usize) -> Result<Self, CoreError> {
        Ok(Self(core::Rolling::new(window)?))
    }

    /// Add samples: a float, or array_like of shape (n,), n >= 0, finite, of magnitude up to 1e150.
    fn push(&mut self, py: Python<'_>, chunk: &Bound<'_, PyAny>) -> PyResult<()> {
        if let Ok(sample) = chunk.cast::<PyFloat>() {
            return Ok(self.0.push(&[sample.value()]).map_err(CoreError)?);
        }
        let x = door::vector("chunk", chunk)?;
        let x = x.as_slice()?;
        door::run(py, x.len(), || self.0.push(x)).map_err(|e| door::explained(e, "x", chunk))
    }

    /// Add samples and write mean, population deviation, minimum and maximum after each into `out`, shape (n, 4).
    fn push_into(
        &mut self,
        py: Python<'_>,
        chunk: &Bound<'_, PyAny>,
        mut out: PyReadwriteArray2<'_, f64>,
    ) -> PyResult<()> {
        let x = door::vector("chunk", chunk)?;
        let (x, out) = (x.as_slice()?, out.as_slice_mut()?);
        door::run(py, x.len(), || self.0.push_into(x, out))
            .map_err(|e| door::explained(e, "x", chunk))
    }

    /// The window's length in samples.
    #[getter]
    fn window(&self) -> usize {
        self.0.window()
    }

    /// How many samples the window holds now.
    #[getter]
    fn count(&self) -> u64 {
        self.0.figures().map_or(0, |f| f.count)
    }

    /// The mean of the window; None of nothing.
    #[getter]
    fn mean(&self) -> Option<f64> {
        self.0.figures().map(|f| f.mean)
    }

    /// The standard deviation of the window with n; None of nothing.
    #[getter]
    fn std_population(&self) -> Option<f64> {
        self.0.figures().map(|f| f.std_population)
    }

    /// The smallest sample of the window; None of nothing.
    #[getter]
    fn min(&self) -> Option<f64> {
        self.0.figures().map(|f| f.min)
    }

    /// The largest sample of the window; None of nothing.
    #[getter]
    fn max(&self) -> Option<f64> {
        self.0.figures().map(|f| f.max)
    }

    /// All there is to store: whole numbers, then floats.
    fn state(&self) -> State {
        self.0.state()
    }

    /// Go on from a stored state.
    fn restore(&mut self, integers: Vec<u64>, numbers: Vec<f64>) -> Result<(), CoreError> {
        self.0 = core::Rolling::from_state(&integers, &numbers)?;
        Ok(())
    }
}

/// Writes the figures of every full window into `out`, shape (n - window + 1, 4).
#[pyfunction]
pub fn rolling(
    py: Python<'_>,
    x: PyReadonlyArray1<'_, f64>,
    window: usize,
    mut out: PyReadwriteArray2<'_, f64>,
) -> PyResult<()> {
    let (x, out) = (x.as_slice()?, out.as_slice_mut()?);
    Ok(py
        .detach(|| core::rolling::rolling(x, window, out))
        .map_err(CoreError)?)
}
