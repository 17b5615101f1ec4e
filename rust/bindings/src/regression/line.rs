//! The straight line.

use luztar::regression as core;
use numpy::PyReadonlyArray1;
use pyo3::prelude::*;

use super::{State, optional};
use crate::door;
use crate::error::CoreError;

/// Slope, intercept; their standard errors, that at the mean and of the residuals; r, n, degrees of freedom, means.
type LineTuple = (
    f64,
    f64,
    (Option<f64>, Option<f64>, Option<f64>, Option<f64>),
    f64,
    u64,
    f64,
    (f64, f64, f64),
);

fn line_tuple(line: core::Line) -> LineTuple {
    (
        line.slope,
        line.intercept,
        (
            line.slope_se,
            line.intercept_se,
            line.mean_se,
            line.residual_std,
        ),
        line.r,
        line.n,
        line.degrees_of_freedom,
        (line.x_mean, line.x_mean_rest, line.y_mean),
    )
}

/// The least-squares line through the points.
#[pyfunction]
pub fn fit_line(
    py: Python<'_>,
    x: &Bound<'_, PyAny>,
    y: &Bound<'_, PyAny>,
    weights: Option<PyReadonlyArray1<'_, f64>>,
) -> PyResult<LineTuple> {
    let (xs, ys) = (door::vector("x", x)?, door::vector("y", y)?);
    let (xs, ys, weights) = (xs.as_slice()?, ys.as_slice()?, optional(weights.as_ref())?);
    let line = door::run(py, xs.len(), || core::fit_line(xs, ys, weights));
    Ok(line_tuple(line.map_err(|e| {
        door::explained_of(e, &[("x", x), ("y", y)])
    })?))
}

/// The centred sums of a line, pushed and merged.
#[pyclass(module = "luztar._core", subclass)]
pub struct LineSums(core::LineSums);

#[pymethods]
impl LineSums {
    #[new]
    #[pyo3(signature = (*, forgetting=1.0))]
    fn new(forgetting: f64) -> Result<Self, CoreError> {
        Ok(Self(core::LineSums::with_forgetting(forgetting)?))
    }

    fn push_points(
        &mut self,
        py: Python<'_>,
        x: &Bound<'_, PyAny>,
        y: &Bound<'_, PyAny>,
        weights: Option<PyReadonlyArray1<'_, f64>>,
    ) -> PyResult<()> {
        let (xs, ys) = (door::vector("x", x)?, door::vector("y", y)?);
        let (xs, ys, weights) = (xs.as_slice()?, ys.as_slice()?, optional(weights.as_ref())?);
        let pushed = door::run(py, xs.len(), || match weights {
            Some(weights) => self.0.push_weighted(xs, ys, weights),
            None => self.0.push(xs, ys),
        });
        pushed.map_err(|e| door::explained_of(e, &[("x", x), ("y", y)]))
    }

    fn push_series(&mut self, py: Python<'_>, y: &Bound<'_, PyAny>) -> PyResult<()> {
        let ys = door::vector("y", y)?;
        let ys = ys.as_slice()?;
        door::run(py, ys.len(), || self.0.push_series(ys)).map_err(|e| door::explained(e, "y", y))
    }

    fn merge_points(slf: &Bound<'_, Self>, other: &Bound<'_, Self>) -> PyResult<()> {
        let other = other.try_borrow()?.0;
        slf.try_borrow_mut()?.0.merge(&other);
        Ok(())
    }

    /// How many points.
    #[getter]
    fn count(&self) -> u64 {
        self.0.count()
    }

    fn figures(&self) -> Result<LineTuple, CoreError> {
        Ok(line_tuple(self.0.fit()?))
    }

    fn figures_over(&self, origin: f64, step: f64) -> Result<LineTuple, CoreError> {
        Ok(line_tuple(self.0.fit()?.stretched(origin, step)?))
    }

    /// All there is to store: whole numbers, then floats.
    fn state(&self) -> State {
        self.0.state()
    }

    /// Go on from a stored state.
    fn restore(&mut self, integers: Vec<u64>, numbers: Vec<f64>) -> Result<(), CoreError> {
        self.0 = core::LineSums::from_state(&integers, &numbers)?;
        Ok(())
    }
}

/// A line over the last points.
#[pyclass(module = "luztar._core", subclass)]
pub struct RollingLine(core::RollingLine);

#[pymethods]
impl RollingLine {
    #[new]
    #[pyo3(signature = (window=2))]
    fn new(window: usize) -> Result<Self, CoreError> {
        Ok(Self(core::RollingLine::new(window)?))
    }

    /// Add points: two array_likes of shape (n,), n >= 0, finite, of magnitude up to 1e150.
    fn push(&mut self, py: Python<'_>, x: &Bound<'_, PyAny>, y: &Bound<'_, PyAny>) -> PyResult<()> {
        let (xs, ys) = (door::vector("x", x)?, door::vector("y", y)?);
        let (xs, ys) = (xs.as_slice()?, ys.as_slice()?);
        door::run(py, xs.len(), || self.0.push(xs, ys))
            .map_err(|e| door::explained_of(e, &[("x", x), ("y", y)]))
    }

    /// The window's length in points.
    #[getter]
    fn window(&self) -> usize {
        self.0.window()
    }

    /// How many points the window holds now.
    #[getter]
    fn count(&self) -> u64 {
        self.0.count()
    }

    fn figures(&self) -> Result<LineTuple, CoreError> {
        Ok(line_tuple(self.0.fit()?))
    }

    /// All there is to store: whole numbers, then floats.
    fn state(&self) -> State {
        self.0.state()
    }

    /// Go on from a stored state.
    fn restore(&mut self, integers: Vec<u64>, numbers: Vec<f64>) -> Result<(), CoreError> {
        self.0 = core::RollingLine::from_state(&integers, &numbers)?;
        Ok(())
    }
}
