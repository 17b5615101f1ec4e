//! `luztar._core.solve_steering_exactly`, `solve_bodies_exactly`: the event-driven oracle.

use luztar::dynamics::oracle::{Body, Exact, Run, Signal, Spring, System};
use luztar::dynamics::{PARAMETERS, Start};
use numpy::{PyArray2, PyReadonlyArray1, PyReadonlyArray2};
use pyo3::prelude::*;

use crate::error::CoreError;

/// Stretches between two looks for an interrupt: some tens of milliseconds.
const PULSE: usize = 4096;

/// Breaks (m), coefficients (m, 4), sines (k, 3).
type SignalParts<'py> = (
    PyReadonlyArray1<'py, f64>,
    PyReadonlyArray2<'py, f64>,
    PyReadonlyArray2<'py, f64>,
);

/// Stiffness, half the gap, how much each body moves the end, the driven end.
type SpringParts<'py> = (f64, f64, PyReadonlyArray1<'py, f64>, SignalParts<'py>);

/// Angles and speeds (bodies, times), events as (time, kind, direction, element, angle).
type ExactParts<'py> = (
    Bound<'py, PyArray2<f64>>,
    Bound<'py, PyArray2<f64>>,
    Vec<(f64, &'static str, i8, usize, f64)>,
);

/// The coefficients (n - 1, 4) of the cubics between even samples.
#[pyfunction]
pub fn sampled_cubics<'py>(
    py: Python<'py>,
    values: PyReadonlyArray1<'_, f64>,
    sample_rate_hz: f64,
) -> PyResult<Bound<'py, PyArray2<f64>>> {
    let signal = Signal::samples(values.as_slice()?, sample_rate_hz).map_err(CoreError)?;
    let rows: Vec<Vec<f64>> = signal.cubics().iter().map(|c| c.to_vec()).collect();
    Ok(PyArray2::from_vec2(py, &rows)?)
}

/// The steering model of one mass, at the times.
#[pyfunction]
#[pyo3(signature = (parameters, start, handwheel, load, *, ground_speed, times_s, most_events))]
#[allow(clippy::too_many_arguments)]
pub fn solve_steering_exactly<'py>(
    py: Python<'py>,
    parameters: PyReadonlyArray1<'_, f64>,
    start: (f64, f64),
    handwheel: SignalParts<'_>,
    load: SignalParts<'_>,
    ground_speed: f64,
    times_s: PyReadonlyArray1<'_, f64>,
    most_events: usize,
) -> PyResult<ExactParts<'py>> {
    let values = parameters.as_slice()?;
    let values: &[f64; PARAMETERS] = values.try_into().map_err(|_| {
        CoreError(luztar::Error::Length {
            name: "parameters",
            expected: PARAMETERS.to_string(),
            got: values.len(),
        })
    })?;
    let (handwheel, load) = (signal(&handwheel)?, signal(&load)?);
    let system = System::one_mass(values, handwheel, load, ground_speed).map_err(CoreError)?;
    solved(py, &system, &[start], times_s.as_slice()?, most_events)
}

/// Bodies (rows: inertia, viscous, kinetic and held forward and backward, ground speed), matrices, springs with gaps.
#[pyfunction]
#[pyo3(signature = (bodies, loads, stiffness, damping, springs, starts, *, times_s, most_events))]
#[allow(clippy::too_many_arguments)]
pub fn solve_bodies_exactly<'py>(
    py: Python<'py>,
    bodies: PyReadonlyArray2<'_, f64>,
    loads: Vec<SignalParts<'_>>,
    stiffness: PyReadonlyArray2<'_, f64>,
    damping: PyReadonlyArray2<'_, f64>,
    springs: Vec<SpringParts<'_>>,
    starts: Vec<(f64, f64)>,
    times_s: PyReadonlyArray1<'_, f64>,
    most_events: usize,
) -> PyResult<ExactParts<'py>> {
    let (rows, _) = bodies.as_slice()?.as_chunks::<8>();
    let bodies: PyResult<Vec<Body>> = rows
        .iter()
        .zip(&loads)
        .map(|(&[inertia, v0, v1, k0, k1, h0, h1, ground_speed], load)| {
            Ok(Body {
                inertia,
                viscous: [v0, v1],
                kinetic: [k0, k1],
                held: [h0, h1],
                ground_speed,
                load: signal(load)?,
            })
        })
        .collect();
    let springs: PyResult<Vec<Spring>> = springs
        .iter()
        .map(|(stiffness, half_gap, at, end)| {
            Ok(Spring {
                stiffness: *stiffness,
                half_gap: *half_gap,
                end: signal(end)?,
                at: at.as_slice()?.to_vec(),
            })
        })
        .collect();
    let system = System::new(
        bodies?,
        stiffness.as_slice()?,
        damping.as_slice()?,
        springs?,
    )
    .map_err(CoreError)?;
    solved(py, &system, &starts, times_s.as_slice()?, most_events)
}

fn solved<'py>(
    py: Python<'py>,
    system: &System,
    starts: &[(f64, f64)],
    times_s: &[f64],
    most_events: usize,
) -> PyResult<ExactParts<'py>> {
    let starts: Vec<Start> = starts
        .iter()
        .map(|&(phi, speed)| Start { phi, speed })
        .collect();
    let mut run = Run::new(system, &starts, times_s, most_events).map_err(CoreError)?;
    while !py.detach(|| run.advance(PULSE)).map_err(CoreError)? {
        py.check_signals()?;
    }
    let Exact {
        angle,
        speed,
        events,
    } = run.finish();
    let events = events
        .iter()
        .map(|e| (e.time_s, e.kind.word(), e.direction, e.element, e.angle))
        .collect();
    Ok((
        PyArray2::from_vec2(py, &angle)?,
        PyArray2::from_vec2(py, &speed)?,
        events,
    ))
}

fn signal((breaks, coefficients, sines): &SignalParts<'_>) -> PyResult<Signal> {
    let (cubics, _) = coefficients.as_slice()?.as_chunks::<4>();
    let (sines, _) = sines.as_slice()?.as_chunks::<3>();
    Ok(Signal::new(breaks.as_slice()?, cubics, sines).map_err(CoreError)?)
}
