//! One block of lanes from start to end: signals, steps, sums, records.
//!
//! The loop over the lanes of a block holds nothing but arithmetic and selects, so that the compiler turns it into
//! vector instructions; which ones is decided at run time. Every lane goes through the same operations in the same
//! order whatever its neighbours, the block or the thread, and nothing is fused: the bits are the same everywhere.

use pulp::WithSimd;

use crate::dynamics::{self, Pure};

use super::body::Body;
use super::columns::{Columns, Views};
use super::corridor::{Course, FREE};
use super::fleet::{BLOCK as N, Fleet, Model, Steer, TyreLaw};
use super::inputs::{Inputs, SLACK};
use super::lateral_roll::LateralRoll;
use super::prepared::{PREPARED, Prepared};
use super::signal::Signal;
use super::single_track::SingleTrack;
use super::step::{State, step};
use super::summary::{KEPT, Shown, Tally};
use super::twelve::Twelve;
use super::tyre::{Brush, Linear, MagicFormula, Tyre};

/// What a block works on.
pub(super) struct Part<'a> {
    pub fleet: &'a Fleet<'a>,
    pub first: usize,
    pub lanes: usize,
    pub every: usize,
    pub summary: &'a mut [f64],
    pub traces: &'a mut [f64],
}

struct Task<'a>(Part<'a>);

/// Runs a block with the instruction set that the fleet asks for.
pub(super) fn run(part: Part<'_>) {
    let width = part.fleet.width;
    dynamics::run(Task(part), width);
}

impl WithSimd for Task<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: pulp::Simd>(self, _simd: S) {
        match self.0.fleet.model {
            Model::SingleTrack => self.on_tyres::<4, SingleTrack>(),
            Model::LateralRoll => self.on_tyres::<6, LateralRoll>(),
            Model::Twelve => self.on_tyres::<20, Twelve>(),
        }
    }
}

impl Task<'_> {
    #[inline(always)]
    fn on_tyres<const S: usize, B: Body<S>>(self) {
        match self.0.fleet.tyre {
            TyreLaw::Linear => self.steered::<S, B, Linear>(),
            TyreLaw::Brush => self.steered::<S, B, Brush>(),
            TyreLaw::MagicFormula => self.steered::<S, B, MagicFormula>(),
        }
    }

    #[inline(always)]
    fn steered<const S: usize, B: Body<S>, T: Tyre>(self) {
        match (self.0.fleet.steer, self.0.fleet.is_rich()) {
            (Steer::Angle, false) => self.along::<S, false, false, B, T>(),
            (Steer::Angle, true) => self.along::<S, true, false, B, T>(),
            // What does not act adds exactly 0: leaving it out would only be quicker, and one more kernel to compile.
            (Steer::Torque, _) => self.along::<S, true, true, B, T>(),
        }
    }

    #[inline(always)]
    fn along<const S: usize, const RICH: bool, const TORQUE: bool, B: Body<S>, T: Tyre>(self) {
        let Part {
            fleet,
            first,
            lanes,
            every,
            summary,
            traces,
        } = self.0;
        // Lanes beyond the last repeat it, so that every block is full.
        let of: [usize; N] = std::array::from_fn(|lane| first + lane.min(lanes - 1));
        let h = fleet.step_s;
        let mut table = [[0.0; N]; PREPARED];
        let mut now = Columns::<S, N>::new();
        let mut until = [0.0; N];
        for lane in 0..N {
            let (car, start) = (&fleet.cars[of[lane]], &fleet.starts[of[lane]]);
            Prepared::of(car, h).scatter(&mut table, lane);
            now.put(lane, &State::begin::<B>(start, car.rear_steer));
            until[lane] = fleet.durations_s[of[lane]];
        }
        let course = Course::<N>::of(fleet, of);
        let mut inputs = Inputs::<N>::new(fleet, of);
        let (steps, samples) = (fleet.steps(), fleet.samples(every));
        let slack = SLACK * h;
        let mut tally = Tally::<N>::new();
        let mut seen = Views::<N>::new();
        let mut before = now.clone();
        for number in 0..=steps {
            let time = number as f64 * h;
            inputs.take(number);
            let recorded = !traces.is_empty() && number % every == 0;
            if recorded {
                before.clone_from(&now);
            }
            let goes_on = number < steps;
            for lane in 0..N {
                let car = Prepared::gather(&table, lane);
                let input = inputs.of(lane);
                let state = now.get(lane);
                let (after, view) = step::<S, RICH, TORQUE, B, T>(&car, &input, &state);
                let handwheel = if TORQUE { state.psi } else { input.hand.start };
                let sideslip = state.car[0] * input.inv_speed;
                // Beyond 45 degrees of sideslip no law here holds; a comparison with NaN is false.
                let driving = tally.spun[lane] == f64::INFINITY;
                let fits = sideslip.0.abs() <= 1.0;
                tally.spun[lane] = Pure(time).when(driving & !fits, Pure(tally.spun[lane])).0;
                let going = goes_on & driving & fits & (time < until[lane] - slack);
                let counts = driving & fits & (time <= until[lane] + slack);
                let weight = Pure(h).when(going, Pure::ZERO);
                let keep = |value: Pure| value.when(counts, Pure::ZERO);
                let shown = Shown {
                    side: keep(view.side),
                    yaw_rate: keep(state.car[1]),
                    sideslip: keep(sideslip),
                    roll: keep(view.posture.roll),
                    handwheel: keep(handwheel),
                    roadwheel: keep(state.phi),
                    roadwheel_speed: state.phi_speed,
                    column: keep(view.column),
                    load: view.posture.least_load().when(counts, Pure(FREE)),
                    turning: if TORQUE {
                        (state.psi_speed + after.psi_speed) * Pure(0.5)
                    } else {
                        inputs.rate(lane)
                    },
                };
                tally.see(lane, &shown, weight);
                now.put(lane, &after.unless(!going, &state));
                seen.keep(lane, &view, handwheel, weight);
            }
            course.measure(&seen, &mut tally);
            if recorded {
                seen.record(&before, lanes, (number / every, samples), traces);
            }
            inputs.turn_over(number);
        }
        for (lane, kept) in summary.chunks_exact_mut(KEPT).enumerate() {
            let time = until[lane].min(tally.spun[lane]);
            let squares = match fleet.hand {
                Signal::Segments(s) if !TORQUE => s.rate_square_integral(of[lane], time),
                _ => tally.rate_square[lane],
            };
            tally.finish(lane, time, squares, &now.get(lane), kept);
        }
    }
}
