//! One block of lanes from start to end: signals, steps, sums, records.
//!
//! The loop over the lanes of a block holds nothing but arithmetic and selects, so that the compiler turns it into
//! vector instructions; which ones is decided at run time. Every lane goes through the same operations in the same
//! order whatever its neighbours, the block or the thread, and nothing is fused: the bits are the same everywhere.

use pulp::WithSimd;

use crate::dynamics::{Pure, Width};

use super::body::Body;
use super::corridor::{FREE, Outline, clearance};
use super::fleet::{BLOCK as N, Fleet, Model, Steer, TyreLaw};
use super::lateral_roll::LateralRoll;
use super::prepared::{PREPARED, Prepared};
use super::signal::{Player, Signal};
use super::single_track::SingleTrack;
use super::step::{Arc, Input, State, step};
use super::summary::{KEPT, Shown, Tally};
use super::trace::CHANNELS;
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

/// Runs a block with the instruction set asked for; one that the processor lacks gives way to the next below.
pub(super) fn run(part: Part<'_>) {
    let width = part.fleet.width;
    let task = Task(part);
    #[cfg(any(target_arch = "x86", target_arch = "x86_64"))]
    {
        use pulp::Simd;
        if matches!(width, Width::Widest | Width::Avx512)
            && let Some(simd) = pulp::x86::V4::try_new()
        {
            return Simd::vectorize(simd, task);
        }
        if width != Width::Baseline
            && let Some(simd) = pulp::x86::V3::try_new()
        {
            return Simd::vectorize(simd, task);
        }
    }
    let _ = width;
    task.with_simd(pulp::Scalar::new());
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
        let (h, inv_h) = (fleet.step_s, 1.0 / fleet.step_s);
        let mut table = [[0.0; N]; PREPARED];
        let mut now = Columns::<S>::new();
        let (mut front, mut rear, mut half_width, mut until) =
            ([0.0; N], [0.0; N], [0.0; N], [0.0; N]);
        for lane in 0..N {
            let (car, start) = (&fleet.cars[of[lane]], &fleet.starts[of[lane]]);
            let prepared = Prepared::of(car, h);
            prepared.scatter(&mut table, lane);
            now.put(
                lane,
                &State {
                    car: B::start(start),
                    x: Pure(start.x),
                    y: Pure(start.y),
                    yaw: Pure(start.yaw),
                    phi: Pure(start.roadwheel),
                    phi_speed: Pure(start.roadwheel_speed),
                    psi: Pure(start.handwheel),
                    psi_speed: Pure(start.handwheel_speed),
                    rear: Pure(car.rear_steer * start.roadwheel),
                },
            );
            front[lane] = car.front_end;
            rear[lane] = car.rear_end;
            half_width[lane] = 0.5 * car.width;
            until[lane] = fleet.durations_s[of[lane]];
        }
        let sections = fleet.corridor.map_or_else(Vec::new, |c| c.lay_out(of));
        let mut hand = Player::<N>::new(fleet.hand, of);
        let mut speed = Player::<N>::new(fleet.speed, of);
        let steps = fleet.steps();
        let samples = fleet.samples(every);
        let slack = 1e-9 * h;
        let mut tally = Tally::<N>::new();
        let (mut hand0, mut hand1, mut hand2) = ([0.0; N], [0.0; N], [0.0; N]);
        let (mut speed0, mut speed1, mut speed2) = ([0.0; N], [0.0; N], [0.0; N]);
        let mut rate = [0.0; N];
        hand.values(0.0, slack, &mut hand0);
        speed.values(0.0, slack, &mut speed0);
        let steady = fleet.speed.is_constant();
        if steady {
            (speed1, speed2) = (speed0, speed0);
        }
        let (mut inv0, mut inv1) = (speed0.map(|u| 1.0 / u), speed1.map(|u| 1.0 / u));
        let mut seen = Views::new();
        let mut before = now.clone();
        for number in 0..=steps {
            let time = number as f64 * h;
            let (middle, end) = (time + 0.5 * h, (number + 1) as f64 * h);
            hand.values(middle, slack, &mut hand1);
            if !TORQUE && matches!(fleet.hand, Signal::Sampled(_)) {
                hand.rates(middle, &mut rate);
            }
            hand.values(end, -slack, &mut hand2);
            if !steady {
                speed.values(middle, slack, &mut speed1);
                speed.values(end, -slack, &mut speed2);
                for lane in 0..N {
                    inv0[lane] = 1.0 / speed0[lane];
                    inv1[lane] = 1.0 / speed1[lane];
                }
            }
            let recorded = !traces.is_empty() && number % every == 0;
            if recorded {
                before.clone_from(&now);
            }
            let goes_on = number < steps;
            for lane in 0..N {
                let car = Prepared::gather(&table, lane);
                let input = Input {
                    hand: Arc {
                        start: Pure(hand0[lane]),
                        middle: Pure(hand1[lane]),
                        end: Pure(hand2[lane]),
                    },
                    speed: Pure(speed0[lane]),
                    inv_speed: Pure(inv0[lane]),
                    speed_middle: Pure(speed1[lane]),
                    inv_speed_middle: Pure(inv1[lane]),
                    push: Pure((speed2[lane] - speed0[lane]) * inv_h),
                };
                let state = now.get(lane);
                let (after, view) = step::<S, RICH, TORQUE, B, T>(&car, &input, &state);
                let handwheel = if TORQUE { state.psi } else { input.hand.start };
                let sideslip = state.car[0] * input.inv_speed;
                // Beyond 45 degrees of sideslip no law here holds; a comparison with NaN is false.
                let driving = tally.spun[lane] == f64::INFINITY;
                let fits = sideslip.0.abs() <= 1.0;
                let spun = driving & !fits;
                tally.spun[lane] = Pure(time).when(spun, Pure(tally.spun[lane])).0;
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
                    load: least_of(view.posture.loads).when(counts, Pure(FREE)),
                };
                tally.see(lane, &shown, weight);
                let turning = if TORQUE {
                    (state.psi_speed + after.psi_speed) * Pure(0.5)
                } else {
                    Pure(rate[lane])
                };
                tally.rate_square[lane] += (weight * turning * turning).0;
                now.put(lane, &after.unless(!going, &state));
                let (stance, loads) = (view.posture, view.posture.loads);
                seen.posture[0][lane] = stance.roll.0;
                seen.posture[1][lane] = stance.roll_rate.0;
                seen.posture[2][lane] = stance.heave.0;
                seen.posture[3][lane] = stance.pitch.0;
                seen.posture[4][lane] = loads[0].0;
                seen.posture[5][lane] = loads[1].0;
                seen.posture[6][lane] = loads[2].0;
                seen.posture[7][lane] = loads[3].0;
                seen.side[lane] = view.side.0;
                seen.column[lane] = view.column.0;
                seen.king_pin[lane] = view.king_pin.0;
                seen.handwheel[lane] = handwheel.0;
                seen.x[lane] = view.x_middle.0;
                seen.y[lane] = view.y_middle.0;
                seen.sin[lane] = view.sin_middle.0;
                seen.cos[lane] = view.cos_middle.0;
                seen.weight[lane] = weight.0;
            }
            if !sections.is_empty() {
                let mut least = [FREE; N];
                for section in &sections {
                    for lane in 0..N {
                        let outline = Outline {
                            x: Pure(seen.x[lane]),
                            y: Pure(seen.y[lane]),
                            sin: Pure(seen.sin[lane]),
                            cos: Pure(seen.cos[lane]),
                            front: Pure(front[lane]),
                            rear: Pure(rear[lane]),
                            half_width: Pure(half_width[lane]),
                        };
                        let (left, right) = clearance(section, lane, &outline);
                        let counts = seen.weight[lane] > 0.0;
                        let lesser = |kept: f64, value: Pure| {
                            value.when(counts & (value.0 < kept), Pure(kept)).0
                        };
                        tally.left[lane] = lesser(tally.left[lane], left);
                        tally.right[lane] = lesser(tally.right[lane], right);
                        least[lane] = lesser(lesser(least[lane], left), right);
                    }
                }
                for lane in 0..N {
                    let over = Pure(-least[lane]).when(least[lane] < 0.0, Pure::ZERO);
                    tally.outside[lane] += (over * Pure(seen.weight[lane])).0;
                }
            }
            if recorded {
                let sample = number / every;
                for lane in 0..lanes {
                    let state = before.get(lane);
                    let channels = [
                        seen.handwheel[lane],
                        state.phi.0,
                        state.phi_speed.0,
                        state.rear.0,
                        seen.column[lane],
                        seen.king_pin[lane],
                        seen.side[lane],
                        state.car[0].0,
                        state.car[1].0,
                        state.yaw.0,
                        state.x.0,
                        state.y.0,
                    ];
                    let stance = seen.posture.iter().map(|row| row[lane]);
                    for (channel, value) in channels.into_iter().chain(stance).enumerate() {
                        traces[(lane * CHANNELS.len() + channel) * samples + sample] = value;
                    }
                }
            }
            let jumped = hand.jumps(end, slack);
            hand0 = hand2;
            if jumped {
                hand.values(end, slack, &mut hand0);
            }
            let jumped = speed.jumps(end, slack);
            speed0 = speed2;
            if jumped {
                speed.values(end, slack, &mut speed0);
            }
        }
        for (lane, kept) in summary.chunks_exact_mut(KEPT).enumerate() {
            let time = until[lane].min(tally.spun[lane]);
            let per = if time > 0.0 { 1.0 / time } else { 0.0 };
            let squares = match fleet.hand {
                Signal::Segments(s) if !TORQUE => s.rate_square_integral(of[lane], time),
                _ => tally.rate_square[lane],
            };
            let end = now.get(lane);
            kept.copy_from_slice(&[
                squares * per,
                tally.side[lane],
                tally.side_square[lane] * per,
                tally.left[lane],
                tally.right[lane],
                tally.outside[lane],
                tally.yaw_rate[lane],
                tally.sideslip[lane],
                tally.roll[lane],
                tally.handwheel[lane],
                tally.roadwheel[lane],
                tally.column[lane],
                tally.rest[lane] * per,
                tally.load[lane],
                tally.spun[lane],
                end.x.0,
                end.y.0,
                end.yaw.0,
                end.car[0].0,
                end.car[1].0,
                end.phi.0,
            ]);
        }
    }
}

/// The least of four.
#[inline(always)]
fn least_of(loads: [Pure; 4]) -> Pure {
    let lesser = |a: Pure, b: Pure| a.when(a.0 < b.0, b);
    lesser(lesser(loads[0], loads[1]), lesser(loads[2], loads[3]))
}

/// What a step showed, lane beside lane.
struct Views {
    /// Roll and its rate, heave, pitch, four loads.
    posture: [[f64; N]; 8],
    side: [f64; N],
    column: [f64; N],
    king_pin: [f64; N],
    handwheel: [f64; N],
    x: [f64; N],
    y: [f64; N],
    sin: [f64; N],
    cos: [f64; N],
    weight: [f64; N],
}

impl Views {
    fn new() -> Self {
        let zero = [0.0; N];
        Self {
            posture: [zero; 8],
            side: zero,
            column: zero,
            king_pin: zero,
            handwheel: zero,
            x: zero,
            y: zero,
            sin: zero,
            cos: zero,
            weight: zero,
        }
    }
}

/// States lane beside lane.
#[derive(Clone)]
struct Columns<const S: usize> {
    car: [[f64; N]; S],
    rest: [[f64; N]; 8],
}

impl<const S: usize> Columns<S> {
    fn new() -> Self {
        Self {
            car: [[0.0; N]; S],
            rest: [[0.0; N]; 8],
        }
    }

    #[inline(always)]
    fn get(&self, lane: usize) -> State<S> {
        let mut car = [Pure::ZERO; S];
        for i in 0..S {
            car[i] = Pure(self.car[i][lane]);
        }
        let of = |row: usize| Pure(self.rest[row][lane]);
        State {
            car,
            x: of(0),
            y: of(1),
            yaw: of(2),
            phi: of(3),
            phi_speed: of(4),
            psi: of(5),
            psi_speed: of(6),
            rear: of(7),
        }
    }

    #[inline(always)]
    fn put(&mut self, lane: usize, state: &State<S>) {
        for i in 0..S {
            self.car[i][lane] = state.car[i].0;
        }
        let rest = [
            state.x,
            state.y,
            state.yaw,
            state.phi,
            state.phi_speed,
            state.psi,
            state.psi_speed,
            state.rear,
        ];
        for (row, value) in self.rest.iter_mut().zip(rest) {
            row[lane] = value.0;
        }
    }
}
