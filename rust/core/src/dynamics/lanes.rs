//! Many parameter sets side by side, driven by one record.
//!
//! Lanes lie next to each other in blocks; the loop over the lanes of a block holds nothing but arithmetic and selects,
//! so that the compiler turns it into vector instructions. Which ones is decided at run time. Every lane goes through
//! the same operations in the same order whatever its neighbours, the block or the thread, and nothing is fused: the
//! bits are the same everywhere.

use pulp::WithSimd;
use rayon::prelude::*;

use crate::Error;
use crate::effects::Lane;

use super::drive::Drive;
use super::march::{Advance, Lanes, State, WithKernel, choose};
use super::number::Pure;
use super::one_mass::OneMass;
use super::tile::Tile;

/// How a step is made.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Kernel {
    /// Second order through events, the default.
    Split,
    /// Moreau and Jean: first order.
    MoreauJean,
}

/// Where a lane starts.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Start {
    /// Road-wheel angle, rad.
    pub phi: f64,
    /// Its speed, rad/s; 0 is at rest.
    pub speed: f64,
}

/// The instruction set to use: the widest there is, or one by name (for tests; the bits are the same).
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Width {
    /// The widest that this processor has.
    Widest,
    /// Two lanes at a time at most: what every processor of this kind has.
    Baseline,
    /// Four lanes at a time, if the processor can.
    Avx2,
    /// Eight lanes at a time, if the processor can.
    Avx512,
}

/// Lanes of a block where there are many: their states stay in the first-level cache.
const LARGE: usize = 64;
/// Smaller ones keep every thread busy where there are few: four vectors of the widest kind, or one.
const MEDIUM: usize = 32;
/// See [`MEDIUM`].
const SMALL: usize = 8;

/// The block that gives every thread something to do and no lane too many.
fn block_for(lanes: usize) -> usize {
    let threads = rayon::current_num_threads();
    if lanes <= SMALL * threads {
        SMALL
    } else if lanes <= 2 * MEDIUM * threads {
        MEDIUM
    } else {
        LARGE
    }
}

/// What to simulate.
#[derive(Debug, Clone, Copy)]
pub struct Batch<'a> {
    /// One body per lane.
    pub bodies: &'a [OneMass<f64>],
    /// One start per lane.
    pub starts: &'a [Start],
    /// The step.
    pub kernel: Kernel,
    /// Instruction set.
    pub width: Width,
}

/// Runs every lane along a drive. `phi` and `speed` take the samples of each lane one after the other, lane by lane;
/// `speed` may be empty if nobody needs it.
///
/// # Errors
/// [`Error::Length`] where an array has the wrong length; [`Error::NonFinite`] or [`Error::OutOfRange`] for a start
/// that is not finite, or a step that the springs of a lane do not allow (the step times the highest circular
/// frequency must stay below 2).
pub fn simulate(
    batch: Batch<'_>,
    drive: &Drive,
    phi: &mut [f64],
    speed: &mut [f64],
) -> Result<(), Error> {
    let wanted = batch.bodies.len() * drive.samples();
    length("phi", phi.len(), wanted)?;
    if !speed.is_empty() {
        length("speed", speed.len(), wanted)?;
    }
    blocks(batch, drive, phi, speed, &mut [])
}

/// What [`summarise`] keeps of a lane.
pub const SUMMARY: [&str; 5] = [
    "last_rad",
    "last_speed_rad_s",
    "peak_rad",
    "rms_rad",
    "at_rest_share",
];

/// Runs every lane along a drive and keeps [`SUMMARY`] of its samples only: memory does not grow with the record.
///
/// # Errors
/// As [`simulate`].
pub fn summarise(batch: Batch<'_>, drive: &Drive, out: &mut [f64]) -> Result<(), Error> {
    length("summary", out.len(), batch.bodies.len() * SUMMARY.len())?;
    blocks(batch, drive, &mut [], &mut [], out)
}

fn length(name: &'static str, got: usize, wanted: usize) -> Result<(), Error> {
    if got == wanted {
        return Ok(());
    }
    Err(Error::Length {
        name,
        expected: format!("{wanted}"),
        got,
    })
}

/// Cuts lanes and results into blocks and runs them over all threads. A result that nobody wants is empty.
fn blocks(
    batch: Batch<'_>,
    drive: &Drive,
    phi: &mut [f64],
    speed: &mut [f64],
    summary: &mut [f64],
) -> Result<(), Error> {
    check(batch, drive)?;
    let block = block_for(batch.bodies.len());
    let count = batch.bodies.len().div_ceil(block);
    let effects = batch
        .bodies
        .iter()
        .fold(0, |bits, body| bits | body.effects());
    let samples = drive.samples();
    let places = cut(phi, block * samples, count)
        .into_iter()
        .zip(cut(speed, block * samples, count))
        .zip(cut(summary, block * SUMMARY.len(), count));
    let parts: Vec<Part<'_>> = places
        .enumerate()
        .map(|(number, ((phi, speed), summary))| {
            let first = number * block;
            let last = (first + block).min(batch.bodies.len());
            Part {
                bodies: &batch.bodies[first..last],
                starts: &batch.starts[first..last],
                drive,
                kernel: batch.kernel,
                effects,
                phi,
                speed,
                summary,
            }
        })
        .collect();
    parts.into_par_iter().for_each(|part| match block {
        SMALL => run(Task::<SMALL>(part), batch.width),
        MEDIUM => run(Task::<MEDIUM>(part), batch.width),
        _ => run(Task::<LARGE>(part), batch.width),
    });
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

pub(super) fn check(batch: Batch<'_>, drive: &Drive) -> Result<(), Error> {
    let lanes = batch.bodies.len();
    if lanes == 0 || batch.starts.len() != lanes {
        return Err(Error::Length {
            name: "starts",
            expected: format!("{lanes}, as many as bodies and at least one,"),
            got: batch.starts.len(),
        });
    }
    let wound = drive.reach_rad();
    for (body, start) in batch.bodies.iter().zip(batch.starts) {
        for (name, value) in [("start angle", start.phi), ("start speed", start.speed)] {
            if !value.is_finite() {
                return Err(Error::NonFinite {
                    name,
                    index: 0,
                    value,
                });
            }
        }
        if batch.kernel == Kernel::MoreauJean && body.bristle.acts() {
            return Err(Error::OutOfRange {
                name: "presliding_breakaway_rad",
                value: 1.0 / body.bristle.per_travel,
                interval: "{0} with moreau_jean, whose contact is rigid: take split".to_owned(),
            });
        }
        let frequency = body.highest_frequency_rad_s(wound + body.ratio * start.phi.abs());
        let longest = 2.0 / frequency;
        if drive.step_s() >= longest {
            let spring = body.stiffest_spring(wound + body.ratio * start.phi.abs());
            return Err(Error::OutOfRange {
                name: "step (seconds)",
                value: drive.step_s(),
                interval: format!(
                    "(0, {longest:.3e}) for the spring {spring}: give more substeps or a higher sample rate"
                ),
            });
        }
    }
    Ok(())
}

/// What a block works on.
struct Part<'a> {
    bodies: &'a [OneMass<f64>],
    starts: &'a [Start],
    drive: &'a Drive,
    kernel: Kernel,
    effects: usize,
    phi: &'a mut [f64],
    speed: &'a mut [f64],
    summary: &'a mut [f64],
}

/// One block of `N` lanes.
struct Task<'a, const N: usize>(Part<'a>);

/// Runs a block with the instruction set asked for; one that the processor lacks gives way to the next below.
fn run<const N: usize>(task: Task<'_, N>, width: Width) {
    #[cfg(any(target_arch = "x86", target_arch = "x86_64"))]
    {
        use pulp::Simd;
        if matches!(width, Width::Widest | Width::Avx512)
            && let Some(simd) = pulp::x86::V4::try_new()
        {
            return Simd::vectorize(simd, task);
        }
        if width != Width::Baseline
            && let Some(simd) = pulp::x86::V3::try_new()
        {
            return Simd::vectorize(simd, task);
        }
    }
    let _ = width;
    task.with_simd(pulp::Scalar::new());
}

impl<const N: usize> WithSimd for Task<'_, N> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: pulp::Simd>(self, _simd: S) {
        let (kernel, effects) = (self.0.kernel, self.0.effects);
        choose(kernel, effects, self);
    }
}

impl<const N: usize> WithKernel for Task<'_, N> {
    type Output = ();

    #[inline(always)]
    fn with<A: Advance>(self) {
        let part = self.0;
        let samples = part.drive.samples();
        let lanes = Lanes::<N>::new(part.bodies, Pure(part.drive.step_s()));
        let mut state = State::<N>::new(part.starts);
        let mut angles = Tile::<N>::new(part.phi, part.bodies.len(), samples);
        let mut speeds = Tile::<N>::new(part.speed, part.bodies.len(), samples);
        let (mut peak, mut squares, mut rest) = ([0.0; N], [0.0; N], [0.0; N]);
        for sample in 0..samples {
            let State { phi, v, .. } = &state;
            angles.take(sample, phi);
            speeds.take(sample, v);
            if !part.summary.is_empty() {
                for lane in 0..N {
                    let size = Pure(phi[lane]).abs();
                    peak[lane] = size.when(size.0 > peak[lane], Pure(peak[lane])).0;
                    squares[lane] += phi[lane] * phi[lane];
                    rest[lane] += Pure::ONE.when(v[lane] == 0.0, Pure::ZERO).0;
                }
            }
            if sample + 1 == samples {
                break;
            }
            for sub in 0..part.drive.substeps() {
                let span = part.drive.span(sample * part.drive.substeps() + sub);
                A::advance(&lanes, |_| span, &mut state);
            }
        }
        let State { phi, v, .. } = &state;
        for (lane, kept) in part.summary.chunks_exact_mut(SUMMARY.len()).enumerate() {
            let n = samples as f64;
            kept.copy_from_slice(&[
                phi[lane],
                v[lane],
                peak[lane],
                (squares[lane] / n).sqrt(),
                rest[lane] / n,
            ]);
        }
    }
}
