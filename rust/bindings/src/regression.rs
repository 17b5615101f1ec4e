//! Least squares.

use luztar::regression::{self as core, line::STATE_LEN};
use numpy::PyReadonlyArray1;
use pyo3::prelude::*;

use crate::error::CoreError;

/// Slope, intercept, their standard errors, r, residual standard deviation, n.
type LineTuple = (f64, f64, Option<f64>, Option<f64>, f64, Option<f64>, u64);

fn tuple(line: core::Line) -> LineTuple {
    let errors = (line.slope_se, line.intercept_se);
    (
        line.slope,
        line.intercept,
        errors.0,
        errors.1,
        line.r,
        line.residual_std,
        line.n,
    )
}

/// The least-squares line through the points.
#[pyfunction]
pub fn fit_line(
    py: Python<'_>,
    x: PyReadonlyArray1<'_, f64>,
    y: PyReadonlyArray1<'_, f64>,
) -> PyResult<LineTuple> {
    let (x, y) = (x.as_slice()?, y.as_slice()?);
    let line = py.detach(|| core::fit_line(x, y)).map_err(CoreError)?;
    Ok(tuple(line))
}

/// The centred sums of a line, pushed and merged.
#[pyclass(module = "luztar._core", from_py_object)]
#[derive(Clone, Default)]
pub struct LineSums(core::LineSums);

#[pymethods]
impl LineSums {
    #[new]
    fn new() -> Self {
        Self::default()
    }

    fn push(
        &mut self,
        py: Python<'_>,
        x: PyReadonlyArray1<'_, f64>,
        y: PyReadonlyArray1<'_, f64>,
    ) -> PyResult<()> {
        let (x, y) = (x.as_slice()?, y.as_slice()?);
        Ok(py.detach(|| self.0.push(x, y)).map_err(CoreError)?)
    }

    fn merge(&mut self, other: LineSums) {
        self.0.merge(&other.0);
    }

    fn copy(&self) -> Self {
        self.clone()
    }

    #[getter]
    fn count(&self) -> u64 {
        self.0.count()
    }

    fn fit(&self) -> Result<LineTuple, CoreError> {
        Ok(tuple(self.0.fit()?))
    }

    fn state(&self) -> (u64, [f64; STATE_LEN]) {
        (self.0.count(), self.0.state())
    }

    #[staticmethod]
    fn from_state(count: u64, state: [f64; STATE_LEN]) -> Result<Self, CoreError> {
        Ok(Self(core::LineSums::from_state(count, state)?))
    }
}
