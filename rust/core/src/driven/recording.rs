//! One run prepared for driven fits: kinematics, strokes and the comparison's low pass.

use super::cache::Cache;
use super::kinematics::derivative;
use super::resolution::{Resolution, span};
use super::staircase::join_steps;
use super::strokes::{Phases, Stroke, strokes};
use crate::Error;
use crate::error::{require_finite, require_positive};
use crate::signal::{AntiAlias, Band as PassBand, Butterworth, CutoffAt, Edges, Passes, ZeroPhase};

/// Poles per pass of the low pass of a comparison and of the kinematics.
const POLES: usize = 4;

/// The kinematics keep this many times the bandwidth of the comparison: a law such as `exp(-(w/v)^2)` makes higher
/// harmonics of the speed, and what lies beyond 2.5 times the band changes nothing below it.
const KINEMATICS_OVER_BAND: f64 = 2.5;

/// The comparison keeps at least this many samples per period of the band's upper edge: at four times the edge the
/// low pass, 8 poles in all, is down to 1.5e-5, so nothing folds back.
const SAMPLES_PER_BAND_PERIOD: f64 = 8.0;

/// The frequency range of a comparison.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Band {
    /// Upper edge: -3 dB per pass of the comparison's Butterworth low pass.
    pub upper_hz: f64,
    /// Keep every n-th sample of the comparison; None chooses n from the band.
    pub decimate: Option<usize>,
    /// Use the low pass of the decimation (see [`AntiAlias`]) instead of the Butterworth one.
    pub anti_alias: bool,
    /// The torque channel has been low-passed by this band before: it is left alone, the model's columns are not.
    pub already_filtered: bool,
}

/// What a structure says about its position channel.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Travel {
    /// A reversal counts once the position has returned by this much.
    pub hysteresis: f64,
    /// A stroke has at least this travel.
    pub minimum: f64,
    /// Radians of the turning part per unit of position: 1 on a rig, `2 pi / pitch` on an axis, NaN where unknown.
    pub turn_rad_per_unit: f64,
}

/// A prepared run. Positions are rad on a rig, m on an axis; everything else follows from that.
#[derive(Debug)]
pub struct Recording {
    pub(super) sample_rate_hz: f64,
    /// What laws see as position: smoothed.
    pub(super) position: Vec<f64>,
    pub(super) speed: Vec<f64>,
    pub(super) acceleration: Vec<f64>,
    /// What the contact follows: an encoder's crossings joined, any other sensor smoothed.
    pub(super) seen: Vec<f64>,
    pub(super) decimate: usize,
    pub(super) turn_rad_per_unit: f64,
    pub(super) load_n: Option<Vec<f64>>,
    pub(super) phases: Phases,
    pub(super) cache: Cache,
    low_pass: ZeroPhase,
    already_filtered: bool,
    resolution: Resolution,
    strokes: Vec<Stroke>,
}

impl Recording {
    /// Prepares a run: smooths the position, differentiates it, finds its strokes.
    ///
    /// # Errors
    /// [`Error`] naming the argument: not finite, too short, or a band above half the sample rate.
    pub fn new(
        position: &[f64],
        sample_rate_hz: f64,
        band: Band,
        travel: Travel,
        load_n: Option<&[f64]>,
    ) -> Result<Self, Error> {
        require_positive("sample_rate_hz", sample_rate_hz)?;
        require_finite("position", position)?;
        if position.len() < 16 {
            return Err(Error::Length {
                name: "position",
                expected: "at least 16".into(),
                got: position.len(),
            });
        }
        let decimate = band.decimate.unwrap_or_else(|| {
            (sample_rate_hz / (SAMPLES_PER_BAND_PERIOD * band.upper_hz))
                .floor()
                .max(1.0) as usize
        });
        let low_pass = if band.anti_alias {
            ZeroPhase::anti_alias(&AntiAlias::new(decimate)?)?
        } else {
            zero_phase(band.upper_hz, sample_rate_hz)?
        };
        let kinematic_hz = KINEMATICS_OVER_BAND * band.upper_hz;
        let smoother = (kinematic_hz < 0.45 * sample_rate_hz)
            .then(|| zero_phase(kinematic_hz, sample_rate_hz))
            .transpose()?;
        let smoothed = |x: &[f64]| {
            smoother
                .as_ref()
                .map_or_else(|| Ok(x.to_vec()), |filter| run(filter, x))
        };
        let mut smooth = smoothed(position)?;
        let resolution = Resolution::of(position, &smooth);
        let seen = if resolution.quantised {
            let joined = join_steps(position);
            smooth = smoothed(&joined)?;
            joined
        } else {
            smooth.clone()
        };
        let strokes = strokes(
            &smooth,
            &seen,
            resolution.step,
            sample_rate_hz,
            travel.hysteresis,
            travel.minimum,
        );
        if let Some(load) = load_n {
            crate::error::require_same_length("load", load, "position", position.len())?;
            require_finite("load", load)?;
        }
        let phases = Phases::of(&seen, &strokes, resolution.step, sample_rate_hz);
        let speed = derivative(&smooth, sample_rate_hz);
        let acceleration = derivative(&speed, sample_rate_hz);
        Ok(Self {
            sample_rate_hz,
            position: smooth,
            speed,
            acceleration,
            seen,
            decimate: decimate.max(1),
            turn_rad_per_unit: travel.turn_rad_per_unit,
            load_n: load_n.map(<[f64]>::to_vec),
            phases,
            cache: Cache::default(),
            low_pass,
            already_filtered: band.already_filtered,
            resolution,
            strokes,
        })
    }

    /// Samples of the run.
    #[must_use]
    pub fn len(&self) -> usize {
        self.position.len()
    }

    /// Never: a recording has at least 16 samples.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.position.is_empty()
    }

    /// The strokes found.
    #[must_use]
    pub fn strokes(&self) -> &[Stroke] {
        &self.strokes
    }

    /// The smallest change the position sensor can show.
    #[must_use]
    pub fn resolution(&self) -> f64 {
        self.resolution.step
    }

    /// Highest minus lowest position.
    #[must_use]
    pub fn range(&self) -> f64 {
        span(&self.position)
    }

    /// The slowest speed worth a law of its own: 1.5 % of the top speed, or ten steps of the sensor a second.
    #[must_use]
    pub fn slowest_speed(&self) -> f64 {
        let top = self.speed.iter().fold(0.0_f64, |top, w| top.max(w.abs()));
        (0.015 * top).max(10.0 * self.resolution.step)
    }

    /// Every how many samples the comparison keeps one.
    #[must_use]
    pub fn decimate(&self) -> usize {
        self.decimate
    }

    /// Position, speed and acceleration at the samples that the comparison keeps.
    #[must_use]
    pub fn kept(&self) -> [Vec<f64>; 3] {
        [&self.position, &self.speed, &self.acceleration]
            .map(|v| v.iter().step_by(self.decimate).copied().collect())
    }

    /// A measured channel through the comparison's low pass, at the samples that the comparison keeps.
    ///
    /// # Errors
    /// [`Error`] where the channel is not finite or not as long as the run.
    pub fn measured(&self, channel: &[f64]) -> Result<Vec<f64>, Error> {
        crate::error::require_same_length("channel", channel, "position", self.len())?;
        require_finite("channel", channel)?;
        let full = if self.already_filtered {
            channel.to_vec()
        } else {
            self.filtered(channel)?
        };
        Ok(full.into_iter().step_by(self.decimate).collect())
    }

    /// A column through the comparison's low pass, at full rate.
    pub(super) fn filtered(&self, column: &[f64]) -> Result<Vec<f64>, Error> {
        run(&self.low_pass, column)
    }
}

fn zero_phase(cutoff_hz: f64, sample_rate_hz: f64) -> Result<ZeroPhase, Error> {
    let design = Butterworth::new(
        POLES,
        PassBand::Low { cutoff_hz },
        sample_rate_hz,
        Passes::ForwardBackward,
        CutoffAt::PerPass,
    )?;
    ZeroPhase::new(&design, Edges::default())
}

fn run(filter: &ZeroPhase, x: &[f64]) -> Result<Vec<f64>, Error> {
    let mut out = vec![0.0; x.len()];
    filter.apply(x, &mut out)?;
    Ok(out)
}
