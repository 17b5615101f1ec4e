//! One step of a mechanism: smooth stretches between the events that are located inside it.
//!
//! As the step of one body ([`crate::dynamics`]): a reversal where the relative speed, a break-away where the held
//! torque crosses its limit, each located inside the step, so that events cost no order. What happens more often in
//! one step than frictions can in turn, is left to one step of Moreau and Jean: the cost is bounded.

use super::box_qp::Method;
use super::channels::Parabola;
use super::contacts::Contacts;
use super::forces::Plan;
use super::moreau::Moreau;
use super::rigid::Rigid;
use super::smooth::{Smooth, State, Stretch, drive};

/// Who looks on while a step is made.
pub(super) trait Watch {
    /// A stretch went from one state to another, the frictions in the modes of the first.
    fn stretch(&mut self, plan: &Plan, from: &State, to: &State, stretch: &Stretch<'_>);
    /// A friction changed its mode at a share of the step.
    fn change(&mut self, friction: usize, from: i8, to: i8, share: f64);
    /// More happened in the step than can be located.
    fn crowded(&mut self);
}

/// Nobody.
pub(super) struct Nobody;

impl Watch for Nobody {
    fn stretch(&mut self, _: &Plan, _: &State, _: &State, _: &Stretch<'_>) {}
    fn change(&mut self, _: usize, _: i8, _: i8, _: f64) {}
    fn crowded(&mut self) {}
}

/// What happens first in a stretch.
enum First {
    /// A friction's relative speed is 0.
    Stop(usize),
    /// What held breaks away.
    Break,
}

// Frictions that stop with another, as those of a left and a right wheel do: what is left of their relative speed, as
// a share of that at the start of the stretch.
const TOGETHER: f64 = 1e-6;

/// A mechanism in motion.
#[derive(Debug, Clone)]
pub(super) struct Engine {
    pub plan: Plan,
    pub state: State,
    pub span: Vec<Parabola>,
    pub h: f64,
    rigid: Rigid,
    smooth: Smooth,
    contacts: Contacts,
    moreau: Moreau,
    pinned: Vec<bool>,
    /// Modes before a decision.
    before: Vec<i8>,
}

impl Engine {
    pub fn new(plan: Plan, h: f64, method: Method) -> Self {
        let (nodes, c) = (plan.nodes(), plan.frictions.len());
        Self {
            state: State {
                place: vec![0.0; nodes],
                speed: vec![0.0; nodes],
                modes: vec![0; c],
            },
            span: vec![Parabola::default(); plan.driven + plan.loads.len()],
            h,
            rigid: Rigid::new(&plan),
            smooth: Smooth::new(&plan),
            contacts: Contacts::new(&plan, method),
            moreau: Moreau::new(&plan, method),
            pinned: vec![false; c],
            before: vec![0; c],
            plan,
        }
    }

    /// Starts from places and speeds of the bodies, with the step to come in `self.span`.
    pub fn start(&mut self, place: &[f64], speed: &[f64]) {
        let n = self.plan.bodies;
        self.state.place[..n].copy_from_slice(place);
        self.state.speed[..n].copy_from_slice(speed);
        let stretch = Stretch {
            span: &self.span,
            h: self.h,
            from: 0.0,
            to: 1.0,
        };
        drive(&self.plan, &stretch, 0.0, &mut self.state);
        for (mode, friction) in self.state.modes.iter_mut().zip(&self.plan.frictions) {
            let speed = friction.pair.of(&self.state.speed);
            *mode = i8::from(speed > 0.0) - i8::from(speed < 0.0);
        }
        self.contacts
            .decide(&self.plan, &mut self.state, &stretch, 0.0);
        self.regroup();
    }

    /// Goes on from a stored state.
    pub fn restore(&mut self, place: &[f64], speed: &[f64], modes: &[i8]) {
        self.state.place.copy_from_slice(place);
        self.state.speed.copy_from_slice(speed);
        self.state.modes.copy_from_slice(modes);
        self.regroup();
    }

    /// Whether the torques that hold are not unique.
    pub fn redundant(&self) -> bool {
        self.rigid.redundant
    }

    /// The torque along each element in the present state, at a share of the present step. Of frictions that hold it is
    /// the one of equilibrium, of assistance what it puts out; frictions that cannot resist are left alone.
    pub fn torques(&mut self, share: f64, out: &mut [f64]) {
        if self.contacts.any_stuck() {
            let stretch = Stretch {
                span: &self.span,
                h: self.h,
                from: 0.0,
                to: 1.0,
            };
            self.contacts.hold(&self.plan, &self.state, &stretch, share);
        }
        let (plan, state) = (&self.plan, &self.state);
        for (i, (friction, &mode)) in plan.frictions.iter().zip(&state.modes).enumerate() {
            out[friction.element] = if mode == 0 {
                self.contacts.held()[i]
            } else {
                friction.kinetic(f64::from(mode), friction.pair.of(&state.speed))
            };
        }
        for spring in &plan.springs {
            out[spring.element] = spring.torque(&state.place);
        }
        for damper in &plan.dampers {
            let speed = damper.pair.of(&state.speed);
            out[damper.element] = damper.viscous * speed + damper.curved(speed);
        }
        for assist in &plan.assists {
            out[assist.element] = assist.torque(&state.place);
        }
    }

    fn regroup(&mut self) {
        self.rigid.set(&self.plan, &self.state.modes);
        self.rigid.merge(&self.plan, &mut self.state.speed);
        self.contacts.set(&self.state.modes, &self.rigid);
        self.smooth.forget();
    }

    /// One step along `self.span`.
    pub fn step(&mut self, watch: &mut impl Watch) {
        let mut from = 0.0;
        self.pinned.fill(false);
        // Every friction may stop, turn and break away once, and one may do so again.
        for _ in 0..3 * self.plan.frictions.len() + 3 {
            let stretch = Stretch {
                span: &self.span,
                h: self.h,
                from,
                to: 1.0,
            };
            self.smooth
                .advance(&self.plan, &self.rigid, &self.state, &stretch);
            if let Some(friction) = self.does_not_start() {
                watch.change(friction, self.state.modes[friction], 0, from);
                self.state.modes[friction] = 0;
                self.pinned[friction] = true;
                self.regroup();
                continue;
            }
            let Some((at, first)) = self.first(from) else {
                self.accept(watch, from, 1.0);
                return;
            };
            let to = self.locate(from, at, &first);
            self.accept(watch, from, to);
            self.before.copy_from_slice(&self.state.modes);
            self.happens(&first);
            let stretch = Stretch {
                span: &self.span,
                h: self.h,
                from: to,
                to: 1.0,
            };
            self.contacts
                .decide(&self.plan, &mut self.state, &stretch, to);
            self.regroup();
            for (friction, (old, new)) in self.before.iter().zip(&self.state.modes).enumerate() {
                if old != new {
                    watch.change(friction, *old, *new, to);
                }
            }
            from = to;
            if from >= 1.0 {
                return;
            }
        }
        self.leave_to_moreau(watch, from);
    }

    fn leave_to_moreau(&mut self, watch: &mut impl Watch, from: f64) {
        let stretch = Stretch {
            span: &self.span,
            h: self.h,
            from,
            to: 1.0,
        };
        watch.crowded();
        self.before.copy_from_slice(&self.state.modes);
        self.moreau
            .advance(&self.plan, &self.state, &stretch, &mut self.smooth.end);
        self.accept(watch, from, 1.0);
        self.state.modes.copy_from_slice(&self.smooth.end.modes);
        self.regroup();
        for (friction, (old, new)) in self.before.iter().zip(&self.state.modes).enumerate() {
            if old != new {
                watch.change(friction, *old, *new, 1.0);
            }
        }
    }

    /// A friction that was let go at rest and would move against its own direction: it is held for the rest of the step.
    fn does_not_start(&self) -> Option<usize> {
        let (now, end) = (&self.state.speed, &self.smooth.end.speed);
        let frictions = self.plan.frictions.iter().zip(&self.state.modes);
        frictions.enumerate().find_map(|(i, (friction, &mode))| {
            let s = f64::from(mode);
            let stays =
                mode != 0 && s * friction.pair.of(now) <= 0.0 && s * friction.pair.of(end) <= 0.0;
            stays.then_some(i)
        })
    }

    /// What happens first between the state and the end of the stretch, and at which share of it.
    fn first(&mut self, from: f64) -> Option<(f64, First)> {
        let mut found: Option<(f64, First)> = None;
        let (now, end) = (&self.state.speed, &self.smooth.end.speed);
        for (i, (friction, &mode)) in
            (self.plan.frictions.iter().zip(&self.state.modes)).enumerate()
        {
            let s = f64::from(mode);
            let (before, after) = (s * friction.pair.of(now), s * friction.pair.of(end));
            if mode != 0 && after <= 0.0 {
                let at = before / (before - after);
                if found.as_ref().is_none_or(|f| at < f.0) {
                    found = Some((at, First::Stop(i)));
                }
            }
        }
        let stretch = Stretch {
            span: &self.span,
            h: self.h,
            from,
            to: 1.0,
        };
        let breaks = self.contacts.break_away(
            &self.plan,
            (&self.state, &self.smooth.end),
            &stretch,
            &self.pinned,
        );
        if let Some(breaks) = breaks
            && found.as_ref().is_none_or(|f| breaks < f.0)
        {
            found = Some((breaks, First::Break));
        }
        found
    }

    /// Carries the state to the event only, into the end of the stretch. A stop is located once more on the way there:
    /// what is left of the relative speed is then below the error of the step.
    fn locate(&mut self, from: f64, at: f64, first: &First) -> f64 {
        let stopping = match *first {
            First::Stop(i) => Some((self.plan.frictions[i].pair, f64::from(self.state.modes[i]))),
            First::Break => None,
        };
        let speed = |nodes: &[f64]| stopping.map_or(0.0, |(pair, s)| s * pair.of(nodes));
        let (before, after) = (speed(&self.state.speed), speed(&self.smooth.end.speed));
        let to = self.advance_to(from, at);
        let Some((pair, s)) = stopping else { return to };
        let there = s * pair.of(&self.smooth.end.speed);
        if there > 0.0 && at < 1.0 {
            self.advance_to(from, at + (1.0 - at) * there / (there - after))
        } else if there < 0.0 {
            self.advance_to(from, at * before / (before - there))
        } else {
            to
        }
    }

    /// Advances to a share of what is left of the step; returns the share of the step.
    fn advance_to(&mut self, from: f64, at: f64) -> f64 {
        let to = if at >= 1.0 {
            1.0
        } else {
            from + at * (1.0 - from)
        };
        let stretch = Stretch {
            span: &self.span,
            h: self.h,
            from,
            to,
        };
        self.smooth
            .advance(&self.plan, &self.rigid, &self.state, &stretch);
        to
    }

    fn accept(&mut self, watch: &mut impl Watch, from: f64, to: f64) {
        let stretch = Stretch {
            span: &self.span,
            h: self.h,
            from,
            to,
        };
        watch.stretch(&self.plan, &self.state, &self.smooth.end, &stretch);
        std::mem::swap(&mut self.state.place, &mut self.smooth.end.place);
        std::mem::swap(&mut self.state.speed, &mut self.smooth.end.speed);
    }

    /// Lets the first event happen: modes of 0 are then decided upon. The state before it is in the end of the stretch.
    fn happens(&mut self, first: &First) {
        match *first {
            First::Stop(stops) => {
                let left = |engine: &Self, i: usize| {
                    let (pair, s) = (
                        engine.plan.frictions[i].pair,
                        f64::from(engine.state.modes[i]),
                    );
                    let before = s * pair.of(&engine.smooth.end.speed);
                    (s * pair.of(&engine.state.speed), before)
                };
                // Twins have the same left over as the one that was located.
                let (now, before) = left(self, stops);
                let share = TOGETHER.max((1.0 + TOGETHER) * now / before);
                for i in 0..self.plan.frictions.len() {
                    let (now, before) = left(self, i);
                    if i == stops || (self.state.modes[i] != 0 && now <= share * before) {
                        self.stop(i);
                    }
                }
            }
            First::Break => {
                for (mode, loose) in self.state.modes.iter_mut().zip(self.contacts.loose()) {
                    if *loose != 0 {
                        *mode = *loose;
                    }
                }
            }
        }
    }

    fn stop(&mut self, friction: usize) {
        let pair = self.plan.frictions[friction].pair;
        self.state.modes[friction] = 0;
        // Beside the ground what is left of the speed is in one body only.
        let ground = self.plan.nodes() - 1;
        if pair.b == ground {
            self.state.speed[pair.a] = 0.0;
        } else if pair.a == ground {
            self.state.speed[pair.b] = 0.0;
        }
    }
}
