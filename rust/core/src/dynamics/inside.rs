//! Events counted and energies booked inside the steps of a block of lanes.

use super::events::{EventKind, Turns, beyond_gap};
use super::keep::ENERGIES;
use super::lane_drives::Spans;
use super::ledger::{ENTRIES, Ledger, TAME, entry};
use super::march::{Advance, GROUP, Lanes, State};
use super::number::Pure;
use super::one_mass::{EVERY, PLAIN, WAVY};
use super::split::{Carried, Step};

/// One step of a group of lanes.
struct Steps {
    rows: [[f64; GROUP]; 9],
}

impl Steps {
    #[inline(always)]
    fn new() -> Self {
        Self {
            rows: [[0.0; GROUP]; 9],
        }
    }

    #[inline(always)]
    fn put(&mut self, lane: usize, step: &Step) {
        self.rows[0][lane] = step.phi.0;
        self.rows[1][lane] = step.speed.0;
        self.rows[2][lane] = step.phi_turn.0;
        self.rows[3][lane] = step.moving.0;
        self.rows[4][lane] = step.stuck.0;
        self.rows[5][lane] = step.speed_turn.0;
        self.rows[6][lane] = step.grip.0;
        self.rows[7][lane] = step.carried.rest_s.0;
        self.rows[8][lane] = step.carried.bristle.0;
    }

    #[inline(always)]
    fn get(&self, lane: usize) -> Step {
        Step {
            phi: Pure(self.rows[0][lane]),
            speed: Pure(self.rows[1][lane]),
            phi_turn: Pure(self.rows[2][lane]),
            moving: Pure(self.rows[3][lane]),
            stuck: Pure(self.rows[4][lane]),
            speed_turn: Pure(self.rows[5][lane]),
            grip: Pure(self.rows[6][lane]),
            carried: Carried {
                rest_s: Pure(self.rows[7][lane]),
                bristle: Pure(self.rows[8][lane]),
            },
        }
    }
}

/// Events and energies of every lane.
pub(super) struct Inside<const N: usize> {
    counts: [[f64; N]; EventKind::ALL.len()],
    beyond: [f64; N],
    booked: Option<usize>,
    entries: [[f64; N]; ENTRIES],
    first: [f64; N],
    last: [f64; N],
}

impl<const N: usize> Inside<N> {
    /// With the effects at work where energies are booked.
    pub fn new(booked: Option<usize>) -> Self {
        Self {
            counts: [[0.0; N]; EventKind::ALL.len()],
            beyond: [0.0; N],
            booked,
            entries: [[0.0; N]; ENTRIES],
            first: [0.0; N],
            last: [0.0; N],
        }
    }

    /// Before the first step.
    pub fn begin(&mut self, lanes: &Lanes<N>, spans: &Spans<N>, state: &State<N>) {
        for lane in 0..N {
            let (body, _) = lanes.lane(lane);
            let (phi, v) = state.at(lane);
            let (psi, _) = spans.of(lane).start();
            self.first[lane] = body.stored(psi, phi, v).0;
            self.beyond[lane] = beyond_gap(&body, psi.0, phi);
        }
    }

    /// Takes every lane one sub-step further and looks at what happened.
    #[inline(always)]
    pub fn step<A: Advance>(&mut self, lanes: &Lanes<N>, spans: &Spans<N>, state: &mut State<N>) {
        for first in (0..N).step_by(GROUP) {
            // A loop for each job, over local rows: that is what becomes vector instructions.
            let mut steps = Steps::new();
            for i in 0..GROUP {
                let (body, pace) = lanes.lane(first + i);
                let (from, carried) = (state.at(first + i), state.carried(first + i));
                steps.put(
                    i,
                    &A::step(&body, &spans.of(first + i), pace, from, carried),
                );
            }
            self.count(first, lanes, spans, state, &steps);
            match self.booked {
                None => {}
                Some(PLAIN) => self.book::<PLAIN>(first, lanes, spans, state, &steps),
                Some(1..WAVY) => self.book::<TAME>(first, lanes, spans, state, &steps),
                Some(_) => self.book::<EVERY>(first, lanes, spans, state, &steps),
            }
            state.phi[first..first + GROUP].copy_from_slice(&steps.rows[0]);
            state.v[first..first + GROUP].copy_from_slice(&steps.rows[1]);
            state.rest_s[first..first + GROUP].copy_from_slice(&steps.rows[7]);
            state.bristle[first..first + GROUP].copy_from_slice(&steps.rows[8]);
        }
    }

    #[inline(always)]
    fn book<const WITH: usize>(
        &mut self,
        first: usize,
        lanes: &Lanes<N>,
        spans: &Spans<N>,
        state: &State<N>,
        steps: &Steps,
    ) {
        let mut entries = [[0.0; GROUP]; ENTRIES];
        for i in 0..GROUP {
            let (body, pace) = lanes.lane(first + i);
            let span = spans.of(first + i);
            let drives = (span.start(), span.end());
            let from = state.at(first + i);
            let booked = entry::<WITH>(&body, pace.h.0, from, &steps.get(i), drives);
            for k in 0..ENTRIES {
                entries[k][i] = booked[k];
            }
        }
        for (sums, row) in self.entries.iter_mut().zip(&entries) {
            for i in 0..GROUP {
                sums[first + i] += row[i];
            }
        }
    }

    #[inline(always)]
    fn count(
        &mut self,
        first: usize,
        lanes: &Lanes<N>,
        spans: &Spans<N>,
        state: &State<N>,
        steps: &Steps,
    ) {
        let mut counted = [[0.0; GROUP]; EventKind::ALL.len()];
        let mut beyond = [0.0; GROUP];
        for i in 0..GROUP {
            let (body, _) = lanes.lane(first + i);
            let step = steps.get(i);
            let (_, v) = state.at(first + i);
            let turns = Turns::of(v, &step);
            let next = beyond_gap(&body, spans.of(first + i).end().0.0, step.phi);
            let (was, is) = (self.beyond[first + i] > 0.0, next > 0.0);
            let has_gap = body.gap.0 > 0.0;
            beyond[i] = next;
            for (row, happened) in counted.iter_mut().zip([
                turns.stick,
                turns.slip,
                turns.reversal,
                has_gap & !was & is,
                has_gap & was & !is,
            ]) {
                row[i] = Pure::ONE.when(happened, Pure::ZERO).0;
            }
        }
        self.beyond[first..first + GROUP].copy_from_slice(&beyond);
        for (sums, row) in self.counts.iter_mut().zip(&counted) {
            for i in 0..GROUP {
                sums[first + i] += row[i];
            }
        }
    }

    /// After the last step.
    pub fn end(&mut self, lanes: &Lanes<N>, spans: &Spans<N>, state: &State<N>) {
        for lane in 0..N {
            let (body, _) = lanes.lane(lane);
            let (phi, v) = state.at(lane);
            let (psi, _) = spans.of(lane).end();
            self.last[lane] = body.stored(psi, phi, v).0;
        }
    }

    /// Writes the counts and energies of a lane; either may be empty.
    pub fn write(&self, lane: usize, counts: &mut [f64], energies: &mut [f64]) {
        for (place, row) in counts.iter_mut().zip(&self.counts) {
            *place = row[lane];
        }
        if energies.len() == ENERGIES.len() {
            let mut ledger = Ledger {
                stored_first: self.first[lane],
                stored_last: self.last[lane],
                ..Ledger::default()
            };
            ledger.book(&self.entries.each_ref().map(|row| row[lane]));
            ledger.turnover += ledger.stored_first;
            energies.copy_from_slice(&ledger.to_array());
        }
    }
}
