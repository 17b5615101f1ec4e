//! The rest of a step in which more happens than can be located: one step of Moreau and Jean.
//!
//! `v+ = argmin 1/2 |v - v_free|^2_B + h sum F |w'v|` with `B = M + h C`: first order, unconditional, dissipative.

use super::box_qp::{BoxQp, Method};
use super::factor::Factor;
use super::forces::Plan;
use super::smooth::{State, Stretch, drive, load};

/// Room for the step; nothing is allocated after construction.
#[derive(Debug, Clone)]
pub(super) struct Moreau {
    method: Method,
    force: Vec<f64>,
    damped: Vec<f64>,
    factor: Factor,
    /// `B^-1 W`, one row per friction.
    response: Vec<f64>,
    qp: BoxQp,
}

impl Moreau {
    pub fn new(plan: &Plan, method: Method) -> Self {
        let (n, c) = (plan.bodies, plan.frictions.len());
        Self {
            method,
            force: vec![0.0; plan.nodes()],
            damped: vec![0.0; n * n],
            factor: Factor::new(n),
            response: vec![0.0; n * c],
            qp: BoxQp::new(c),
        }
    }

    /// Carries a state to the end of a stretch, with the modes it has there.
    pub fn advance(&mut self, plan: &Plan, state: &State, stretch: &Stretch<'_>, end: &mut State) {
        let n = plan.bodies;
        let dt = stretch.seconds();
        drive(plan, stretch, stretch.to, end);
        // Without the frictions: implicit in the dampers, explicit in all else.
        end.speed[..n].copy_from_slice(&state.speed[..n]);
        self.force.fill(0.0);
        plan.elastic(&state.place, &mut self.force);
        load(plan, stretch.span, stretch.to, &mut self.force);
        plan.viscous(&end.speed, &mut self.force);
        for damper in &plan.dampers {
            let curved = damper.curved(damper.pair.of(&state.speed));
            damper.pair.resist(curved, &mut self.force);
        }
        self.factor_damped(plan, dt);
        for torque in &mut self.force[..n] {
            *torque *= dt;
        }
        self.factor.solve(&mut self.force[..n]);
        for i in 0..n {
            end.speed[i] += self.force[i];
        }
        self.resist(plan, state, dt, end);
        for i in 0..n {
            end.place[i] = state.place[i] + dt * end.speed[i];
        }
    }

    fn factor_damped(&mut self, plan: &Plan, dt: f64) {
        let n = plan.bodies;
        self.damped.fill(0.0);
        for (i, inertia) in plan.inertia.iter().enumerate() {
            self.damped[i * n + i] = *inertia;
        }
        for damper in &plan.dampers {
            let ends = [
                (damper.pair.a, damper.pair.ca),
                (damper.pair.b, damper.pair.cb),
            ];
            for (i, ci) in ends {
                for (j, cj) in ends {
                    if i < n && j < n {
                        self.damped[i * n + j] += dt * damper.viscous * ci * cj;
                    }
                }
            }
        }
        let damped = &self.damped;
        self.factor.set(n, |i, j| damped[i * n + j]);
    }

    fn resist(&mut self, plan: &Plan, state: &State, dt: f64, end: &mut State) {
        let (n, c) = (plan.bodies, plan.frictions.len());
        for (friction, row) in plan
            .frictions
            .iter()
            .zip(self.response.chunks_exact_mut(n.max(1)))
        {
            row.fill(0.0);
            for (node, share) in [
                (friction.pair.a, friction.pair.ca),
                (friction.pair.b, friction.pair.cb),
            ] {
                if node < n {
                    row[node] += share;
                }
            }
            self.factor.solve(row);
        }
        let response = &self.response;
        self.qp.set_matrix(c, |i, j| {
            let pair = plan.frictions[i].pair;
            let row = &response[j * n..(j + 1) * n];
            let of = |node: usize, share: f64| if node < n { share * row[node] } else { 0.0 };
            of(pair.a, pair.ca) + of(pair.b, pair.cb)
        });
        for (i, friction) in plan.frictions.iter().enumerate() {
            let speed = friction.pair.of(&state.speed);
            let level = |direction: f64| {
                if state.modes[i] == 0 {
                    friction.held(direction)
                } else {
                    friction.kinetic(direction, speed).abs()
                }
            };
            let free = friction.pair.of(&end.speed);
            self.qp.set_row(i, free, -dt * level(-1.0), dt * level(1.0));
        }
        self.qp.solve(self.method);
        for (j, torque) in self.qp.torque().iter().enumerate() {
            for i in 0..n {
                end.speed[i] -= torque * self.response[j * n + i];
            }
        }
        for (i, mode) in end.modes.iter_mut().enumerate() {
            *mode = self.qp.slides(i);
        }
    }
}
