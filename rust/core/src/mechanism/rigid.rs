//! What moves together: the bodies that stuck frictions join with each other, with the ground or with a driven node.

use super::forces::{Friction, Plan};

// Two ways round a loop of stuck frictions agree if their ratios differ by no more than rounding leaves.
const SAME_RATIO: f64 = 1e-12;

/// Every node moves as `share` times the node that leads it.
#[derive(Debug, Clone)]
pub(super) struct Rigid {
    /// The leading node of each node: a body, a driven node or the ground.
    pub lead: Vec<usize>,
    pub share: Vec<f64>,
    /// For each node that leads and is a body, its number among those; meaningless elsewhere.
    pub column: Vec<usize>,
    /// The bodies that lead.
    pub free: Vec<usize>,
    /// Whether there are more stuck frictions than it takes: their torques are not unique.
    pub redundant: bool,
}

impl Rigid {
    pub fn new(plan: &Plan) -> Self {
        let nodes = plan.nodes();
        Self {
            lead: (0..nodes).collect(),
            share: vec![1.0; nodes],
            column: vec![0; nodes],
            free: Vec::with_capacity(plan.bodies),
            redundant: false,
        }
    }

    /// Joins what the frictions of mode 0 hold together.
    pub fn set(&mut self, plan: &Plan, modes: &[i8]) {
        for (i, lead) in self.lead.iter_mut().enumerate() {
            *lead = i;
        }
        self.share.fill(1.0);
        self.redundant = false;
        for (friction, mode) in plan.frictions.iter().zip(modes) {
            if *mode == 0 {
                self.join(plan, friction);
            }
        }
        self.free.clear();
        for body in 0..plan.bodies {
            if self.lead[body] == body {
                self.column[body] = self.free.len();
                self.free.push(body);
            }
        }
    }

    fn join(&mut self, plan: &Plan, friction: &Friction) {
        let pair = friction.pair;
        let ground = plan.nodes() - 1;
        let (la, lb) = (self.lead[pair.a], self.lead[pair.b]);
        let (sa, sb) = (pair.ca * self.share[pair.a], pair.cb * self.share[pair.b]);
        if la == lb {
            self.redundant = true;
            // Two different ratios between the same two: neither can move.
            if la < plan.bodies && (sa + sb).abs() > SAME_RATIO * (sa.abs() + sb.abs()) {
                self.follow(la, ground, 1.0);
            }
        } else if la < plan.bodies {
            self.follow(la, lb, if lb == ground { 1.0 } else { -sb / sa });
        } else if lb < plan.bodies {
            self.follow(lb, la, if la == ground { 1.0 } else { -sa / sb });
        } else {
            self.redundant = true;
        }
    }

    fn follow(&mut self, from: usize, to: usize, share: f64) {
        let ground = self.lead.len() - 1;
        for (lead, own) in self.lead.iter_mut().zip(&mut self.share) {
            if *lead == from {
                *lead = to;
                // Behind the ground everything stands: no product that could be a negative 0.
                *own = if to == ground { 1.0 } else { *own * share };
            }
        }
    }

    /// Lets what has just been joined move as one, with the momentum that its bodies had.
    pub fn merge(&self, plan: &Plan, speed: &mut [f64]) {
        for &lead in &self.free {
            let (mut momentum, mut inertia, mut alone) = (0.0, 0.0, true);
            for body in 0..plan.bodies {
                if self.lead[body] == lead {
                    momentum += plan.inertia[body] * self.share[body] * speed[body];
                    inertia += plan.inertia[body] * self.share[body] * self.share[body];
                    // What moves as one already keeps its speed to the bit.
                    alone &= speed[body] == self.share[body] * speed[lead];
                }
            }
            if !alone {
                speed[lead] = momentum / inertia;
            }
        }
        self.impose(plan, speed);
    }

    /// Lets every body have the speed of what leads it.
    pub fn impose(&self, plan: &Plan, speed: &mut [f64]) {
        for body in 0..plan.bodies {
            let lead = self.lead[body];
            if lead != body {
                speed[body] = self.share[body] * speed[lead];
            }
        }
    }
}
