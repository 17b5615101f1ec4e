//! What a mechanism consists of: bodies, nodes whose motion is given, loads, and elements between them.

use crate::Error;

use super::check::check;

/// A body with one coordinate, an angle or a way.
#[derive(Debug, Clone, PartialEq)]
pub struct Body {
    /// Its name in errors, events and results.
    pub name: String,
    /// Moment of inertia, kg m2, or mass, kg.
    pub inertia: f64,
}

/// What an element can be fastened to.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Node {
    /// What never moves.
    Ground,
    /// A body, by its place in the list.
    Body(usize),
    /// A node whose motion is given, by its place in the list.
    Driven(usize),
}

/// One end of an element: it sees the node's coordinate times a ratio.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct End {
    /// The node.
    pub node: Node,
    /// Element coordinate per node coordinate.
    pub ratio: f64,
}

/// What acts along `x = a.ratio * q_a - b.ratio * q_b`. Torques in Nm over rad, or forces in N over m.
#[derive(Debug, Clone, PartialEq)]
pub enum Law {
    /// `K l + K3 l^3`, `l = luz(x, gap / 2)`. An end stop is one with a wide gap.
    Spring {
        /// K.
        stiffness: f64,
        /// Full width of the gap.
        gap: f64,
        /// K3.
        hardening: f64,
    },
    /// `c v + d |v| v`.
    Damper {
        /// c.
        viscous: f64,
        /// d.
        drag: f64,
    },
    /// Dry friction: the level of the direction, Stribeck's extra at low speed, a further extra at rest.
    Friction {
        /// Kinetic level.
        level: f64,
        /// Half the difference of the levels of the two directions.
        difference: f64,
        /// Extra at very low speed.
        stribeck: f64,
        /// Speed at which that has fallen to 37 %.
        stribeck_speed: f64,
        /// Extra at rest.
        stiction: f64,
    },
    /// A torque on another node by the element's own x: an odd curve, a sum of luz terms.
    Assist {
        /// Where it acts, against the ground.
        on: End,
        /// Factor on the whole curve.
        scale: f64,
        /// (k, a): the curve is the sum of `k luz(x, a)`.
        terms: Vec<(f64, f64)>,
    },
}

/// One element.
#[derive(Debug, Clone, PartialEq)]
pub struct Element {
    /// Its name in errors, events and results.
    pub name: String,
    /// The end that counts positive.
    pub a: End,
    /// The other end.
    pub b: End,
    /// What acts along it.
    pub law: Law,
}

/// A mechanism, checked.
#[derive(Debug, Clone, PartialEq)]
pub struct Network {
    bodies: Vec<Body>,
    driven: Vec<String>,
    /// Torque channels: name, and the body they act on.
    loads: Vec<(String, usize)>,
    elements: Vec<Element>,
}

impl Network {
    /// Checks what was described.
    ///
    /// # Errors
    /// [`Error::Mechanism`] names the body or element, what is wrong with it and what to do.
    pub fn new(
        bodies: Vec<Body>,
        driven: Vec<String>,
        loads: Vec<(String, usize)>,
        elements: Vec<Element>,
    ) -> Result<Self, Error> {
        let made = Self {
            bodies,
            driven,
            loads,
            elements,
        };
        check(&made)?;
        Ok(made)
    }

    /// The bodies.
    #[must_use]
    pub fn bodies(&self) -> &[Body] {
        &self.bodies
    }

    /// Names of the nodes whose motion is given.
    #[must_use]
    pub fn driven(&self) -> &[String] {
        &self.driven
    }

    /// Torque channels: name, and the body they act on.
    #[must_use]
    pub fn loads(&self) -> &[(String, usize)] {
        &self.loads
    }

    /// The elements.
    #[must_use]
    pub fn elements(&self) -> &[Element] {
        &self.elements
    }

    /// How many channels drive it: the driven nodes, then the loads.
    #[must_use]
    pub fn channels(&self) -> usize {
        self.driven.len() + self.loads.len()
    }

    /// Every number of the mechanism in a fixed order: whose it is, and its name.
    #[must_use]
    pub fn parameters(&self) -> Vec<(&str, &'static str)> {
        let bodies = self.bodies.iter().map(|b| (b.name.as_str(), "inertia"));
        let elements = self.elements.iter().flat_map(|e| {
            let own: &[&'static str] = match e.law {
                Law::Spring { .. } => &["stiffness", "gap", "hardening"],
                Law::Damper { .. } => &["viscous", "drag"],
                Law::Friction { .. } => &[
                    "level",
                    "difference",
                    "stribeck",
                    "stribeck_speed",
                    "stiction",
                ],
                Law::Assist { .. } => &["scale"],
            };
            ["ratio_a", "ratio_b"]
                .iter()
                .chain(own)
                .map(|p| (e.name.as_str(), *p))
        });
        bodies.chain(elements).collect()
    }

    /// The numbers in the order of [`Network::parameters`].
    #[must_use]
    pub fn values(&self) -> Vec<f64> {
        let mut twin = self.clone();
        let mut out = Vec::new();
        twin.visit(|value| out.push(*value));
        out
    }

    /// The same structure with other numbers.
    ///
    /// # Errors
    /// [`Error::Length`] where there are not as many as parameters; as [`Network::new`].
    pub fn with_values(&self, values: &[f64]) -> Result<Self, Error> {
        let mut twin = self.clone();
        let mut wanted = 0;
        twin.visit(|value| {
            if let Some(given) = values.get(wanted) {
                *value = *given;
            }
            wanted += 1;
        });
        if wanted != values.len() {
            return Err(Error::Length {
                name: "values",
                expected: format!("{wanted}"),
                got: values.len(),
            });
        }
        check(&twin)?;
        Ok(twin)
    }

    /// Calls with every number, in the order of [`Network::parameters`].
    fn visit(&mut self, mut each: impl FnMut(&mut f64)) {
        for body in &mut self.bodies {
            each(&mut body.inertia);
        }
        for element in &mut self.elements {
            each(&mut element.a.ratio);
            each(&mut element.b.ratio);
            match &mut element.law {
                Law::Spring {
                    stiffness,
                    gap,
                    hardening,
                } => [stiffness, gap, hardening].into_iter().for_each(&mut each),
                Law::Damper { viscous, drag } => [viscous, drag].into_iter().for_each(&mut each),
                Law::Friction {
                    level,
                    difference,
                    stribeck,
                    stribeck_speed,
                    stiction,
                } => [level, difference, stribeck, stribeck_speed, stiction]
                    .into_iter()
                    .for_each(&mut each),
                Law::Assist { scale, .. } => each(scale),
            }
        }
    }
}
