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
    /// Places of the bodies at the start.
    pub place: &'a [f64],
    /// Their speeds.
    pub speed: &'a [f64],
}

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
    let width = lanes.network.parameters().len();
    let count = lanes.values.len() / width;
    let size = lanes.network.bodies().len() * channels.samples();
    for (name, got, expected) in [
        ("values", lanes.values.len(), count * width),
        ("place", place.len(), count * size),
        ("speed", speed.len(), count * size),
    ] {
        if got != expected || count == 0 {
            return Err(Error::Length {
                name,
                expected: format!("{expected}"),
                got,
            });
        }
    }
    let failed: Option<(usize, Error)> = lanes
        .values
        .par_chunks(width)
        .zip(place.par_chunks_mut(size))
        .zip(speed.par_chunks_mut(size))
        .enumerate()
        .filter_map(|(lane, ((values, place), speed))| {
            let one = run(&lanes, values, channels, place, speed);
            one.err().map(|error| (lane, error))
        })
        .min_by_key(|(lane, _)| *lane);
    match failed {
        None => Ok(()),
        Some((
            lane,
            Error::Mechanism {
                place,
                problem,
                remedy,
            },
        )) => Err(Error::Mechanism {
            place: format!("lane {lane}, {place}"),
            problem,
            remedy,
        }),
        Some((_, error)) => Err(error),
    }
}

fn run(
    lanes: &Lanes<'_>,
    values: &[f64],
    channels: &Channels,
    place: &mut [f64],
    speed: &mut [f64],
) -> Result<(), Error> {
    let network = lanes.network.with_values(values)?;
    require_short(&network, channels.step_s())?;
    require_start(&network, lanes.place, lanes.speed)?;
    let mut engine = Engine::new(Plan::new(&network), channels.step_s(), Method::ActiveSet);
    channels.read(0, &mut engine.span);
    engine.start(lanes.place, lanes.speed);
    let samples = channels.samples();
    for sample in 0..samples {
        for i in 0..engine.plan.bodies {
            place[i * samples + sample] = engine.state.place[i];
            speed[i * samples + sample] = engine.state.speed[i];
        }
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
