//! A block of lanes that is looked at inside of its steps, or whose lanes have drives of their own.

use pulp::WithSimd;

use super::drive::Drive;
use super::inside::Inside;
use super::lane_drives::{BlockDrives, Spans};
use super::lanes::{Drives, Kernel, LOOK, Part};
use super::ledger::TAME;
use super::march::{Advance, Elastic, Lanes, MoreauJean, Split, State, WHOLE};
use super::number::Pure;
use super::observe::Samples;
use super::one_mass::{EVERY, PLAIN, WAVY};

/// One block of `N` lanes, the same steps with the same bits as [`super::lanes::Task`].
pub(super) struct Watched<'a, const INSIDE: bool, const N: usize>(pub Part<'a>);

impl<const INSIDE: bool, const N: usize> WithSimd for Watched<'_, INSIDE, N> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: pulp::Simd>(self, _simd: S) {
        // Fewer kernels than without a look inside: there the look is what costs.
        match (self.0.kernel, self.0.effects) {
            (Kernel::MoreauJean, _) => self.along::<MoreauJean<EVERY>>(),
            (Kernel::Split, PLAIN) => self.along::<Split<PLAIN>>(),
            (Kernel::Split, 1..WAVY) => self.along::<Split<TAME>>(),
            (Kernel::Split, WAVY..=EVERY) => self.along::<Split<EVERY>>(),
            (Kernel::Split, _) => self.along::<Elastic<WHOLE>>(),
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

impl<const INSIDE: bool, const N: usize> Watched<'_, INSIDE, N> {
    #[inline(always)]
    fn along<A: Advance>(self) {
        let mut source = Source::<N>::of(&self.0);
        let part = self.0;
        let samples = part.drives.samples();
        let lanes = Lanes::<N>::new(part.bodies, Pure(part.drives.step_s()));
        let mut state = State::<N>::new(part.starts);
        let mut spans = Spans::<N>::new();
        let mut inside = Inside::<N>::new(part.keep.energy.then_some(part.effects));
        let mut seen = Samples::<N>::new(part.places, part.keep, part.bodies.len(), samples);
        for sample in 0..samples {
            seen.take(sample, &state);
            if sample + 1 == samples {
                break;
            }
            for sub in 0..part.drives.substeps() {
                if sub.is_multiple_of(LOOK) && part.control.stopped() {
                    return;
                }
                source.advance(&mut spans, sample, sub);
                if INSIDE {
                    if sample == 0 && sub == 0 {
                        inside.begin(&lanes, &spans, &state);
                    }
                    inside.step::<A>(&lanes, &spans, &mut state);
                } else {
                    A::advance(&lanes, |lane| spans.of(lane), &mut state);
                }
            }
        }
        if INSIDE {
            inside.end(&lanes, &spans, &state);
        }
        seen.finish(&state, |lane, counts, energies| {
            inside.write(lane, counts, energies);
        });
        part.control.add(part.bodies.len());
    }
}
