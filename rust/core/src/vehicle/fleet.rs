//! Many cars side by side: what to run, what is wrong with it, blocks over threads.

use rayon::prelude::*;

use crate::Error;
use crate::dynamics::Width;
use crate::error::require_positive;

use super::block::{Part, run};
use super::body::Body;
use super::corridor::Corridor;
use super::lateral_roll::LateralRoll;
use super::parameters::{Parameters, out};
use super::signal::Signal;
use super::single_track::SingleTrack;
use super::start::Start;
use super::summary::KEPT;
use super::trace::CHANNELS;
use super::twelve::Twelve;

/// The equations of the car.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Model {
    /// Lateral speed and yaw.
    SingleTrack,
    /// With roll and load transfer.
    LateralRoll,
    /// With heave, pitch and wheels on tyres: 12 degrees of freedom.
    Twelve,
}

/// The law of the tyres.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum TyreLaw {
    /// Force proportional to slip; small angles.
    Linear,
    /// Fiala's brush.
    Brush,
    /// Pacejka's Magic Formula.
    MagicFormula,
}

/// What the driver gives.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Steer {
    /// The handwheel's angle.
    Angle,
    /// A torque on the handwheel, which is then a body of its own.
    Torque,
}

/// What to run.
#[derive(Debug, Clone, Copy)]
pub struct Fleet<'a> {
    /// One car per lane.
    pub cars: &'a [Parameters],
    /// One start per lane.
    pub starts: &'a [Start],
    /// Seconds that count, one per lane; afterwards a lane stands still.
    pub durations_s: &'a [f64],
    /// Forward speed, m/s, one row of signals for all or one per lane.
    pub speed: Signal<'a>,
    /// Handwheel angle or steering torque.
    pub hand: Signal<'a>,
    /// Which of the two.
    pub steer: Steer,
    /// Equations.
    pub model: Model,
    /// Tyres.
    pub tyre: TyreLaw,
    /// Seconds of a step.
    pub step_s: f64,
    /// Where to stay, if anywhere.
    pub corridor: Option<Corridor<'a>>,
    /// Instruction set.
    pub width: Width,
}

/// Lanes of a block.
pub(super) const BLOCK: usize = 16;
/// The quickest decay of the midpoint rule that is still resolved: its bound is 2, coupling takes some of it.
const LARGEST_SHARE: f64 = 1.0;

/// Runs every car. `summary` takes [`KEPT`] numbers per lane, `traces` [`CHANNELS`] rows per lane of
/// [`Fleet::samples`] values, one every `every` steps; each may be empty.
///
/// # Errors
/// [`Error::Length`] where an array has the wrong length; [`Error::NonFinite`] or [`Error::OutOfRange`] for parameters
/// that model or tyre cannot do with, a speed that is not positive, a step that is too long.
pub fn drive(
    fleet: &Fleet<'_>,
    every: usize,
    summary: &mut [f64],
    traces: &mut [f64],
) -> Result<(), Error> {
    fleet.check()?;
    if every == 0 {
        return Err(out("every", 0.0, "[1, inf)"));
    }
    let lanes = fleet.cars.len();
    let samples = fleet.samples(every);
    for (name, got, wanted) in [
        ("summary", summary.len(), lanes * KEPT),
        ("traces", traces.len(), lanes * CHANNELS.len() * samples),
    ] {
        if got != 0 && got != wanted {
            return Err(Error::Length {
                name,
                expected: format!("{wanted}"),
                got,
            });
        }
    }
    let count = lanes.div_ceil(BLOCK);
    let parts: Vec<Part<'_>> = cut(summary, BLOCK * KEPT, count)
        .into_iter()
        .zip(cut(traces, BLOCK * CHANNELS.len() * samples, count))
        .enumerate()
        .map(|(number, (summary, traces))| Part {
            fleet,
            first: number * BLOCK,
            lanes: (lanes - number * BLOCK).min(BLOCK),
            every,
            summary,
            traces,
        })
        .collect();
    parts.into_par_iter().for_each(run);
    Ok(())
}

/// The places of the blocks in a result; empty ones where the result is.
fn cut(result: &mut [f64], size: usize, count: usize) -> Vec<&mut [f64]> {
    if result.is_empty() {
        (0..count).map(|_| &mut [][..]).collect()
    } else {
        result.chunks_mut(size).collect()
    }
}

impl Fleet<'_> {
    /// Steps of the longest run.
    #[must_use]
    pub fn steps(&self) -> usize {
        let longest = self
            .durations_s
            .iter()
            .fold(0.0, |most: f64, d| most.max(*d));
        // A duration that is a multiple of the step up to rounding is that multiple.
        (longest / self.step_s - 1e-6).ceil().max(1.0) as usize
    }

    /// Values of a channel.
    #[must_use]
    pub fn samples(&self, every: usize) -> usize {
        self.steps() / every.max(1) + 1
    }

    /// Whether anything beyond constant dry and viscous friction acts at the king-pins of any lane.
    pub(super) fn is_rich(&self) -> bool {
        self.cars.iter().any(|car| car.stribeck != 0.0)
    }

    fn check(&self) -> Result<(), Error> {
        let lanes = self.cars.len();
        for (name, got) in [
            ("cars", lanes),
            ("starts", self.starts.len()),
            ("durations_s", self.durations_s.len()),
        ] {
            if got != lanes || lanes == 0 {
                return Err(Error::Length {
                    name,
                    expected: format!("{}, one per car,", lanes.max(1)),
                    got,
                });
            }
        }
        for (name, rows) in [("hand", self.hand.rows()), ("speed", self.speed.rows())] {
            if rows != 1 && rows != lanes {
                return Err(Error::Length {
                    name,
                    expected: format!("1 row, or {lanes}, one per car,"),
                    got: rows,
                });
            }
        }
        if let Some(corridor) = self.corridor
            && corridor.sets() != 1
            && corridor.sets() != lanes
        {
            return Err(Error::Length {
                name: "corridor",
                expected: format!("1 set of sections, or {lanes}, one per car,"),
                got: corridor.sets(),
            });
        }
        require_positive("step_s", self.step_s)?;
        for &duration in self.durations_s {
            require_positive("duration_s", duration)?;
        }
        let slowest = self.speed.least();
        let fastest = self.speed.most();
        if !(slowest > 0.0 && fastest.is_finite()) {
            return Err(out("speed_m_s", slowest, "(0, inf)"));
        }
        if self.speed.begins_s() > 0.0 {
            let interval =
                "(-inf, 0]: before its first piece a signal is 0, and a car stands still";
            return Err(out("start of speed_m_s", self.speed.begins_s(), interval));
        }
        for car in self.cars {
            match self.model {
                Model::SingleTrack => SingleTrack::check(car)?,
                Model::LateralRoll => LateralRoll::check(car)?,
                Model::Twelve => Twelve::check(car)?,
            }
            if self.tyre != TyreLaw::Linear {
                car.require_grip(self.tyre == TyreLaw::MagicFormula)?;
            }
            if self.steer == Steer::Torque && car.wheel_inertia <= 0.0 {
                let interval = "(0, inf) under a steering torque";
                return Err(out("handwheel.inertia_kg_m2", car.wheel_inertia, interval));
            }
            self.check_step(car, slowest, fastest)?;
        }
        Ok(())
    }

    /// Refuses a step that the quickest part of a car does not allow.
    fn check_step(&self, car: &Parameters, slowest: f64, fastest: f64) -> Result<(), Error> {
        let steering = self.steering_frequency_rad_s(car);
        let (a, b) = (car.front_axle, car.rear_axle);
        let own = match self.model {
            Model::SingleTrack => SingleTrack::quickest(car),
            Model::LateralRoll => LateralRoll::quickest(car),
            Model::Twelve => Twelve::quickest(car),
        };
        let inverse = |length: f64| if length > 0.0 { fastest / length } else { 0.0 };
        let lateral = (car.front_cornering + car.rear_cornering) / (car.mass * slowest);
        let turning = (a * a * car.front_cornering + b * b * car.rear_cornering)
            / (car.yaw_inertia * slowest);
        for (what, longest) in [
            ("the spring steering.stiffness_nm_per_rad", 2.0 / steering),
            (
                "the slowest speed_m_s: its tyres' damping",
                LARGEST_SHARE / lateral.max(turning),
            ),
            (
                "front.relaxation_m or rear.relaxation_m",
                LARGEST_SHARE / inverse(car.front_relaxation).max(inverse(car.rear_relaxation)),
            ),
            (
                "the suspension's stiffness and damping",
                LARGEST_SHARE / own,
            ),
        ] {
            if self.step_s >= longest {
                let interval = format!("(0, {longest:.3e}) for {what}");
                return Err(out("step_s", self.step_s, &interval));
            }
        }
        Ok(())
    }

    /// Highest circular frequency of handwheel and king-pins on their springs, at most.
    fn steering_frequency_rad_s(&self, car: &Parameters) -> f64 {
        let p = car.steering_ratio;
        let assist = car.assist_gain.abs() + car.assist_second_gain.abs();
        let trail = car.front_pneumatic_trail.abs() + car.front_caster_trail.abs();
        let ground = car.steering_aligning + trail * car.front_cornering;
        let mut square =
            (p * (p + assist) * car.steering_stiffness + ground) / car.steering_inertia;
        if self.steer == Steer::Torque {
            square += car.steering_stiffness / car.wheel_inertia;
        }
        square.sqrt()
    }
}
