//! Filters: the design and the zero-phase record.

use luztar::signal::{self as core, Band, CutoffAt, Edges, InstructionSet, Passes, Scale, uneven};
use numpy::{
    PyArray1, PyArrayMethods, PyReadonlyArray1, PyReadonlyArray2, PyReadwriteArray1,
    PyReadwriteArray2, PyUntypedArray, PyUntypedArrayMethods,
};
use pyo3::prelude::*;

use crate::error::CoreError;

/// Below this many samples releasing the interpreter costs more than it gives: a few microseconds of work.
pub const WORTH_DETACHING: usize = 4096;

/// The array if it is a contiguous vector of doubles and nothing more: a masked array is not.
pub fn plain_vector<'a, 'py>(x: &'a Bound<'py, PyAny>) -> Option<&'a Bound<'py, PyArray1<f64>>> {
    x.cast_exact::<PyUntypedArray>().ok()?;
    let x = x.cast::<PyArray1<f64>>().ok()?;
    (x.is_c_contiguous() && x.is_aligned()).then_some(x)
}

/// Two plain vectors apart from each other, the second writable; None for anything else.
pub fn plain<'py>(
    x: &Bound<'py, PyAny>,
    out: &Bound<'py, PyAny>,
) -> Option<(PyReadonlyArray1<'py, f64>, PyReadwriteArray1<'py, f64>)> {
    let (x, out) = (plain_vector(x)?, plain_vector(out)?);
    if x.len() != out.len() {
        return None;
    }
    Some((x.try_readonly().ok()?, out.try_readwrite().ok()?))
}

/// A Butterworth design.
#[pyclass(frozen, module = "luztar._core")]
#[derive(Clone)]
pub struct Butterworth {
    pub design: core::Butterworth,
    pub set: InstructionSet,
}

#[pymethods]
impl Butterworth {
    /// `band` is "low", "high", "pass" or "stop"; the first two use `low_hz` alone.
    #[new]
    fn new(
        poles: usize,
        band: &str,
        low_hz: f64,
        high_hz: f64,
        sample_rate_hz: f64,
        passes: (bool, bool),
        instruction_set: &str,
    ) -> Result<Self, CoreError> {
        let (forward_backward, overall) = passes;
        let band = match band {
            "low" => Band::Low { cutoff_hz: low_hz },
            "high" => Band::High { cutoff_hz: low_hz },
            "pass" => Band::Pass { low_hz, high_hz },
            _ => Band::Stop { low_hz, high_hz },
        };
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
        Ok(Self {
            design: core::Butterworth::new(poles, band, sample_rate_hz, passes, cutoff_at)?,
            set: instruction_set_of(instruction_set)?,
        })
    }

    fn describe(&self) -> String {
        self.design.describe()
    }

    fn magnitude(&self, frequency_hz: f64) -> Result<f64, CoreError> {
        Ok(self.design.magnitude(frequency_hz)?)
    }

    fn response(&self, frequency_hz: f64) -> Result<[f64; 2], CoreError> {
        Ok(self.design.response(frequency_hz)?)
    }

    fn settle_samples(&self, tolerance: f64) -> Result<usize, CoreError> {
        Ok(self.design.settle_samples(tolerance)?)
    }

    #[getter]
    fn designed_at_hz(&self) -> Vec<f64> {
        self.design.designed_at_hz()
    }

    #[getter]
    fn delay_s(&self) -> f64 {
        self.design.delay_s()
    }

    #[getter]
    fn settle_s(&self) -> f64 {
        self.design.settle_s()
    }
}

fn instruction_set_of(name: &str) -> Result<InstructionSet, luztar::Error> {
    if name == "auto" {
        return Ok(InstructionSet::best());
    }
    let found = InstructionSet::ALL
        .into_iter()
        .find(|set| set.name() == name && set.available());
    found.ok_or_else(|| luztar::Error::Unknown {
        what: "instruction set",
        name: name.to_owned(),
        known: instruction_sets().join(", "),
    })
}

/// The instruction sets this processor has, the narrowest first.
#[pyfunction]
pub fn instruction_sets() -> Vec<&'static str> {
    let all = InstructionSet::ALL.into_iter();
    all.filter(|set| set.available())
        .map(InstructionSet::name)
        .collect()
}

/// A zero-phase filter, ready to run.
#[pyclass(frozen, module = "luztar._core")]
pub struct ZeroPhase(core::ZeroPhase);

#[pymethods]
impl ZeroPhase {
    /// `edges` is "settled", "scipy", "matlab" or "gust".
    #[new]
    fn new(
        design: &Butterworth,
        edges: &str,
        tolerance: f64,
        derivative: bool,
    ) -> Result<Self, CoreError> {
        let edges = match edges {
            "settled" => Edges::Settled { tolerance },
            "scipy" => Edges::Scipy,
            "matlab" => Edges::Matlab,
            _ => Edges::Gustafsson,
        };
        Ok(Self(if derivative {
            core::ZeroPhase::derivative(&design.design, edges, design.set)?
        } else {
            core::ZeroPhase::on(&design.design, edges, design.set)?
        }))
    }

    #[getter]
    fn instruction_set(&self) -> &'static str {
        self.0.instruction_set().name()
    }

    fn trusted(&self, length: usize, tolerance: f64) -> Result<(usize, usize), CoreError> {
        let range = self.0.trusted(length, tolerance)?;
        Ok((range.start, range.end))
    }

    fn apply(
        &self,
        py: Python<'_>,
        x: PyReadonlyArray1<'_, f64>,
        mut out: PyReadwriteArray1<'_, f64>,
    ) -> PyResult<()> {
        let (x, out) = (x.as_slice()?, out.as_slice_mut()?);
        if x.len() < WORTH_DETACHING {
            return Ok(self.0.apply(x, out).map_err(CoreError)?);
        }
        Ok(py.detach(|| self.0.apply(x, out)).map_err(CoreError)?)
    }

    /// Whether `x` and `out` were contiguous vectors of doubles apart from each other, and were filtered.
    fn apply_plain(
        &self,
        py: Python<'_>,
        x: &Bound<'_, PyAny>,
        out: &Bound<'_, PyAny>,
    ) -> PyResult<bool> {
        let Some((x, out)) = plain(x, out) else {
            return Ok(false);
        };
        self.apply(py, x, out)?;
        Ok(true)
    }

    fn apply_in_place(&self, py: Python<'_>, mut x: PyReadwriteArray1<'_, f64>) -> PyResult<()> {
        let x = x.as_slice_mut()?;
        Ok(py.detach(|| self.0.apply_in_place(x)).map_err(CoreError)?)
    }

    /// Filters each row of `x` into the same row of `out`.
    fn apply_rows(
        &self,
        py: Python<'_>,
        x: PyReadonlyArray2<'_, f64>,
        mut out: PyReadwriteArray2<'_, f64>,
        threads: usize,
    ) -> PyResult<()> {
        let length = x.as_array().ncols();
        let (x, out) = (x.as_slice()?, out.as_slice_mut()?);
        let done = py.detach(|| self.0.apply_rows(x, length, out, threads));
        Ok(done.map_err(CoreError)?)
    }

    /// Filters the columns of `frames` in place.
    fn apply_frames(&self, py: Python<'_>, mut frames: PyReadwriteArray2<'_, f64>) -> PyResult<()> {
        let channels = frames.as_array().ncols();
        let frames = frames.as_slice_mut()?;
        let done = py.detach(|| self.0.apply_frames(frames, channels));
        Ok(done.map_err(CoreError)?)
    }

    /// Filters counts or single-precision samples, `factor x + offset` in their unit.
    fn apply_samples(
        &self,
        py: Python<'_>,
        x: &Bound<'_, PyAny>,
        scale: (f64, f64),
        mut out: PyReadwriteArray1<'_, f64>,
    ) -> PyResult<()> {
        let (factor, offset) = scale;
        let scale = Scale { factor, offset };
        let out = out.as_slice_mut()?;
        let done = if let Ok(x) = x.cast::<PyArray1<i16>>() {
            let (filter, x) = (&self.0, x.readonly());
            let x = x.as_slice()?;
            py.detach(|| filter.apply_samples(x, scale, out))
        } else if let Ok(x) = x.cast::<PyArray1<i32>>() {
            let (filter, x) = (&self.0, x.readonly());
            let x = x.as_slice()?;
            py.detach(|| filter.apply_samples(x, scale, out))
        } else {
            let (filter, x) = (&self.0, x.cast::<PyArray1<f32>>()?.readonly());
            let x = x.as_slice()?;
            py.detach(|| filter.apply_samples(x, scale, out))
        };
        Ok(done.map_err(CoreError)?)
    }
}

/// The places of the extremes of each of `count` stretches.
#[pyfunction]
pub fn extremes<'py>(
    py: Python<'py>,
    x: PyReadonlyArray1<'py, f64>,
    count: usize,
) -> PyResult<Bound<'py, PyArray1<i64>>> {
    let x = x.as_slice()?;
    let places = py.detach(|| core::extremes(x, count)).map_err(CoreError)?;
    Ok(PyArray1::from_iter(
        py,
        places.into_iter().map(usize::cast_signed).map(|p| p as i64),
    ))
}

/// An uneven record read at even times, and its gaps.
#[pyfunction]
#[allow(clippy::type_complexity)]
pub fn even<'py>(
    py: Python<'py>,
    time: PyReadonlyArray1<'py, f64>,
    x: PyReadonlyArray1<'py, f64>,
    sample_rate_hz: f64,
    max_gap_s: f64,
    cubic: bool,
) -> PyResult<(Bound<'py, PyArray1<f64>>, Vec<(f64, f64)>)> {
    let (time, x) = (time.as_slice()?, x.as_slice()?);
    let between = if cubic {
        uneven::Between::Cubic
    } else {
        uneven::Between::Linear
    };
    let made = py.detach(|| uneven::even(time, x, sample_rate_hz, max_gap_s, between));
    let made = made.map_err(CoreError)?;
    Ok((PyArray1::from_vec(py, made.x), made.gaps))
}
