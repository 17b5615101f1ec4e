//! Events counted and energies booked inside the steps of a block of lanes.

use super::events::{EventKind, Turns, beyond_gap};
use super::keep::ENERGIES;
use super::lane_drives::Spans;
use super::ledger::Ledger;
use super::march::{Advance, Lanes, State};
use super::number::Pure;
use super::split::Step;

/// One step of every lane.
struct Steps<const N: usize> {
    rows: [[f64; N]; 6],
}

impl<const N: usize> Steps<N> {
    pub fn new() -> Self {
        Self {
            rows: [[0.0; N]; 6],
        }
    }

    #[inline(always)]
    pub fn put(&mut self, lane: usize, step: &Step) {
        let values = [
            step.phi,
            step.speed,
            step.phi_turn,
            step.moving,
            step.stuck,
            step.speed_turn,
        ];
        for (row, value) in self.rows.iter_mut().zip(values) {
            row[lane] = value.0;
        }
    }

    #[inline(always)]
    fn get(&self, lane: usize) -> Step {
        let [phi, speed, phi_turn, moving, stuck, speed_turn] =
            self.rows.each_ref().map(|row| Pure(row[lane]));
        Step {
            phi,
            speed,
            phi_turn,
            moving,
            stuck,
            speed_turn,
        }
    }
}

/// Events and energies of every lane.
pub(super) struct Inside<const N: usize> {
    steps: Steps<N>,
    counts: [[f64; N]; EventKind::ALL.len()],
    beyond: [f64; N],
    ledgers: [Ledger; N],
}

impl<const N: usize> Inside<N> {
    pub fn new() -> Self {
        Self {
            steps: Steps::new(),
            counts: [[0.0; N]; EventKind::ALL.len()],
            beyond: [0.0; N],
            ledgers: [Ledger::default(); N],
        }
    }

    /// Before the first step.
    pub fn begin(&mut self, lanes: &Lanes<N>, spans: &Spans<N>, state: &State<N>) {
        for lane in 0..N {
            let (body, _) = lanes.lane(lane);
            let (phi, v) = state.at(lane);
            let (psi, _) = spans.of(lane).start();
            self.ledgers[lane].stored_first = body.stored(psi, phi, v).0;
            self.beyond[lane] = beyond_gap(&body, psi.0, phi);
        }
    }

    /// Takes every lane one sub-step further and looks at what happened.
    #[inline(always)]
    pub fn step<A: Advance>(&mut self, lanes: &Lanes<N>, spans: &Spans<N>, state: &mut State<N>) {
        // One loop for each job: together they are too much for the registers.
        for lane in 0..N {
            let (body, pace) = lanes.lane(lane);
            let (phi, v) = state.at(lane);
            let step = A::step(&body, &spans.of(lane), pace, phi, v);
            self.steps.put(lane, &step);
        }
        self.count(lanes, spans, state);
        for lane in 0..N {
            let (body, pace) = lanes.lane(lane);
            let span = spans.of(lane);
            let drives = (span.start(), span.end());
            let step = self.steps.get(lane);
            self.ledgers[lane].book(&body, pace.h.0, state.at(lane), &step, drives);
        }
        (state.phi, state.v) = (self.steps.rows[0], self.steps.rows[1]);
    }

    #[inline(always)]
    fn count(&mut self, lanes: &Lanes<N>, spans: &Spans<N>, state: &State<N>) {
        for lane in 0..N {
            let (body, _) = lanes.lane(lane);
            let step = self.steps.get(lane);
            let (_, v) = state.at(lane);
            let turns = Turns::of(v, &step);
            let next = beyond_gap(&body, spans.of(lane).end().0.0, step.phi);
            let (was, is) = (self.beyond[lane] > 0.0, next > 0.0);
            let has_gap = body.gap.0 > 0.0;
            self.beyond[lane] = next;
            for (row, happened) in self.counts.iter_mut().zip([
                turns.stick,
                turns.slip,
                turns.reversal,
                has_gap & !was & is,
                has_gap & was & !is,
            ]) {
                row[lane] += Pure::ONE.when(happened, Pure::ZERO).0;
            }
        }
    }

    /// After the last step.
    pub fn end(&mut self, lanes: &Lanes<N>, spans: &Spans<N>, state: &State<N>) {
        for lane in 0..N {
            let (body, _) = lanes.lane(lane);
            let (phi, v) = state.at(lane);
            let (psi, _) = spans.of(lane).end();
            let ledger = &mut self.ledgers[lane];
            ledger.stored_last = body.stored(psi, phi, v).0;
            ledger.turnover += ledger.stored_first;
        }
    }

    /// Writes the counts and energies of a lane; either may be empty.
    pub fn write(&self, lane: usize, counts: &mut [f64], energies: &mut [f64]) {
        for (place, row) in counts.iter_mut().zip(&self.counts) {
            *place = row[lane];
        }
        if energies.len() == ENERGIES.len() {
            energies.copy_from_slice(&self.ledgers[lane].to_array());
        }
    }
}
