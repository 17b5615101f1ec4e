//! A block of lanes that is looked at inside of its steps, or whose lanes have drives of their own.

use pulp::WithSimd;

use super::lanes::{Advance, Drives, Kernel, MoreauJean, Part, Split};
use super::number::Pure;
use super::observe::{Inside, Samples};
use super::one_mass::{OneMass, PARAMETERS};
use super::split::Pace;
use super::{drive::Span, lane_drives::BlockDrives};

/// One block of `N` lanes, the same steps with the same bits as [`super::lanes::Task`].
pub(super) struct Watched<'a, const INSIDE: bool, const N: usize>(pub Part<'a>);

impl<const INSIDE: bool, const N: usize> WithSimd for Watched<'_, INSIDE, N> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: pulp::Simd>(self, _simd: S) {
        match (self.0.kernel, self.0.rich) {
            (Kernel::Split, false) => self.along::<Split<false>>(),
            (Kernel::Split, true) => self.along::<Split<true>>(),
            (Kernel::MoreauJean, _) => self.along::<MoreauJean>(),
        }
    }
}

/// The drive of a block, one sub-step after the other.
enum Source<'a, const N: usize> {
    Shared(&'a super::Drive, usize),
    Own(Box<BlockDrives<'a, N>>),
}

impl<'a, const N: usize> Source<'a, N> {
    fn of(part: &Part<'a>) -> Self {
        match part.drives {
            Drives::Shared(drive) => Self::Shared(drive, 0),
            Drives::Own(drives) => Self::Own(Box::new(drives.block(part.first, part.bodies.len()))),
        }
    }

    #[inline(always)]
    fn advance(&mut self, sample: usize, sub: usize) {
        match self {
            Self::Shared(drive, step) => *step = sample * drive.substeps() + sub,
            Self::Own(drives) => drives.advance(sample, sub),
        }
    }

    #[inline(always)]
    fn span(&self, lane: usize) -> Span {
        match self {
            Self::Shared(drive, step) => drive.span(*step),
            Self::Own(drives) => drives.span(lane),
        }
    }
}

impl<const INSIDE: bool, const N: usize> Watched<'_, INSIDE, N> {
    #[inline(always)]
    fn along<A: Advance>(self) {
        let mut source = Source::<N>::of(&self.0);
        let part = self.0;
        let lanes = part.bodies.len();
        let mut table = [[0.0; N]; PARAMETERS];
        let (mut phi, mut v) = ([0.0; N], [0.0; N]);
        for lane in 0..N {
            let of = lane.min(lanes - 1);
            for (row, value) in table.iter_mut().zip(part.bodies[of].to_array()) {
                row[lane] = value;
            }
            phi[lane] = part.starts[of].phi;
            v[lane] = part.starts[of].speed;
        }
        let (samples, substeps) = (part.drives.samples(), part.drives.substeps());
        let h = Pure(part.drives.step_s());
        let mut inside = Inside::<N>::new();
        let mut seen = Samples::<N>::new(part.places, part.keep, lanes, samples);
        for sample in 0..samples {
            if part.control.stopped() {
                return;
            }
            seen.take(sample, &phi, &v);
            if sample + 1 == samples {
                break;
            }
            for sub in 0..substeps {
                source.advance(sample, sub);
                if INSIDE && sample == 0 && sub == 0 {
                    for lane in 0..N {
                        let body = OneMass::gather(&table, lane);
                        inside.begin(
                            lane,
                            &body,
                            &source.span(lane),
                            Pure(phi[lane]),
                            Pure(v[lane]),
                        );
                    }
                }
                for lane in 0..N {
                    let body = OneMass::gather(&table, lane);
                    let span = source.span(lane);
                    let before = (Pure(phi[lane]), Pure(v[lane]));
                    let next = A::step(&body, &span, Pace::of(&body, h), before.0, before.1);
                    if INSIDE {
                        inside.step(lane, &body, h.0, &span, before, &next);
                    }
                    phi[lane] = next.phi.0;
                    v[lane] = next.speed.0;
                }
            }
        }
        if INSIDE {
            for lane in 0..N {
                let body = OneMass::gather(&table, lane);
                inside.end(
                    lane,
                    &body,
                    &source.span(lane),
                    Pure(phi[lane]),
                    Pure(v[lane]),
                );
            }
        }
        seen.finish(&phi, &v, |lane, counts, energies| {
            inside.write(lane, counts, energies);
        });
        part.control.add(lanes);
    }
}
