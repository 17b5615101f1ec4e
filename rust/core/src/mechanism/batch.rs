//! Many parameter sets of one structure, over all threads. Each lane is a run of its own: the bits do not depend on the
//! number of threads.

use rayon::prelude::*;

use crate::Error;

use super::box_qp::Method;
use super::channels::Channels;
use super::engine::{Engine, Nobody};
use super::forces::Plan;
use super::network::Network;
use super::stability::require_short;
use super::trace::{require_bounded, require_start};

/// What to run: one row of [`Network::parameters`] per lane, one start for all.
#[derive(Debug, Clone, Copy)]
pub struct Lanes<'a> {
    /// The structure.
    pub network: &'a Network,
    /// Rows of values, one after the other.
    pub values: &'a [f64],
    /// The number of the first lane, for errors.
    pub first: usize,
    /// Places of the bodies at the start.
    pub place: &'a [f64],
    /// Their speeds.
    pub speed: &'a [f64],
}

/// What [`summarise`] keeps of each body of a lane.
pub const SUMMARY: [&str; 5] = ["last", "last_speed", "peak", "rms", "at_rest_share"];

/// Runs every lane. `place` and `speed` take the samples lane by lane, in each body by body.
///
/// # Errors
/// As [`super::trace`], for the first lane that is refused, with its number; [`Error::Length`] for results of the wrong
/// length.
pub fn simulate(
    lanes: Lanes<'_>,
    channels: &Channels,
    place: &mut [f64],
    speed: &mut [f64],
) -> Result<(), Error> {
    let samples = channels.samples();
    let bodies = lanes.network.bodies().len();
    let (width, size) = require_lengths(&lanes, bodies * samples, &[place.len(), speed.len()])?;
    let parts = lanes
        .values
        .par_chunks(width)
        .zip(place.par_chunks_mut(size))
        .zip(speed.par_chunks_mut(size))
        .enumerate();
    first_failure(
        lanes.first,
        parts.filter_map(|(lane, ((values, place), speed))| {
            let done = run(&lanes, values, channels, |sample, places, speeds| {
                for i in 0..bodies {
                    place[i * samples + sample] = places[i];
                    speed[i * samples + sample] = speeds[i];
                }
            });
            done.err().map(|error| (lane, error))
        }),
    )
}

/// Runs every lane and keeps [`SUMMARY`] of each body only, lane by lane: memory does not grow with the record.
///
/// # Errors
/// As [`simulate`].
pub fn summarise(lanes: Lanes<'_>, channels: &Channels, out: &mut [f64]) -> Result<(), Error> {
    let bodies = lanes.network.bodies().len();
    let (width, size) = require_lengths(&lanes, bodies * SUMMARY.len(), &[out.len()])?;
    let parts = lanes
        .values
        .par_chunks(width)
        .zip(out.par_chunks_mut(size))
        .enumerate();
    let samples = channels.samples() as f64;
    first_failure(
        lanes.first,
        parts.filter_map(|(lane, (values, out))| {
            out.fill(0.0);
            let done = run(&lanes, values, channels, |_, places, speeds| {
                for (i, kept) in out.chunks_exact_mut(SUMMARY.len()).enumerate() {
                    kept[0] = places[i];
                    kept[1] = speeds[i];
                    kept[2] = kept[2].max(places[i].abs());
                    kept[3] += places[i] * places[i];
                    kept[4] += f64::from(u8::from(speeds[i] == 0.0));
                }
            });
            for kept in out.chunks_exact_mut(SUMMARY.len()) {
                kept[3] = (kept[3] / samples).sqrt();
                kept[4] /= samples;
            }
            done.err().map(|error| (lane, error))
        }),
    )
}

/// Checks the lengths of the results; returns the numbers of one lane, in and out.
fn require_lengths(
    lanes: &Lanes<'_>,
    size: usize,
    results: &[usize],
) -> Result<(usize, usize), Error> {
    let width = lanes.network.parameters().len();
    let count = lanes.values.len() / width;
    let refuse = |name, expected: usize, got| {
        Err(Error::Length {
            name,
            expected: format!("{expected}"),
            got,
        })
    };
    if count == 0 || lanes.values.len() != count * width {
        return refuse("values", count.max(1) * width, lanes.values.len());
    }
    match results.iter().find(|got| **got != count * size) {
        Some(got) => refuse("results", count * size, *got),
        None => Ok((width, size)),
    }
}

/// The failure of the lowest lane, with its number.
fn first_failure(
    first: usize,
    failures: impl ParallelIterator<Item = (usize, Error)>,
) -> Result<(), Error> {
    match failures.min_by_key(|(lane, _)| *lane) {
        None => Ok(()),
        Some((
            lane,
            Error::Mechanism {
                place,
                problem,
                remedy,
            },
        )) => Err(Error::Mechanism {
            place: format!("lane {}, {place}", first + lane),
            problem,
            remedy,
        }),
        Some((_, error)) => Err(error),
    }
}

/// One lane; `each` is called with every sample's number, places and speeds of the bodies.
fn run(
    lanes: &Lanes<'_>,
    values: &[f64],
    channels: &Channels,
    mut each: impl FnMut(usize, &[f64], &[f64]),
) -> Result<(), Error> {
    let network = lanes.network.with_values(values)?;
    require_short(&network, channels.step_s())?;
    require_start(&network, lanes.place, lanes.speed)?;
    let mut engine = Engine::new(Plan::new(&network), channels.step_s(), Method::ActiveSet);
    channels.read(0, &mut engine.span);
    engine.start(lanes.place, lanes.speed);
    let samples = channels.samples();
    for sample in 0..samples {
        each(sample, &engine.state.place, &engine.state.speed);
        if sample + 1 == samples {
            break;
        }
        for sub in 0..channels.substeps() {
            channels.read(sample * channels.substeps() + sub, &mut engine.span);
            engine.step(&mut Nobody);
        }
        let time_s = ((sample + 1) * channels.substeps()) as f64 * channels.step_s();
        require_bounded(&engine.state, time_s)?;
    }
    Ok(())
}
