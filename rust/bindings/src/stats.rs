//! Statistics of streams.

use luztar::stats::{self as core, moments::STATE_LEN};
use numpy::PyReadonlyArray1;
use pyo3::prelude::*;

use crate::error::CoreError;

/// Mergeable moments.
#[pyclass(module = "luztar._core", from_py_object)]
#[derive(Clone, Default)]
pub struct Moments(core::Moments);

#[pymethods]
impl Moments {
    #[new]
    fn new() -> Self {
        Self::default()
    }

    fn push(&mut self, py: Python<'_>, x: PyReadonlyArray1<'_, f64>) -> PyResult<()> {
        let x = x.as_slice()?;
        Ok(py.detach(|| self.0.push(x)).map_err(CoreError)?)
    }

    fn merge(&mut self, later: Moments) {
        self.0.merge(&later.0);
    }

    fn copy(&self) -> Self {
        self.clone()
    }

    #[getter]
    fn count(&self) -> u64 {
        self.0.count()
    }

    #[getter]
    fn mean(&self) -> Option<f64> {
        self.0.mean()
    }

    #[getter]
    fn variance_population(&self) -> Option<f64> {
        self.0.variance_population()
    }

    #[getter]
    fn variance_sample(&self) -> Option<f64> {
        self.0.variance_sample()
    }

    #[getter]
    fn std_population(&self) -> Option<f64> {
        self.0.std_population()
    }

    #[getter]
    fn std_sample(&self) -> Option<f64> {
        self.0.std_sample()
    }

    #[getter]
    fn rms(&self) -> Option<f64> {
        self.0.rms()
    }

    #[getter]
    fn min(&self) -> Option<(f64, u64)> {
        self.0.min().map(|e| (e.value, e.index))
    }

    #[getter]
    fn max(&self) -> Option<(f64, u64)> {
        self.0.max().map(|e| (e.value, e.index))
    }

    fn state(&self) -> (u64, [f64; STATE_LEN], u64, u64) {
        let index = |e: Option<core::moments::Extreme>| e.map_or(0, |e| e.index);
        (
            self.0.count(),
            self.0.state(),
            index(self.0.min()),
            index(self.0.max()),
        )
    }

    #[staticmethod]
    fn from_state(
        count: u64,
        state: [f64; STATE_LEN],
        min_index: u64,
        max_index: u64,
    ) -> Result<Self, CoreError> {
        Ok(Self(core::Moments::from_state(
            count, state, min_index, max_index,
        )?))
    }
}
