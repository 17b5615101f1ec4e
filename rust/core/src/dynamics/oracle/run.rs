//! From event to event.

use crate::Error;
use crate::error::{require_finite, require_same_length};

use super::super::events::EventKind;
use super::super::lanes::Start;
use super::crossing::first_crossing;
use super::mode::{Mode, State, Stretch};
use super::series::Series;
use super::signal::{Instant, Signal};
use super::system::System;

/// One event.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ExactEvent {
    /// When.
    pub time_s: f64,
    /// What happened.
    pub kind: EventKind,
    /// Of the body for stick, slip and reversal, of the spring for contact and release.
    pub element: usize,
    /// Direction of the sliding that follows, or of the side that touches; 0 where the body stays.
    pub direction: i8,
    /// Angle of the body, or of the spring's driven end less its other end.
    pub angle: f64,
}

/// What [`exact`] returns.
#[derive(Debug, Clone, PartialEq)]
pub struct Exact {
    /// Angles at the times asked for, body by body.
    pub angle: Vec<Vec<f64>>,
    /// Speeds.
    pub speed: Vec<Vec<f64>>,
    /// What happened, in order.
    pub events: Vec<ExactEvent>,
}

/// What ends a mode.
#[derive(Debug, Clone, Copy, PartialEq)]
enum End {
    /// A sliding body comes to rest on its ground.
    Rest(usize),
    /// The torque on a held body passes its limit to a side.
    Slip(usize, i8),
    /// The spring's end reaches the edge of the gap, from inside to a side or from a side.
    Gap(usize, i8),
}

/// Runs a mechanism from `times_s[0]` and returns it at the times.
///
/// # Errors
/// Those of [`Run::new`] and [`Run::advance`].
pub fn exact(
    system: &System,
    starts: &[Start],
    times_s: &[f64],
    most_events: usize,
) -> Result<Exact, Error> {
    let mut run = Run::new(system, starts, times_s, most_events)?;
    while !run.advance(usize::MAX)? {}
    Ok(run.finish())
}

/// A run that can be advanced a little at a time, so that the caller may look up in between.
#[derive(Debug)]
pub struct Run<'a> {
    system: &'a System,
    times_s: &'a [f64],
    most_events: usize,
    now: Instant,
    state: State,
    mode: Mode<'a>,
    /// What has just ended the mode before.
    just: Option<End>,
    /// The longest stretch so far, s.
    longest: f64,
    out: Exact,
}

impl<'a> Run<'a> {
    /// A run from `times_s[0]`.
    ///
    /// # Errors
    /// [`Error::Length`] where there are not as many starts as bodies, or no time; [`Error::NonFinite`];
    /// [`Error::OutOfRange`] for times that decrease.
    pub fn new(
        system: &'a System,
        starts: &[Start],
        times_s: &'a [f64],
        most_events: usize,
    ) -> Result<Self, Error> {
        let now = Instant::at(check(system, starts, times_s)?);
        let state = State {
            angle: starts.iter().map(|s| s.phi).collect(),
            speed: starts.iter().map(|s| s.speed).collect(),
        };
        let columns = vec![Vec::with_capacity(times_s.len()); starts.len()];
        Ok(Self {
            system,
            times_s,
            most_events,
            now,
            mode: Mode::of(system, now, &state),
            state,
            just: None,
            longest: 0.0,
            out: Exact {
                angle: columns.clone(),
                speed: columns,
                events: Vec::new(),
            },
        })
    }

    /// Goes on for at most so many stretches; whether the last time is reached.
    ///
    /// # Errors
    /// [`Error::TooMany`] beyond the events allowed, [`Error::Unrepresentable`] where the motion grows without bound.
    pub fn advance(&mut self, stretches: usize) -> Result<bool, Error> {
        let last = self.times_s[self.times_s.len() - 1];
        for _ in 0..stretches {
            if self.now.until(last) <= 0.0 {
                return Ok(true);
            }
            self.stretch(last)?;
        }
        Ok(false)
    }

    /// What was told at the times; those that were not reached bear the last state.
    #[must_use]
    pub fn finish(mut self) -> Exact {
        for _ in self.told()..self.times_s.len() {
            self.out.tell(&self.state);
        }
        self.out
    }

    /// How many of the times have been told.
    fn told(&self) -> usize {
        self.out.angle[0].len()
    }

    /// One stretch: to the next event, break of a drive or end of what the series can tell.
    fn stretch(&mut self, last: f64) -> Result<(), Error> {
        let (system, now) = (self.system, self.now);
        let breaks = system.signals().filter_map(|s: &Signal| s.next_break(now));
        let stop = breaks.fold(last, f64::min);
        let to_stop = now.until(stop);
        let readable = 1.0 / self.mode.rate_rad_s();
        let length = to_stop.min(readable);
        let stretch = self.mode.stretch(now, &self.state);
        let doubt = readable.min(self.longest);
        let end = first_end(system, &self.mode, &stretch, (length, doubt), self.just);
        self.longest = self.longest.max(length);
        let reached = end.map_or(length, |(seconds, _)| seconds);
        while let Some(time_s) = self.times_s.get(self.told())
            && now.until(*time_s) < reached
        {
            self.out
                .tell(&stretch.state(&self.mode, now.until(*time_s)));
        }
        self.state = stretch.state(&self.mode, reached);
        let mut values = self.state.angle.iter().chain(&self.state.speed);
        if !values.all(|v| v.is_finite()) {
            return Err(Error::Unrepresentable { name: "motion" });
        }
        self.now = if end.is_none() && length == to_stop {
            Instant::at(stop)
        } else {
            now.after(reached)
        };
        self.just = end.map(|(_, end)| end);
        if let Some(end) = self.just {
            if self.out.events.len() == self.most_events {
                return Err(Error::TooMany {
                    what: "events",
                    most: self.most_events,
                    time_s: self.now.hi,
                });
            }
            let event = apply(system, &mut self.mode, self.now, &mut self.state, end);
            self.out.events.push(event);
        }
        Ok(())
    }
}

impl Exact {
    fn tell(&mut self, state: &State) {
        for (column, value) in self.angle.iter_mut().zip(&state.angle) {
            column.push(*value);
        }
        for (column, value) in self.speed.iter_mut().zip(&state.speed) {
            column.push(*value);
        }
    }
}

fn check(system: &System, starts: &[Start], times_s: &[f64]) -> Result<f64, Error> {
    let angles: Vec<f64> = starts.iter().map(|s| s.phi).collect();
    let speeds: Vec<f64> = starts.iter().map(|s| s.speed).collect();
    require_same_length("start", &angles, "inertia", system.count())?;
    require_finite("start_rad", &angles)?;
    require_finite("start_speed_rad_s", &speeds)?;
    require_finite("times_s", times_s)?;
    if let Some(pair) = times_s.windows(2).find(|pair| pair[1] < pair[0]) {
        return Err(Error::OutOfRange {
            name: "times_s",
            value: pair[1],
            interval: format!("[{}, inf): times do not decrease", pair[0]),
        });
    }
    times_s.first().copied().ok_or(Error::Length {
        name: "times_s",
        expected: "at least 1".to_owned(),
        got: 0,
    })
}

/// What ends the mode first within a stretch, and after how many seconds; its start is in doubt by the rounding of some.
fn first_end(
    system: &System,
    mode: &Mode,
    stretch: &Stretch,
    (length, doubt): (f64, f64),
    just: Option<End>,
) -> Option<(f64, End)> {
    let mut first: Option<(f64, End)> = None;
    let mut consider = |mut series: Series, end: End| {
        series.doubt(doubt);
        let within = first.map_or(length, |(seconds, _)| seconds);
        if let Some(seconds) = first_crossing(&series, within)
            && first.is_none_or(|(earliest, _)| seconds < earliest)
        {
            first = Some((seconds, end));
        }
    };
    for (i, body) in system.bodies.iter().enumerate() {
        let way = mode.way[i];
        if way == 0 {
            for (side, forward) in [(0, 1_i8), (1, -1)] {
                let mut left = Series::ZERO;
                left.add(0, &[body.held[side]]);
                left.add_times(-f64::from(forward), &stretch.torque[i]);
                consider(left, End::Slip(i, forward));
            }
            continue;
        }
        let mut sliding = Series::ZERO;
        sliding.add_times(f64::from(way), &stretch.angle[i].rate());
        if body.ground_speed != 0.0 {
            sliding.add(0, &[-f64::from(way) * body.ground_speed]);
        }
        if just == Some(End::Slip(i, way)) {
            // The instant of a break-away is that at which the limit was reached: its rounding must not stop the body.
            let side = usize::from(way < 0);
            let least = (body.held[side] - body.kinetic[side]) / body.inertia;
            sliding.value[0] = 0.0;
            sliding.value[1] = sliding.value[1].max(least);
        }
        consider(sliding, End::Rest(i));
    }
    for (j, spring) in system.springs.iter().enumerate() {
        if spring.half_gap == 0.0 {
            continue;
        }
        let fresh = matches!(just, Some(End::Gap(k, _)) if k == j);
        let side = mode.contact[j];
        let towards: &[i8] = if side == 0 { &[1, -1] } else { &[side] };
        for &way in towards {
            let mut left = Series::ZERO;
            // Inside the gap: what is left to its edge. Beyond: what is left to return to it.
            let inward = if side == 0 { -1.0 } else { 1.0 };
            left.add(0, &[-inward * spring.half_gap]);
            left.add_times(inward * f64::from(way), &stretch.wound[j]);
            if fresh && left.value[0].abs() < spring.half_gap {
                // It stands on the edge that it has just passed.
                left.value[0] = left.value[0].max(0.0);
            }
            consider(left, End::Gap(j, way));
        }
    }
    first
}

/// Changes the mode, and the state where it is known exactly.
fn apply(
    system: &System,
    mode: &mut Mode,
    now: Instant,
    state: &mut State,
    end: End,
) -> ExactEvent {
    let (element, kind, direction) = match end {
        End::Gap(j, side) => {
            let opened = mode.contact[j] != 0;
            mode.contact[j] = if opened { 0 } else { side };
            let kind = if opened {
                EventKind::Release
            } else {
                EventKind::Contact
            };
            (j, kind, side)
        }
        End::Slip(i, way) => {
            mode.way[i] = way;
            (i, EventKind::Slip, way)
        }
        End::Rest(i) => {
            mode.way[i] = 0;
            mode.assemble();
            state.speed[i] = system.bodies[i].ground_speed;
            let torque = &mode.stretch(now, state).torque[i];
            let (value, noise) = (torque.value[0], torque.noise());
            let [forward, backward] = system.bodies[i].held;
            mode.way[i] = i8::from(value > forward + noise) - i8::from(value < -backward - noise);
            let kind = if mode.way[i] == 0 {
                EventKind::Stick
            } else {
                EventKind::Reversal
            };
            (i, kind, mode.way[i])
        }
    };
    mode.assemble();
    let angle = if matches!(end, End::Gap(..)) {
        mode.stretch(now, state).wound[element].value[0]
    } else {
        state.angle[element]
    };
    ExactEvent {
        time_s: now.hi,
        kind,
        element,
        direction,
        angle,
    }
}
