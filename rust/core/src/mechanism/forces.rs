//! A network laid out for the step: every element is a pair of places in one vector of nodes, and what acts along it.

use crate::dynamics::Pure;
use crate::effects::{Drag, Law as EffectLaw, Motion, Stribeck};
use crate::projections::luz;

use super::network::{End, Law, Network, Node};

/// Two places in the vector of nodes (bodies, driven nodes, ground) and what the element sees of them:
/// `x = ca q_a + cb q_b`.
#[derive(Debug, Clone, Copy)]
pub(super) struct Pair {
    pub a: usize,
    pub b: usize,
    pub ca: f64,
    pub cb: f64,
}

impl Pair {
    /// The element's coordinate, or its speed.
    #[inline]
    pub fn of(&self, nodes: &[f64]) -> f64 {
        self.ca * nodes[self.a] + self.cb * nodes[self.b]
    }

    /// Lets a torque that resists the element's motion act on its nodes.
    #[inline]
    pub fn resist(&self, torque: f64, nodes: &mut [f64]) {
        nodes[self.a] -= self.ca * torque;
        nodes[self.b] -= self.cb * torque;
    }
}

#[derive(Debug, Clone)]
pub(super) struct Spring {
    pub pair: Pair,
    pub element: usize,
    pub stiffness: f64,
    pub half_gap: f64,
    pub hardening: f64,
}

impl Spring {
    /// How far it is wound up, its gap taken off.
    #[inline]
    pub fn wound(&self, nodes: &[f64]) -> f64 {
        luz(Pure(self.pair.of(nodes)), Pure(self.half_gap)).0
    }

    #[inline]
    pub fn torque(&self, nodes: &[f64]) -> f64 {
        let l = self.wound(nodes);
        self.stiffness * l + self.hardening * (l * l * l)
    }

    pub fn stored(&self, nodes: &[f64]) -> f64 {
        let square = self.wound(nodes).powi(2);
        0.5 * self.stiffness * square + 0.25 * self.hardening * square * square
    }
}

#[derive(Debug, Clone)]
pub(super) struct Damper {
    pub pair: Pair,
    pub element: usize,
    pub viscous: f64,
    pub drag: f64,
}

impl Damper {
    /// What is beyond the linear part.
    pub fn curved(&self, speed: f64) -> f64 {
        if self.drag == 0.0 {
            return 0.0;
        }
        let mut out = [Pure(0.0)];
        Drag::basis(&moving(speed), &[], &mut out);
        self.drag * out[0].0
    }
}

#[derive(Debug, Clone)]
pub(super) struct Friction {
    pub pair: Pair,
    pub element: usize,
    pub level: f64,
    pub difference: f64,
    pub stribeck: f64,
    pub stribeck_speed: f64,
    pub stiction: f64,
}

impl Friction {
    /// The torque that resists a motion in a direction (-1, 1) at a speed.
    #[inline]
    pub fn kinetic(&self, direction: f64, speed: f64) -> f64 {
        let plain = self.level + self.difference * direction;
        if self.stribeck == 0.0 {
            return direction * plain;
        }
        let mut out = [Pure(0.0)];
        Stribeck::basis(&moving(speed), &[self.stribeck_speed], &mut out);
        direction * (plain + self.stribeck * out[0].0)
    }

    /// The largest torque that is held at rest against a motion in a direction.
    #[inline]
    pub fn held(&self, direction: f64) -> f64 {
        self.level + self.difference * direction + self.stribeck + self.stiction
    }
}

fn moving(speed: f64) -> Motion<Pure> {
    Motion {
        position: Pure(0.0),
        speed: Pure(speed),
        acceleration: Pure(0.0),
        turn_rad: Pure(0.0),
        time_s: Pure(0.0),
        rest_s: Pure(0.0),
        travelled: Pure(0.0),
        direction: Pure(speed).sign(),
        slowest_speed: Pure(1.0),
        load_n: Pure(0.0),
    }
}

#[derive(Debug, Clone)]
pub(super) struct Assist {
    pub pair: Pair,
    pub element: usize,
    pub on: usize,
    pub ratio: f64,
    pub scale: f64,
    pub terms: Vec<(f64, f64)>,
}

impl Assist {
    /// The torque of the curve.
    #[inline]
    pub fn torque(&self, nodes: &[f64]) -> f64 {
        let x = Pure(self.pair.of(nodes));
        let sum: f64 = self.terms.iter().map(|&(k, a)| k * luz(x, Pure(a)).0).sum();
        self.scale * sum
    }
}

/// A network laid out for the step.
#[derive(Debug, Clone)]
pub(super) struct Plan {
    /// How many bodies; they come first among the nodes.
    pub bodies: usize,
    /// How many driven nodes; they come next. Ground is the last node.
    pub driven: usize,
    pub inertia: Vec<f64>,
    pub springs: Vec<Spring>,
    pub dampers: Vec<Damper>,
    /// Those that can resist at all.
    pub frictions: Vec<Friction>,
    pub assists: Vec<Assist>,
    /// The body of each load.
    pub loads: Vec<usize>,
    /// Whether a torque depends on speed in a curved way.
    pub rich: bool,
}

impl Plan {
    pub fn new(network: &Network) -> Self {
        let (bodies, driven) = (network.bodies().len(), network.driven().len());
        let place = |end: End| match end.node {
            Node::Body(i) => (i, end.ratio),
            Node::Driven(i) => (bodies + i, end.ratio),
            Node::Ground => (bodies + driven, end.ratio),
        };
        let mut plan = Self {
            bodies,
            driven,
            inertia: network.bodies().iter().map(|b| b.inertia).collect(),
            springs: Vec::new(),
            dampers: Vec::new(),
            frictions: Vec::new(),
            assists: Vec::new(),
            loads: network.loads().iter().map(|(_, body)| *body).collect(),
            rich: false,
        };
        for (element, described) in network.elements().iter().enumerate() {
            let ((a, ca), (b, cb)) = (place(described.a), place(described.b));
            let pair = Pair { a, b, ca, cb: -cb };
            match &described.law {
                Law::Spring {
                    stiffness,
                    gap,
                    hardening,
                } => plan.springs.push(Spring {
                    pair,
                    element,
                    stiffness: *stiffness,
                    half_gap: 0.5 * gap,
                    hardening: *hardening,
                }),
                Law::Damper { viscous, drag } => {
                    plan.rich |= *drag != 0.0;
                    plan.dampers.push(Damper {
                        pair,
                        element,
                        viscous: *viscous,
                        drag: *drag,
                    });
                }
                Law::Friction {
                    level,
                    difference,
                    stribeck,
                    stribeck_speed,
                    stiction,
                } => {
                    plan.rich |= *stribeck != 0.0;
                    if *level + *stiction + stribeck.max(0.0) > 0.0 {
                        plan.frictions.push(Friction {
                            pair,
                            element,
                            level: *level,
                            difference: *difference,
                            stribeck: *stribeck,
                            stribeck_speed: *stribeck_speed,
                            stiction: *stiction,
                        });
                    }
                }
                Law::Assist { on, scale, terms } => plan.assists.push(Assist {
                    pair,
                    element,
                    on: place(*on).0,
                    ratio: on.ratio,
                    scale: *scale,
                    terms: terms.clone(),
                }),
            }
        }
        plan
    }

    /// Bodies, driven nodes and the ground.
    pub fn nodes(&self) -> usize {
        self.bodies + self.driven + 1
    }

    /// The torques of springs and assistance on the nodes, given their places.
    pub fn elastic(&self, place: &[f64], out: &mut [f64]) {
        for spring in &self.springs {
            spring.pair.resist(spring.torque(place), out);
        }
        for assist in &self.assists {
            out[assist.on] += assist.ratio * assist.torque(place);
        }
    }

    /// The linear torques of dampers on the nodes, given their speeds.
    pub fn viscous(&self, speed: &[f64], out: &mut [f64]) {
        for damper in &self.dampers {
            let torque = damper.viscous * damper.pair.of(speed);
            damper.pair.resist(torque, out);
        }
    }

    /// The torques of drag and of the frictions that slip (mode -1 or 1), given the speeds.
    pub fn resisting(&self, speed: &[f64], modes: &[i8], out: &mut [f64]) {
        for damper in &self.dampers {
            damper
                .pair
                .resist(damper.curved(damper.pair.of(speed)), out);
        }
        for (friction, &mode) in self.frictions.iter().zip(modes) {
            if mode != 0 {
                let torque = friction.kinetic(f64::from(mode), friction.pair.of(speed));
                friction.pair.resist(torque, out);
            }
        }
    }

    /// Energy of motion and springs.
    pub fn stored(&self, place: &[f64], speed: &[f64]) -> f64 {
        let moving: f64 = (self.inertia.iter().zip(speed))
            .map(|(m, v)| 0.5 * m * v * v)
            .sum();
        moving + self.springs.iter().map(|s| s.stored(place)).sum::<f64>()
    }
}
