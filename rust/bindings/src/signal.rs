//! Filters: the design, the stream and the zero-phase record.

use luztar::signal::{self as core, CutoffAt, Edges, Passes, ZeroPhase};
use numpy::{PyArray1, PyReadonlyArray1, PyReadonlyArray2, PyReadwriteArray1, PyReadwriteArray2};
use pyo3::prelude::*;

use crate::error::CoreError;

/// A low-pass design.
#[pyclass(frozen, module = "luztar._core")]
#[derive(Clone)]
pub struct LowPass(core::LowPass);

#[pymethods]
impl LowPass {
    #[new]
    fn new(
        poles: usize,
        cutoff_hz: f64,
        sample_rate_hz: f64,
        forward_backward: bool,
        overall: bool,
    ) -> Result<Self, CoreError> {
        let passes = if forward_backward {
            Passes::ForwardBackward
        } else {
            Passes::Forward
        };
        let cutoff_at = if overall {
            CutoffAt::Overall
        } else {
            CutoffAt::PerPass
        };
        Ok(Self(core::LowPass::new(
            poles,
            cutoff_hz,
            sample_rate_hz,
            passes,
            cutoff_at,
        )?))
    }

    fn describe(&self) -> String {
        self.0.describe()
    }

    fn magnitude(&self, frequency_hz: f64) -> Result<f64, CoreError> {
        Ok(self.0.magnitude(frequency_hz)?)
    }

    fn settle_samples(&self, tolerance: f64) -> Result<usize, CoreError> {
        Ok(self.0.settle_samples(tolerance)?)
    }

    #[getter]
    fn designed_at_hz(&self) -> f64 {
        self.0.designed_at_hz()
    }

    #[getter]
    fn delay_s(&self) -> f64 {
        self.0.delay_s()
    }

    #[getter]
    fn settle_s(&self) -> f64 {
        self.0.settle_s()
    }
}

/// A causal filter with its memory.
#[pyclass(module = "luztar._core")]
#[derive(Clone)]
pub struct Filter(core::Filter);

#[pymethods]
impl Filter {
    #[new]
    fn new(low_pass: &LowPass) -> Self {
        Self(core::Filter::new(low_pass.0))
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

    fn push_in_place(&mut self, py: Python<'_>, mut x: PyReadwriteArray1<'_, f64>) -> PyResult<()> {
        let x = x.as_slice_mut()?;
        Ok(py.detach(|| self.0.push_in_place(x)).map_err(CoreError)?)
    }

    fn reset(&mut self, level: Option<f64>) -> Result<(), CoreError> {
        Ok(self.0.reset(level)?)
    }

    fn copy(&self) -> Self {
        self.clone()
    }

    fn state<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        PyArray1::from_slice(py, &self.0.state())
    }

    fn restore(&mut self, state: PyReadonlyArray1<'_, f64>) -> PyResult<()> {
        Ok(self.0.restore(state.as_slice()?).map_err(CoreError)?)
    }
}

/// Filters each row of `x` into the same row of `out`; the settled edges if a tolerance is given, else scipy's.
#[pyfunction]
pub fn zero_phase(
    py: Python<'_>,
    low_pass: &LowPass,
    tolerance: Option<f64>,
    x: PyReadonlyArray2<'_, f64>,
    mut out: PyReadwriteArray2<'_, f64>,
) -> PyResult<()> {
    let edges = tolerance.map_or(Edges::Scipy, |tolerance| Edges::Settled { tolerance });
    let mut filter = ZeroPhase::new(low_pass.0, edges).map_err(CoreError)?;
    let length = x.as_array().ncols();
    let (x, out) = (x.as_slice()?, out.as_slice_mut()?);
    Ok(py
        .detach(|| filter.apply_rows(x, length, out))
        .map_err(CoreError)?)
}
