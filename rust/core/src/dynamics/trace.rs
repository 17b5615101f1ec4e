//! One trajectory with everything that happened: samples, events, energies.

use crate::Error;

use super::drive::Drive;
use super::events::{Event, beyond_gap, friction_events, gap_event};
use super::lane_check::check_lanes;
use super::lanes::{Drives, Kernel, Start};
use super::ledger::{Ledger, entry};
use super::march::{Advance, MoreauJean, Split};
use super::number::Pure;
use super::one_mass::OneMass;
use super::split::Pace;

/// What [`trace`] returns.
#[derive(Debug, Clone, PartialEq)]
pub struct Trace {
    /// Road-wheel angle at the samples, rad.
    pub phi: Vec<f64>,
    /// Its speed, rad/s.
    pub speed: Vec<f64>,
    /// What happened, in order.
    pub events: Vec<Event>,
    /// Where the energy went.
    pub ledger: Ledger,
}

/// Runs one body along a drive, with the same bits as a lane of [`super::simulate`].
///
/// # Errors
/// As [`super::simulate`].
pub fn trace(
    body: &OneMass<f64>,
    start: Start,
    kernel: Kernel,
    drive: &Drive,
) -> Result<Trace, Error> {
    check_lanes(&[*body], &[start], Drives::Shared(drive))?;
    let rich = body.is_rich();
    let body = body.pure();
    let (mut phi, mut v) = (Pure(start.phi), Pure(start.speed));
    let h = drive.step_s();
    let pace = Pace::of(&body, Pure(h));
    let samples = drive.samples();
    let mut out = Trace {
        phi: Vec::with_capacity(samples),
        speed: Vec::with_capacity(samples),
        events: Vec::new(),
        ledger: Ledger::default(),
    };
    let (psi, _) = drive.span(0).start();
    out.ledger.stored_first = body.stored(psi, phi, v).0;
    let mut gap = beyond_gap(&body, psi.0, phi);
    for sample in 0..samples {
        out.phi.push(phi.0);
        out.speed.push(v.0);
        if sample + 1 == samples {
            break;
        }
        for sub in 0..drive.substeps() {
            let number = sample * drive.substeps() + sub;
            let span = drive.span(number);
            let time_s = number as f64 * h;
            let step = match (kernel, rich) {
                (Kernel::MoreauJean, _) => MoreauJean::step(&body, &span, pace, phi, v),
                (Kernel::Split, false) => Split::<false>::step(&body, &span, pace, phi, v),
                (Kernel::Split, true) => Split::<true>::step(&body, &span, pace, phi, v),
            };
            friction_events(&mut out.events, time_s, h, v, &step);
            if body.gap.0 > 0.0 {
                let (psi, _) = span.end();
                let next = beyond_gap(&body, psi.0, step.phi);
                let side = (psi - body.ratio * step.phi).sign().0;
                gap_event(&mut out.events, time_s, h, (gap, next), side);
                gap = next;
            }
            let drives = (span.start(), span.end());
            let booked = if rich {
                entry::<true>(&body, h, (phi, v), &step, drives)
            } else {
                entry::<false>(&body, h, (phi, v), &step, drives)
            };
            out.ledger.book(&booked);
            (phi, v) = (step.phi, step.speed);
        }
    }
    let (psi, _) = drive.span((samples - 1) * drive.substeps() - 1).end();
    out.ledger.stored_last = body.stored(psi, phi, v).0;
    out.ledger.turnover += out.ledger.stored_first;
    out.events.sort_by(|a, b| a.time_s.total_cmp(&b.time_s));
    Ok(out)
}
