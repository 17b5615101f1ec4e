//! `luztar._core.simulate_steering`: free runs of the steering model, many parameter sets at once.

use luztar::dynamics::{
    Batch, Drive, Kernel, NAMES, OneMass, PARAMETERS, Start, Width, simulate, trace,
};
use numpy::{
    IntoPyArray, PyArray1, PyReadonlyArray1, PyReadonlyArray2, PyReadwriteArray2,
    PyUntypedArrayMethods,
};
use pyo3::prelude::*;

use crate::error::CoreError;

/// Angle, speed, friction, events, energies.
type TraceParts<'py> = (
    Bound<'py, PyArray1<f64>>,
    Bound<'py, PyArray1<f64>>,
    Bound<'py, PyArray1<f64>>,
    Vec<(f64, &'static str, f64)>,
    Vec<(&'static str, f64)>,
);

/// The names of the columns of `parameters`.
#[pyfunction]
pub fn steering_parameters() -> Vec<&'static str> {
    NAMES.to_vec()
}

/// The highest circular frequency of every row of `parameters`, rad/s, the column wound up by so much. Errors number
/// the lanes from `first` on.
#[pyfunction]
#[pyo3(signature = (parameters, wound_rad, first=0))]
pub fn steering_highest_rad_s<'py>(
    py: Python<'py>,
    parameters: PyReadonlyArray2<'_, f64>,
    wound_rad: f64,
    first: usize,
) -> PyResult<Bound<'py, PyArray1<f64>>> {
    let highest = |body: &OneMass<f64>| body.highest_frequency_rad_s(wound_rad);
    let made: Vec<f64> = bodies(&parameters, first)?.iter().map(highest).collect();
    Ok(made.into_pyarray(py))
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
    let bodies = bodies(&parameters, 0)?;
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

/// One trajectory: (phi, speed, friction, events as (time, kind, direction), energies by name).
#[pyfunction]
#[pyo3(signature = (parameters, start, handwheel_rad, load_nm, *, sample_rate_hz, substeps, method))]
#[allow(clippy::too_many_arguments)]
pub fn trace_steering<'py>(
    py: Python<'py>,
    parameters: PyReadonlyArray2<'_, f64>,
    start: (f64, f64),
    handwheel_rad: PyReadonlyArray1<'_, f64>,
    load_nm: Option<PyReadonlyArray1<'_, f64>>,
    sample_rate_hz: f64,
    substeps: usize,
    method: &str,
) -> PyResult<TraceParts<'py>> {
    let bodies = bodies(&parameters, 0)?;
    let [body] = bodies[..] else {
        return Err(CoreError(luztar::Error::Length {
            name: "parameters",
            expected: "1 row".to_owned(),
            got: bodies.len(),
        })
        .into());
    };
    let psi = handwheel_rad.as_slice()?;
    let load = load_nm
        .as_ref()
        .map(PyReadonlyArray1::as_slice)
        .transpose()?;
    let drive = Drive::new(psi, load, sample_rate_hz, substeps).map_err(CoreError)?;
    let kernel = kernel(method)?;
    let start = Start {
        phi: start.0,
        speed: start.1,
    };
    let made = py
        .detach(|| trace(&body, start, kernel, &drive))
        .map_err(CoreError)?;
    let events = made
        .events
        .iter()
        .map(|e| (e.time_s, e.kind.word(), e.direction))
        .collect();
    let l = made.ledger;
    let energies = vec![
        ("handwheel", l.handwheel),
        ("load", l.load),
        ("stored_first", l.stored_first),
        ("stored_last", l.stored_last),
        ("dry", l.dry),
        ("viscous", l.viscous),
        ("curved", l.curved),
        ("turnover", l.turnover),
        ("residual", l.residual()),
    ];
    Ok((
        made.phi.into_pyarray(py),
        made.speed.into_pyarray(py),
        made.friction.into_pyarray(py),
        events,
        energies,
    ))
}

/// The bodies of rows, which are the lanes from `first` on.
pub fn bodies(parameters: &PyReadonlyArray2<'_, f64>, first: usize) -> PyResult<Vec<OneMass<f64>>> {
    if parameters.shape()[1] != PARAMETERS {
        return Err(CoreError(luztar::Error::Length {
            name: "parameters",
            expected: format!("{PARAMETERS} columns"),
            got: parameters.shape()[1],
        })
        .into());
    }
    let (rows, _) = parameters.as_slice()?.as_chunks::<PARAMETERS>();
    let many = first + rows.len() > 1;
    let made: Result<Vec<_>, _> = rows
        .iter()
        .enumerate()
        .map(|(lane, row)| {
            OneMass::from_array(row).map_err(|e| if many { of_lane(e, first + lane) } else { e })
        })
        .collect();
    Ok(made.map_err(CoreError)?)
}

/// The error of one of many lanes says which.
fn of_lane(error: luztar::Error, lane: usize) -> luztar::Error {
    match error {
        luztar::Error::NonFinite { name, value, .. } => luztar::Error::NonFinite {
            name,
            index: lane,
            value,
        },
        luztar::Error::OutOfRange {
            name,
            value,
            interval,
        } => luztar::Error::OutOfRange {
            name,
            value,
            interval: format!("{interval}, lane {lane}"),
        },
        other => other,
    }
}

pub fn starts(starts: &PyReadonlyArray2<'_, f64>) -> PyResult<Vec<Start>> {
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

pub fn kernel(name: &str) -> PyResult<Kernel> {
    match name {
        "split" => Ok(Kernel::Split),
        "moreau_jean" => Ok(Kernel::MoreauJean),
        _ => Err(unknown("method", name, "split, moreau_jean")),
    }
}

pub fn width(name: &str) -> PyResult<Width> {
    match name {
        "widest" => Ok(Width::Widest),
        "baseline" => Ok(Width::Baseline),
        "avx2" => Ok(Width::Avx2),
        "avx512" => Ok(Width::Avx512),
        _ => Err(unknown("width", name, "widest, baseline, avx2, avx512")),
    }
}

pub(crate) fn unknown(what: &'static str, name: &str, known: &str) -> PyErr {
    CoreError(luztar::Error::Unknown {
        what,
        name: name.to_owned(),
        known: known.to_owned(),
    })
    .into()
}
