//! One run with everything that happened in it.

use crate::Error;

use super::box_qp::Method;
use super::channels::Channels;
use super::contacts::Contacts;
use super::engine::{Engine, Watch};
use super::forces::Plan;
use super::ledger::{Books, Ledger};
use super::network::Network;
use super::smooth::{State, Stretch};
use super::stability::require_short;

pub use crate::dynamics::EventKind;

/// One event.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Event {
    /// Seconds since the start.
    pub time_s: f64,
    /// The element at which it happened.
    pub element: usize,
    /// What happened: frictions stick, slip and reverse, gaps touch and release.
    pub kind: EventKind,
    /// Direction of the motion that follows, or the side that touches; 0 where nothing moves.
    pub direction: f64,
}

/// What [`trace`] returns. Tables are row by row, one row per body, driven node or element.
#[derive(Debug, Clone, PartialEq)]
pub struct Trace {
    /// Places of the bodies, rad or m.
    pub place: Vec<f64>,
    /// Their speeds.
    pub speed: Vec<f64>,
    /// The torque along each element; of assistance, the torque that it puts out.
    pub torque: Vec<f64>,
    /// The elements that are frictions and can resist.
    pub frictions: Vec<usize>,
    /// For each of those: 0 where it holds, else the direction in which it slides.
    pub modes: Vec<i8>,
    /// Samples at which the torques of the frictions that hold are not unique.
    pub redundant: Vec<bool>,
    /// What happened, in order.
    pub events: Vec<Event>,
    /// Steps in which more happened than can be located: first order, by Moreau and Jean.
    pub crowded_steps: usize,
    /// Where the energy went.
    pub ledger: Ledger,
}

/// Looks on and writes down.
struct Scribe {
    events: Vec<Event>,
    books: Books,
    /// Seconds at the start of the present step, and its length.
    time_s: f64,
    h: f64,
    frictions: Vec<usize>,
    crowded_steps: usize,
}

impl Watch for Scribe {
    fn stretch(&mut self, plan: &Plan, from: &State, to: &State, stretch: &Stretch<'_>) {
        self.books.book(plan, from, to, stretch);
        for spring in plan.springs.iter().filter(|s| s.half_gap > 0.0) {
            let beyond = |state: &State| spring.pair.of(&state.place).abs() - spring.half_gap;
            let (before, after) = (beyond(from), beyond(to));
            if (before > 0.0) != (after > 0.0) {
                let share = before / (before - after);
                let at = stretch.from + share * (stretch.to - stretch.from);
                self.events.push(Event {
                    time_s: self.time_s + at * self.h,
                    element: spring.element,
                    kind: if after > 0.0 {
                        EventKind::Contact
                    } else {
                        EventKind::Release
                    },
                    direction: spring.pair.of(&to.place).signum(),
                });
            }
        }
    }

    fn crowded(&mut self) {
        self.crowded_steps += 1;
    }

    fn change(&mut self, friction: usize, from: i8, to: i8, share: f64) {
        let element = self.frictions[friction];
        let time_s = self.time_s + share * self.h;
        // A friction that was let go at this very instant and did not start was never let go.
        let last = self.events.iter().rposition(|e| e.element == element);
        if let Some(last) = last
            && to == 0
            && self.events[last].time_s == time_s
        {
            match self.events[last].kind {
                EventKind::Slip => {
                    self.events.remove(last);
                    return;
                }
                EventKind::Reversal => {
                    self.events[last].kind = EventKind::Stick;
                    self.events[last].direction = 0.0;
                    return;
                }
                _ => {}
            }
        }
        let kind = match (from, to) {
            (0, _) => EventKind::Slip,
            (_, 0) => EventKind::Stick,
            _ => EventKind::Reversal,
        };
        self.events.push(Event {
            time_s,
            element,
            kind,
            direction: f64::from(to),
        });
    }
}

/// Runs a mechanism along its channels, from places and speeds of its bodies.
///
/// # Errors
/// [`Error::Mechanism`] for a step that the springs do not allow (naming the spring and the longest step) or a motion
/// that grows beyond all bounds (naming the instant); [`Error::Length`] for a start of the wrong length.
pub fn trace(
    network: &Network,
    place: &[f64],
    speed: &[f64],
    channels: &Channels,
    method: Method,
) -> Result<Trace, Error> {
    require_short(network, channels.step_s())?;
    require_start(network, place, speed)?;
    let plan = Plan::new(network);
    let (bodies, elements) = (plan.bodies, network.elements().len());
    let samples = channels.samples();
    let frictions: Vec<usize> = plan.frictions.iter().map(|f| f.element).collect();
    let mut scribe = Scribe {
        events: Vec::new(),
        books: Books::new(&plan, elements, || Contacts::new(&plan, method)),
        time_s: 0.0,
        h: channels.step_s(),
        frictions: frictions.clone(),
        crowded_steps: 0,
    };
    let mut engine = Engine::new(plan, channels.step_s(), method);
    channels.read(0, &mut engine.span);
    engine.start(place, speed);
    scribe.books.open(&engine.plan, &engine.state);
    let mut out = Trace {
        place: vec![0.0; bodies * samples],
        speed: vec![0.0; bodies * samples],
        torque: vec![0.0; elements * samples],
        modes: vec![0; frictions.len() * samples],
        redundant: vec![false; samples],
        frictions,
        events: Vec::new(),
        crowded_steps: 0,
        ledger: Ledger::default(),
    };
    let mut torque = vec![0.0; elements];
    for sample in 0..samples {
        for i in 0..bodies {
            out.place[i * samples + sample] = engine.state.place[i];
            out.speed[i * samples + sample] = engine.state.speed[i];
        }
        for (i, mode) in engine.state.modes.iter().enumerate() {
            out.modes[i * samples + sample] = *mode;
        }
        out.redundant[sample] = engine.redundant();
        engine.torques(if sample == 0 { 0.0 } else { 1.0 }, &mut torque);
        for (row, torque) in torque.iter().enumerate() {
            out.torque[row * samples + sample] = *torque;
        }
        if sample + 1 == samples {
            break;
        }
        for sub in 0..channels.substeps() {
            let number = sample * channels.substeps() + sub;
            scribe.time_s = number as f64 * channels.step_s();
            channels.read(number, &mut engine.span);
            engine.step(&mut scribe);
        }
        require_bounded(&engine.state, scribe.time_s + scribe.h)?;
    }
    scribe.books.close(&engine.plan, &engine.state);
    scribe.events.sort_by(|a, b| a.time_s.total_cmp(&b.time_s));
    out.events = scribe.events;
    out.crowded_steps = scribe.crowded_steps;
    out.ledger = scribe.books.ledger;
    Ok(out)
}

/// Refuses a start that does not fit the bodies or is not finite.
pub(super) fn require_start(network: &Network, place: &[f64], speed: &[f64]) -> Result<(), Error> {
    for (name, values) in [("start", place), ("start_speed", speed)] {
        if values.len() != network.bodies().len() {
            return Err(Error::Length {
                name,
                expected: format!("{}, one per body,", network.bodies().len()),
                got: values.len(),
            });
        }
        if let Some(i) = values.iter().position(|v| !v.is_finite()) {
            return Err(Error::Mechanism {
                place: network.bodies()[i].name.clone(),
                problem: format!("its {name} is {}", values[i]),
                remedy: "Give a finite number.".to_owned(),
            });
        }
    }
    Ok(())
}

/// Refuses to go on from a state that is not finite.
pub(super) fn require_bounded(state: &State, time_s: f64) -> Result<(), Error> {
    if state
        .place
        .iter()
        .chain(&state.speed)
        .all(|v| v.is_finite())
    {
        return Ok(());
    }
    Err(Error::Mechanism {
        place: format!("t = {time_s:.6} s"),
        problem: "the motion grows beyond all bounds".to_owned(),
        remedy:
            "Step shorter where a spring hardens, or look for assistance that drives the motion."
                .to_owned(),
    })
}
