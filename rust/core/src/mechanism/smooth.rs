//! A stretch of time in which nothing changes its mode: drift, torque, drift.
//!
//! Springs are taken at the middle, linear damping as the mean of both ends, so that any damper is stable; what curves
//! with speed is predicted at the start and then taken at the mean speed. Second order.

use super::channels::Parabola;
use super::factor::Factor;
use super::forces::Plan;
use super::rigid::Rigid;

/// Where everything is, how fast, and which frictions hold (0) or slide (-1, 1).
#[derive(Debug, Clone)]
pub(super) struct State {
    pub place: Vec<f64>,
    pub speed: Vec<f64>,
    pub modes: Vec<i8>,
}

/// A part of one step.
#[derive(Debug, Clone, Copy)]
pub(super) struct Stretch<'a> {
    pub span: &'a [Parabola],
    /// Seconds of the whole step.
    pub h: f64,
    /// Shares of the step.
    pub from: f64,
    pub to: f64,
}

impl Stretch<'_> {
    pub fn seconds(&self) -> f64 {
        (self.to - self.from) * self.h
    }
}

/// Writes places and speeds of the driven nodes at a share of a step.
pub(super) fn drive(plan: &Plan, stretch: &Stretch<'_>, share: f64, state: &mut State) {
    for (i, channel) in stretch.span[..plan.driven].iter().enumerate() {
        state.place[plan.bodies + i] = channel.at(share);
        state.speed[plan.bodies + i] = channel.slope(share) / stretch.h;
    }
}

/// Adds the loads at a share of a step.
pub(super) fn load(plan: &Plan, span: &[Parabola], share: f64, out: &mut [f64]) {
    for (channel, &body) in span[plan.driven..].iter().zip(&plan.loads) {
        out[body] += channel.at(share);
    }
}

/// Room for one stretch; nothing is allocated after construction.
#[derive(Debug, Clone)]
pub(super) struct Smooth {
    /// Where the last stretch ended.
    pub end: State,
    middle: Vec<f64>,
    mean: Vec<f64>,
    force: Vec<f64>,
    curved: Vec<f64>,
    right: Vec<f64>,
    reduced: Vec<f64>,
    part: Factor,
    /// For the whole step and the present modes.
    whole: Factor,
    whole_is_set: bool,
}

impl Smooth {
    pub fn new(plan: &Plan) -> Self {
        let (n, nodes) = (plan.bodies, plan.nodes());
        Self {
            end: State {
                place: vec![0.0; nodes],
                speed: vec![0.0; nodes],
                modes: vec![0; plan.frictions.len()],
            },
            middle: vec![0.0; nodes],
            mean: vec![0.0; nodes],
            force: vec![0.0; nodes],
            curved: vec![0.0; nodes],
            right: vec![0.0; n],
            reduced: vec![0.0; n * n],
            part: Factor::new(n),
            whole: Factor::new(n),
            whole_is_set: false,
        }
    }

    /// To be called when modes have changed.
    pub fn forget(&mut self) {
        self.whole_is_set = false;
    }

    /// Carries a state to the end of a stretch, into `self.end`.
    pub fn advance(&mut self, plan: &Plan, rigid: &Rigid, state: &State, stretch: &Stretch<'_>) {
        let n = plan.bodies;
        let dt = stretch.seconds();
        let half = 0.5 * dt;
        let whole = stretch.from == 0.0 && stretch.to == 1.0;
        if !(whole && self.whole_is_set) {
            self.assemble(plan, rigid, half);
            let (reduced, r) = (&self.reduced, rigid.free.len());
            let factor = if whole {
                &mut self.whole
            } else {
                &mut self.part
            };
            factor.set(r, |i, j| reduced[i * r + j]);
            self.whole_is_set |= whole;
        }
        let middle = 0.5 * (stretch.from + stretch.to);
        drive(plan, stretch, stretch.to, &mut self.end);
        for i in 0..n {
            self.middle[i] = state.place[i] + dt * state.speed[i] * 0.5;
            self.mean[i] = state.speed[i];
        }
        for i in 0..plan.driven {
            self.middle[n + i] = stretch.span[i].at(middle);
            self.mean[n + i] = 0.5 * (state.speed[n + i] + self.end.speed[n + i]);
        }
        // What a driven node drags along has its mean speed; all others start from their own.
        for i in 0..n {
            let lead = rigid.lead[i];
            if lead >= n {
                self.mean[i] = rigid.share[i] * self.mean[lead];
            }
        }
        self.force.fill(0.0);
        plan.elastic(&self.middle, &mut self.force);
        load(plan, stretch.span, middle, &mut self.force);
        plan.viscous(&self.mean, &mut self.force);
        self.gain(plan, rigid, &state.modes, (dt, whole));
        if plan.rich {
            for i in 0..n {
                let lead = rigid.lead[i];
                if lead < n {
                    let gained = rigid.share[i] * self.right[rigid.column[lead]];
                    self.mean[i] = state.speed[i] + 0.5 * gained;
                }
            }
            self.gain(plan, rigid, &state.modes, (dt, whole));
        }
        for (column, &body) in rigid.free.iter().enumerate() {
            self.end.speed[body] = state.speed[body] + self.right[column];
        }
        rigid.impose(plan, &mut self.end.speed);
        for i in 0..n {
            self.end.place[i] = self.middle[i] + dt * self.end.speed[i] * 0.5;
        }
        self.end.modes.copy_from_slice(&state.modes);
    }

    /// What the leading bodies gain in speed, into `self.right`.
    fn gain(&mut self, plan: &Plan, rigid: &Rigid, modes: &[i8], (dt, whole): (f64, bool)) {
        self.curved.fill(0.0);
        plan.resisting(&self.mean, modes, &mut self.curved);
        let r = rigid.free.len();
        self.right[..r].fill(0.0);
        for i in 0..plan.bodies {
            let lead = rigid.lead[i];
            if lead < plan.bodies {
                self.right[rigid.column[lead]] +=
                    dt * rigid.share[i] * (self.force[i] + self.curved[i]);
            }
        }
        let factor = if whole { &self.whole } else { &self.part };
        factor.solve(&mut self.right[..r]);
    }

    /// Inertia and half the damping of what moves together.
    fn assemble(&mut self, plan: &Plan, rigid: &Rigid, half: f64) {
        let r = rigid.free.len();
        self.reduced[..r * r].fill(0.0);
        for (i, inertia) in plan.inertia.iter().enumerate() {
            let lead = rigid.lead[i];
            if lead < plan.bodies {
                let column = rigid.column[lead];
                self.reduced[column * r + column] += inertia * rigid.share[i] * rigid.share[i];
            }
        }
        for damper in &plan.dampers {
            let pair = damper.pair;
            let ends = [(pair.a, pair.ca), (pair.b, pair.cb)];
            for (one, c1) in ends {
                for (other, c2) in ends {
                    let (l1, l2) = (rigid.lead[one], rigid.lead[other]);
                    if l1 < plan.bodies && l2 < plan.bodies {
                        self.reduced[rigid.column[l1] * r + rigid.column[l2]] += half
                            * damper.viscous
                            * (c1 * rigid.share[one])
                            * (c2 * rigid.share[other]);
                    }
                }
            }
        }
    }
}
