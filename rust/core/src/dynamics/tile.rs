//! Samples of a block of lanes on their way into an array that holds lane after lane.
//!
//! Written one by one, the samples of an instant lie a whole record apart: every store needs a cache line of its own,
//! and the lines of all lanes fall into the same few sets of the cache. A tile keeps some instants and writes each
//! lane's in one piece.

/// Instants of a tile: two cache lines per lane.
const INSTANTS: usize = 16;

/// The last instants of `N` lanes, one value each.
pub(super) struct Tile<'a, const N: usize> {
    rows: [[f64; N]; INSTANTS],
    out: &'a mut [f64],
    lanes: usize,
    samples: usize,
}

impl<'a, const N: usize> Tile<'a, N> {
    /// On the way to `out`, which holds `samples` of each of `lanes` lanes, or is empty if nobody wants them.
    #[inline(always)]
    pub fn new(out: &'a mut [f64], lanes: usize, samples: usize) -> Self {
        Self {
            rows: [[0.0; N]; INSTANTS],
            out,
            lanes,
            samples,
        }
    }

    /// Takes the values of one instant; instants come in order, and after the last of them everything is written.
    #[inline(always)]
    pub fn take(&mut self, sample: usize, values: &[f64; N]) {
        if self.out.is_empty() {
            return;
        }
        let row = sample % INSTANTS;
        self.rows[row] = *values;
        if row + 1 == INSTANTS || sample + 1 == self.samples {
            let records = self.out.chunks_exact_mut(self.samples);
            for (lane, record) in records.enumerate().take(self.lanes) {
                let places = &mut record[sample - row..=sample];
                for (place, row) in places.iter_mut().zip(&self.rows) {
                    *place = row[lane];
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::{INSTANTS, Tile};

    #[test]
    fn every_sample_arrives_whatever_the_length() {
        for samples in [1, INSTANTS - 1, INSTANTS, INSTANTS + 1, 3 * INSTANTS + 5] {
            let mut out = vec![f64::NAN; 3 * samples];
            let mut tile = Tile::<8>::new(&mut out, 3, samples);
            for sample in 0..samples {
                tile.take(
                    sample,
                    &std::array::from_fn(|lane| (100 * lane + sample) as f64),
                );
            }
            for lane in 0..3 {
                for sample in 0..samples {
                    assert_eq!(out[lane * samples + sample], (100 * lane + sample) as f64);
                }
            }
        }
    }
}
