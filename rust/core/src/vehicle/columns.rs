//! What changes along a run, lane beside lane: states, and what a step showed.

use crate::dynamics::Pure;

use super::step::{Seen, State};
use super::trace::CHANNELS;

/// What a step showed, lane beside lane.
pub(super) struct Views<const N: usize> {
    /// Roll and its rate, heave, pitch, four loads.
    posture: [[f64; N]; 8],
    side: [f64; N],
    column: [f64; N],
    king_pin: [f64; N],
    handwheel: [f64; N],
    pub x: [f64; N],
    pub y: [f64; N],
    pub sin: [f64; N],
    pub cos: [f64; N],
    pub weight: [f64; N],
}

impl<const N: usize> Views<N> {
    /// All zero.
    pub fn new() -> Self {
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

    /// Takes up what a lane's step showed; `weight` is the share of the step that counts in sums.
    #[inline(always)]
    pub fn keep(&mut self, lane: usize, view: &Seen, handwheel: Pure, weight: Pure) {
        let (stance, loads) = (view.posture, view.posture.loads);
        self.posture[0][lane] = stance.roll.0;
        self.posture[1][lane] = stance.roll_rate.0;
        self.posture[2][lane] = stance.heave.0;
        self.posture[3][lane] = stance.pitch.0;
        self.posture[4][lane] = loads[0].0;
        self.posture[5][lane] = loads[1].0;
        self.posture[6][lane] = loads[2].0;
        self.posture[7][lane] = loads[3].0;
        self.side[lane] = view.side.0;
        self.column[lane] = view.column.0;
        self.king_pin[lane] = view.king_pin.0;
        self.handwheel[lane] = handwheel.0;
        self.x[lane] = view.x_middle.0;
        self.y[lane] = view.y_middle.0;
        self.sin[lane] = view.sin_middle.0;
        self.cos[lane] = view.cos_middle.0;
        self.weight[lane] = weight.0;
    }

    /// Writes the channels at the start of the step into the sample of every lane's trace.
    pub fn record<const S: usize>(
        &self,
        before: &Columns<S, N>,
        lanes: usize,
        (sample, samples): (usize, usize),
        traces: &mut [f64],
    ) {
        for lane in 0..lanes {
            let state = before.get(lane);
            let channels = [
                self.handwheel[lane],
                state.phi.0,
                state.phi_speed.0,
                state.rear.0,
                self.column[lane],
                self.king_pin[lane],
                self.side[lane],
                state.car[0].0,
                state.car[1].0,
                state.yaw.0,
                state.x.0,
                state.y.0,
            ];
            let stance = self.posture.iter().map(|row| row[lane]);
            for (channel, value) in channels.into_iter().chain(stance).enumerate() {
                traces[(lane * CHANNELS.len() + channel) * samples + sample] = value;
            }
        }
    }
}

/// States lane beside lane.
#[derive(Clone)]
pub(super) struct Columns<const S: usize, const N: usize> {
    car: [[f64; N]; S],
    rest: [[f64; N]; 8],
}

impl<const S: usize, const N: usize> Columns<S, N> {
    /// All zero.
    pub fn new() -> Self {
        Self {
            car: [[0.0; N]; S],
            rest: [[0.0; N]; 8],
        }
    }

    /// The state of a lane.
    #[inline(always)]
    pub fn get(&self, lane: usize) -> State<S> {
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

    /// Writes the state of a lane.
    #[inline(always)]
    pub fn put(&mut self, lane: usize, state: &State<S>) {
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
