//! Least squares.

use luztar::regression as core;
use numpy::{PyArray1, PyReadonlyArray1, PyReadwriteArray1, PyUntypedArrayMethods};
use pyo3::prelude::*;

use crate::door;
use crate::error::CoreError;

type State = (Vec<u64>, Vec<f64>);

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

fn optional<'a>(array: Option<&'a PyReadonlyArray1<'_, f64>>) -> PyResult<Option<&'a [f64]>> {
    Ok(array.map(|a| a.as_slice()).transpose()?)
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
        Ok(line_tuple(self.0.fit()?.stretched(origin, step)))
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

/// Coefficients, standard errors, residual deviation, squares left and explained, n, degrees of freedom.
type LinearTuple<'py> = (
    Bound<'py, PyArray1<f64>>,
    Option<Bound<'py, PyArray1<f64>>>,
    Option<f64>,
    f64,
    f64,
    u64,
    f64,
);

fn linear_tuple(py: Python<'_>, fit: core::LinearFit) -> LinearTuple<'_> {
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

/// Recursive least squares in square-root form.
#[pyclass(module = "luztar._core", subclass)]
pub struct Recursive(core::Recursive);

#[pymethods]
impl Recursive {
    #[new]
    #[pyo3(signature = (start=vec![0.0], *, start_error=1e6, forgetting=1.0))]
    fn new(start: Vec<f64>, start_error: f64, forgetting: f64) -> Result<Self, CoreError> {
        Ok(Self(core::Recursive::new(&start, start_error, forgetting)?))
    }

    fn push_rows(
        &mut self,
        py: Python<'_>,
        x: &Bound<'_, PyAny>,
        y: &Bound<'_, PyAny>,
        errors: Option<PyReadwriteArray1<'_, f64>>,
    ) -> PyResult<()> {
        let mut errors = errors;
        let (xs, ys) = (
            door::rows("x", x, Some(self.0.size()))?,
            door::vector("y", y)?,
        );
        let (x, y) = (xs.as_slice()?, ys.as_slice()?);
        let errors = errors.as_mut().map(|e| e.as_slice_mut()).transpose()?;
        Ok(door::run(py, x.len(), || self.0.push(x, y, errors)).map_err(CoreError)?)
    }

    /// The coefficients now.
    #[getter]
    fn coefficients<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        PyArray1::from_vec(py, self.0.coefficients())
    }

    /// How many coefficients.
    #[getter]
    fn size(&self) -> usize {
        self.0.size()
    }

    /// How many rows were pushed.
    #[getter]
    fn count(&self) -> u64 {
        self.0.count()
    }

    /// All there is to store: whole numbers, then floats.
    fn state(&self) -> State {
        self.0.state()
    }

    /// Go on from a stored state.
    fn restore(&mut self, integers: Vec<u64>, numbers: Vec<f64>) -> Result<(), CoreError> {
        self.0 = core::Recursive::from_state(&integers, &numbers)?;
        Ok(())
    }
}

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
