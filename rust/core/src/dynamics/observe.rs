//! What is looked at while a block of lanes runs, and written where it is kept.

use super::drive::Span;
use super::events::{EventKind, Turns, beyond_gap};
use super::keep::{ENERGIES, Keep, SUMMARY};
use super::ledger::Ledger;
use super::number::Pure;
use super::one_mass::OneMass;
use super::split::Step;
use crate::effects::Lane;

/// Where the results of a block go; what nobody wants is empty.
#[derive(Debug, Default)]
pub(super) struct Places<'a> {
    /// Angles, lane by lane.
    pub phi: &'a mut [f64],
    /// Speeds, lane by lane.
    pub speed: &'a mut [f64],
    /// One row per lane, as [`Keep`] says.
    pub rows: &'a mut [f64],
    /// Whether a lane is finished.
    pub done: &'a mut [bool],
}

/// Sums and extremes over the samples of a block.
pub(super) struct Samples<'a, const N: usize> {
    places: Places<'a>,
    keep: &'a Keep,
    lanes: usize,
    length: usize,
    width: usize,
    peak: [f64; N],
    squares: [f64; N],
    rest: [f64; N],
    least: [f64; N],
    greatest: [f64; N],
    next_chosen: usize,
}

impl<'a, const N: usize> Samples<'a, N> {
    pub fn new(places: Places<'a>, keep: &'a Keep, lanes: usize, length: usize) -> Self {
        Self {
            places,
            keep,
            lanes,
            length,
            width: keep.width(length),
            peak: [0.0; N],
            squares: [0.0; N],
            rest: [0.0; N],
            least: [0.0; N],
            greatest: [0.0; N],
            next_chosen: 0,
        }
    }

    /// Takes in one sample of every lane.
    #[inline(always)]
    pub fn take(&mut self, sample: usize, phi: &[f64; N], v: &[f64; N]) {
        for (place, values) in [(&mut self.places.phi, phi), (&mut self.places.speed, v)] {
            if !place.is_empty() {
                for lane in 0..self.lanes {
                    place[lane * self.length + sample] = values[lane];
                }
            }
        }
        if self.places.rows.is_empty() {
            return;
        }
        for lane in 0..N {
            let size = Pure(phi[lane]).abs();
            self.peak[lane] = size.when(size.0 > self.peak[lane], Pure(self.peak[lane])).0;
            self.squares[lane] += phi[lane] * phi[lane];
            self.rest[lane] += Pure::ONE.when(v[lane] == 0.0, Pure::ZERO).0;
        }
        if self.keep.window > 0 {
            self.envelope(sample, phi);
        }
        if self.keep.chosen.get(self.next_chosen) == Some(&sample) {
            let at = self.keep.chosen_at(self.length) + self.next_chosen;
            let count = self.keep.chosen.len();
            for lane in 0..self.lanes {
                self.places.rows[lane * self.width + at] = phi[lane];
                self.places.rows[lane * self.width + at + count] = v[lane];
            }
            self.next_chosen += 1;
        }
    }

    #[inline(always)]
    fn envelope(&mut self, sample: usize, phi: &[f64; N]) {
        let window = self.keep.window;
        if sample.is_multiple_of(window) {
            (self.least, self.greatest) = (*phi, *phi);
        }
        for lane in 0..N {
            let (here, least, greatest) = (
                Pure(phi[lane]),
                Pure(self.least[lane]),
                Pure(self.greatest[lane]),
            );
            self.least[lane] = here.when(here.0 < least.0, least).0;
            self.greatest[lane] = here.when(here.0 > greatest.0, greatest).0;
        }
        if (sample + 1).is_multiple_of(window) || sample + 1 == self.length {
            let at = self.keep.envelope_at() + sample / window;
            let windows = self.length.div_ceil(window);
            for lane in 0..self.lanes {
                self.places.rows[lane * self.width + at] = self.least[lane];
                self.places.rows[lane * self.width + at + windows] = self.greatest[lane];
            }
        }
    }

    /// Writes what stands at the end; `inside` are the counts and energies of every lane, in the order of the rows.
    pub fn finish(
        self,
        phi: &[f64; N],
        v: &[f64; N],
        inside: impl Fn(usize, &mut [f64], &mut [f64]),
    ) {
        let n = self.length as f64;
        if !self.places.rows.is_empty() {
            let rows = self.places.rows.chunks_exact_mut(self.width);
            for (lane, row) in rows.enumerate() {
                row[..SUMMARY.len()].copy_from_slice(&[
                    phi[lane],
                    v[lane],
                    self.peak[lane],
                    (self.squares[lane] / n).sqrt(),
                    self.rest[lane] / n,
                ]);
                let (head, tail) = row.split_at_mut(self.keep.energy_at());
                let energies = &mut tail[..self.keep.envelope_at() - self.keep.energy_at()];
                inside(lane, &mut head[Keep::events_at()..], energies);
            }
        }
        self.places.done.fill(true);
    }
}

/// Events counted and energies booked inside the steps of a block.
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

    /// A lane before its first step.
    pub fn begin(&mut self, lane: usize, body: &OneMass<Pure>, span: &Span, phi: Pure, v: Pure) {
        let (psi, _) = span.start();
        self.ledgers[lane].stored_first = body.stored(psi, phi, v).0;
        self.beyond[lane] = beyond_gap(body, psi.0, phi);
    }

    /// A lane after one step of length `h` from (`phi`, `v`).
    #[inline(always)]
    pub fn step(
        &mut self,
        lane: usize,
        body: &OneMass<Pure>,
        h: f64,
        span: &Span,
        (phi, v): (Pure, Pure),
        step: &Step,
    ) {
        let turns = Turns::of(v, step);
        let next = beyond_gap(body, span.end().0.0, step.phi);
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
        self.ledgers[lane].book(body, h, (phi, v), step, (span.start(), span.end()));
    }

    /// A lane after its last step.
    pub fn end(&mut self, lane: usize, body: &OneMass<Pure>, span: &Span, phi: Pure, v: Pure) {
        let ledger = &mut self.ledgers[lane];
        ledger.stored_last = body.stored(span.end().0, phi, v).0;
        ledger.turnover += ledger.stored_first;
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
