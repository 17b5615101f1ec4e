//! Quantiles: within a relative error, and exact ones of whole numbers.

use luztar::stats as core;
use numpy::PyArray1;
use pyo3::prelude::*;
use pyo3::types::PyFloat;

use super::State;
use crate::door;
use crate::error::CoreError;

/// Quantiles within a relative error.
#[pyclass(module = "luztar._core", subclass)]
pub struct QuantileSketch(core::QuantileSketch);

#[pymethods]
impl QuantileSketch {
    #[new]
    #[pyo3(signature = (relative_error=0.01))]
    fn new(relative_error: f64) -> Result<Self, CoreError> {
        Ok(Self(core::QuantileSketch::new(relative_error)?))
    }

    /// Add samples: a float, or array_like of shape (n,), n >= 0, finite.
    fn push(&mut self, py: Python<'_>, chunk: &Bound<'_, PyAny>) -> PyResult<()> {
        if let Ok(sample) = chunk.cast::<PyFloat>() {
            return Ok(self.0.push(&[sample.value()]).map_err(CoreError)?);
        }
        let x = door::vector("chunk", chunk)?;
        let x = x.as_slice()?;
        door::run(py, x.len(), || self.0.push(x)).map_err(|e| door::explained(e, "x", chunk))
    }

    /// Add what another sketch of the same accuracy has seen: exactly as if this one had seen it.
    fn merge(slf: &Bound<'_, Self>, other: &Bound<'_, Self>) -> PyResult<()> {
        let other = other.try_borrow()?.0.clone();
        Ok(slf.try_borrow_mut()?.0.merge(&other).map_err(CoreError)?)
    }

    /// The bound that holds: a power of two, at most what was asked for.
    #[getter]
    fn relative_error(&self) -> f64 {
        self.0.relative_error()
    }

    /// How many samples.
    #[getter]
    fn count(&self) -> u64 {
        self.0.count()
    }

    /// The smallest sample, exactly; None of nothing.
    #[getter]
    fn min(&self) -> Option<f64> {
        self.0.extremes().map(|e| e.0)
    }

    /// The largest sample, exactly; None of nothing.
    #[getter]
    fn max(&self) -> Option<f64> {
        self.0.extremes().map(|e| e.1)
    }

    /// Close to the sample of rank floor(q (n - 1)) from zero (NumPy's method "lower"), 0 <= q <= 1; None of nothing.
    fn quantile(&self, q: f64) -> Result<Option<f64>, CoreError> {
        Ok(self.0.quantile(q)?)
    }

    /// All there is to store: whole numbers, then floats.
    fn state(&self) -> State {
        self.0.state()
    }

    /// Go on from a stored state.
    fn restore(&mut self, integers: Vec<u64>, numbers: Vec<f64>) -> Result<(), CoreError> {
        self.0 = core::QuantileSketch::from_state(&integers, &numbers)?;
        Ok(())
    }
}

/// Every value of integer data counted.
#[pyclass(module = "luztar._core", subclass)]
pub struct Counts(core::Counts);

#[pymethods]
impl Counts {
    #[new]
    fn new() -> Self {
        Self(core::Counts::new())
    }

    /// Count samples: array_like of whole numbers of at most 32 bits, shape (n,), n >= 0.
    fn push(&mut self, py: Python<'_>, chunk: &Bound<'_, PyAny>) -> PyResult<()> {
        let pushed = if let Some(x) = door::as_it_lies::<i16>(chunk) {
            let x = x.as_slice()?;
            door::run(py, x.len(), || self.0.push(x))
        } else {
            let x = door::integers("chunk", chunk)?;
            let x = x.as_slice()?;
            door::run(py, x.len(), || self.0.push(x))
        };
        Ok(pushed.map_err(CoreError)?)
    }

    /// Add what another object has counted.
    fn merge(slf: &Bound<'_, Self>, other: &Bound<'_, Self>) -> PyResult<()> {
        let other = other.try_borrow()?.0.clone();
        Ok(slf.try_borrow_mut()?.0.merge(&other).map_err(CoreError)?)
    }

    /// How many samples.
    #[getter]
    fn count(&self) -> u64 {
        self.0.count()
    }

    /// The smallest value; None of nothing.
    #[getter]
    fn min(&self) -> Option<i32> {
        self.0.extremes().map(|e| e.0)
    }

    /// The largest value; None of nothing.
    #[getter]
    fn max(&self) -> Option<i32> {
        self.0.extremes().map(|e| e.1)
    }

    /// The mean, from an exact sum; None of nothing.
    #[getter]
    fn mean(&self) -> Option<f64> {
        self.0.mean_and_std().map(|m| m.0)
    }

    /// The standard deviation with n, from exact sums; None of nothing.
    #[getter]
    fn std_population(&self) -> Option<f64> {
        self.0.mean_and_std().map(|m| m.1)
    }

    fn neighbours(&self, q: f64) -> Result<Option<(i32, i32, f64)>, CoreError> {
        Ok(self.0.quantile(q)?)
    }

    /// The values that occurred, in order, and how often.
    fn values<'py>(
        &self,
        py: Python<'py>,
    ) -> (Bound<'py, PyArray1<i32>>, Bound<'py, PyArray1<u64>>) {
        let (values, times): (Vec<i32>, Vec<u64>) = self.0.values().unzip();
        (
            PyArray1::from_vec(py, values),
            PyArray1::from_vec(py, times),
        )
    }

    /// All there is to store: whole numbers, then floats.
    fn state(&self) -> State {
        self.0.state()
    }

    /// Go on from a stored state.
    fn restore(&mut self, integers: Vec<u64>, numbers: Vec<f64>) -> Result<(), CoreError> {
        self.0 = core::Counts::from_state(&integers, &numbers)?;
        Ok(())
    }
}
