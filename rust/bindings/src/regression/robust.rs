//! Fits that outliers do not bend.

use luztar::regression as core;
use numpy::{PyReadonlyArray1, PyUntypedArrayMethods};
use pyo3::prelude::*;

use super::linear::{LinearTuple, linear_tuple};
use crate::door;
use crate::error::CoreError;

/// Slope, intercept, the slope's interval, n.
#[pyfunction]
pub fn theil_sen(
    py: Python<'_>,
    x: PyReadonlyArray1<'_, f64>,
    y: PyReadonlyArray1<'_, f64>,
    normal_quantile: f64,
) -> PyResult<(f64, f64, f64, f64, u64)> {
    let (x, y) = (x.as_slice()?, y.as_slice()?);
    let t = py
        .detach(|| core::theil_sen::theil_sen(x, y, normal_quantile))
        .map_err(CoreError)?;
    Ok((t.slope, t.intercept, t.slope_low, t.slope_high, t.n))
}

/// As of a linear fit, then the robust scale, the number of outliers and of repetitions.
#[pyfunction]
pub fn huber<'py>(
    py: Python<'py>,
    x: &Bound<'py, PyAny>,
    y: &Bound<'py, PyAny>,
    intercept: bool,
    threshold: f64,
) -> PyResult<(LinearTuple<'py>, f64, u64, usize)> {
    let (x, y) = (door::rows("x", x, None)?, door::vector("y", y)?);
    let predictors = x.shape()[1];
    let (x, y) = (x.as_slice()?, y.as_slice()?);
    let h = py
        .detach(|| core::huber::huber(x, y, predictors, intercept, threshold))
        .map_err(CoreError)?;
    Ok((linear_tuple(py, h.fit), h.scale, h.outliers, h.repetitions))
}
