//! Polynomials.

use luztar::regression as core;
use numpy::{PyArray1, PyReadonlyArray1};
use pyo3::prelude::*;

use super::linear::{LinearTuple, linear_tuple};
use super::{State, optional};
use crate::door;
use crate::error::CoreError;

/// As of a linear fit, then the Chebyshev coefficients and the domain.
type PolynomialTuple<'py> = (LinearTuple<'py>, Bound<'py, PyArray1<f64>>, (f64, f64));

fn polynomial_tuple(py: Python<'_>, fit: core::PolynomialFit) -> PolynomialTuple<'_> {
    let linear = core::LinearFit {
        coefficients: fit.coefficients,
        standard_errors: fit.standard_errors,
        residual_std: fit.residual_std,
        residual_squares: fit.residual_squares,
        explained_squares: fit.explained_squares,
        n: fit.n,
        degrees_of_freedom: fit.degrees_of_freedom,
    };
    let chebyshev = PyArray1::from_vec(py, fit.chebyshev);
    (linear_tuple(py, linear), chebyshev, fit.domain)
}

/// The least-squares polynomial through the points.
#[pyfunction]
pub fn fit_polynomial<'py>(
    py: Python<'py>,
    x: &Bound<'py, PyAny>,
    y: &Bound<'py, PyAny>,
    weights: Option<PyReadonlyArray1<'py, f64>>,
    degree: usize,
) -> PyResult<PolynomialTuple<'py>> {
    let (xs, ys) = (door::vector("x", x)?, door::vector("y", y)?);
    let (xs, ys, weights) = (xs.as_slice()?, ys.as_slice()?, optional(weights.as_ref())?);
    let fit = door::run(py, xs.len(), || {
        core::fit_polynomial(xs, ys, weights, degree)
    });
    let fit = fit.map_err(|e| door::explained_of(e, &[("x", x), ("y", y)]))?;
    Ok(polynomial_tuple(py, fit))
}

/// The triangular factor of a polynomial.
#[pyclass(module = "luztar._core", subclass)]
pub struct PolynomialSums(core::PolynomialSums);

#[pymethods]
impl PolynomialSums {
    #[new]
    #[pyo3(signature = (degree=1, domain=(-1.0, 1.0), *, forgetting=1.0))]
    fn new(degree: usize, domain: (f64, f64), forgetting: f64) -> Result<Self, CoreError> {
        Ok(Self(core::PolynomialSums::new(degree, domain, forgetting)?))
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
        door::run(py, xs.len(), || self.0.push(xs, ys, weights))
            .map_err(|e| door::explained_of(e, &[("x", x), ("y", y)]))
    }

    /// Add the points another object of the same degree and domain has seen.
    fn merge(slf: &Bound<'_, Self>, other: &Bound<'_, Self>) -> PyResult<()> {
        let other = other.try_borrow()?.0.clone();
        Ok(slf.try_borrow_mut()?.0.merge(&other).map_err(CoreError)?)
    }

    /// The degree.
    #[getter]
    fn degree(&self) -> usize {
        self.0.degree()
    }

    /// How many points.
    #[getter]
    fn count(&self) -> u64 {
        self.0.count()
    }

    fn figures<'py>(&self, py: Python<'py>) -> PyResult<PolynomialTuple<'py>> {
        Ok(polynomial_tuple(py, self.0.fit().map_err(CoreError)?))
    }

    /// All there is to store: whole numbers, then floats.
    fn state(&self) -> State {
        self.0.state()
    }

    /// Go on from a stored state.
    fn restore(&mut self, integers: Vec<u64>, numbers: Vec<f64>) -> Result<(), CoreError> {
        self.0 = core::PolynomialSums::from_state(&integers, &numbers)?;
        Ok(())
    }
}

/// A polynomial over the last points.
#[pyclass(module = "luztar._core", subclass)]
pub struct RollingPolynomial(core::RollingPolynomial);

#[pymethods]
impl RollingPolynomial {
    #[new]
    #[pyo3(signature = (degree=1, window=2))]
    fn new(degree: usize, window: usize) -> Result<Self, CoreError> {
        Ok(Self(core::RollingPolynomial::new(degree, window)?))
    }

    /// Add points: two array_likes of shape (n,), n >= 0, finite, of magnitude up to 1e150.
    fn push(&mut self, py: Python<'_>, x: &Bound<'_, PyAny>, y: &Bound<'_, PyAny>) -> PyResult<()> {
        let (xs, ys) = (door::vector("x", x)?, door::vector("y", y)?);
        let (xs, ys) = (xs.as_slice()?, ys.as_slice()?);
        door::run(py, xs.len(), || self.0.push(xs, ys))
            .map_err(|e| door::explained_of(e, &[("x", x), ("y", y)]))
    }

    /// The degree.
    #[getter]
    fn degree(&self) -> usize {
        self.0.degree()
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

    fn figures<'py>(&self, py: Python<'py>) -> PyResult<PolynomialTuple<'py>> {
        let fit = door::run(py, self.0.count() as usize, || self.0.fit()).map_err(CoreError)?;
        Ok(polynomial_tuple(py, fit))
    }

    /// All there is to store: whole numbers, then floats.
    fn state(&self) -> State {
        self.0.state()
    }

    /// Go on from a stored state.
    fn restore(&mut self, integers: Vec<u64>, numbers: Vec<f64>) -> Result<(), CoreError> {
        self.0 = core::RollingPolynomial::from_state(&integers, &numbers)?;
        Ok(())
    }
}
