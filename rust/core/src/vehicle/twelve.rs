//! The model of 12 degrees of freedom: body 6 (the forward one commanded), 4 wheels vertical, handwheel, king-pins.
//!
//! The paper gives only the number; the make-up is ours. The body rolls about the roll axis as in the lateral-roll
//! model, heaves and pitches on springs and dampers at the wheels, and the wheels stand on the springs of their tyres:
//! `m A - ms h p' = sum F`, `Ix p' - ms h A = ms g h phi + sum y S - bars`, `ms z'' = sum S`,
//! `Iy th'' = -sum x S - ms h_cg ax`, `mu w'' = Fz - Fz0 - S`, `S = -k (z + y phi - x th - w) - c (...)'`. What a lateral
//! force moves through the roll centre and the wheels' own inertia reaches the wheels at once. The load of a wheel is
//! that of its tyre's spring, never below 0; each wheel has a slip and a lag of its own. Angles of roll and pitch are
//! small.

use crate::Error;
use crate::dynamics::Pure;
use crate::effects::Lane;

use super::axle::{Axle, across, along, slip};
use super::body::{Body, Moment, Posture, Rates};
use super::lateral_roll::LateralRoll;
use super::parameters::{Parameters, out};
use super::prepared::Prepared;
use super::single_track::lagged;
use super::start::Start;
use super::tyre::{Contact, Tyre};

/// States: lateral speed, yaw rate; lagged slip of the wheels (front left, front right, rear left, rear right); heave,
/// pitch (nose down), roll, each with its rate; height of the wheels, their speeds.
pub(super) struct Twelve;

const LAG: usize = 2;
const HEAVE: usize = 6;
const PITCH: usize = 8;
const ROLL: usize = 10;
const WHEEL: usize = 12;
const WHEEL_SPEED: usize = 16;
const STATES: usize = 20;

/// A wheel: where it is and what it has of its axle.
struct Corner {
    /// Forward and left of the reference point, m.
    x: Pure,
    y: Pure,
    /// 1 on the left, -1 on the right.
    way: Pure,
    axle: Axle,
    spring: Pure,
    damper: Pure,
    /// Torque of the bar per rad over the track, N.
    bar: Pure,
    inv_track: Pure,
    steer: Pure,
    inv_relaxation: Pure,
    inv_mass: Pure,
    tyre_spring: Pure,
    static_load: Pure,
    /// Load moved per lateral acceleration, kg.
    moved: Pure,
}

impl Corner {
    #[inline(always)]
    fn front(car: &Prepared, now: &Moment, roll: Pure, way: Pure) -> Self {
        Self {
            x: car.front_axle,
            y: way * car.front_half_track,
            way,
            axle: car.front(),
            spring: car.front_spring,
            damper: car.front_damper,
            bar: car.front_bar,
            inv_track: car.front_inv_track,
            steer: now.front + car.front_roll_steer * roll,
            inv_relaxation: car.front_inv_relaxation,
            inv_mass: car.front_inv_wheel_mass,
            tyre_spring: car.front_tyre_spring,
            static_load: car.front_wheel_load,
            moved: car.front_moved,
        }
    }

    #[inline(always)]
    fn rear(car: &Prepared, now: &Moment, roll: Pure, way: Pure) -> Self {
        Self {
            x: -car.rear_axle,
            y: way * car.rear_half_track,
            way,
            axle: car.rear(),
            spring: car.rear_spring,
            damper: car.rear_damper,
            bar: car.rear_bar,
            inv_track: car.rear_inv_track,
            steer: now.rear + car.rear_roll_steer * roll,
            inv_relaxation: car.rear_inv_relaxation,
            inv_mass: car.rear_inv_wheel_mass,
            tyre_spring: car.rear_tyre_spring,
            static_load: car.rear_wheel_load,
            moved: car.rear_moved,
        }
    }

    /// The load of the wheel whose hub stands `height` above its place at rest.
    #[inline(always)]
    fn load(&self, height: Pure) -> Pure {
        carried(self.static_load, self.tyre_spring, height)
    }

    /// What the wheel at `place`, whose neighbour on the axle is at `other`, does to car and hub.
    #[inline(always)]
    fn act<T: Tyre>(
        &self,
        now: &Moment,
        state: &[Pure; STATES],
        place: usize,
        other: usize,
    ) -> Action {
        let (v, r, roll) = (state[0], state[1], state[ROLL]);
        let pace = if T::LINEAR {
            now.inv_speed
        } else {
            Pure::ONE / (now.speed - r * self.y)
        };
        let (slipped, lag) = lagged(
            slip::<T>((v + self.x * r) * pace, self.steer),
            state[LAG + place],
            now.speed * self.inv_relaxation,
        );
        let height = state[WHEEL + place];
        let load = self.load(height);
        let contact = self.axle.wheel::<T>(slipped, load / self.static_load);
        let side = across::<T>(contact.force, self.steer);
        let reach = state[HEAVE] + self.y * roll - self.x * state[PITCH] - height;
        let reach_rate = state[HEAVE + 1] + self.y * state[ROLL + 1]
            - self.x * state[PITCH + 1]
            - state[WHEEL_SPEED + place];
        let pushed = -(self.spring * reach + self.damper * reach_rate);
        // The bar twists with the roll of the body against that of its axle.
        let twist = roll - self.way * (height - state[WHEEL + other]) * self.inv_track;
        let bar = -(self.way * self.bar * twist);
        Action {
            lag,
            contact,
            side,
            turn: self.x * side + self.y * along::<T>(contact.force, self.steer),
            pushed,
            nod: -(self.x * pushed),
            lean: self.y * (pushed + bar),
            hub: load - self.static_load - pushed - bar,
        }
    }

    /// The acceleration of the hub: in a turn to the left the wheels on the right are pressed down.
    #[inline(always)]
    fn hub(&self, action: &Action, side: Pure) -> Pure {
        (action.hub + self.way * self.moved * side) * self.inv_mass
    }
}

/// See [`Corner::act`].
struct Action {
    lag: Pure,
    contact: Contact,
    side: Pure,
    turn: Pure,
    pushed: Pure,
    nod: Pure,
    lean: Pure,
    hub: Pure,
}

#[inline(always)]
fn carried(static_load: Pure, tyre_spring: Pure, height: Pure) -> Pure {
    (static_load - tyre_spring * height).clamp(Pure::ZERO, Pure(f64::MAX))
}

impl Body<STATES> for Twelve {
    #[inline(always)]
    fn rates<T: Tyre>(car: &Prepared, now: &Moment, state: &[Pure; STATES]) -> Rates<STATES> {
        let (v, r, roll) = (state[0], state[1], state[ROLL]);
        let (left, right) = (Pure::ONE, -Pure::ONE);
        // One call after the other: a loop over the wheels would keep the loop over the lanes from being vectorised.
        let corners = [
            Corner::front(car, now, roll, left),
            Corner::front(car, now, roll, right),
            Corner::rear(car, now, roll, left),
            Corner::rear(car, now, roll, right),
        ];
        let fl = corners[0].act::<T>(now, state, 0, 1);
        let fr = corners[1].act::<T>(now, state, 1, 0);
        let rl = corners[2].act::<T>(now, state, 2, 3);
        let rr = corners[3].act::<T>(now, state, 3, 2);
        let force = (fl.side + fr.side) + (rl.side + rr.side);
        let turn = (fl.turn + fr.turn) + (rl.turn + rr.turn);
        let lift = (fl.pushed + fr.pushed) + (rl.pushed + rr.pushed);
        let nod = (fl.nod + fr.nod) + (rl.nod + rr.nod);
        let lean = (fl.lean + fr.lean) + (rl.lean + rr.lean) + car.roll_weight * roll;
        let side = car.side_by_force * force + car.side_by_roll * lean;
        let forward = now.push - r * v;
        Rates {
            change: [
                side - now.speed * r,
                turn * car.inv_yaw_inertia,
                fl.lag,
                fr.lag,
                rl.lag,
                rr.lag,
                state[HEAVE + 1],
                lift * car.inv_sprung_mass,
                state[PITCH + 1],
                (nod - car.pitch_arm * forward) * car.inv_pitch_inertia,
                state[ROLL + 1],
                car.roll_by_force * force + car.roll_by_roll * lean,
                state[WHEEL_SPEED],
                state[WHEEL_SPEED + 1],
                state[WHEEL_SPEED + 2],
                state[WHEEL_SPEED + 3],
                corners[0].hub(&fl, side),
                corners[1].hub(&fr, side),
                corners[2].hub(&rl, side),
                corners[3].hub(&rr, side),
            ],
            king_pin: -((fl.contact.moment + fr.contact.moment)
                + car.front_caster * (fl.contact.force + fr.contact.force)),
            side,
        }
    }

    #[inline(always)]
    fn posture(car: &Prepared, _now: &Moment, state: &[Pure; STATES]) -> Posture {
        let front = |wheel: usize| {
            carried(
                car.front_wheel_load,
                car.front_tyre_spring,
                state[WHEEL + wheel],
            )
        };
        let rear = |wheel: usize| {
            carried(
                car.rear_wheel_load,
                car.rear_tyre_spring,
                state[WHEEL + wheel],
            )
        };
        Posture {
            roll: state[ROLL],
            roll_rate: state[ROLL + 1],
            heave: state[HEAVE],
            pitch: state[PITCH],
            loads: [front(0), front(1), rear(2), rear(3)],
        }
    }

    fn start(start: &Start) -> [Pure; STATES] {
        let mut state = [Pure::ZERO; STATES];
        state[0] = Pure(start.lateral_speed);
        state[1] = Pure(start.yaw_rate);
        state[ROLL] = Pure(start.roll);
        state[ROLL + 1] = Pure(start.roll_rate);
        state
    }

    fn check(car: &Parameters) -> Result<(), Error> {
        LateralRoll::check(car)?;
        for (name, value) in [
            ("body.pitch_inertia_kg_m2", car.pitch_inertia),
            ("front.unsprung_kg", car.front_unsprung),
            ("rear.unsprung_kg", car.rear_unsprung),
            ("front.spring_n_per_m", car.front_spring),
            ("rear.spring_n_per_m", car.rear_spring),
            ("front.tyre_stiffness_n_per_m", car.front_tyre_stiffness),
            ("rear.tyre_stiffness_n_per_m", car.rear_tyre_stiffness),
        ] {
            if value <= 0.0 {
                return Err(out(
                    name,
                    value,
                    "(0, inf) for the model of 12 degrees of freedom",
                ));
            }
        }
        let masses = car.sprung_mass + car.front_unsprung + car.rear_unsprung;
        if (masses - car.mass).abs() > MASSES_AGREE * car.mass {
            let interval = format!("[{masses}, {masses}]: sprung and unsprung masses together");
            return Err(out("body.mass_kg", car.mass, &interval));
        }
        for (name, total, spring, track) in [
            (
                "front.roll_stiffness_nm_per_rad",
                car.front_roll_stiffness,
                car.front_spring,
                car.front_track,
            ),
            (
                "rear.roll_stiffness_nm_per_rad",
                car.rear_roll_stiffness,
                car.rear_spring,
                car.rear_track,
            ),
        ] {
            let springs = 0.5 * spring * track * track;
            if total < springs {
                let interval = format!("[{springs:.6e}, inf): springs and bar together");
                return Err(out(name, total, &interval));
            }
        }
        Ok(())
    }

    fn quickest(car: &Parameters) -> f64 {
        let hop = |spring: f64, tyre: f64, unsprung: f64, damping: f64, track: f64| {
            let (mass, damper) = (0.5 * unsprung, 2.0 * damping / (track * track));
            ((spring + tyre) / mass).sqrt().max(damper / mass)
        };
        let front = hop(
            car.front_roll_stiffness * 2.0 / (car.front_track * car.front_track),
            car.front_tyre_stiffness,
            car.front_unsprung,
            car.front_roll_damping,
            car.front_track,
        );
        let rear = hop(
            car.rear_roll_stiffness * 2.0 / (car.rear_track * car.rear_track),
            car.rear_tyre_stiffness,
            car.rear_unsprung,
            car.rear_roll_damping,
            car.rear_track,
        );
        LateralRoll::quickest(car).max(front).max(rear)
    }
}

/// Masses given to about five digits agree with their sum to this share.
const MASSES_AGREE: f64 = 1e-4;
