//! One step of car and steering together, second order through the events of friction and gap.
//!
//! The midpoint rule for the car and the splitting of [`super::turn`] for handwheel and king-pins share their middle:
//! the car's rates there see the drifted wheel angle, and the torque of the tyres on the king-pins comes from the same
//! evaluation. At the instants of friction events the tyres' torque is extrapolated from start and middle.

use crate::dynamics::Pure;
use crate::projections::luz;

use super::angle::{cos, sin};
use super::body::{Body, Moment, Posture};
use super::prepared::Prepared;
use super::start::Start;
use super::turn::{Pull, turn};
use super::tyre::Tyre;

/// Everything that moves.
#[derive(Debug, Clone, Copy)]
pub(super) struct State<const S: usize> {
    /// States of the car model.
    pub car: [Pure; S],
    /// Reference point in the plane, m, and yaw angle, rad.
    pub x: Pure,
    /// See `x`.
    pub y: Pure,
    /// See `x`.
    pub yaw: Pure,
    /// Road-wheel angle, rad, and its speed.
    pub phi: Pure,
    /// See `phi`.
    pub phi_speed: Pure,
    /// Handwheel angle, rad, and its speed; states under torque only.
    pub psi: Pure,
    /// See `psi`.
    pub psi_speed: Pure,
    /// Angle of the rear wheels, rad.
    pub rear: Pure,
}

/// One channel over a step: at its start, middle and end.
#[derive(Debug, Clone, Copy)]
pub(super) struct Arc {
    /// Value at the start.
    pub start: Pure,
    /// Value in the middle.
    pub middle: Pure,
    /// Value at the end.
    pub end: Pure,
}

impl Arc {
    /// The parabola through the three.
    #[inline(always)]
    fn at(&self, share: Pure) -> Pure {
        let slope = self.middle * Pure(4.0) - self.start * Pure(3.0) - self.end;
        let bend = (self.start - self.middle * Pure(2.0) + self.end) * Pure(2.0);
        self.start + share * (slope + share * bend)
    }

    /// A body that moves on.
    #[inline(always)]
    fn drift(from: Pure, by: Pure) -> Self {
        Self {
            start: from,
            middle: from + by * Pure(0.5),
            end: from + by,
        }
    }
}

/// What comes in during a step.
#[derive(Debug, Clone, Copy)]
pub(super) struct Input {
    /// Handwheel angle, rad, or steering torque, Nm.
    pub hand: Arc,
    /// Forward speed at the start, m/s, and 1 over it.
    pub speed: Pure,
    /// See `speed`.
    pub inv_speed: Pure,
    /// The same in the middle.
    pub speed_middle: Pure,
    /// See `speed_middle`.
    pub inv_speed_middle: Pure,
    /// How fast the speed changes, m/s2.
    pub push: Pure,
}

/// What is seen on the way.
#[derive(Debug, Clone, Copy)]
pub(super) struct Seen {
    /// How the body stands at the start.
    pub posture: Posture,
    /// Lateral acceleration at the start, m/s2.
    pub side: Pure,
    /// Torque in the column at the start, Nm.
    pub column: Pure,
    /// Torque of the tyres on the king-pins at the start, Nm.
    pub king_pin: Pure,
    /// Place and heading in the middle of the step.
    pub x_middle: Pure,
    /// See `x_middle`.
    pub y_middle: Pure,
    /// See `x_middle`.
    pub sin_middle: Pure,
    /// See `x_middle`.
    pub cos_middle: Pure,
}

/// Torque in the column: a spring with freeplay.
#[inline(always)]
fn column(car: &Prepared, psi: Pure, phi: Pure) -> Pure {
    car.stiffness * luz(psi - car.ratio * phi, car.half_gap)
}

/// Torque of column, power assistance and centring spring on the king-pins; assistance is a sum of luz.
#[inline(always)]
fn at_king_pins(car: &Prepared, column: Pure, phi: Pure) -> Pure {
    car.ratio * column
        + car.assist_gain * luz(column, car.assist_threshold)
        + car.assist_second_gain * luz(column, car.assist_second_threshold)
        - car.aligning * phi
}

struct KingPins<'a> {
    car: &'a Prepared,
    psi: Arc,
    load: Pure,
    load_slope: Pure,
}

impl Pull for KingPins<'_> {
    #[inline(always)]
    fn at(&self, share: Pure, angle: Pure) -> Pure {
        let column = column(self.car, self.psi.at(share), angle);
        at_king_pins(self.car, column, angle) + self.load + share * self.load_slope
    }
}

struct Handwheel<'a> {
    car: &'a Prepared,
    torque: Arc,
    phi: Arc,
}

impl Pull for Handwheel<'_> {
    #[inline(always)]
    fn at(&self, share: Pure, angle: Pure) -> Pure {
        self.torque.at(share) - column(self.car, angle, self.phi.at(share))
    }
}

/// The rear wheels follow the front ones through a gap.
#[inline(always)]
fn follow(car: &Prepared, rear: Pure, phi: Pure) -> Pure {
    rear + luz(car.rear_steer * phi - rear, car.rear_steer_half_gap)
}

/// One step; `TORQUE` says whether the handwheel is free and a torque acts on it.
#[inline(always)]
pub(super) fn step<const S: usize, const RICH: bool, const TORQUE: bool, B: Body<S>, T: Tyre>(
    car: &Prepared,
    input: &Input,
    now: &State<S>,
) -> (State<S>, Seen) {
    let h = car.h;
    let half = h * Pure(0.5);
    let phi = Arc::drift(now.phi, h * now.phi_speed);
    let psi = if TORQUE {
        Arc::drift(now.psi, h * now.psi_speed)
    } else {
        input.hand
    };
    let begin = Moment {
        speed: input.speed,
        inv_speed: input.inv_speed,
        front: now.phi,
        rear: now.rear,
        push: input.push,
    };
    let first = B::rates::<T>(car, &begin, &now.car);
    let mut middle = now.car;
    for i in 0..S {
        middle[i] = middle[i] + half * first.change[i];
    }
    let rear_middle = follow(car, now.rear, phi.middle);
    let second = B::rates::<T>(
        car,
        &Moment {
            speed: input.speed_middle,
            inv_speed: input.inv_speed_middle,
            front: phi.middle,
            rear: rear_middle,
            push: input.push,
        },
        &middle,
    );
    let mut end = now.car;
    for i in 0..S {
        end[i] = end[i] + h * second.change[i];
    }

    let wound = column(car, psi.middle, phi.middle);
    let pins = KingPins {
        car,
        psi,
        load: first.king_pin,
        load_slope: (second.king_pin - first.king_pin) * Pure(2.0),
    };
    let torque = at_king_pins(car, wound, phi.middle) + second.king_pin;
    let (phi_end, phi_speed) =
        turn::<RICH, _>(&car.king_pins(), torque, &pins, now.phi, now.phi_speed);
    let (psi_end, psi_speed) = if TORQUE {
        let wheel = Handwheel {
            car,
            torque: input.hand,
            phi,
        };
        let torque = input.hand.middle - wound;
        turn::<false, _>(&car.handwheel(), torque, &wheel, now.psi, now.psi_speed)
    } else {
        (input.hand.end, Pure::ZERO)
    };

    let yaw_middle = now.yaw + half * now.car[1];
    let (sin_middle, cos_middle) = (sin(yaw_middle), cos(yaw_middle));
    let along = input.speed_middle * cos_middle - middle[0] * sin_middle;
    let aside = input.speed_middle * sin_middle + middle[0] * cos_middle;
    (
        State {
            car: end,
            x: now.x + h * along,
            y: now.y + h * aside,
            yaw: now.yaw + h * middle[1],
            phi: phi_end,
            phi_speed,
            psi: psi_end,
            psi_speed,
            rear: follow(car, now.rear, phi_end),
        },
        Seen {
            posture: B::posture(car, &begin, &now.car),
            side: first.side,
            column: column(car, psi.start, now.phi),
            king_pin: first.king_pin,
            x_middle: now.x + half * along,
            y_middle: now.y + half * aside,
            sin_middle,
            cos_middle,
        },
    )
}

impl<const S: usize> State<S> {
    /// At the start; the rear wheels stand at their share of the front angle.
    pub fn begin<B: Body<S>>(start: &Start, rear_steer: f64) -> Self {
        Self {
            car: B::start(start),
            x: Pure(start.x),
            y: Pure(start.y),
            yaw: Pure(start.yaw),
            phi: Pure(start.roadwheel),
            phi_speed: Pure(start.roadwheel_speed),
            psi: Pure(start.handwheel),
            psi_speed: Pure(start.handwheel_speed),
            rear: Pure(rear_steer * start.roadwheel),
        }
    }

    /// This state, or the other where the condition holds.
    #[inline(always)]
    pub fn unless(&self, condition: bool, other: &Self) -> Self {
        let pick = |new: Pure, old: Pure| old.when(condition, new);
        let mut car = self.car;
        for i in 0..S {
            car[i] = pick(car[i], other.car[i]);
        }
        Self {
            car,
            x: pick(self.x, other.x),
            y: pick(self.y, other.y),
            yaw: pick(self.yaw, other.yaw),
            phi: pick(self.phi, other.phi),
            phi_speed: pick(self.phi_speed, other.phi_speed),
            psi: pick(self.psi, other.psi),
            psi_speed: pick(self.psi_speed, other.psi_speed),
            rear: pick(self.rear, other.rear),
        }
    }
}
