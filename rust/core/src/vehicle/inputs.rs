//! Driver and speed of a block of lanes over one step.

use crate::dynamics::Pure;

use super::fleet::{Fleet, Steer};
use super::signal::{Player, Signal};
use super::step::{Arc, Input};

/// A piece that starts within this share of a step of an instant starts at it.
pub(super) const SLACK: f64 = 1e-9;

/// A channel at start, middle and end of a step.
struct Three<const N: usize> {
    start: [f64; N],
    middle: [f64; N],
    end: [f64; N],
}

/// What comes in during a step, lane beside lane.
pub(super) struct Inputs<'a, const N: usize> {
    hand: Player<'a, N>,
    speed: Player<'a, N>,
    /// Whether the speed never changes, and whether the hand's rate is wanted step by step.
    steady: bool,
    rated: bool,
    hands: Three<N>,
    speeds: Three<N>,
    inverse: [f64; N],
    inverse_middle: [f64; N],
    rate: [f64; N],
    h: f64,
    inv_h: f64,
}

impl<'a, const N: usize> Inputs<'a, N> {
    /// At the start of the first step.
    #[inline(always)]
    pub fn new(fleet: &Fleet<'a>, of: [usize; N]) -> Self {
        let h = fleet.step_s;
        let mut hand = Player::<N>::new(fleet.hand, of);
        let mut speed = Player::<N>::new(fleet.speed, of);
        let (mut first, mut pace) = ([0.0; N], [0.0; N]);
        hand.values(0.0, SLACK * h, &mut first);
        speed.values(0.0, SLACK * h, &mut pace);
        let inverse = pace.map(|u| 1.0 / u);
        let same = |value| Three {
            start: value,
            middle: value,
            end: value,
        };
        Self {
            hand,
            speed,
            steady: fleet.speed.is_constant(),
            rated: fleet.steer == Steer::Angle && matches!(fleet.hand, Signal::Sampled(_)),
            hands: same(first),
            speeds: same(pace),
            inverse,
            inverse_middle: inverse,
            rate: [0.0; N],
            h,
            inv_h: 1.0 / h,
        }
    }

    /// Takes up middle and end of a step.
    #[inline(always)]
    pub fn take(&mut self, number: usize) {
        let slack = SLACK * self.h;
        let middle = (number as f64 + 0.5) * self.h;
        let end = (number + 1) as f64 * self.h;
        self.hand.values(middle, slack, &mut self.hands.middle);
        if self.rated {
            self.hand.rates(middle, &mut self.rate);
        }
        self.hand.values(end, -slack, &mut self.hands.end);
        if self.steady {
            return;
        }
        self.speed.values(middle, slack, &mut self.speeds.middle);
        self.speed.values(end, -slack, &mut self.speeds.end);
        for lane in 0..N {
            self.inverse[lane] = 1.0 / self.speeds.start[lane];
            self.inverse_middle[lane] = 1.0 / self.speeds.middle[lane];
        }
    }

    /// Makes the end of a step the start of the next; a piece that starts there has its own first value.
    #[inline(always)]
    pub fn turn_over(&mut self, number: usize) {
        let (end, slack) = ((number + 1) as f64 * self.h, SLACK * self.h);
        self.hands.start = self.hands.end;
        if self.hand.jumps(end, slack) {
            self.hand.values(end, slack, &mut self.hands.start);
        }
        if self.steady {
            return;
        }
        self.speeds.start = self.speeds.end;
        if self.speed.jumps(end, slack) {
            self.speed.values(end, slack, &mut self.speeds.start);
        }
    }

    /// What comes in for a lane.
    #[inline(always)]
    pub fn of(&self, lane: usize) -> Input {
        let (hands, speeds) = (&self.hands, &self.speeds);
        Input {
            hand: Arc {
                start: Pure(hands.start[lane]),
                middle: Pure(hands.middle[lane]),
                end: Pure(hands.end[lane]),
            },
            speed: Pure(speeds.start[lane]),
            inv_speed: Pure(self.inverse[lane]),
            speed_middle: Pure(speeds.middle[lane]),
            inv_speed_middle: Pure(self.inverse_middle[lane]),
            push: Pure((speeds.end[lane] - speeds.start[lane]) * self.inv_h),
        }
    }

    /// The rate of a sampled handwheel angle in the middle of the step, else 0.
    #[inline(always)]
    pub fn rate(&self, lane: usize) -> Pure {
        Pure(self.rate[lane])
    }
}
