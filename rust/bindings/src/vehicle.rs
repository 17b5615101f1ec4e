//! `luztar._core.drive_cars`: cars driven by handwheel angle or torque, many at once.

use luztar::vehicle::{
    CHANNELS, Corridor, Fleet, Model, NAMES, Parameters, START_NAMES, STARTS, SUMMARY, Sampled,
    Segments, Signal, Start, Steer, TyreLaw, drive,
};
use numpy::{PyReadonlyArray1, PyReadonlyArray2, PyReadwriteArray1, PyUntypedArrayMethods};
use pyo3::prelude::*;

use crate::dynamics::{unknown, width};
use crate::error::CoreError;

/// The names of the columns of `cars`, `starts`, a summary and the channels of a trace.
#[pyfunction]
pub fn car_names() -> (
    Vec<&'static str>,
    Vec<&'static str>,
    Vec<&'static str>,
    Vec<&'static str>,
) {
    (
        NAMES.to_vec(),
        START_NAMES.to_vec(),
        SUMMARY.to_vec(),
        CHANNELS.to_vec(),
    )
}

/// Starts, levels, amplitudes, frequencies and phases, each (rows, pieces) in one vector; or samples and their rate.
#[derive(FromPyObject)]
pub enum Played<'py> {
    Pieces(
        usize,
        PyReadonlyArray1<'py, f64>,
        PyReadonlyArray1<'py, f64>,
        PyReadonlyArray1<'py, f64>,
        PyReadonlyArray1<'py, f64>,
        PyReadonlyArray1<'py, f64>,
    ),
    Samples(usize, PyReadonlyArray1<'py, f64>, f64),
}

impl Played<'_> {
    fn signal(&self) -> PyResult<Signal<'_>> {
        Ok(match self {
            Played::Pieces(count, start, level, amplitude, frequency, phase) => Signal::Segments(
                Segments::new(
                    *count,
                    start.as_slice()?,
                    level.as_slice()?,
                    amplitude.as_slice()?,
                    frequency.as_slice()?,
                    phase.as_slice()?,
                )
                .map_err(CoreError)?,
            ),
            Played::Samples(samples, values, rate) => Signal::Sampled(
                Sampled::new(*samples, values.as_slice()?, *rate).map_err(CoreError)?,
            ),
        })
    }
}

/// `cars` (lanes, names), `starts` (lanes, names), `summary` (lanes * names) and `traces` (lanes * channels * samples),
/// written; either may be empty.
#[pyfunction]
#[pyo3(signature = (cars, starts, durations_s, speed, hand, corridor, *, sections, steer, model, tyre, step_s, every, width, summary, traces))]
#[allow(clippy::too_many_arguments)]
pub fn drive_cars(
    py: Python<'_>,
    cars: PyReadonlyArray2<'_, f64>,
    starts: PyReadonlyArray2<'_, f64>,
    durations_s: PyReadonlyArray1<'_, f64>,
    speed: Played<'_>,
    hand: Played<'_>,
    corridor: Option<PyReadonlyArray1<'_, f64>>,
    sections: usize,
    steer: &str,
    model: &str,
    tyre: &str,
    step_s: f64,
    every: usize,
    width: &str,
    mut summary: PyReadwriteArray1<'_, f64>,
    mut traces: PyReadwriteArray1<'_, f64>,
) -> PyResult<()> {
    let cars: Result<Vec<_>, _> = cars
        .as_slice()?
        .chunks_exact(cars.shape()[1].max(1))
        .map(Parameters::from_slice)
        .collect();
    let (rows, _) = starts.as_slice()?.as_chunks::<STARTS>();
    let starts: Result<Vec<_>, _> = rows.iter().map(Start::from_array).collect();
    let (cars, starts) = (cars.map_err(CoreError)?, starts.map_err(CoreError)?);
    let corridor = match &corridor {
        Some(values) => Some(Corridor::new(sections, values.as_slice()?).map_err(CoreError)?),
        None => None,
    };
    let fleet = Fleet {
        cars: &cars,
        starts: &starts,
        durations_s: durations_s.as_slice()?,
        speed: speed.signal()?,
        hand: hand.signal()?,
        steer: self::steer(steer)?,
        model: self::model(model)?,
        tyre: self::tyre(tyre)?,
        step_s,
        corridor,
        width: crate::vehicle::width(width)?,
    };
    let (summary, traces) = (summary.as_slice_mut()?, traces.as_slice_mut()?);
    py.detach(|| drive(&fleet, every, summary, traces))
        .map_err(CoreError)?;
    Ok(())
}

fn steer(name: &str) -> PyResult<Steer> {
    match name {
        "angle" => Ok(Steer::Angle),
        "torque" => Ok(Steer::Torque),
        _ => Err(unknown("steer", name, "angle, torque")),
    }
}

fn model(name: &str) -> PyResult<Model> {
    match name {
        "single_track" => Ok(Model::SingleTrack),
        "lateral_roll" => Ok(Model::LateralRoll),
        "twelve" => Ok(Model::Twelve),
        _ => Err(unknown("model", name, "single_track, lateral_roll, twelve")),
    }
}

fn tyre(name: &str) -> PyResult<TyreLaw> {
    match name {
        "linear" => Ok(TyreLaw::Linear),
        "brush" => Ok(TyreLaw::Brush),
        "magic_formula" => Ok(TyreLaw::MagicFormula),
        _ => Err(unknown("tyre", name, "linear, brush, magic_formula")),
    }
}
