//! A block of lanes that is looked at inside of its steps, or whose lanes have drives of their own.

use pulp::WithSimd;

use super::drive::Drive;
use super::inside::{Inside, Steps};
use super::lane_drives::{BlockDrives, Spans};
use super::lanes::{Advance, Drives, Kernel, MoreauJean, Part, Split};
use super::number::Pure;
use super::observe::Samples;
use super::one_mass::{OneMass, PARAMETERS};
use super::split::Pace;

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
    Shared(&'a Drive),
    Own(Box<BlockDrives<'a, N>>),
}

impl<'a, const N: usize> Source<'a, N> {
    fn of(part: &Part<'a>) -> Self {
        match part.drives {
            Drives::Shared(drive) => Self::Shared(drive),
            Drives::Own(drives) => Self::Own(Box::new(drives.block(part.first, part.bodies.len()))),
        }
    }

    #[inline(always)]
    fn advance(&mut self, spans: &mut Spans<N>, sample: usize, sub: usize) {
        match self {
            Self::Shared(drive) => spans.share(&drive.span(sample * drive.substeps() + sub)),
            Self::Own(drives) => drives.advance(spans, sample, sub),
        }
    }
}

/// Sub-steps between two looks whether to stop, where a sampling interval has many: a tenth of a millisecond.
const LOOK: usize = 512;

impl<const INSIDE: bool, const N: usize> Watched<'_, INSIDE, N> {
    #[inline(always)]
    fn along<A: Advance>(self) {
        let mut source = Source::<N>::of(&self.0);
        let part = self.0;
        let lanes = part.bodies.len();
        let mut table = [[0.0; N]; PARAMETERS];
        let (mut phi, mut v) = ([0.0; N], [0.0; N]);
        let h = Pure(part.drives.step_s());
        let mut paces = [[0.0; N]; 3];
        for lane in 0..N {
            let of = lane.min(lanes - 1);
            for (row, value) in table.iter_mut().zip(part.bodies[of].to_array()) {
                row[lane] = value;
            }
            phi[lane] = part.starts[of].phi;
            v[lane] = part.starts[of].speed;
            let pace = Pace::of(&OneMass::gather(&table, lane), h);
            (paces[0][lane], paces[1][lane], paces[2][lane]) =
                (pace.rate.0, pace.kept.0, pace.damped.0);
        }
        let (samples, substeps) = (part.drives.samples(), part.drives.substeps());
        let mut spans = Spans::<N>::new();
        let mut steps = Steps::<N>::new();
        let mut inside = Inside::<N>::new();
        let mut seen = Samples::<N>::new(part.places, part.keep, lanes, samples);
        for sample in 0..samples {
            seen.take(sample, &phi, &v);
            if sample + 1 == samples {
                break;
            }
            for sub in 0..substeps {
                if sub.is_multiple_of(LOOK) && part.control.stopped() {
                    return;
                }
                source.advance(&mut spans, sample, sub);
                if INSIDE && sample == 0 && sub == 0 {
                    inside.begin(&table, &spans, &phi, &v);
                }
                for lane in 0..N {
                    let body = OneMass::gather(&table, lane);
                    let pace = Pace {
                        h,
                        rate: Pure(paces[0][lane]),
                        kept: Pure(paces[1][lane]),
                        damped: Pure(paces[2][lane]),
                    };
                    let span = spans.of(lane);
                    let next = A::step(&body, &span, pace, Pure(phi[lane]), Pure(v[lane]));
                    if INSIDE {
                        steps.put(lane, &next);
                    } else {
                        phi[lane] = next.phi.0;
                        v[lane] = next.speed.0;
                    }
                }
                if INSIDE {
                    inside.step(&table, h.0, &spans, (&phi, &v), &steps);
                    (phi, v) = steps.end();
                }
            }
        }
        if INSIDE {
            inside.end(&table, &spans, &phi, &v);
        }
        seen.finish(&phi, &v, |lane, counts, energies| {
            inside.write(lane, counts, energies);
        });
        part.control.add(lanes);
    }
}
