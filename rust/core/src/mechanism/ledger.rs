//! Where the energy of a run went, element by element.

use super::contacts::Contacts;
use super::forces::{Pair, Plan};
use super::rigid::Rigid;
use super::smooth::{State, Stretch};

/// Energies of a run, J.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Ledger {
    /// Per element: what a spring stores more at the end than at the start, the heat of a damper or friction, minus the
    /// work that assistance puts in.
    pub element: Vec<f64>,
    /// Work put in at each driven node.
    pub driven: Vec<f64>,
    /// Work of each load.
    pub load: Vec<f64>,
    /// Energy of motion and springs at the start.
    pub stored_first: f64,
    /// The same at the end.
    pub stored_last: f64,
    /// Energy of motion at the end less that at the start.
    pub motion: f64,
    /// All that was ever put in, by size: what the residual is measured against.
    pub turnover: f64,
}

impl Ledger {
    /// Energy that the numbers do not account for: of second order in the step.
    #[must_use]
    pub fn residual(&self) -> f64 {
        let put_in: f64 = self.driven.iter().chain(&self.load).sum();
        put_in - self.motion - self.element.iter().sum::<f64>()
    }
}

/// Books a run, stretch by stretch.
#[derive(Debug)]
pub(super) struct Books {
    pub ledger: Ledger,
    /// For the torque of a friction that is dragged by a driven node.
    drag: Option<(Contacts, Rigid)>,
    torque: [Vec<f64>; 2],
}

impl Books {
    pub fn new(plan: &Plan, elements: usize, contacts: impl Fn() -> Contacts) -> Self {
        let driven = plan.bodies..plan.bodies + plan.driven;
        let drags = plan
            .frictions
            .iter()
            .any(|f| driven.contains(&f.pair.a) || driven.contains(&f.pair.b));
        Self {
            ledger: Ledger {
                element: vec![0.0; elements],
                driven: vec![0.0; plan.driven],
                load: vec![0.0; plan.loads.len()],
                ..Ledger::default()
            },
            drag: drags.then(|| (contacts(), Rigid::new(plan))),
            torque: [
                vec![0.0; plan.frictions.len()],
                vec![0.0; plan.frictions.len()],
            ],
        }
    }

    pub fn open(&mut self, plan: &Plan, state: &State) {
        self.ledger.stored_first = plan.stored(&state.place, &state.speed);
        self.ledger.turnover = self.ledger.stored_first;
        self.ledger.motion = -motion(plan, state);
        for spring in &plan.springs {
            self.ledger.element[spring.element] = -spring.stored(&state.place);
        }
    }

    pub fn close(&mut self, plan: &Plan, state: &State) {
        self.ledger.stored_last = plan.stored(&state.place, &state.speed);
        self.ledger.motion += motion(plan, state);
        for spring in &plan.springs {
            self.ledger.element[spring.element] += spring.stored(&state.place);
        }
    }

    /// Books a stretch between two states; the frictions have the modes of the first.
    pub fn book(&mut self, plan: &Plan, from: &State, to: &State, stretch: &Stretch<'_>) {
        let dt = stretch.seconds();
        // Speeds run along straight lines: Simpson's rule is exact for linear dampers.
        let heat = |pair: Pair, torque: &dyn Fn(f64) -> f64| {
            let (first, last) = (pair.of(&from.speed), pair.of(&to.speed));
            let power = |v: f64| torque(v) * v;
            dt * (power(first) + 4.0 * power(0.5 * (first + last)) + power(last)) / 6.0
        };
        for damper in &plan.dampers {
            let law = |v: f64| damper.viscous * v + damper.curved(v);
            self.ledger.element[damper.element] += heat(damper.pair, &law);
        }
        for (friction, &mode) in plan.frictions.iter().zip(&from.modes) {
            if mode != 0 {
                let law = |v: f64| friction.kinetic(f64::from(mode), v);
                self.ledger.element[friction.element] += heat(friction.pair, &law);
            }
        }
        for assist in &plan.assists {
            let mean = 0.5 * (assist.torque(&from.place) + assist.torque(&to.place));
            let work = mean * assist.ratio * (to.place[assist.on] - from.place[assist.on]);
            self.ledger.element[assist.element] -= work;
            self.ledger.turnover += work.abs();
        }
        for (i, &body) in plan.loads.iter().enumerate() {
            let channel = stretch.span[plan.driven + i];
            let mean = 0.5 * (channel.at(stretch.from) + channel.at(stretch.to));
            let work = mean * (to.place[body] - from.place[body]);
            self.ledger.load[i] += work;
            self.ledger.turnover += work.abs();
        }
        self.book_driven(plan, (from, to), stretch);
    }

    fn book_driven(&mut self, plan: &Plan, (from, to): (&State, &State), stretch: &Stretch<'_>) {
        if plan.driven == 0 {
            return;
        }
        if let Some((contacts, rigid)) = &mut self.drag {
            rigid.set(plan, &from.modes);
            contacts.set(&from.modes, rigid);
            let shares = [stretch.from, stretch.to];
            // The end of the stretch has the modes of its start.
            for ((state, share), torque) in [from, to].into_iter().zip(shares).zip(&mut self.torque)
            {
                contacts.hold(plan, state, stretch, share);
                for (i, friction) in plan.frictions.iter().enumerate() {
                    let mode = f64::from(from.modes[i]);
                    torque[i] = if mode == 0.0 {
                        contacts.held()[i]
                    } else {
                        friction.kinetic(mode, friction.pair.of(&state.speed))
                    };
                }
            }
        }
        let ledger = &mut self.ledger;
        let mut feel = |pair: Pair, first: f64, last: f64| {
            for (node, share) in [(pair.a, pair.ca), (pair.b, pair.cb)] {
                if (plan.bodies..plan.bodies + plan.driven).contains(&node) {
                    let way = to.place[node] - from.place[node];
                    let work = 0.5 * (first + last) * share * way;
                    ledger.driven[node - plan.bodies] += work;
                    ledger.turnover += work.abs();
                }
            }
        };
        for spring in &plan.springs {
            feel(
                spring.pair,
                spring.torque(&from.place),
                spring.torque(&to.place),
            );
        }
        for damper in &plan.dampers {
            let law = |v: f64| damper.viscous * v + damper.curved(v);
            feel(
                damper.pair,
                law(damper.pair.of(&from.speed)),
                law(damper.pair.of(&to.speed)),
            );
        }
        if self.drag.is_some() {
            for (i, friction) in plan.frictions.iter().enumerate() {
                feel(friction.pair, self.torque[0][i], self.torque[1][i]);
            }
        }
    }
}

fn motion(plan: &Plan, state: &State) -> f64 {
    (plan.inertia.iter().zip(&state.speed))
        .map(|(m, v)| 0.5 * m * v * v)
        .sum()
}
