//! What is looked at while a block of lanes runs from sample to sample, and written where it is kept.

use super::keep::{Keep, SUMMARY};
use super::march::State;
use super::number::Pure;
use super::tile::Tile;
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
    angles: Tile<'a, N>,
    speeds: Tile<'a, N>,
    rows: &'a mut [f64],
    done: &'a mut [bool],
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
        let Places {
            phi,
            speed,
            rows,
            done,
        } = places;
        Self {
            angles: Tile::new(phi, lanes, length),
            speeds: Tile::new(speed, lanes, length),
            rows,
            done,
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
    pub fn take(&mut self, sample: usize, state: &State<N>) {
        let State { phi, v, .. } = state;
        self.angles.take(sample, phi);
        self.speeds.take(sample, v);
        if self.rows.is_empty() {
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
                self.rows[lane * self.width + at] = phi[lane];
                self.rows[lane * self.width + at + count] = v[lane];
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
                self.rows[lane * self.width + at] = self.least[lane];
                self.rows[lane * self.width + at + windows] = self.greatest[lane];
            }
        }
    }

    /// Writes what stands at the end; `inside` are the counts and energies of every lane, in the order of the rows.
    pub fn finish(self, state: &State<N>, inside: impl Fn(usize, &mut [f64], &mut [f64])) {
        let n = self.length as f64;
        if !self.rows.is_empty() {
            let rows = self.rows.chunks_exact_mut(self.width);
            for (lane, row) in rows.enumerate() {
                row[..SUMMARY.len()].copy_from_slice(&[
                    state.phi[lane],
                    state.v[lane],
                    self.peak[lane],
                    (self.squares[lane] / n).sqrt(),
                    self.rest[lane] / n,
                ]);
                let (head, tail) = row.split_at_mut(self.keep.energy_at());
                let energies = &mut tail[..self.keep.envelope_at() - self.keep.energy_at()];
                inside(lane, &mut head[Keep::events_at()..], energies);
            }
        }
        self.done.fill(true);
    }
}
