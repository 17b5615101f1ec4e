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

#[cfg(test)]
mod tests {
    use super::super::channels::Parabola;
    use super::super::network::{Body, Element, End, Law, Network, Node};
    use super::*;

    fn end(node: Node) -> End {
        End { node, ratio: 1.0 }
    }

    fn friction(name: &str, a: Node, b: Node, level: f64) -> Element {
        Element {
            name: name.to_owned(),
            a: end(a),
            b: end(b),
            law: Law::Friction {
                level,
                difference: 0.0,
                stribeck: 0.0,
                stribeck_speed: 0.0,
                stiction: 0.0,
            },
        }
    }

    /// Speeds after one step of 0.1 s of bodies of 2 and 3 kg m2 under loads, and the modes.
    fn step(elements: Vec<Element>, speed: [f64; 2], loads: [f64; 2]) -> (Vec<f64>, Vec<i8>) {
        let body = |name: &str, inertia| Body {
            name: name.to_owned(),
            inertia,
        };
        let network = Network::new(
            vec![body("one", 2.0), body("two", 3.0)],
            vec![],
            vec![("f1".to_owned(), 0), ("f2".to_owned(), 1)],
            elements,
        )
        .expect("sound");
        let plan = Plan::new(&network);
        let modes = plan
            .frictions
            .iter()
            .map(|f| f.pair.of(&[speed[0], speed[1], 0.0]).signum() as i8)
            .collect();
        let state = State {
            place: vec![0.0; 3],
            speed: vec![speed[0], speed[1], 0.0],
            modes,
        };
        let span = loads.map(|value| Parabola {
            start: value,
            middle: value,
            end: value,
            third: 0.0,
        });
        let stretch = Stretch {
            span: &span,
            h: 0.1,
            from: 0.0,
            to: 1.0,
        };
        let mut after = state.clone();
        Moreau::new(&plan, Method::ActiveSet).advance(&plan, &state, &stretch, &mut after);
        (after.speed, after.modes)
    }

    #[test]
    fn one_body_takes_the_soft_threshold() {
        // v+ = luz(v + h M / I, h F / I) / (1 + h mu / I).
        for (v, m) in [(0.4, 1.0), (-0.3, 0.2), (0.02, -0.4), (0.0, 3.0)] {
            let elements = vec![
                friction("f", Node::Body(0), Node::Ground, 1.5),
                Element {
                    name: "d".to_owned(),
                    a: end(Node::Body(0)),
                    b: end(Node::Ground),
                    law: Law::Damper {
                        viscous: 4.0,
                        drag: 0.0,
                    },
                },
                // What joins the other body takes no part.
                friction("join", Node::Body(1), Node::Body(0), 0.0),
            ];
            let (speed, modes) = step(elements, [v, 0.0], [m, 0.0]);
            // The damper acts on the old speed and on what is gained: (2 + 0.4) dv = 0.1 (m - 4 v).
            let free = v + 0.1 * (m - 4.0 * v) / 2.4;
            let wanted = (free.abs() - 0.1 * 1.5 / 2.4).max(0.0) * free.signum();
            assert!((speed[0] - wanted).abs() < 1e-15, "{v} {m}");
            assert_eq!(modes[0] == 0, wanted == 0.0);
        }
    }

    #[test]
    fn two_bodies_that_their_friction_can_hold_go_on_as_one() {
        let elements = vec![friction("f", Node::Body(0), Node::Body(1), 9.0)];
        let (speed, modes) = step(elements, [0.5, 0.1], [0.4, -1.0]);
        let together = (2.0 * 0.5 + 3.0 * 0.1 + 0.1 * (0.4 - 1.0)) / 5.0;
        assert!((speed[0] - together).abs() < 1e-15 && (speed[1] - together).abs() < 1e-15);
        assert_eq!(modes, [0]);
    }
}
