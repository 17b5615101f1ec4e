//! `luztar._core.simulate_steering`: free runs of the steering model, many parameter sets at once.

use luztar::dynamics::{Batch, Drive, Kernel, NAMES, OneMass, PARAMETERS, Start, Width, simulate};
use numpy::{PyReadonlyArray1, PyReadonlyArray2, PyReadwriteArray2, PyUntypedArrayMethods};
use pyo3::prelude::*;

use crate::error::CoreError;

/// The names of the columns of `parameters`.
#[pyfunction]
pub fn steering_parameters() -> Vec<&'static str> {
    NAMES.to_vec()
}

/// `parameters` (lanes, names), `starts` (lanes, 2), `phi` and `speed` (lanes, samples), written.
#[pyfunction]
#[pyo3(signature = (parameters, starts, handwheel_rad, load_nm, *, sample_rate_hz, substeps, method, width, phi, speed))]
#[allow(clippy::too_many_arguments)]
pub fn simulate_steering(
    py: Python<'_>,
    parameters: PyReadonlyArray2<'_, f64>,
    starts: PyReadonlyArray2<'_, f64>,
    handwheel_rad: PyReadonlyArray1<'_, f64>,
    load_nm: Option<PyReadonlyArray1<'_, f64>>,
    sample_rate_hz: f64,
    substeps: usize,
    method: &str,
    width: &str,
    mut phi: PyReadwriteArray2<'_, f64>,
    mut speed: Option<PyReadwriteArray2<'_, f64>>,
) -> PyResult<()> {
    let bodies = bodies(&parameters)?;
    let starts = self::starts(&starts)?;
    let psi = handwheel_rad.as_slice()?;
    let load = load_nm
        .as_ref()
        .map(PyReadonlyArray1::as_slice)
        .transpose()?;
    let drive = Drive::new(psi, load, sample_rate_hz, substeps).map_err(CoreError)?;
    let batch = Batch {
        bodies: &bodies,
        starts: &starts,
        kernel: kernel(method)?,
        width: self::width(width)?,
    };
    let phi = phi.as_slice_mut()?;
    let mut nothing: [f64; 0] = [];
    let speed = match speed.as_mut() {
        Some(array) => array.as_slice_mut()?,
        None => &mut nothing,
    };
    py.detach(|| simulate(batch, &drive, phi, speed))
        .map_err(CoreError)?;
    Ok(())
}

fn bodies(parameters: &PyReadonlyArray2<'_, f64>) -> PyResult<Vec<OneMass<f64>>> {
    if parameters.shape()[1] != PARAMETERS {
        return Err(CoreError(luztar::Error::Length {
            name: "parameters",
            expected: format!("{PARAMETERS} columns"),
            got: parameters.shape()[1],
        })
        .into());
    }
    let (rows, _) = parameters.as_slice()?.as_chunks::<PARAMETERS>();
    let made: Result<Vec<_>, _> = rows.iter().map(OneMass::from_array).collect();
    Ok(made.map_err(CoreError)?)
}

fn starts(starts: &PyReadonlyArray2<'_, f64>) -> PyResult<Vec<Start>> {
    if starts.shape()[1] != 2 {
        return Err(CoreError(luztar::Error::Length {
            name: "starts",
            expected: "2 columns (angle, speed)".to_owned(),
            got: starts.shape()[1],
        })
        .into());
    }
    let (rows, _) = starts.as_slice()?.as_chunks::<2>();
    Ok(rows
        .iter()
        .map(|&[phi, speed]| Start { phi, speed })
        .collect())
}

fn kernel(name: &str) -> PyResult<Kernel> {
    match name {
        "split" => Ok(Kernel::Split),
        "moreau_jean" => Ok(Kernel::MoreauJean),
        _ => Err(unknown("method", name, "split, moreau_jean")),
    }
}

fn width(name: &str) -> PyResult<Width> {
    match name {
        "widest" => Ok(Width::Widest),
        "baseline" => Ok(Width::Baseline),
        "avx2" => Ok(Width::Avx2),
        "avx512" => Ok(Width::Avx512),
        _ => Err(unknown("width", name, "widest, baseline, avx2, avx512")),
    }
}

fn unknown(what: &'static str, name: &str, known: &str) -> PyErr {
    CoreError(luztar::Error::Unknown {
        what,
        name: name.to_owned(),
        known: known.to_owned(),
    })
    .into()
}
