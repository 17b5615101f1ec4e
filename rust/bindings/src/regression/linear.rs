//! Several predictors.

use luztar::regression as core;
use numpy::{PyArray1, PyReadonlyArray1, PyUntypedArrayMethods};
use pyo3::prelude::*;

use super::{State, optional};
use crate::door;
use crate::error::CoreError;

/// Coefficients, standard errors, residual deviation, squares left and explained, n, degrees of freedom.
pub type LinearTuple<'py> = (
    Bound<'py, PyArray1<f64>>,
    Option<Bound<'py, PyArray1<f64>>>,
    Option<f64>,
    f64,
    f64,
    u64,
    f64,
);

pub fn linear_tuple(py: Python<'_>, fit: core::LinearFit) -> LinearTuple<'_> {
    (
        PyArray1::from_vec(py, fit.coefficients),
        fit.standard_errors.map(|e| PyArray1::from_vec(py, e)),
        fit.residual_std,
        fit.residual_squares,
        fit.explained_squares,
        fit.n,
        fit.degrees_of_freedom,
    )
}

/// The least-squares fit of the rows of x.
#[pyfunction]
pub fn fit_linear<'py>(
    py: Python<'py>,
    x: &Bound<'py, PyAny>,
    y: &Bound<'py, PyAny>,
    weights: Option<PyReadonlyArray1<'py, f64>>,
    intercept: bool,
) -> PyResult<LinearTuple<'py>> {
    let (x, y) = (door::rows("x", x, None)?, door::vector("y", y)?);
    let predictors = x.shape()[1];
    let (x, y, weights) = (x.as_slice()?, y.as_slice()?, optional(weights.as_ref())?);
    let fit = door::run(py, x.len(), || {
        core::fit_linear(x, y, weights, predictors, intercept)
    })
    .map_err(CoreError)?;
    Ok(linear_tuple(py, fit))
}

/// The triangular factor of a multiple regression.
#[pyclass(module = "luztar._core", subclass)]
pub struct LinearSums(core::LinearSums);

#[pymethods]
impl LinearSums {
    #[new]
    #[pyo3(signature = (predictors=1, *, intercept=true, forgetting=1.0))]
    fn new(predictors: usize, intercept: bool, forgetting: f64) -> Result<Self, CoreError> {
        Ok(Self(core::LinearSums::new(
            predictors, intercept, forgetting,
        )?))
    }

    fn push_rows(
        &mut self,
        py: Python<'_>,
        x: &Bound<'_, PyAny>,
        y: &Bound<'_, PyAny>,
        weights: Option<PyReadonlyArray1<'_, f64>>,
    ) -> PyResult<()> {
        let (xs, ys) = (
            door::rows("x", x, Some(self.0.predictors()))?,
            door::vector("y", y)?,
        );
        let (xs, ys, weights) = (xs.as_slice()?, ys.as_slice()?, optional(weights.as_ref())?);
        Ok(door::run(py, xs.len(), || self.0.push(xs, ys, weights)).map_err(CoreError)?)
    }

    /// Add the rows another object has seen.
    fn merge(slf: &Bound<'_, Self>, other: &Bound<'_, Self>) -> PyResult<()> {
        let other = other.try_borrow()?.0.clone();
        Ok(slf.try_borrow_mut()?.0.merge(&other).map_err(CoreError)?)
    }

    /// How many predictors a row has.
    #[getter]
    fn predictors(&self) -> usize {
        self.0.predictors()
    }

    /// How many rows.
    #[getter]
    fn count(&self) -> u64 {
        self.0.count()
    }

    fn figures<'py>(&self, py: Python<'py>) -> PyResult<LinearTuple<'py>> {
        Ok(linear_tuple(py, self.0.fit().map_err(CoreError)?))
    }

    /// All there is to store: whole numbers, then floats.
    fn state(&self) -> State {
        self.0.state()
    }

    /// Go on from a stored state.
    fn restore(&mut self, integers: Vec<u64>, numbers: Vec<f64>) -> Result<(), CoreError> {
        self.0 = core::LinearSums::from_state(&integers, &numbers)?;
        Ok(())
    }
}
