//! Statistics of streams.

use luztar::stats::{self as core, moments::Extreme};
use numpy::{PyArray1, PyReadonlyArray1, PyReadwriteArray2};
use pyo3::prelude::*;
use pyo3::types::PyFloat;

use crate::door;
use crate::error::CoreError;

type State = (Vec<u64>, Vec<f64>);

/// Mergeable moments.
#[pyclass(module = "luztar._core", subclass)]
pub struct Moments(core::Moments);

#[pymethods]
impl Moments {
    #[new]
    #[pyo3(signature = (*, shape=false, skip_nan=false, clipped_at=(f64::NEG_INFINITY, f64::INFINITY)))]
    fn new(shape: bool, skip_nan: bool, clipped_at: (f64, f64)) -> Self {
        Self(core::Moments::new(core::Settings {
            shape,
            skip_nan,
            clipped_at,
        }))
    }

    /// Add samples: a float, or array_like of shape (n,), n >= 0, of magnitude up to 1e150 (1e75 with shape=True).
    fn push(&mut self, py: Python<'_>, chunk: &Bound<'_, PyAny>) -> PyResult<()> {
        if let Ok(sample) = chunk.cast::<PyFloat>() {
            return Ok(self.0.push_one(sample.value()).map_err(CoreError)?);
        }
        let pushed = if let Some(x) = door::as_it_lies::<f64>(chunk) {
            let x = x.as_slice()?;
            door::run(py, x.len(), || self.0.push(x))
        } else if let Some(x) = door::as_it_lies::<i16>(chunk) {
            let x = x.as_slice()?;
            door::run(py, x.len(), || self.0.push_converted(x))
        } else if let Some(x) = door::as_it_lies::<i32>(chunk) {
            let x = x.as_slice()?;
            door::run(py, x.len(), || self.0.push_converted(x))
        } else if let Some(x) = door::as_it_lies::<f32>(chunk) {
            let x = x.as_slice()?;
            door::run(py, x.len(), || self.0.push_converted(x))
        } else {
            let x = door::vector("chunk", chunk)?;
            let x = x.as_slice()?;
            door::run(py, x.len(), || self.0.push(x))
        };
        // Where NaN is allowed, the list of all that is not finite would name the wrong ones.
        let alone = self.0.settings().skip_nan;
        pushed.map_err(|e| {
            if alone {
                CoreError(e).into()
            } else {
                door::explained(e, "x", chunk)
            }
        })
    }

    /// Add what another object has seen, as if it came after this one's samples.
    fn merge(slf: &Bound<'_, Self>, later: &Bound<'_, Self>) -> PyResult<()> {
        let later = later.try_borrow()?.0;
        slf.try_borrow_mut()?.0.merge(&later);
        Ok(())
    }

    /// Whether third and fourth powers are summed, NaN skipped, and beyond what samples count as clipped.
    #[getter]
    fn settings(&self) -> (bool, bool, (f64, f64)) {
        let s = self.0.settings();
        (s.shape, s.skip_nan, s.clipped_at)
    }

    /// How many samples are in the moments.
    #[getter]
    fn count(&self) -> u64 {
        self.0.count()
    }

    /// How many NaN were skipped.
    #[getter]
    fn nan_count(&self) -> u64 {
        self.0.nan_count()
    }

    /// How many samples lay at or beyond the limits.
    #[getter]
    fn clipped_count(&self) -> u64 {
        self.0.clipped_count()
    }

    /// The mean; None of nothing.
    #[getter]
    fn mean(&self) -> Option<f64> {
        self.0.figures().mean()
    }

    /// The variance with n; None of nothing.
    #[getter]
    fn variance_population(&self) -> Option<f64> {
        self.0.figures().variance_population()
    }

    /// The variance with n - 1; None below two samples.
    #[getter]
    fn variance_sample(&self) -> Option<f64> {
        self.0.figures().variance_sample()
    }

    /// The standard deviation with n (TB 038); None of nothing.
    #[getter]
    fn std_population(&self) -> Option<f64> {
        self.0.figures().std_population()
    }

    /// The standard deviation with n - 1; None below two samples.
    #[getter]
    fn std_sample(&self) -> Option<f64> {
        self.0.figures().std_sample()
    }

    /// The root of the mean square; None of nothing.
    #[getter]
    fn rms(&self) -> Option<f64> {
        self.0.figures().rms()
    }

    /// The population skewness m3 / m2^1.5; None without shape=True or where nothing varies.
    #[getter]
    fn skew(&self) -> Option<f64> {
        self.0.figures().skew()
    }

    /// The population excess kurtosis m4 / m2^2 - 3; None without shape=True or where nothing varies.
    #[getter]
    fn excess_kurtosis(&self) -> Option<f64> {
        self.0.figures().excess_kurtosis()
    }

    /// The smallest sample; None of nothing.
    #[getter]
    fn min(&self) -> Option<f64> {
        self.0.min().map(|e| e.value)
    }

    /// Where the smallest sample was first met, from 0; None of nothing.
    #[getter]
    fn min_index(&self) -> Option<u64> {
        self.0.min().map(|e| e.index)
    }

    /// The largest sample; None of nothing.
    #[getter]
    fn max(&self) -> Option<f64> {
        self.0.max().map(|e| e.value)
    }

    /// Where the largest sample was first met, from 0; None of nothing.
    #[getter]
    fn max_index(&self) -> Option<u64> {
        self.0.max().map(|e| e.index)
    }

    /// Counts, then the figures in the order of `luztar.stats.Description`.
    fn figures(&self) -> Figures {
        let f = self.0.figures();
        let value = |e: Option<Extreme>| e.map(|e| e.value);
        let index = |e: Option<Extreme>| e.map(|e| e.index);
        let (min, max) = (self.0.min(), self.0.max());
        (
            (self.0.count(), self.0.nan_count(), self.0.clipped_count()),
            (f.mean(), f.std_population(), f.std_sample(), f.rms()),
            (f.skew(), f.excess_kurtosis()),
            (value(min), index(min), value(max), index(max)),
        )
    }

    /// All there is to store: whole numbers, then floats.
    fn state(&self) -> State {
        self.0.state()
    }

    /// Go on from a stored state.
    fn restore(&mut self, integers: Vec<u64>, numbers: Vec<f64>) -> Result<(), CoreError> {
        self.0 = core::Moments::from_state(&integers, &numbers)?;
        Ok(())
    }
}

type Figures = (
    (u64, u64, u64),
    (Option<f64>, Option<f64>, Option<f64>, Option<f64>),
    (Option<f64>, Option<f64>),
    (Option<f64>, Option<u64>, Option<f64>, Option<u64>),
);

/// The moments of every label.
#[pyfunction]
pub fn moments_by_label(
    py: Python<'_>,
    x: PyReadonlyArray1<'_, f64>,
    labels: PyReadonlyArray1<'_, i64>,
    like: &Moments,
) -> PyResult<Vec<(i64, Moments)>> {
    let (x, labels, settings) = (x.as_slice()?, labels.as_slice()?, like.0.settings());
    let groups = py
        .detach(|| core::groups::by_label(x, labels, settings))
        .map_err(CoreError)?;
    Ok(groups.into_iter().map(|(l, m)| (l, Moments(m))).collect())
}

/// The moments of every window [start, end).
#[pyfunction]
pub fn moments_by_window(
    py: Python<'_>,
    x: PyReadonlyArray1<'_, f64>,
    windows: Vec<(usize, usize)>,
    like: &Moments,
) -> PyResult<Vec<Moments>> {
    let (x, settings) = (x.as_slice()?, like.0.settings());
    let groups = py
        .detach(|| core::groups::by_window(x, &windows, settings))
        .map_err(CoreError)?;
    Ok(groups.into_iter().map(Moments).collect())
}

/// Statistics of the last samples.
#[pyclass(module = "luztar._core", subclass)]
pub struct Rolling(core::Rolling);

#[pymethods]
impl Rolling {
    #[new]
    #[pyo3(signature = (window=1))]
    fn new(window: usize) -> Result<Self, CoreError> {
        Ok(Self(core::Rolling::new(window)?))
    }

    /// Add samples: a float, or array_like of shape (n,), n >= 0, finite, of magnitude up to 1e150.
    fn push(&mut self, py: Python<'_>, chunk: &Bound<'_, PyAny>) -> PyResult<()> {
        if let Ok(sample) = chunk.cast::<PyFloat>() {
            return Ok(self.0.push(&[sample.value()]).map_err(CoreError)?);
        }
        let x = door::vector("chunk", chunk)?;
        let x = x.as_slice()?;
        door::run(py, x.len(), || self.0.push(x)).map_err(|e| door::explained(e, "x", chunk))
    }

    /// Add samples and write mean, population deviation, minimum and maximum after each into `out`, shape (n, 4).
    fn push_into(
        &mut self,
        py: Python<'_>,
        chunk: &Bound<'_, PyAny>,
        mut out: PyReadwriteArray2<'_, f64>,
    ) -> PyResult<()> {
        let x = door::vector("chunk", chunk)?;
        let (x, out) = (x.as_slice()?, out.as_slice_mut()?);
        door::run(py, x.len(), || self.0.push_into(x, out))
            .map_err(|e| door::explained(e, "x", chunk))
    }

    /// The window's length in samples.
    #[getter]
    fn window(&self) -> usize {
        self.0.window()
    }

    /// How many samples the window holds now.
    #[getter]
    fn count(&self) -> u64 {
        self.0.figures().map_or(0, |f| f.count)
    }

    /// The mean of the window; None of nothing.
    #[getter]
    fn mean(&self) -> Option<f64> {
        self.0.figures().map(|f| f.mean)
    }

    /// The standard deviation of the window with n; None of nothing.
    #[getter]
    fn std_population(&self) -> Option<f64> {
        self.0.figures().map(|f| f.std_population)
    }

    /// The smallest sample of the window; None of nothing.
    #[getter]
    fn min(&self) -> Option<f64> {
        self.0.figures().map(|f| f.min)
    }

    /// The largest sample of the window; None of nothing.
    #[getter]
    fn max(&self) -> Option<f64> {
        self.0.figures().map(|f| f.max)
    }

    /// All there is to store: whole numbers, then floats.
    fn state(&self) -> State {
        self.0.state()
    }

    /// Go on from a stored state.
    fn restore(&mut self, integers: Vec<u64>, numbers: Vec<f64>) -> Result<(), CoreError> {
        self.0 = core::Rolling::from_state(&integers, &numbers)?;
        Ok(())
    }
}

/// Writes the figures of every full window into `out`, shape (n - window + 1, 4).
#[pyfunction]
pub fn rolling(
    py: Python<'_>,
    x: PyReadonlyArray1<'_, f64>,
    window: usize,
    mut out: PyReadwriteArray2<'_, f64>,
) -> PyResult<()> {
    let (x, out) = (x.as_slice()?, out.as_slice_mut()?);
    Ok(py
        .detach(|| core::rolling::rolling(x, window, out))
        .map_err(CoreError)?)
}

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
