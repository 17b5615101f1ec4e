//! Which frictions hold and which slide, decided at an instant from torques and relative accelerations.

use super::box_qp::{BoxQp, Method};
use super::factor::Factor;
use super::forces::{Pair, Plan};
use super::rigid::Rigid;
use super::smooth::{State, Stretch, load};

// Frictions that break away with another, as those of a left and a right wheel do: shares of a stretch.
const TOGETHER: f64 = 1e-6;
// Halvings of a step that find a break-away where torques are not unique: to 1e-12 of the step.
const HALVINGS: usize = 40;

/// Room for the decisions; nothing is allocated after construction.
#[derive(Debug, Clone)]
pub(super) struct Contacts {
    method: Method,
    /// `W' M^-1 W`: relative acceleration per friction torque.
    matrix: Vec<f64>,
    /// Torques on the nodes, then accelerations.
    nodes: Vec<f64>,
    /// Relative accelerations without the frictions that hold, at one instant and at another.
    free: Vec<f64>,
    free_first: Vec<f64>,
    /// The frictions that hold.
    stuck: Vec<usize>,
    factor: Factor,
    unique: bool,
    /// Torques that hold, per friction; 0 where it slides.
    held: Vec<f64>,
    held_first: Vec<f64>,
    right: Vec<f64>,
    /// Directions into which frictions break away, as found last.
    loose: Vec<i8>,
    broken: Vec<bool>,
    qp: BoxQp,
}

impl Contacts {
    pub fn new(plan: &Plan, method: Method) -> Self {
        let c = plan.frictions.len();
        let mut matrix = vec![0.0; c * c];
        for (i, one) in plan.frictions.iter().enumerate() {
            for (j, other) in plan.frictions.iter().enumerate() {
                matrix[i * c + j] = coupling(plan, one.pair, other.pair);
            }
        }
        Self {
            method,
            matrix,
            nodes: vec![0.0; plan.nodes()],
            free: vec![0.0; c],
            free_first: vec![0.0; c],
            stuck: Vec::with_capacity(c),
            factor: Factor::new(c),
            unique: true,
            held: vec![0.0; c],
            held_first: vec![0.0; c],
            right: vec![0.0; c],
            loose: vec![0; c],
            broken: vec![false; c],
            qp: BoxQp::new(c),
        }
    }

    /// To be called when modes have changed.
    pub fn set(&mut self, modes: &[i8], rigid: &Rigid) {
        self.stuck.clear();
        let stuck = modes.iter().enumerate().filter(|(_, mode)| **mode == 0);
        self.stuck.extend(stuck.map(|(i, _)| i));
        let (matrix, stuck, c) = (&self.matrix, &self.stuck, modes.len());
        let regular = self
            .factor
            .set(stuck.len(), |i, j| matrix[stuck[i] * c + stuck[j]]);
        self.unique = regular && !rigid.redundant;
    }

    /// The torques that hold, in the last state that was looked at.
    pub fn held(&self) -> &[f64] {
        &self.held
    }

    /// Whether anything holds.
    pub fn any_stuck(&self) -> bool {
        !self.stuck.is_empty()
    }

    /// Relative accelerations in a state without the frictions that hold, into `self.free`.
    fn accelerate(&mut self, plan: &Plan, state: &State, stretch: &Stretch<'_>, share: f64) {
        let n = plan.bodies;
        self.nodes.fill(0.0);
        plan.elastic(&state.place, &mut self.nodes);
        load(plan, stretch.span, share, &mut self.nodes);
        plan.viscous(&state.speed, &mut self.nodes);
        plan.resisting(&state.speed, &state.modes, &mut self.nodes);
        for (torque, inertia) in self.nodes.iter_mut().zip(&plan.inertia) {
            *torque /= inertia;
        }
        for i in 0..plan.driven {
            self.nodes[n + i] = stretch.span[i].bend(share) / (stretch.h * stretch.h);
        }
        self.nodes[n + plan.driven] = 0.0;
        for (free, friction) in self.free.iter_mut().zip(&plan.frictions) {
            *free = friction.pair.of(&self.nodes);
        }
    }

    /// The torques that hold in a state; one of many where they are not unique.
    pub fn hold(&mut self, plan: &Plan, state: &State, stretch: &Stretch<'_>, share: f64) {
        self.accelerate(plan, state, stretch, share);
        self.held.fill(0.0);
        if self.unique {
            for (right, &i) in self.right.iter_mut().zip(&self.stuck) {
                *right = self.free[i];
            }
            self.factor.solve(&mut self.right[..self.stuck.len()]);
            for (right, &i) in self.right.iter().zip(&self.stuck) {
                self.held[i] = *right;
            }
        } else {
            self.solve_stuck(plan, 1.0);
            for (row, &i) in self.stuck.iter().enumerate() {
                self.held[i] = self.qp.torque()[row];
            }
        }
    }

    /// The programme over what holds, with relative accelerations between those of two instants. Returns whether all
    /// of it still holds.
    fn solve_stuck(&mut self, plan: &Plan, share: f64) -> bool {
        let (matrix, stuck, c) = (&self.matrix, &self.stuck, plan.frictions.len());
        self.qp
            .set_matrix(stuck.len(), |i, j| matrix[stuck[i] * c + stuck[j]]);
        for (row, &i) in stuck.iter().enumerate() {
            let friction = &plan.frictions[i];
            let free = self.free_first[i] + share * (self.free[i] - self.free_first[i]);
            let free = if share == 1.0 { self.free[i] } else { free };
            self.qp
                .set_row(row, free, -friction.held(-1.0), friction.held(1.0));
        }
        self.qp.solve(self.method);
        (0..stuck.len()).all(|row| self.qp.slides(row) == 0)
    }

    /// The share of a stretch between two states at which the first break-away happens, if there is one; which frictions
    /// then go, and where to, is in [`Contacts::loose`]. `pinned` ones are not looked at.
    pub fn break_away(
        &mut self,
        plan: &Plan,
        (first, last): (&State, &State),
        stretch: &Stretch<'_>,
        pinned: &[bool],
    ) -> Option<f64> {
        if self.stuck.is_empty() {
            return None;
        }
        self.hold(plan, last, stretch, stretch.to);
        if !self.unique {
            return self.break_away_of_many(plan, first, stretch, pinned);
        }
        let over = |i: usize, held: f64| {
            let friction = &plan.frictions[i];
            (held > friction.held(1.0) || -held > friction.held(-1.0)) && !pinned[i]
        };
        if !self.stuck.iter().any(|&i| over(i, self.held[i])) {
            return None;
        }
        std::mem::swap(&mut self.held, &mut self.held_first);
        self.hold(plan, first, stretch, stretch.from);
        std::mem::swap(&mut self.held, &mut self.held_first);
        let mut earliest = 1.0;
        self.loose.fill(0);
        for &i in &self.stuck {
            let (before, after) = (self.held_first[i], self.held[i]);
            if over(i, after) {
                let direction = after.signum();
                let limit = direction * plan.frictions[i].held(direction);
                let at = ((limit - before) / (after - before)).clamp(0.0, 1.0);
                // Over the limit from the start, and no interpolation: at once.
                let at = if at.is_nan() { 0.0 } else { at };
                self.loose[i] = if direction > 0.0 { 1 } else { -1 };
                self.right[i] = at;
                if at < earliest {
                    earliest = at;
                }
            }
        }
        for (loose, at) in self.loose.iter_mut().zip(&self.right) {
            if *at > earliest + TOGETHER {
                *loose = 0;
            }
        }
        Some(earliest)
    }

    /// The same where the torques are not unique: whether anything holds is asked of the programme.
    fn break_away_of_many(
        &mut self,
        plan: &Plan,
        first: &State,
        stretch: &Stretch<'_>,
        pinned: &[bool],
    ) -> Option<f64> {
        let holds = |contacts: &Self| {
            (contacts.stuck.iter().enumerate())
                .all(|(row, &i)| contacts.qp.slides(row) == 0 || pinned[i])
        };
        if holds(self) {
            return None;
        }
        std::mem::swap(&mut self.free, &mut self.free_first);
        self.accelerate(plan, first, stretch, stretch.from);
        std::mem::swap(&mut self.free, &mut self.free_first);
        let (mut low, mut high) = (0.0, 1.0);
        for _ in 0..HALVINGS {
            let middle = 0.5 * (low + high);
            self.solve_stuck(plan, middle);
            if holds(self) {
                low = middle;
            } else {
                high = middle;
            }
        }
        self.solve_stuck(plan, high);
        self.loose.fill(0);
        for (row, &i) in self.stuck.iter().enumerate() {
            self.loose[i] = self.qp.slides(row);
        }
        Some(high)
    }

    /// For each friction the direction into which it breaks away, 0 if it does not, as [`Contacts::break_away`] found.
    pub fn loose(&self) -> &[i8] {
        &self.loose
    }

    /// Decides for the frictions of mode 0 in a state whether they hold or slide, and writes their modes. What breaks
    /// away has kinetic friction from then on, which may make others break away.
    pub fn decide(&mut self, plan: &Plan, state: &mut State, stretch: &Stretch<'_>, share: f64) {
        self.stuck.clear();
        let stuck = state
            .modes
            .iter()
            .enumerate()
            .filter(|(_, mode)| **mode == 0);
        self.stuck.extend(stuck.map(|(i, _)| i));
        if self.stuck.is_empty() {
            return;
        }
        self.accelerate(plan, state, stretch, share);
        self.broken.fill(false);
        let c = plan.frictions.len();
        // Every round but the last breaks one away at least.
        for _ in 0..=c {
            let (matrix, stuck) = (&self.matrix, &self.stuck);
            self.qp
                .set_matrix(stuck.len(), |i, j| matrix[stuck[i] * c + stuck[j]]);
            for (row, &i) in stuck.iter().enumerate() {
                let friction = &plan.frictions[i];
                let extra = if self.broken[i] {
                    friction.stiction
                } else {
                    0.0
                };
                let (low, high) = (extra - friction.held(-1.0), friction.held(1.0) - extra);
                self.qp.set_row(row, self.free[i], low, high);
            }
            self.qp.solve(self.method);
            let mut again = false;
            for (row, &i) in stuck.iter().enumerate() {
                let breaks =
                    self.qp.slides(row) != 0 && !self.broken[i] && plan.frictions[i].stiction > 0.0;
                self.broken[i] |= breaks;
                again |= breaks;
            }
            if !again {
                break;
            }
        }
        for (row, &i) in self.stuck.iter().enumerate() {
            state.modes[i] = self.qp.slides(row);
        }
    }
}

/// Relative acceleration along one pair per torque along another.
fn coupling(plan: &Plan, one: Pair, other: Pair) -> f64 {
    let mut sum = 0.0;
    for (a, ca) in [(one.a, one.ca), (one.b, one.cb)] {
        for (b, cb) in [(other.a, other.ca), (other.b, other.cb)] {
            if a == b && a < plan.bodies {
                sum += ca * cb / plan.inertia[a];
            }
        }
    }
    sum
}
