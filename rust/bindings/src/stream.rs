//! Filters on a stream: one channel, a bank of them, zero phase at a fixed lag.

use luztar::signal::{self as core, Scale};
use numpy::{
    PyArray1, PyArrayMethods, PyReadonlyArray1, PyReadwriteArray1, PyReadwriteArray2,
    PyUntypedArrayMethods,
};
use pyo3::prelude::*;

use crate::error::CoreError;
use crate::signal::{Butterworth, WORTH_DETACHING, plain, plain_vector};

/// A causal filter with its memory.
#[pyclass(module = "luztar._core")]
#[derive(Clone)]
pub struct Filter(core::Filter);

#[pymethods]
impl Filter {
    #[new]
    fn new(design: &Butterworth, derivative: bool) -> Result<Self, CoreError> {
        Ok(Self(if derivative {
            core::Filter::derivative(design.design, design.set)?
        } else {
            core::Filter::on(design.design, design.set)
        }))
    }

    /// The next outputs, or None for anything but a contiguous vector of doubles.
    fn push<'py>(
        &mut self,
        py: Python<'py>,
        x: &Bound<'py, PyAny>,
    ) -> PyResult<Option<Bound<'py, PyArray1<f64>>>> {
        let Some(x) = plain_vector(x) else {
            return Ok(None);
        };
        let x = x.readonly();
        let out = PyArray1::zeros(py, x.len(), false);
        self.push_into(py, x, out.readwrite())?;
        Ok(Some(out))
    }

    fn push_into(
        &mut self,
        py: Python<'_>,
        x: PyReadonlyArray1<'_, f64>,
        mut out: PyReadwriteArray1<'_, f64>,
    ) -> PyResult<()> {
        let (x, out) = (x.as_slice()?, out.as_slice_mut()?);
        if x.len() < WORTH_DETACHING {
            return Ok(self.0.push_into(x, out).map_err(CoreError)?);
        }
        Ok(py.detach(|| self.0.push_into(x, out)).map_err(CoreError)?)
    }

    /// Whether `x` and `out` were contiguous vectors of doubles apart from each other, and were filtered.
    fn push_plain(
        &mut self,
        py: Python<'_>,
        x: &Bound<'_, PyAny>,
        out: &Bound<'_, PyAny>,
    ) -> PyResult<bool> {
        let Some((x, out)) = plain(x, out) else {
            return Ok(false);
        };
        self.push_into(py, x, out)?;
        Ok(true)
    }

    fn push_in_place(&mut self, py: Python<'_>, mut x: PyReadwriteArray1<'_, f64>) -> PyResult<()> {
        let x = x.as_slice_mut()?;
        Ok(py.detach(|| self.0.push_in_place(x)).map_err(CoreError)?)
    }

    /// Filters 16- or 32-bit counts, `factor x + offset` in their unit.
    fn push_counts(
        &mut self,
        py: Python<'_>,
        x: &Bound<'_, PyAny>,
        scale: (f64, f64),
        mut out: PyReadwriteArray1<'_, f64>,
    ) -> PyResult<()> {
        let (factor, offset) = scale;
        let scale = Scale { factor, offset };
        let (out, filter) = (out.as_slice_mut()?, &mut self.0);
        let done = if let Ok(x) = x.cast::<PyArray1<i16>>() {
            let x = x.readonly();
            let x = x.as_slice()?;
            py.detach(|| filter.push_samples(x, scale, out))
        } else {
            let x = x.cast::<PyArray1<i32>>()?.readonly();
            let x = x.as_slice()?;
            py.detach(|| filter.push_samples(x, scale, out))
        };
        Ok(done.map_err(CoreError)?)
    }

    fn push_single(
        &mut self,
        py: Python<'_>,
        x: PyReadonlyArray1<'_, f32>,
        mut out: PyReadwriteArray1<'_, f32>,
    ) -> PyResult<()> {
        let (x, out) = (x.as_slice()?, out.as_slice_mut()?);
        Ok(py
            .detach(|| self.0.push_single(x, out))
            .map_err(CoreError)?)
    }

    fn reset(&mut self, level: Option<f64>) -> Result<(), CoreError> {
        Ok(self.0.reset(level)?)
    }

    fn copy(&self) -> Self {
        self.clone()
    }

    fn state(&self) -> Vec<f64> {
        self.0.state().to_vec()
    }

    fn restore(&mut self, state: Vec<f64>) -> Result<(), CoreError> {
        Ok(self.0.restore(&state)?)
    }
}

/// Equal causal filters, one per channel.
#[pyclass(module = "luztar._core")]
#[derive(Clone)]
pub struct Bank(core::Bank);

#[pymethods]
impl Bank {
    #[new]
    fn new(design: &Butterworth, channels: usize) -> Result<Self, CoreError> {
        Ok(Self(core::Bank::new(design.design, channels, design.set)?))
    }

    fn push_in_place(
        &mut self,
        py: Python<'_>,
        mut frames: PyReadwriteArray2<'_, f64>,
    ) -> PyResult<()> {
        let frames = frames.as_slice_mut()?;
        Ok(py
            .detach(|| self.0.push_in_place(frames))
            .map_err(CoreError)?)
    }

    fn reset(&mut self, levels: Option<Vec<f64>>) -> Result<(), CoreError> {
        Ok(self.0.reset(levels.as_deref())?)
    }

    fn copy(&self) -> Self {
        self.clone()
    }

    fn state(&self) -> Vec<f64> {
        self.0.state()
    }

    fn restore(&mut self, state: Vec<f64>) -> Result<(), CoreError> {
        Ok(self.0.restore(&state)?)
    }
}

/// Zero phase on a stream, late by a fixed number of samples.
#[pyclass(module = "luztar._core")]
#[derive(Clone)]
pub struct FixedLag(core::FixedLag);

#[pymethods]
impl FixedLag {
    #[new]
    fn new(design: &Butterworth, delay: usize) -> Result<Self, CoreError> {
        let filter = core::FixedLag::new(&design.design, delay, design.set)?;
        Ok(Self(filter))
    }

    #[getter]
    fn error_bound(&self) -> f64 {
        self.0.error_bound()
    }

    fn push_into(
        &mut self,
        py: Python<'_>,
        x: PyReadonlyArray1<'_, f64>,
        mut out: PyReadwriteArray1<'_, f64>,
    ) -> PyResult<()> {
        let (x, out) = (x.as_slice()?, out.as_slice_mut()?);
        Ok(py.detach(|| self.0.push_into(x, out)).map_err(CoreError)?)
    }

    fn reset(&mut self, level: Option<f64>) -> Result<(), CoreError> {
        Ok(self.0.reset(level)?)
    }

    fn copy(&self) -> Self {
        self.clone()
    }
}
