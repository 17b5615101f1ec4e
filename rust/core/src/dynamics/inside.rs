//! Events counted and energies booked inside the steps of a block of lanes.

use super::events::{EventKind, Turns, beyond_gap};
use super::keep::ENERGIES;
use super::lane_drives::Spans;
use super::ledger::Ledger;
use super::number::Pure;
use super::one_mass::{OneMass, PARAMETERS};
use super::split::Step;

/// The parameters of a block, a row of lanes for each.
pub(super) type Table<const N: usize> = [[f64; N]; PARAMETERS];

/// One step of every lane.
pub(super) struct Steps<const N: usize> {
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

    /// Angles and speeds at the end of the step.
    #[inline(always)]
    pub fn end(&self) -> ([f64; N], [f64; N]) {
        (self.rows[0], self.rows[1])
    }
}

/// Events and energies of every lane.
pub(super) struct Inside<const N: usize> {
    counts: [[f64; N]; EventKind::ALL.len()],
    beyond: [f64; N],
    ledgers: [Ledger; N],
}

impl<const N: usize> Inside<N> {
    pub fn new() -> Self {
        Self {
            counts: [[0.0; N]; EventKind::ALL.len()],
            beyond: [0.0; N],
            ledgers: [Ledger::default(); N],
        }
    }

    /// Before the first step.
    pub fn begin(&mut self, table: &Table<N>, spans: &Spans<N>, phi: &[f64; N], v: &[f64; N]) {
        for lane in 0..N {
            let body = OneMass::gather(table, lane);
            let (psi, _) = spans.of(lane).start();
            let (phi, v) = (Pure(phi[lane]), Pure(v[lane]));
            self.ledgers[lane].stored_first = body.stored(psi, phi, v).0;
            self.beyond[lane] = beyond_gap(&body, psi.0, phi);
        }
    }

    /// After one step of length `h` from angles and speeds.
    #[inline(always)]
    pub fn step(
        &mut self,
        table: &Table<N>,
        h: f64,
        spans: &Spans<N>,
        (phi, v): (&[f64; N], &[f64; N]),
        steps: &Steps<N>,
    ) {
        self.count(table, spans, v, steps);
        for lane in 0..N {
            let (body, span) = (OneMass::gather(table, lane), spans.of(lane));
            let before = (Pure(phi[lane]), Pure(v[lane]));
            let drives = (span.start(), span.end());
            self.ledgers[lane].book(&body, h, before, &steps.get(lane), drives);
        }
    }

    #[inline(always)]
    fn count(&mut self, table: &Table<N>, spans: &Spans<N>, v: &[f64; N], steps: &Steps<N>) {
        for lane in 0..N {
            let body = OneMass::gather(table, lane);
            let step = steps.get(lane);
            let turns = Turns::of(Pure(v[lane]), &step);
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
    pub fn end(&mut self, table: &Table<N>, spans: &Spans<N>, phi: &[f64; N], v: &[f64; N]) {
        for lane in 0..N {
            let body = OneMass::gather(table, lane);
            let (psi, _) = spans.of(lane).end();
            let ledger = &mut self.ledgers[lane];
            ledger.stored_last = body.stored(psi, Pure(phi[lane]), Pure(v[lane])).0;
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
