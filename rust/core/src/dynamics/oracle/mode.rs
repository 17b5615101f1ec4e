//! A mode: which gaps are closed to which side, which body slides where; and the linear equation that holds in it.

use super::series::{ORDER, Series};
use super::signal::Instant;
use super::system::System;

/// Angles and speeds of the bodies at an instant.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct State {
    pub angle: Vec<f64>,
    pub speed: Vec<f64>,
}

/// A mode and its linear equation `I q'' = drive - stiffness q - damping q'`.
#[derive(Debug, Clone)]
pub(super) struct Mode<'a> {
    system: &'a System,
    /// Of each spring with a gap: -1, 0, 1, where 0 is inside the gap.
    pub contact: Vec<i8>,
    /// Of each body: -1, 0, 1, the side to which it slides on its ground; 0 is held.
    pub way: Vec<i8>,
    stiffness: Vec<f64>,
    damping: Vec<f64>,
    /// What acts on each body without a drive: the far end of the gap, dry friction, the ground's drag.
    constant: Vec<[f64; 3]>,
}

/// The motion over a stretch, as power series from its start.
#[derive(Debug, Clone)]
pub(super) struct Stretch {
    /// Angles of the bodies.
    pub angle: Vec<Series>,
    /// Torque on each body but for the friction on its own coordinate.
    pub torque: Vec<Series>,
    /// Of each spring: driven end less bodies' end.
    pub wound: Vec<Series>,
}

impl<'a> Mode<'a> {
    /// The mode that a state begins in: bodies at rest on their ground are held, gaps are closed beyond their edge.
    pub fn of(system: &'a System, now: Instant, state: &State) -> Self {
        let way = system
            .bodies
            .iter()
            .zip(&state.speed)
            .map(|(body, speed)| sign(speed - body.ground_speed))
            .collect();
        let contact = system
            .springs
            .iter()
            .map(|spring| {
                let ends: f64 = spring.at.iter().zip(&state.angle).map(|(a, q)| a * q).sum();
                let wound = spring.end.series(now).value[0] - ends;
                if wound.abs() > spring.half_gap {
                    sign(wound)
                } else {
                    0
                }
            })
            .collect();
        let mut mode = Self {
            system,
            contact,
            way,
            stiffness: Vec::new(),
            damping: Vec::new(),
            constant: Vec::new(),
        };
        mode.assemble();
        mode
    }

    /// Writes the linear equation of the mode; to be called when `contact` or `way` has changed.
    pub fn assemble(&mut self) {
        let n = self.system.count();
        self.stiffness.clone_from(&self.system.stiffness);
        self.damping.clone_from(&self.system.damping);
        self.constant = vec![[0.0; 3]; n];
        for (spring, &side) in self.system.springs.iter().zip(&self.contact) {
            // Without a gap the spring always pulls.
            if side == 0 && spring.half_gap > 0.0 {
                continue;
            }
            for i in 0..n {
                for j in 0..n {
                    self.stiffness[i * n + j] += spring.stiffness * spring.at[i] * spring.at[j];
                }
                let far = spring.stiffness * spring.at[i] * spring.half_gap;
                self.constant[i][0] -= f64::from(side) * far;
            }
        }
        for (i, body) in self.system.bodies.iter().enumerate() {
            if self.way[i] == 0 {
                continue;
            }
            let side = usize::from(self.way[i] < 0);
            self.damping[i * n + i] += body.viscous[side];
            self.constant[i][1] = -f64::from(self.way[i]) * body.kinetic[side];
            self.constant[i][2] = body.viscous[side] * body.ground_speed;
        }
    }

    /// A bound on how quickly the motion and its drive change: a stretch of length `1 / rate` is short (see
    /// [`ORDER`]). Springs and dampers are measured in the coordinates `sqrt(I) q`, in which units drop out.
    pub fn rate_rad_s(&self) -> f64 {
        let n = self.system.count();
        let norm = |matrix: &[f64]| {
            (0..n)
                .filter(|&i| self.way[i] != 0)
                .fold(0.0, |most: f64, i| {
                    let row = (0..n).filter(|&j| self.way[j] != 0).map(|j| {
                        let scale = self.system.bodies[i].inertia * self.system.bodies[j].inertia;
                        matrix[i * n + j].abs() / scale.sqrt()
                    });
                    most.max(row.sum())
                })
        };
        let drive = self.system.signals().map(super::Signal::highest_rad_s);
        let own = norm(&self.stiffness).sqrt().max(norm(&self.damping));
        drive.fold(own, f64::max)
    }

    /// The motion from an instant on, exact to rounding over `1 / rate` seconds.
    pub fn stretch(&self, now: Instant, state: &State) -> Stretch {
        let n = self.system.count();
        let ends: Vec<Series> = self
            .system
            .springs
            .iter()
            .map(|s| s.end.series(now))
            .collect();
        let mut torque: Vec<Series> = self
            .system
            .bodies
            .iter()
            .map(|b| b.load.series(now))
            .collect();
        for ((spring, &side), end) in self.system.springs.iter().zip(&self.contact).zip(&ends) {
            if side != 0 || spring.half_gap == 0.0 {
                for (total, at) in torque.iter_mut().zip(&spring.at) {
                    total.add_times(spring.stiffness * at, end);
                }
            }
        }
        let mut angle = vec![Series::ZERO; n];
        for i in 0..n {
            torque[i].add(0, &self.constant[i][..1]);
            angle[i].add(0, &[state.angle[i]]);
            angle[i].add(1, &[state.speed[i]]);
        }
        for k in 0..=ORDER {
            for i in 0..n {
                for j in 0..n {
                    let spring = self.stiffness[i * n + j];
                    torque[i].value[k] -= spring * angle[j].value[k];
                    torque[i].size[k] += spring.abs() * angle[j].size[k];
                    if k < ORDER {
                        // Dampers, and the body's own viscous friction while it slides; a held body has none, and
                        // only its torque is asked for.
                        let damper = self.damping[i * n + j] * (k + 1) as f64;
                        torque[i].value[k] -= damper * angle[j].value[k + 1];
                        torque[i].size[k] += damper.abs() * angle[j].size[k + 1];
                    }
                }
                if k + 2 > ORDER || self.way[i] == 0 {
                    continue;
                }
                let mut value = torque[i].value[k];
                let mut size = torque[i].size[k];
                if k == 0 {
                    for term in &self.constant[i][1..] {
                        value += term;
                        size += term.abs();
                    }
                }
                let under = self.system.bodies[i].inertia * ((k + 1) * (k + 2)) as f64;
                angle[i].value[k + 2] = value / under;
                angle[i].size[k + 2] = size / under;
            }
        }
        let wound = self
            .system
            .springs
            .iter()
            .zip(ends)
            .map(|(spring, mut end)| {
                for (at, q) in spring.at.iter().zip(&angle) {
                    end.add_times(-at, q);
                }
                end
            })
            .collect();
        Stretch {
            angle,
            torque,
            wound,
        }
    }
}

impl Stretch {
    /// The state some seconds after the start.
    pub fn state(&self, mode: &Mode, seconds: f64) -> State {
        let speed = self
            .angle
            .iter()
            .zip(mode.system.bodies.iter())
            .zip(&mode.way);
        State {
            angle: self.angle.iter().map(|q| q.at(seconds)).collect(),
            speed: speed
                .map(|((q, body), &way)| {
                    if way == 0 {
                        body.ground_speed
                    } else {
                        q.rate().at(seconds)
                    }
                })
                .collect(),
        }
    }
}

fn sign(x: f64) -> i8 {
    i8::from(x > 0.0) - i8::from(x < 0.0)
}
