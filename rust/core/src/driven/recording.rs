//! One run prepared for driven fits: kinematics, strokes and the comparison's low pass.

use super::cache::Cache;
use super::contact::Slide;
use super::kinematics::derivative;
use super::resolution::{Resolution, span};
use super::rests::{CERTAIN, held, noise};
use super::staircase::{Joined, join_steps};
use super::strokes::{Phases, Stroke, strokes, turning_points};
use crate::Error;
use crate::error::{require_finite, require_positive};
use crate::signal::{AntiAlias, Band as PassBand, Butterworth, CutoffAt, Edges, Passes, ZeroPhase};

/// Poles per pass of the low pass of a comparison and of the kinematics.
const POLES: usize = 4;

/// The kinematics keep this many times the bandwidth of the comparison: a law such as `exp(-(w/v)^2)` makes higher
/// harmonics of the speed, and what lies beyond 2.5 times the band changes nothing below it.
const KINEMATICS_OVER_BAND: f64 = 2.5;

/// What a sensor trembles faster than this many times the bandwidth of the comparison is no start of a motion.
const TREMBLE_OVER_BAND: f64 = 8.0;

/// Noise below this share of the range is none: the position is followed as it is.
const NEGLIGIBLE_NOISE: f64 = 1e-6;

/// A travel below this share of the range tells nothing about a steering mechanism: positions that are exact, from a
/// simulation say, are taken to resolve no more. Their break-away would else be found whatever it is.
const FINEST: f64 = 1e-4;

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

/// The slowest speed worth a law of its own: this share of the top speed, or so many steps of the sensor a second.
const SLOWEST_OF_TOP_SPEED: f64 = 0.015;
const SLOWEST_STEPS_PER_S: f64 = 10.0;

/// Laws are evaluated this many times per period of the band's upper edge: what they look at is smoothed to 2.5 times
/// the band, and what is quicker, the turning of friction, enters by its means (see [`super::contact::slide`]).
const LAWS_PER_BAND_PERIOD: f64 = 32.0;

/// Before only every n-th sample of a measured channel goes on to the comparison's low pass, a low pass at this many
/// times the band keeps what would fold back below 1e-6 and takes 3e-6 off at the band's upper edge.
const FOLDING_OVER_BAND: f64 = 5.0;

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
    /// The rate at which laws are evaluated; the channels below are at this rate.
    pub(super) law_rate_hz: f64,
    /// What laws see as position: smoothed.
    pub(super) position: Vec<f64>,
    pub(super) speed: Vec<f64>,
    pub(super) acceleration: Vec<f64>,
    /// What the contact follows: an encoder's crossings joined, a noisy sensor's rests held.
    pub(super) seen: Vec<f64>,
    pub(super) slowest_speed: f64,
    pub(super) turn_rad_per_unit: f64,
    pub(super) load_n: Option<Vec<f64>>,
    pub(super) phases: Phases,
    pub(super) columns_kept: Cache<Vec<Vec<f64>>>,
    pub(super) slides_kept: Cache<Slide>,
    /// Samples of the run, and how many of them go on one sample of a law and of the comparison.
    samples: usize,
    stride: usize,
    decimate: usize,
    range: f64,
    low_pass: ZeroPhase,
    /// What keeps a measured channel from folding back where laws have a lower rate than the run.
    folding: Option<ZeroPhase>,
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
        let (stride, decimate) = strides(sample_rate_hz, band);
        let law_rate_hz = sample_rate_hz / stride as f64;
        let low_pass = if band.anti_alias {
            ZeroPhase::anti_alias(&AntiAlias::new(decimate)?)?
        } else {
            zero_phase(band.upper_hz, law_rate_hz)?
        };
        let folding = (stride > 1)
            .then(|| zero_phase(FOLDING_OVER_BAND * band.upper_hz, sample_rate_hz))
            .transpose()?;
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
        let mut resolution = Resolution::of(position, &smooth);
        let mut known = Vec::new();
        let seen = if resolution.quantised {
            let Joined { position, starts } = join_steps(position, resolution.step);
            known = starts;
            smooth = smoothed(&position)?;
            position
        } else {
            // Noise faster than any start of a motion is taken off first.
            let quick_hz = TREMBLE_OVER_BAND * band.upper_hz;
            let (quick, quick_hz) = if quick_hz < 0.45 * sample_rate_hz {
                (
                    run(&zero_phase(quick_hz, sample_rate_hz)?, position)?,
                    quick_hz,
                )
            } else {
                (position.to_vec(), 0.5 * sample_rate_hz)
            };
            let certain = CERTAIN * noise(&quick, &smooth, (kinematic_hz / quick_hz).min(0.9));
            // Smoothing takes the corners of a quick motion off as well: only what is left of it all along is noise.
            if 2.0 * certain > NEGLIGIBLE_NOISE * span(&smooth) {
                resolution.step = 2.0 * certain;
                let turns = turning_points(&smooth, travel.hysteresis, travel.minimum);
                let quiet = held(&quick, &smooth, &turns, certain);
                smooth = smoothed(&quiet)?;
                quiet
            } else {
                resolution.step = resolution.step.max(FINEST * span(&smooth));
                position.to_vec()
            }
        };
        let turns = turning_points(&smooth, travel.hysteresis, travel.minimum);
        let strokes = strokes(&turns, &seen, &known, resolution.step, sample_rate_hz);
        if let Some(load) = load_n {
            crate::error::require_same_length("load", load, "position", position.len())?;
            require_finite("load", load)?;
        }
        let phases = Phases::of(&seen, &strokes, resolution.step, sample_rate_hz);
        let speed = derivative(&smooth, sample_rate_hz);
        let acceleration = derivative(&speed, sample_rate_hz);
        let top_speed = speed.iter().fold(0.0_f64, |top, w| top.max(w.abs()));
        let range = span(&smooth);
        let strided = |v: &[f64]| -> Vec<f64> { v.iter().step_by(stride).copied().collect() };
        Ok(Self {
            law_rate_hz,
            position: strided(&smooth),
            speed: strided(&speed),
            acceleration: strided(&acceleration),
            seen: strided(&seen),
            slowest_speed: (SLOWEST_OF_TOP_SPEED * top_speed)
                .max(SLOWEST_STEPS_PER_S * resolution.step),
            turn_rad_per_unit: travel.turn_rad_per_unit,
            load_n: load_n.map(strided),
            phases: phases.strided(stride),
            columns_kept: Cache::new(position.len() / stride),
            slides_kept: Cache::new(4 * position.len() / stride),
            samples: position.len(),
            stride,
            decimate,
            range,
            low_pass,
            folding,
            already_filtered: band.already_filtered,
            resolution,
            strokes,
        })
    }

    /// Samples of the run.
    #[must_use]
    pub fn len(&self) -> usize {
        self.samples
    }

    /// Never: a recording has at least 16 samples.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.samples == 0
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
        self.range
    }

    /// The slowest speed worth a law of its own: 1.5 % of the top speed, or ten steps of the sensor a second.
    #[must_use]
    pub fn slowest_speed(&self) -> f64 {
        self.slowest_speed
    }

    /// Every how many samples the comparison keeps one.
    #[must_use]
    pub fn decimate(&self) -> usize {
        self.decimate
    }

    /// Seconds between the samples that the comparison keeps.
    #[must_use]
    pub fn step_s(&self) -> f64 {
        self.every() as f64 / self.law_rate_hz
    }

    /// Every how many samples of the laws the comparison keeps one.
    pub(super) fn every(&self) -> usize {
        self.decimate / self.stride
    }

    /// The sample of the laws at or before a sample of the run.
    pub(super) fn law_sample(&self, sample: usize) -> usize {
        sample / self.stride
    }

    /// Position, speed and acceleration at the samples that the comparison keeps.
    #[must_use]
    pub fn kept(&self) -> [Vec<f64>; 3] {
        [&self.position, &self.speed, &self.acceleration]
            .map(|v| v.iter().step_by(self.every()).copied().collect())
    }

    /// A measured channel through the comparison's low pass, at the samples that the comparison keeps.
    ///
    /// # Errors
    /// [`Error`] where the channel is not finite or not as long as the run.
    pub fn measured(&self, channel: &[f64]) -> Result<Vec<f64>, Error> {
        crate::error::require_same_length("channel", channel, "position", self.len())?;
        require_finite("channel", channel)?;
        let kept = |full: &[f64], every| full.iter().step_by(every).copied().collect();
        if self.already_filtered {
            return Ok(kept(channel, self.decimate));
        }
        let at_law_rate: Vec<f64> = match &self.folding {
            Some(folding) => kept(&run(folding, channel)?, self.stride),
            None => channel.to_vec(),
        };
        Ok(kept(&self.filtered(&at_law_rate)?, self.every()))
    }

    /// A column through the comparison's low pass, at the rate of the laws.
    pub(super) fn filtered(&self, column: &[f64]) -> Result<Vec<f64>, Error> {
        run(&self.low_pass, column)
    }
}

/// How many samples of the run go on one sample of the laws, and on one of the comparison; the second is a multiple.
///
/// A filter that was applied before, or that comes with a decimation, is one at the rate of the run: laws keep to it.
fn strides(sample_rate_hz: f64, band: Band) -> (usize, usize) {
    let over = |rate_hz: f64, per_period: f64| {
        (rate_hz / (per_period * band.upper_hz)).floor().max(1.0) as usize
    };
    let longest = if band.anti_alias || band.already_filtered {
        1
    } else {
        over(sample_rate_hz, LAWS_PER_BAND_PERIOD)
    };
    if let Some(every) = band.decimate {
        let divides = (1..=longest).rev().find(|k| every % k == 0);
        (divides.unwrap_or(1), every.max(1))
    } else {
        let kept = over(sample_rate_hz / longest as f64, SAMPLES_PER_BAND_PERIOD);
        (longest, longest * kept)
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
