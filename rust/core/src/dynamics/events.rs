//! What happens along a trajectory: stick, slip, reversal, contact, release.

use super::number::Pure;
use super::one_mass::OneMass;
use super::split::Step;

/// What happened.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum EventKind {
    /// The body came to rest and is held.
    Stick,
    /// It broke away from rest.
    Slip,
    /// It turned around without being held.
    Reversal,
    /// The gap closed: the handwheel spring takes hold.
    Contact,
    /// The gap opened.
    Release,
}

impl EventKind {
    /// All of them, in the order in which they are counted.
    pub const ALL: [Self; 5] = [
        Self::Stick,
        Self::Slip,
        Self::Reversal,
        Self::Contact,
        Self::Release,
    ];

    /// The word used in results.
    #[must_use]
    pub const fn word(self) -> &'static str {
        match self {
            Self::Stick => "stick",
            Self::Slip => "slip",
            Self::Reversal => "reversal",
            Self::Contact => "contact",
            Self::Release => "release",
        }
    }
}

/// One event.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Event {
    /// Seconds since the start.
    pub time_s: f64,
    /// What happened.
    pub kind: EventKind,
    /// Direction of the motion that follows, or of the side that touches; 0 where the body stays.
    pub direction: f64,
}

/// How far the handwheel is beyond its gap, rad; negative inside it.
pub(super) fn beyond_gap(body: &OneMass<Pure>, psi: f64, phi: Pure) -> f64 {
    (psi - body.ratio.0 * phi.0).abs() - 0.5 * body.gap.0
}

/// What friction did within one sub-step; both the list and the counts of events are made of it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Turns {
    /// Came to rest.
    pub stick: bool,
    /// Broke away, at once or after having come to rest.
    pub slip: bool,
    /// Turned around without being held.
    pub reversal: bool,
}

impl Turns {
    /// Of a sub-step that started with speed `v`.
    #[inline(always)]
    pub fn of(v: Pure, step: &Step) -> Self {
        let (moved, moves) = (v.0 != 0.0, step.speed.0 != 0.0);
        let turned = moved & (step.moving.0 < 1.0);
        let held = turned & (step.stuck.0 > 0.0);
        Self {
            stick: (moved & !moves) | held,
            slip: moves & (!moved | held),
            // A step that locates nothing shows a reversal by the sign of the speed alone.
            reversal: moved & moves & !held & (turned | ((v * step.speed).0 < 0.0)),
        }
    }
}

/// Writes the events of one sub-step that started at `time_s` with speed `v`.
pub(super) fn friction_events(out: &mut Vec<Event>, time_s: f64, h: f64, v: Pure, step: &Step) {
    let turns = Turns::of(v, step);
    let turned = time_s + step.moving.0 * h;
    let left = turned + step.stuck.0 * h;
    let after = step.speed.sign().0;
    for (happened, time_s, kind, direction) in [
        (turns.stick, turned, EventKind::Stick, 0.0),
        (turns.slip, left, EventKind::Slip, after),
        (turns.reversal, turned, EventKind::Reversal, after),
    ] {
        if happened {
            out.push(Event {
                time_s,
                kind,
                direction,
            });
        }
    }
}

/// Writes the event of a gap whose state went from `before` to `after` (see [`beyond_gap`]) within a sub-step.
pub(super) fn gap_event(
    out: &mut Vec<Event>,
    time_s: f64,
    h: f64,
    (before, after): (f64, f64),
    side: f64,
) {
    if (before > 0.0) == (after > 0.0) {
        return;
    }
    let kind = if after > 0.0 {
        EventKind::Contact
    } else {
        EventKind::Release
    };
    out.push(Event {
        time_s: time_s + h * before / (before - after),
        kind,
        direction: side,
    });
}
