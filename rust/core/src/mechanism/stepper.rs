//! A mechanism in a loop: one step at a time, nothing allocated, a bounded cost.

use crate::Error;
use crate::error::{require_positive, require_same_length};

use super::box_qp::Method;
use super::channels::{Parabola, require_finite};
use super::engine::{Engine, Nobody};
use super::forces::Plan;
use super::network::Network;
use super::stability::require_short;
use super::trace::require_start;

/// A mechanism that is stepped from outside.
///
/// Each step takes the values that the channels have at its end. Between two steps a channel follows the parabola
/// through its last two values and the new one: nothing is known ahead.
#[derive(Debug, Clone)]
pub struct Stepper {
    engine: Engine,
    names: Vec<String>,
    elements: usize,
    substeps: usize,
    /// Values of the channels one and two steps ago.
    last: Vec<f64>,
    before_last: Vec<f64>,
    /// 0: not started; 1: one value of each channel is known; 2: two.
    known: u8,
    steps: u64,
}

impl Stepper {
    /// Starts from places and speeds of the bodies and the present values of the channels.
    ///
    /// # Errors
    /// As [`super::trace`]; [`Error::OutOfRange`] for a step that is not positive.
    pub fn new(
        network: &Network,
        step_s: f64,
        substeps: usize,
        start: (&[f64], &[f64]),
        channels: &[f64],
    ) -> Result<Self, Error> {
        require_positive("step_s", step_s)?;
        if substeps == 0 {
            return Err(Error::OutOfRange {
                name: "substeps",
                value: 0.0,
                interval: "[1, inf)".to_owned(),
            });
        }
        let h = step_s / substeps as f64;
        require_short(network, h)?;
        require_start(network, start.0, start.1)?;
        let loads = network.loads().iter().map(|(name, _)| name.clone());
        let mut made = Self {
            engine: Engine::new(Plan::new(network), h, Method::ActiveSet),
            names: network.driven().iter().cloned().chain(loads).collect(),
            elements: network.elements().len(),
            substeps,
            last: channels.to_vec(),
            before_last: channels.to_vec(),
            known: 1,
            steps: 0,
        };
        made.require(channels)?;
        for (span, value) in made.engine.span.iter_mut().zip(channels) {
            *span = Parabola {
                start: *value,
                middle: *value,
                end: *value,
                third: 0.0,
            };
        }
        made.engine.start(start.0, start.1);
        Ok(made)
    }

    fn require(&self, channels: &[f64]) -> Result<(), Error> {
        require_same_length("channels", channels, "channels", self.names.len())?;
        for (name, value) in self.names.iter().zip(channels) {
            require_finite(name, std::slice::from_ref(value))?;
        }
        Ok(())
    }

    /// One step to the instant at which the channels have these values. Refused values leave the state as it was.
    ///
    /// # Errors
    /// [`Error::Length`], or [`Error::Mechanism`] for a value that is not finite.
    pub fn step(&mut self, channels: &[f64]) -> Result<(), Error> {
        self.require(channels)?;
        let parts = self.substeps as f64;
        for sub in 0..self.substeps {
            for (i, &new) in channels.iter().enumerate() {
                let (old, older) = (self.last[i], self.before_last[i]);
                let middle = if self.known > 1 {
                    (6.0 * old - older + 3.0 * new) / 8.0
                } else {
                    0.5 * (old + new)
                };
                let whole = Parabola {
                    start: old,
                    middle,
                    end: new,
                    third: 0.0,
                };
                self.engine.span[i] = if self.substeps == 1 {
                    whole
                } else {
                    Parabola {
                        start: whole.at(sub as f64 / parts),
                        middle: whole.at((sub as f64 + 0.5) / parts),
                        end: whole.at((sub as f64 + 1.0) / parts),
                        third: 0.0,
                    }
                };
            }
            self.engine.step(&mut Nobody);
        }
        std::mem::swap(&mut self.last, &mut self.before_last);
        self.last.copy_from_slice(channels);
        self.known = 2;
        self.steps += 1;
        Ok(())
    }

    /// Seconds since the start.
    #[must_use]
    pub fn time_s(&self) -> f64 {
        self.steps as f64 * self.engine.h * self.substeps as f64
    }

    /// Places of the bodies.
    #[must_use]
    pub fn place(&self) -> &[f64] {
        &self.engine.state.place[..self.engine.plan.bodies]
    }

    /// Speeds of the bodies; exactly 0 where one is held.
    #[must_use]
    pub fn speed(&self) -> &[f64] {
        &self.engine.state.speed[..self.engine.plan.bodies]
    }

    /// How many elements the mechanism has.
    #[must_use]
    pub fn elements(&self) -> usize {
        self.elements
    }

    /// Writes the torque along each element; of frictions that hold the one of equilibrium, of assistance what it puts
    /// out. Nothing is allocated.
    ///
    /// # Errors
    /// [`Error::Length`] unless there is room for one per element.
    pub fn torques_into(&mut self, out: &mut [f64]) -> Result<(), Error> {
        if out.len() != self.elements {
            return Err(Error::Length {
                name: "torques",
                expected: format!("{}", self.elements),
                got: out.len(),
            });
        }
        out.fill(0.0);
        let share = if self.steps == 0 { 0.0 } else { 1.0 };
        self.engine.torques(share, out);
        Ok(())
    }

    /// For each friction that can resist: 0 where it holds, else the direction in which it slides.
    #[must_use]
    pub fn modes(&self) -> &[i8] {
        &self.engine.state.modes
    }

    /// Everything that a twin needs to go on: whole numbers and numbers.
    #[must_use]
    pub fn state(&self) -> (Vec<i64>, Vec<f64>) {
        let state = &self.engine.state;
        let mut integers = vec![i64::from(self.known), self.steps.cast_signed()];
        integers.extend(state.modes.iter().map(|m| i64::from(*m)));
        let parts = [&state.place, &state.speed, &self.last, &self.before_last];
        let mut numbers: Vec<f64> = parts.into_iter().flatten().copied().collect();
        for span in &self.engine.span {
            numbers.extend([span.start, span.middle, span.end]);
        }
        (integers, numbers)
    }

    /// Goes on from what [`Stepper::state`] of a stepper of the same mechanism gave.
    ///
    /// # Errors
    /// [`Error::Length`] or [`Error::NonFinite`] for what is no such state; this one is then as it was.
    pub fn restore(&mut self, integers: &[i64], numbers: &[f64]) -> Result<(), Error> {
        let (nodes, channels) = (self.engine.plan.nodes(), self.last.len());
        let wanted = 2 * nodes + 5 * channels;
        let modes = self.engine.state.modes.len();
        let sound = integers.len() == modes + 2
            && integers[2..].iter().all(|m| (-1..=1).contains(m))
            && (1..=2).contains(&integers[0])
            && integers[1] >= 0;
        if !sound || numbers.len() != wanted {
            return Err(Error::Length {
                name: "state",
                expected: format!("{} whole numbers and {wanted}", modes + 2),
                got: numbers.len(),
            });
        }
        crate::error::require_finite("state", numbers)?;
        let modes: Vec<i8> = integers[2..].iter().map(|m| *m as i8).collect();
        let (place, rest) = numbers.split_at(nodes);
        let (speed, rest) = rest.split_at(nodes);
        let (last, rest) = rest.split_at(channels);
        let (before_last, spans) = rest.split_at(channels);
        self.engine.restore(place, speed, &modes);
        for (span, values) in self.engine.span.iter_mut().zip(spans.chunks_exact(3)) {
            *span = Parabola {
                start: values[0],
                middle: values[1],
                end: values[2],
                third: 0.0,
            };
        }
        self.last.copy_from_slice(last);
        self.before_last.copy_from_slice(before_last);
        self.known = integers[0] as u8;
        self.steps = integers[1].cast_unsigned();
        Ok(())
    }
}
