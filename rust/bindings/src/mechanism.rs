//! `luztar._core.Mechanism` and its stepper: mechanisms of several bodies.

use luztar::mechanism as core;
use numpy::{
    IntoPyArray, PyArray1, PyArray2, PyArrayMethods, PyReadonlyArray1, PyReadonlyArray2,
    PyReadwriteArray1, PyReadwriteArray3, PyUntypedArrayMethods,
};
use pyo3::prelude::*;

use crate::error::CoreError;

/// (name, kind, (node, ratio), (node, ratio), values, (acts on, ratio), curve).
type ElementParts = (
    String,
    String,
    (String, f64),
    (String, f64),
    Vec<f64>,
    (String, f64),
    Vec<(f64, f64)>,
);
type Table<'py> = Bound<'py, PyArray2<f64>>;
/// Time, element, kind, direction.
type EventParts = (f64, usize, &'static str, f64);
/// Place, speed, torque; frictions, their modes, redundant samples; events, crowded steps; energies.
type TraceParts<'py> = (
    Table<'py>,
    Table<'py>,
    Table<'py>,
    Vec<usize>,
    Bound<'py, PyArray2<i8>>,
    Bound<'py, PyArray1<bool>>,
    Vec<EventParts>,
    usize,
    EnergyParts,
);
/// Torques, relative accelerations, sets, sweeps, solved.
type Held = (Vec<f64>, Vec<f64>, usize, usize, bool);
/// Per element, driven node and load; then stored first and last, turnover, residual.
type EnergyParts = (Vec<f64>, Vec<f64>, Vec<f64>, [f64; 4]);

/// A checked network of bodies and elements.
#[pyclass(module = "luztar._core", frozen)]
pub struct Mechanism(core::Network);

#[pymethods]
impl Mechanism {
    #[new]
    fn new(
        bodies: Vec<(String, f64)>,
        driven: Vec<String>,
        loads: Vec<(String, String)>,
        elements: Vec<ElementParts>,
    ) -> PyResult<Self> {
        let node = |of: &str, name: &str| -> Result<core::Node, CoreError> {
            let found = bodies.iter().position(|(body, _)| body == name);
            let given = driven.iter().position(|node| node == name);
            match (name, found, given) {
                ("ground", ..) => Ok(core::Node::Ground),
                (_, Some(i), _) => Ok(core::Node::Body(i)),
                (_, _, Some(i)) => Ok(core::Node::Driven(i)),
                _ => Err(CoreError(luztar::Error::Mechanism {
                    place: of.to_owned(),
                    problem: format!("there is no body or driven node '{name}'"),
                    remedy: "Name one of the mechanism, or ground.".to_owned(),
                })),
            }
        };
        let acts = loads
            .iter()
            .map(|(name, body)| match node(name, body)? {
                core::Node::Body(i) => Ok((name.clone(), i)),
                _ => Err(CoreError(luztar::Error::Mechanism {
                    place: name.clone(),
                    problem: format!("'{body}' is no body"),
                    remedy: "Let it act on a body of the mechanism.".to_owned(),
                })),
            })
            .collect::<Result<Vec<_>, _>>()?;
        let described = elements
            .into_iter()
            .map(|(name, kind, a, b, values, on, curve)| {
                let end = |(place, ratio): (String, f64)| -> Result<core::End, CoreError> {
                    let node = node(&name, &place)?;
                    Ok(core::End { node, ratio })
                };
                let law = law(&kind, &values, || end(on), curve)?;
                let (a, b) = (end(a)?, end(b)?);
                Ok(core::Element {
                    name: name.clone(),
                    a,
                    b,
                    law,
                })
            })
            .collect::<Result<Vec<_>, CoreError>>()?;
        let bodies = bodies
            .iter()
            .map(|(name, inertia)| core::Body {
                name: name.clone(),
                inertia: *inertia,
            })
            .collect();
        let made = core::Network::new(bodies, driven, acts, described).map_err(CoreError)?;
        Ok(Self(made))
    }

    fn parameters(&self) -> Vec<(String, &'static str, f64)> {
        let names = self.0.parameters();
        let values = self.0.values();
        let pairs = names.into_iter().zip(values);
        pairs
            .map(|((of, name), v)| (of.to_owned(), name, v))
            .collect()
    }

    fn longest_step(&self) -> (f64, Option<usize>) {
        let found = core::longest_step(&self.0);
        (found.seconds, found.element)
    }

    #[pyo3(signature = (channels, start, start_speed, *, sample_rate_hz, substeps, gauss_seidel))]
    #[allow(clippy::too_many_arguments)]
    fn trace<'py>(
        &self,
        py: Python<'py>,
        channels: PyReadonlyArray2<'_, f64>,
        start: PyReadonlyArray1<'_, f64>,
        start_speed: PyReadonlyArray1<'_, f64>,
        sample_rate_hz: f64,
        substeps: usize,
        gauss_seidel: bool,
    ) -> PyResult<TraceParts<'py>> {
        let channels = self.channels(&channels, sample_rate_hz, substeps)?;
        let (place, speed) = (start.as_slice()?, start_speed.as_slice()?);
        let method = if gauss_seidel {
            core::Method::GaussSeidel
        } else {
            core::Method::ActiveSet
        };
        let made = py
            .detach(|| core::trace(&self.0, place, speed, &channels, method))
            .map_err(CoreError)?;
        let samples = channels.samples();
        let table = |values: Vec<f64>| {
            let rows = values.len() / samples;
            values.into_pyarray(py).reshape([rows, samples])
        };
        let events = (made.events.iter())
            .map(|e| (e.time_s, e.element, e.kind.word(), e.direction))
            .collect();
        let l = made.ledger;
        let totals = [l.stored_first, l.stored_last, l.turnover, l.residual()];
        let frictions = made.frictions.len();
        Ok((
            table(made.place)?,
            table(made.speed)?,
            table(made.torque)?,
            made.frictions,
            made.modes.into_pyarray(py).reshape([frictions, samples])?,
            made.redundant.into_pyarray(py),
            events,
            made.crowded_steps,
            (l.element, l.driven, l.load, totals),
        ))
    }

    /// `values` (lanes, parameters); `place` and `speed` (lanes, bodies, samples), written.
    #[pyo3(signature = (values, channels, start, start_speed, *, first, sample_rate_hz, substeps, place, speed))]
    #[allow(clippy::too_many_arguments)]
    fn simulate(
        &self,
        py: Python<'_>,
        values: PyReadonlyArray2<'_, f64>,
        channels: PyReadonlyArray2<'_, f64>,
        start: PyReadonlyArray1<'_, f64>,
        start_speed: PyReadonlyArray1<'_, f64>,
        first: usize,
        sample_rate_hz: f64,
        substeps: usize,
        mut place: PyReadwriteArray3<'_, f64>,
        mut speed: PyReadwriteArray3<'_, f64>,
    ) -> PyResult<()> {
        let channels = self.channels(&channels, sample_rate_hz, substeps)?;
        let lanes = core::Lanes {
            network: &self.0,
            values: values.as_slice()?,
            first,
            place: start.as_slice()?,
            speed: start_speed.as_slice()?,
        };
        let (place, speed) = (place.as_slice_mut()?, speed.as_slice_mut()?);
        py.detach(|| core::simulate(lanes, &channels, place, speed))
            .map_err(CoreError)?;
        Ok(())
    }

    /// `out` (lanes, bodies, names), written.
    #[pyo3(signature = (values, channels, start, start_speed, *, first, sample_rate_hz, substeps, out))]
    #[allow(clippy::too_many_arguments)]
    fn summarise(
        &self,
        py: Python<'_>,
        values: PyReadonlyArray2<'_, f64>,
        channels: PyReadonlyArray2<'_, f64>,
        start: PyReadonlyArray1<'_, f64>,
        start_speed: PyReadonlyArray1<'_, f64>,
        first: usize,
        sample_rate_hz: f64,
        substeps: usize,
        mut out: PyReadwriteArray3<'_, f64>,
    ) -> PyResult<()> {
        let channels = self.channels(&channels, sample_rate_hz, substeps)?;
        let lanes = core::Lanes {
            network: &self.0,
            values: values.as_slice()?,
            first,
            place: start.as_slice()?,
            speed: start_speed.as_slice()?,
        };
        let out = out.as_slice_mut()?;
        py.detach(|| core::summarise(lanes, &channels, out))
            .map_err(CoreError)?;
        Ok(())
    }

    #[staticmethod]
    fn summary_names() -> Vec<&'static str> {
        core::SUMMARY.to_vec()
    }
}

impl Mechanism {
    fn channels(
        &self,
        rows: &PyReadonlyArray2<'_, f64>,
        sample_rate_hz: f64,
        substeps: usize,
    ) -> PyResult<core::Channels> {
        let samples = rows.shape()[1];
        let all = rows.as_slice()?;
        let rows: Vec<&[f64]> = all.chunks_exact(samples.max(1)).collect();
        let made = core::Channels::new(&self.0, &rows, samples, sample_rate_hz, substeps);
        Ok(made.map_err(CoreError)?)
    }
}

fn law(
    kind: &str,
    values: &[f64],
    on: impl FnOnce() -> Result<core::End, CoreError>,
    terms: Vec<(f64, f64)>,
) -> Result<core::Law, CoreError> {
    match (kind, values) {
        ("spring", &[stiffness, gap, hardening]) => Ok(core::Law::Spring {
            stiffness,
            gap,
            hardening,
        }),
        ("damper", &[viscous, drag]) => Ok(core::Law::Damper { viscous, drag }),
        ("friction", &[level, difference, stribeck, stribeck_speed, stiction]) => {
            Ok(core::Law::Friction {
                level,
                difference,
                stribeck,
                stribeck_speed,
                stiction,
            })
        }
        ("assist", &[scale]) => Ok(core::Law::Assist {
            on: on()?,
            scale,
            terms,
        }),
        _ => Err(CoreError(luztar::Error::Unknown {
            what: "element kind",
            name: kind.to_owned(),
            known: "spring, damper, friction, assist".to_owned(),
        })),
    }
}

/// A mechanism that is stepped from outside.
#[pyclass(module = "luztar._core")]
#[derive(Clone)]
pub struct MechanismStepper(core::Stepper);

#[pymethods]
impl MechanismStepper {
    #[new]
    fn new(
        mechanism: &Mechanism,
        step_s: f64,
        substeps: usize,
        start: Vec<f64>,
        start_speed: Vec<f64>,
        channels: Vec<f64>,
    ) -> Result<Self, CoreError> {
        let start = (&start[..], &start_speed[..]);
        let made = core::Stepper::new(&mechanism.0, step_s, substeps, start, &channels)?;
        Ok(Self(made))
    }

    fn step(
        &mut self,
        channels: PyReadonlyArray1<'_, f64>,
        mut place: PyReadwriteArray1<'_, f64>,
        mut speed: PyReadwriteArray1<'_, f64>,
    ) -> PyResult<()> {
        self.0.step(channels.as_slice()?).map_err(CoreError)?;
        self.read(&mut place, &mut speed)
    }

    fn read_into(
        &self,
        mut place: PyReadwriteArray1<'_, f64>,
        mut speed: PyReadwriteArray1<'_, f64>,
    ) -> PyResult<()> {
        self.read(&mut place, &mut speed)
    }

    #[getter]
    fn time_s(&self) -> f64 {
        self.0.time_s()
    }

    fn modes(&self) -> Vec<i64> {
        self.0.modes().iter().map(|m| i64::from(*m)).collect()
    }

    fn torques_into(&mut self, mut torque: PyReadwriteArray1<'_, f64>) -> PyResult<()> {
        let torque = torque.as_slice_mut()?;
        Ok(self.0.torques_into(torque).map_err(CoreError)?)
    }

    fn copy(&self) -> Self {
        self.clone()
    }

    fn state(&self) -> (Vec<i64>, Vec<f64>) {
        self.0.state()
    }

    fn restore(&mut self, integers: Vec<i64>, numbers: Vec<f64>) -> Result<(), CoreError> {
        Ok(self.0.restore(&integers, &numbers)?)
    }
}

impl MechanismStepper {
    fn read(
        &self,
        place: &mut PyReadwriteArray1<'_, f64>,
        speed: &mut PyReadwriteArray1<'_, f64>,
    ) -> PyResult<()> {
        fill(place.as_slice_mut()?, self.0.place())?;
        fill(speed.as_slice_mut()?, self.0.speed())
    }
}

fn fill(out: &mut [f64], values: &[f64]) -> PyResult<()> {
    if out.len() != values.len() {
        return Err(CoreError(luztar::Error::Length {
            name: "out",
            expected: format!("{}", values.len()),
            got: out.len(),
        })
        .into());
    }
    out.copy_from_slice(values);
    Ok(())
}

/// A quadratic programme within a box: (torques, relative accelerations, sets, sweeps, solved).
#[pyfunction]
pub fn hold_or_slide(
    matrix: PyReadonlyArray2<'_, f64>,
    free: PyReadonlyArray1<'_, f64>,
    low: PyReadonlyArray1<'_, f64>,
    high: PyReadonlyArray1<'_, f64>,
    gauss_seidel: bool,
) -> PyResult<Held> {
    let (matrix, rows) = (matrix.as_slice()?, free.len());
    let (free, low, high) = (free.as_slice()?, low.as_slice()?, high.as_slice()?);
    for (name, got, expected) in [
        ("matrix", matrix.len(), rows * rows),
        ("low", low.len(), rows),
        ("high", high.len(), rows),
    ] {
        if got != expected {
            return Err(CoreError(luztar::Error::Length {
                name,
                expected: format!("{expected}"),
                got,
            })
            .into());
        }
    }
    let mut qp = core::BoxQp::new(rows);
    qp.set_matrix(rows, |i, j| matrix[i * rows + j]);
    for row in 0..rows {
        qp.set_row(row, free[row], low[row], high[row]);
    }
    let method = if gauss_seidel {
        core::Method::GaussSeidel
    } else {
        core::Method::ActiveSet
    };
    let outcome = qp.solve(method);
    Ok((
        qp.torque().to_vec(),
        qp.slack().to_vec(),
        outcome.sets,
        outcome.sweeps,
        outcome.solved,
    ))
}
