//! Moments of streams and of the parts of a record.

use luztar::stats::{self as core, moments::Extreme};
use numpy::PyReadonlyArray1;
use pyo3::prelude::*;
use pyo3::types::PyFloat;

use super::State;
use crate::door;
use crate::error::CoreError;

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
        Ok(slf.try_borrow_mut()?.0.merge(&later).map_err(CoreError)?)
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
