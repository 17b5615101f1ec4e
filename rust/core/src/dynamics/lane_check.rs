//! What is refused before a batch runs: starts that are not finite, steps that a lane's springs do not allow.

use crate::Error;

use super::lanes::{Drives, Kernel, Start};
use super::one_mass::OneMass;

/// Refuses what a batch of these lanes, numbered from `first` on, would refuse.
///
/// # Errors
/// [`Error::Length`] without lanes or where bodies and starts differ in number, [`Error::NonFinite`] for a start,
/// [`Error::OutOfRange`] for a step that a spring does not allow; both name the lane.
pub fn check_lanes(
    bodies: &[OneMass<f64>],
    starts: &[Start],
    drives: Drives<'_>,
    kernel: Kernel,
    first: usize,
) -> Result<(), Error> {
    let lanes = bodies.len();
    if lanes == 0 || starts.len() != lanes {
        return Err(Error::Length {
            name: "starts",
            expected: format!("{lanes}, as many as bodies and at least one,"),
            got: starts.len(),
        });
    }
    let shared = match drives {
        Drives::Shared(drive) => drive.reach_rad(),
        Drives::Own(_) => 0.0,
    };
    for (lane, (body, start)) in bodies.iter().zip(starts).enumerate() {
        for (name, value) in [("start angle", start.phi), ("start speed", start.speed)] {
            if !value.is_finite() {
                return Err(Error::NonFinite {
                    name,
                    index: first + lane,
                    value,
                });
            }
        }
        if kernel == Kernel::MoreauJean && body.bristle.acts() {
            return Err(Error::OutOfRange {
                name: "presliding_breakaway_rad",
                value: 1.0 / body.bristle.per_travel,
                interval: "{0} with moreau_jean, whose contact is rigid: take split".to_owned(),
            });
        }
        let reach = match drives {
            Drives::Shared(_) => shared,
            // Only a hardening spring is stiffer the further it is wound up.
            Drives::Own(_) if body.hardening <= 0.0 => 0.0,
            Drives::Own(drives) => drives.reach_rad(lane),
        };
        check_step(
            body,
            drives.step_s(),
            reach + body.ratio * start.phi.abs(),
            first + lane,
        )?;
    }
    Ok(())
}

fn check_step(body: &OneMass<f64>, step_s: f64, wound_rad: f64, lane: usize) -> Result<(), Error> {
    let longest = 2.0 / body.highest_frequency_rad_s(wound_rad);
    if step_s < longest {
        return Ok(());
    }
    let spring = body.stiffest_spring(wound_rad);
    let where_it_is = if lane > 0 {
        format!(" of lane {lane}")
    } else {
        String::new()
    };
    Err(Error::OutOfRange {
        name: "step (seconds)",
        value: step_s,
        interval: format!(
            "(0, {longest:.3e}) for the spring {spring}{where_it_is}: give more substeps or a higher sample rate"
        ),
    })
}
