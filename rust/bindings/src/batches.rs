//! `luztar._core.run_lanes`: many free runs of the steering model, each with its own parameters and drive, of which a
//! row of numbers is kept, or all.

use luztar::dynamics::{
    Batch, Channel, Control, Drive, Drives, Keep, LaneDrives, Results, check_lanes as check,
    run_lanes as run,
};
use numpy::{PyReadonlyArray2, PyReadwriteArray1, PyReadwriteArray2, PyUntypedArrayMethods};
use pyo3::prelude::*;

use crate::dynamics::{bodies, kernel, starts, width};
use crate::error::CoreError;
use crate::interruptible::interruptible;

/// Sub-steps of a shared drive that are refined beforehand, 32 MB of each channel; more are refined on the way, with the
/// same bits.
const MOST_REFINED: usize = 1 << 21;

/// The drives of some lanes, from arrays of one row for all or one row per lane.
enum Driven<'a> {
    Shared(Drive),
    Own(LaneDrives<'a>),
}

impl<'a> Driven<'a> {
    fn new(
        lanes: usize,
        handwheel: &'a PyReadonlyArray2<'_, f64>,
        load: Option<&'a PyReadonlyArray2<'_, f64>>,
        sample_rate_hz: f64,
        substeps: usize,
    ) -> PyResult<Self> {
        let channel = |rows: &'a PyReadonlyArray2<'_, f64>| -> PyResult<Channel<'a>> {
            Ok(Channel {
                values: rows.as_slice()?,
                shared: rows.shape()[0] == 1,
            })
        };
        let samples = handwheel.shape()[1];
        let psi = channel(handwheel)?;
        let load = load.map(channel).transpose()?;
        let shared = psi.shared && load.is_none_or(|l| l.shared);
        if shared && samples.saturating_mul(substeps) <= MOST_REFINED {
            let drive = Drive::new(psi.values, load.map(|l| l.values), sample_rate_hz, substeps);
            return Ok(Self::Shared(drive.map_err(CoreError)?));
        }
        let drives = LaneDrives::new(lanes, samples, psi, load, sample_rate_hz, substeps);
        Ok(Self::Own(drives.map_err(CoreError)?))
    }

    fn drives(&self) -> Drives<'_> {
        match self {
            Self::Shared(drive) => Drives::Shared(drive),
            Self::Own(drives) => Drives::Own(drives),
        }
    }
}

fn keep(events: bool, energy: bool, window: usize, chosen: Vec<usize>) -> Keep {
    Keep {
        events,
        energy,
        window,
        chosen,
    }
}

/// Names and numbers of values of the parts of a row.
#[pyfunction]
pub fn lane_columns(
    samples: usize,
    events: bool,
    energy: bool,
    window: usize,
    chosen: Vec<usize>,
) -> Vec<(String, usize)> {
    keep(events, energy, window, chosen).columns(samples)
}

/// Refuses what [`run_lanes`] would refuse, without running; the rows are the lanes from `first` on.
#[pyfunction]
#[pyo3(signature = (parameters, starts, handwheel_rad, load_nm, *, sample_rate_hz, substeps, method, first))]
#[allow(clippy::too_many_arguments)]
pub fn check_lanes(
    parameters: PyReadonlyArray2<'_, f64>,
    starts: PyReadonlyArray2<'_, f64>,
    handwheel_rad: PyReadonlyArray2<'_, f64>,
    load_nm: Option<PyReadonlyArray2<'_, f64>>,
    sample_rate_hz: f64,
    substeps: usize,
    method: &str,
    first: usize,
) -> PyResult<()> {
    let bodies = bodies(&parameters, first)?;
    let starts = self::starts(&starts)?;
    let driven = Driven::new(
        bodies.len(),
        &handwheel_rad,
        load_nm.as_ref(),
        sample_rate_hz,
        substeps,
    )?;
    Ok(check(&bodies, &starts, driven.drives(), kernel(method)?, first).map_err(CoreError)?)
}

/// `rows` (lanes, values), `done` (lanes), `phi` and `speed` (lanes, samples), written; `told` is called with the lanes
/// done. An interrupt leaves `done` false where a lane is not finished.
#[pyfunction]
#[pyo3(signature = (
    parameters, starts, handwheel_rad, load_nm, *, sample_rate_hz, substeps, method, width, events, energy, window,
    chosen, rows, done, phi, speed, told
))]
#[allow(clippy::too_many_arguments, clippy::fn_params_excessive_bools)]
pub fn run_lanes(
    py: Python<'_>,
    parameters: PyReadonlyArray2<'_, f64>,
    starts: PyReadonlyArray2<'_, f64>,
    handwheel_rad: PyReadonlyArray2<'_, f64>,
    load_nm: Option<PyReadonlyArray2<'_, f64>>,
    sample_rate_hz: f64,
    substeps: usize,
    method: &str,
    width: &str,
    events: bool,
    energy: bool,
    window: usize,
    chosen: Vec<usize>,
    mut rows: PyReadwriteArray2<'_, f64>,
    mut done: PyReadwriteArray1<'_, bool>,
    mut phi: Option<PyReadwriteArray2<'_, f64>>,
    mut speed: Option<PyReadwriteArray2<'_, f64>>,
    told: Option<Bound<'_, PyAny>>,
) -> PyResult<()> {
    let bodies = bodies(&parameters, 0)?;
    let starts = self::starts(&starts)?;
    let load = load_nm.as_ref();
    let driven = Driven::new(bodies.len(), &handwheel_rad, load, sample_rate_hz, substeps)?;
    let batch = Batch {
        bodies: &bodies,
        starts: &starts,
        kernel: kernel(method)?,
        width: self::width(width)?,
    };
    let keep = keep(events, energy, window, chosen);
    let results = Results {
        phi: writable(phi.as_mut())?,
        speed: writable(speed.as_mut())?,
        rows: rows.as_slice_mut()?,
        done: done.as_slice_mut()?,
    };
    let control = Control::default();
    let drives = driven.drives();
    let tell = |lanes: usize| match &told {
        Some(told) => told.call1((lanes,)).map(drop),
        None => Ok(()),
    };
    let made = interruptible(py, &control, tell, || {
        run(batch, drives, &keep, results, &control)
    })?;
    Ok(made.map_err(CoreError)?)
}

fn writable<'a>(array: Option<&'a mut PyReadwriteArray2<'_, f64>>) -> PyResult<&'a mut [f64]> {
    match array {
        Some(array) => Ok(array.as_slice_mut()?),
        None => Ok(&mut []),
    }
}
