//! Many parameter sets side by side, driven by one record.
//!
//! Lanes lie next to each other in blocks; the loop over the lanes of a block holds nothing but arithmetic and selects,
//! so that the compiler turns it into vector instructions. Which ones is decided at run time. Every lane goes through
//! the same operations in the same order whatever its neighbours, the block or the thread, and nothing is fused: the
//! bits are the same everywhere.

use pulp::WithSimd;
use rayon::prelude::*;

use crate::Error;

use super::control::Control;
use super::drive::Drive;
use super::keep::Keep;
use super::lane_check::check_lanes;
use super::lane_drives::LaneDrives;
use super::march::{Advance, Lanes, State, WithKernel, choose};
use super::number::Pure;
use super::observe::{Places, Samples};
use super::one_mass::OneMass;
use super::watched::Watched;
use super::width::{Width, run};

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

/// Lanes of a block where there are many: their states stay in the first-level cache.
const LARGE: usize = 64;
/// Smaller ones keep every thread busy where there are few: four vectors of the widest kind, or one.
const MEDIUM: usize = 32;
/// See [`MEDIUM`].
const SMALL: usize = 8;

/// Sub-steps between two looks whether to stop, where a sampling interval has many: a tenth of a millisecond.
pub(super) const LOOK: usize = 512;

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

/// What drives the lanes.
#[derive(Debug, Clone, Copy)]
pub enum Drives<'a> {
    /// One record for all.
    Shared(&'a Drive),
    /// Every lane has its own.
    Own(&'a LaneDrives<'a>),
}

impl Drives<'_> {
    pub(super) fn samples(&self) -> usize {
        match self {
            Self::Shared(drive) => drive.samples(),
            Self::Own(drives) => drives.samples(),
        }
    }

    pub(super) fn substeps(&self) -> usize {
        match self {
            Self::Shared(drive) => drive.substeps(),
            Self::Own(drives) => drives.substeps(),
        }
    }

    pub(super) fn step_s(&self) -> f64 {
        match self {
            Self::Shared(drive) => drive.step_s(),
            Self::Own(drives) => drives.step_s(),
        }
    }
}

/// Where the results of a batch go; what nobody wants is empty.
#[derive(Debug, Default)]
pub struct Results<'a> {
    /// Angles, rad: the samples of each lane one after the other, lane by lane.
    pub phi: &'a mut [f64],
    /// Speeds, rad/s, likewise.
    pub speed: &'a mut [f64],
    /// One row per lane, as [`Keep`] says.
    pub rows: &'a mut [f64],
    /// Set where a lane is finished; those of a batch that was stopped are not all.
    pub done: &'a mut [bool],
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
    length("phi", phi.len(), batch.bodies.len() * drive.samples())?;
    let results = Results {
        phi,
        speed,
        ..Results::default()
    };
    let control = Control::default();
    run_lanes(
        batch,
        Drives::Shared(drive),
        &Keep::default(),
        results,
        &control,
    )
}

/// Runs every lane along its drive and keeps what is asked for. A batch that `control` stops returns early; `done`
/// tells what is finished then.
///
/// # Errors
/// As [`simulate`], and for samples to keep that are not there.
pub fn run_lanes(
    batch: Batch<'_>,
    drives: Drives<'_>,
    keep: &Keep,
    results: Results<'_>,
    control: &Control,
) -> Result<(), Error> {
    let (lanes, samples) = (batch.bodies.len(), drives.samples());
    keep.check(samples)?;
    let Results {
        phi,
        speed,
        rows,
        done,
    } = results;
    for (name, got, each) in [
        ("phi", phi.len(), samples),
        ("speed", speed.len(), samples),
        ("rows", rows.len(), keep.width(samples)),
        ("done", done.len(), 1),
    ] {
        if got > 0 {
            length(name, got, lanes * each)?;
        }
    }
    check_lanes(batch.bodies, batch.starts, drives, batch.kernel, 0)?;
    let watched = keep.watches_steps() || matches!(drives, Drives::Own(_));
    // What is looked at inside of the steps costs more than small blocks do.
    let block = if watched { MEDIUM } else { block_for(lanes) };
    let count = lanes.div_ceil(block);
    let effects = batch
        .bodies
        .iter()
        .fold(0, |bits, body| bits | body.effects());
    let places = cut(phi, block * samples, count)
        .zip(cut(speed, block * samples, count))
        .zip(cut(rows, block * keep.width(samples), count))
        .zip(cut(done, block, count));
    let parts: Vec<Part<'_>> = places
        .enumerate()
        .map(|(number, (((phi, speed), rows), done))| {
            let first = number * block;
            let last = (first + block).min(lanes);
            Part {
                bodies: &batch.bodies[first..last],
                starts: &batch.starts[first..last],
                first,
                drives,
                kernel: batch.kernel,
                effects,
                keep,
                control,
                places: Places {
                    phi,
                    speed,
                    rows,
                    done,
                },
            }
        })
        .collect();
    parts
        .into_par_iter()
        .for_each(|part| match (part.drives, block) {
            _ if control.stopped() => {}
            (Drives::Shared(_), _) if watched => run(Watched::<true, MEDIUM>(part), batch.width),
            (Drives::Own(_), _) if keep.watches_steps() => {
                run(Watched::<true, MEDIUM>(part), batch.width);
            }
            (Drives::Own(_), _) => run(Watched::<false, MEDIUM>(part), batch.width),
            (Drives::Shared(drive), SMALL) => run(Task::<SMALL>(part, drive), batch.width),
            (Drives::Shared(drive), MEDIUM) => run(Task::<MEDIUM>(part, drive), batch.width),
            (Drives::Shared(drive), _) => run(Task::<LARGE>(part, drive), batch.width),
        });
    Ok(())
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

/// The places of the blocks in a result; empty ones where the result is.
fn cut<T>(result: &mut [T], size: usize, count: usize) -> impl Iterator<Item = &mut [T]> {
    result
        .chunks_mut(size.max(1))
        .chain(std::iter::repeat_with(Default::default))
        .take(count)
}

/// What a block works on.
pub(super) struct Part<'a> {
    pub bodies: &'a [OneMass<f64>],
    pub starts: &'a [Start],
    /// The number of its first lane.
    pub first: usize,
    pub drives: Drives<'a>,
    pub kernel: Kernel,
    pub effects: usize,
    pub keep: &'a Keep,
    pub control: &'a Control,
    pub places: Places<'a>,
}

/// One block of `N` lanes along one drive.
struct Task<'a, const N: usize>(Part<'a>, &'a Drive);

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
        let (part, drive) = (self.0, self.1);
        let samples = drive.samples();
        let lanes = Lanes::<N>::new(part.bodies, Pure(drive.step_s()));
        let mut state = State::<N>::new(part.starts);
        let mut seen = Samples::<N>::new(part.places, part.keep, part.bodies.len(), samples);
        for sample in 0..samples {
            seen.take(sample, &state);
            if sample + 1 == samples {
                break;
            }
            for sub in 0..drive.substeps() {
                if sub.is_multiple_of(LOOK) && part.control.stopped() {
                    return;
                }
                let span = drive.span(sample * drive.substeps() + sub);
                A::advance(&lanes, |_| span, &mut state);
            }
        }
        seen.finish(&state, |_, _, _| {});
        part.control.add(part.bodies.len());
    }
}
