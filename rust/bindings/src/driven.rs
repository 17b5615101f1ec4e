//! `luztar._core.Recording`: a run prepared for driven fits.

use luztar::driven::{Band, Blocks, Recording as Core, Rows, Term, Travel, Whitening, solve};
use numpy::{
    IntoPyArray, PyArray1, PyArray2, PyArray3, PyArrayMethods, PyReadonlyArray1, PyReadonlyArray2,
    PyReadonlyArray3, PyUntypedArrayMethods,
};
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyTuple};

use crate::error::CoreError;

/// (effect, inner parameters) pairs as Python gives them.
type Terms = Vec<(String, Vec<f64>)>;

fn terms(given: Terms) -> Vec<Term> {
    given
        .into_iter()
        .map(|(effect, inner)| Term { effect, inner })
        .collect()
}

/// A run prepared for driven fits; immutable, so that threads may share it.
#[pyclass(frozen, module = "luztar._core")]
pub struct Recording {
    core: Core,
    /// What it was made from, so that it can be made again in another process.
    made_from: MadeFrom,
}

/// The arrays are the caller's own: a reference costs nothing.
struct MadeFrom {
    position: Py<PyArray1<f64>>,
    load_n: Option<Py<PyArray1<f64>>>,
    sample_rate_hz: f64,
    band: Band,
    travel: Travel,
}

#[pymethods]
impl Recording {
    #[new]
    #[pyo3(signature = (position, *, sample_rate_hz, band_hz, decimate, anti_alias, already_filtered, hysteresis, minimum_travel, turn_rad_per_unit, load_n))]
    #[allow(clippy::too_many_arguments)]
    fn new(
        py: Python<'_>,
        position: PyReadonlyArray1<'_, f64>,
        sample_rate_hz: f64,
        band_hz: f64,
        decimate: Option<usize>,
        anti_alias: bool,
        already_filtered: bool,
        hysteresis: f64,
        minimum_travel: f64,
        turn_rad_per_unit: f64,
        load_n: Option<PyReadonlyArray1<'_, f64>>,
    ) -> PyResult<Self> {
        let x = position.as_slice()?;
        let load = load_n
            .as_ref()
            .map(PyReadonlyArray1::as_slice)
            .transpose()?;
        let band = Band {
            upper_hz: band_hz,
            decimate,
            anti_alias,
            already_filtered,
        };
        let travel = Travel {
            hysteresis,
            minimum: minimum_travel,
            turn_rad_per_unit,
        };
        let core = py
            .detach(|| Core::new(x, sample_rate_hz, band, travel, load))
            .map_err(CoreError)?;
        let made_from = MadeFrom {
            position: (*position).clone().unbind(),
            load_n: load_n.map(|load| (*load).clone().unbind()),
            sample_rate_hz,
            band,
            travel,
        };
        Ok(Self { core, made_from })
    }

    /// For pickle.
    fn __getnewargs_ex__<'py>(
        &self,
        py: Python<'py>,
    ) -> PyResult<(Bound<'py, PyTuple>, Bound<'py, PyDict>)> {
        let made = &self.made_from;
        let (band, travel) = (made.band, made.travel);
        let options = PyDict::new(py);
        options.set_item("sample_rate_hz", made.sample_rate_hz)?;
        options.set_item("band_hz", band.upper_hz)?;
        options.set_item("decimate", band.decimate)?;
        options.set_item("anti_alias", band.anti_alias)?;
        options.set_item("already_filtered", band.already_filtered)?;
        options.set_item("hysteresis", travel.hysteresis)?;
        options.set_item("minimum_travel", travel.minimum)?;
        options.set_item("turn_rad_per_unit", travel.turn_rad_per_unit)?;
        options.set_item("load_n", made.load_n.as_ref())?;
        Ok((PyTuple::new(py, [&made.position])?, options))
    }

    fn __len__(&self) -> usize {
        self.core.len()
    }

    #[getter]
    fn resolution(&self) -> f64 {
        self.core.resolution()
    }

    #[getter]
    fn slowest_speed(&self) -> f64 {
        self.core.slowest_speed()
    }

    #[getter]
    fn range(&self) -> f64 {
        self.core.range()
    }

    #[getter]
    fn decimate(&self) -> usize {
        self.core.decimate()
    }

    /// Position, speed and acceleration at the kept samples.
    fn kept<'py>(&self, py: Python<'py>) -> [Bound<'py, PyArray1<f64>>; 3] {
        self.core.kept().map(|v| v.into_pyarray(py))
    }

    /// (onset, turn, direction, onset uncertainty in seconds) of every stroke, in samples of the full rate.
    fn strokes(&self) -> Vec<(usize, usize, f64, f64)> {
        self.core
            .strokes()
            .iter()
            .map(|s| (s.onset, s.turn, s.direction, s.onset_uncertainty_s))
            .collect()
    }

    fn measured<'py>(
        &self,
        py: Python<'py>,
        channel: PyReadonlyArray1<'_, f64>,
    ) -> PyResult<Bound<'py, PyArray1<f64>>> {
        let x = channel.as_slice()?;
        let kept = py.detach(|| self.core.measured(x)).map_err(CoreError)?;
        Ok(kept.into_pyarray(py))
    }

    fn start_shift<'py>(
        &self,
        py: Python<'py>,
        model: Terms,
    ) -> PyResult<Bound<'py, PyArray1<f64>>> {
        let model = terms(model);
        Ok(py
            .detach(|| self.core.start_shift(&model))
            .map_err(CoreError)?
            .into_pyarray(py))
    }

    /// Shape (columns, kept samples).
    fn columns<'py>(
        &self,
        py: Python<'py>,
        model: Terms,
        wanted: Vec<usize>,
    ) -> PyResult<Bound<'py, PyArray2<f64>>> {
        let model = terms(model);
        let columns = py
            .detach(|| self.core.columns(&model, &wanted))
            .map_err(CoreError)?;
        // Terms without a column of their own (a delay alone) make none, of the run's length all the same.
        let kept = || self.core.len().div_ceil(self.core.decimate());
        let shape = [columns.len(), columns.first().map_or_else(kept, Vec::len)];
        columns.concat().into_pyarray(py).reshape(shape)
    }

    /// Shape (strokes, size, size). `strokes`: (first, last, ridge) in kept samples. `whitening`: its zero and pole, Hz.
    #[pyo3(signature = (model, given, effort, strokes, whitening=None))]
    fn normal_equations<'py>(
        &self,
        py: Python<'py>,
        model: Terms,
        given: Vec<(usize, f64)>,
        effort: PyReadonlyArray1<'_, f64>,
        strokes: Vec<(usize, usize, f64)>,
        whitening: Option<(f64, f64)>,
    ) -> PyResult<Bound<'py, PyArray3<f64>>> {
        let (model, rows) = (terms(model), rows(strokes));
        let y = effort.as_slice()?;
        let filter = whitening
            .map(|(zero_hz, pole_hz)| Whitening::new(zero_hz, pole_hz, self.core.step_s()));
        let made = py
            .detach(|| self.core.normal_equations(&model, &given, y, &rows, filter))
            .map_err(CoreError)?;
        array(py, made)
    }
}

fn rows(strokes: Vec<(usize, usize, f64)>) -> Vec<Rows> {
    strokes
        .into_iter()
        .map(|(first, last, ridge)| Rows { first, last, ridge })
        .collect()
}

fn array(py: Python<'_>, blocks: Blocks) -> PyResult<Bound<'_, PyArray3<f64>>> {
    let shape = [blocks.len(), blocks.size, blocks.size];
    blocks.products.into_pyarray(py).reshape(shape)
}

fn blocks(products: &PyReadonlyArray3<'_, f64>) -> PyResult<Blocks> {
    Ok(Blocks {
        size: products.shape()[1],
        products: products.as_slice()?.to_vec(),
    })
}

/// The blocks of columns that are at hand; `columns` has the shape (size, kept samples).
#[pyfunction]
pub fn normal_equations<'py>(
    py: Python<'py>,
    columns: PyReadonlyArray2<'_, f64>,
    strokes: Vec<(usize, usize, f64)>,
) -> PyResult<Bound<'py, PyArray3<f64>>> {
    let (count, length) = (columns.shape()[0], columns.shape()[1]);
    let values = columns.as_slice()?;
    let all: Vec<&[f64]> = (0..count)
        .map(|i| &values[i * length..(i + 1) * length])
        .collect();
    array(py, Blocks::of(&all, &rows(strokes)))
}

/// The columns through a whitening filter; `columns` has the shape (size, kept samples).
#[pyfunction]
pub fn whitened<'py>(
    py: Python<'py>,
    columns: PyReadonlyArray2<'_, f64>,
    step_s: f64,
    zero_hz: f64,
    pole_hz: f64,
) -> PyResult<Bound<'py, PyArray2<f64>>> {
    let (rows, length) = (columns.shape()[0], columns.shape()[1]);
    let mut out = columns.as_slice()?.to_vec();
    let filter = Whitening::new(zero_hz, pole_hz, step_s);
    py.detach(|| {
        for series in out.chunks_mut(length.max(1)) {
            filter.apply(series);
        }
    });
    out.into_pyarray(py).reshape([rows, length])
}

/// The least-squares coefficients of one summed block, shape (size, size).
#[pyfunction]
pub fn solve_block<'py>(
    py: Python<'py>,
    block: PyReadonlyArray2<'_, f64>,
    bound: f64,
) -> PyResult<Bound<'py, PyArray1<f64>>> {
    Ok(solve(block.as_slice()?, block.shape()[0], bound).into_pyarray(py))
}

/// [losses per stroke, training loss per fold].
#[pyfunction]
pub fn held_out<'py>(
    py: Python<'py>,
    products: PyReadonlyArray3<'_, f64>,
    fold_of: Vec<usize>,
    folds: usize,
    bound: f64,
) -> PyResult<[Bound<'py, PyArray1<f64>>; 2]> {
    let (losses, training) = blocks(&products)?.held_out(&fold_of, folds, bound);
    Ok([losses, training].map(|v| v.into_pyarray(py)))
}
