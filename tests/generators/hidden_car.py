"""Car runs from a general solver: steering, tyres and body as a machine of modes, each by DOP853 between events.

Shares no code with luztar: the front wheels turn to the left, to the right, or stand; an event function ends each mode.
The handwheel is a sum of sines, known in closed form. Axes of ISO 8855: y and yaw to the left, roll to the right.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from scipy.integrate import solve_ivp

from .steering import Hand

GRAVITY = 9.80665
# Wheels at rest are looked at this often: a hand of 1 Hz winds no spring up and lets it go again in between.
SCANS_PER_S = 400
# A tenth of the smallest noise that is added to a run, over the largest of the states.
RUN_TOLERANCE = 1e-6


@dataclass(frozen=True)
class CarTruth:
    """A car as a workshop would note it."""

    mass: float = 1350.0
    yaw_inertia: float = 2200.0
    front_axle: float = 1.15
    rear_axle: float = 1.45
    front_cornering: float = 105e3
    rear_cornering: float = 118e3
    pneumatic_trail: float = 0.035
    caster_trail: float = 0.025
    sprung_mass: float = 1200.0
    roll_arm: float = 0.5
    roll_inertia: float = 750.0
    front_roll_stiffness: float = 32e3
    rear_roll_stiffness: float = 24e3
    front_roll_damping: float = 1900.0
    rear_roll_damping: float = 1700.0
    ratio: float = 16.0
    stiffness: float = 45.0
    inertia: float = 3.0
    viscous: float = 90.0
    half_gap: float = 0.0
    kinetic: float = 0.0
    static: float = 0.0
    adhesion: float = math.inf
    relaxation: float = 0.0
    front_roll_steer: float = 0.0
    rear_roll_steer: float = 0.0

    def known(self) -> dict[str, float]:
        """What a scale, a tape and a torque wrench show: everything that is no tyre, friction or yaw inertia."""
        return {
            "body.mass_kg": self.mass,
            "body.front_axle_m": self.front_axle,
            "body.rear_axle_m": self.rear_axle,
            "body.sprung_mass_kg": self.sprung_mass,
            "body.roll_arm_m": self.roll_arm,
            "body.roll_inertia_kg_m2": self.roll_inertia,
            "front.pneumatic_trail_m": self.pneumatic_trail,
            "front.caster_trail_m": self.caster_trail,
            "front.track_m": 1.5,
            "front.roll_stiffness_nm_per_rad": self.front_roll_stiffness,
            "front.roll_damping_nm_s_per_rad": self.front_roll_damping,
            "rear.track_m": 1.5,
            "rear.roll_stiffness_nm_per_rad": self.rear_roll_stiffness,
            "rear.roll_damping_nm_s_per_rad": self.rear_roll_damping,
            "steering.inertia_kg_m2": self.inertia,
            "steering.ratio": self.ratio,
            "steering.stiffness_nm_per_rad": self.stiffness,
        }

    # --- tyres ---

    def slip(self, sideways: float, angle: float) -> float:
        """Slip of a wheel: small angles for the linear tyre, the tangent of the slip angle for one that slides."""
        if math.isinf(self.adhesion):
            return sideways - angle
        return math.tan(math.atan(sideways) - angle)

    def wheel(self, stiffness: float, load: float, slip: float) -> tuple[float, float]:
        """Lateral force and the share of the pneumatic trail that is left, of one wheel."""
        if math.isinf(self.adhesion):
            return -stiffness * slip, 1.0
        limit = self.adhesion * load
        share = min(stiffness * abs(slip) / (3.0 * limit), 1.0)
        shape = 1.0 - share + share**2 / 3.0
        force = -math.copysign(3.0 * limit * share * shape, slip)
        return force, (1.0 - share) ** 3 / shape

    def axle(self, stiffness: float, load: float, slip: float, moved: float) -> tuple[float, float]:
        """Force of an axle and its torque per metre of pneumatic trail, ``moved`` newtons of load to the right."""
        force = turn = 0.0
        for side in (-1.0, 1.0):
            each = max(0.5 * load + side * moved, 1e-9)
            f, trail = self.wheel(stiffness * each / load, each, slip)
            force, turn = force + f, turn + f * trail
        return force, turn

    # --- motion ---

    def moves(self, u: float, phi: float, y: np.ndarray) -> tuple[list[float], float, float]:
        """Rates of (v, r, lag front, lag rear, roll, roll rate), torque on the king-pins, lateral acceleration."""
        v, r, lag_front, lag_rear, roll, roll_rate = y
        base = self.front_axle + self.rear_axle
        front_angle, rear_angle = phi + self.front_roll_steer * roll, self.rear_roll_steer * roll
        front_slip = self.slip((v + self.front_axle * r) / u, front_angle)
        rear_slip = self.slip((v - self.rear_axle * r) / u, rear_angle)
        front_lag = rear_lag = 0.0
        if self.relaxation > 0.0:
            front_lag, rear_lag = (
                u / self.relaxation * (front_slip - lag_front),
                u / self.relaxation * (rear_slip - lag_rear),
            )
            front_slip, rear_slip = lag_front, lag_rear
        front_load, rear_load = (self.mass * GRAVITY * x / base for x in (self.rear_axle, self.front_axle))
        front_moved = (self.front_roll_stiffness * roll + self.front_roll_damping * roll_rate) / 1.5
        rear_moved = (self.rear_roll_stiffness * roll + self.rear_roll_damping * roll_rate) / 1.5
        front, turn = self.axle(self.front_cornering, front_load, front_slip, front_moved)
        rear, _ = self.axle(self.rear_cornering, rear_load, rear_slip, rear_moved)
        sideways = [front, rear]
        if not math.isinf(self.adhesion):
            sideways = [front * math.cos(front_angle), rear * math.cos(rear_angle)]
        arm = self.sprung_mass * self.roll_arm
        stiffness = self.front_roll_stiffness + self.rear_roll_stiffness - arm * GRAVITY
        restoring = -stiffness * roll - (self.front_roll_damping + self.rear_roll_damping) * roll_rate
        side, lean = np.linalg.solve(
            [[self.mass, -arm], [-arm, self.roll_inertia]], [sideways[0] + sideways[1], restoring]
        )
        yaw = (self.front_axle * sideways[0] - self.rear_axle * sideways[1]) / self.yaw_inertia
        torque = -(self.pneumatic_trail * turn + self.caster_trail * front)
        return [side - u * r, yaw, front_lag, rear_lag, roll_rate, lean], torque, side

    def column(self, psi: float, phi: float) -> float:
        """Torque of the column on the king-pins."""
        z = psi - self.ratio * phi
        return self.ratio * self.stiffness * (z - min(max(z, -self.half_gap), self.half_gap))


def drive(
    car: CarTruth, hand: Hand, speed: float, times: np.ndarray, *, tolerance: float = 1e-9
) -> dict[str, np.ndarray]:
    """Return what a car does, from straight driving, at some instants."""
    dry = car.kinetic > 0.0 or car.static > 0.0
    # A little above the kinetic level, so that what breaks away is pulled on and does not stand again by rounding.
    held = max(car.static, car.kinetic) * (1.0 + 1e-9)
    states = np.zeros((times.size, 8))
    end = float(times[-1])
    t, y = float(times[0]), np.zeros(8)
    side = 0 if dry else 1

    def torque(x: float, y: np.ndarray) -> float:
        _, aligning, _ = car.moves(speed, y[6], y[:6])
        return car.column(float(hand(x)), y[6]) + aligning

    while t < end:
        if side == 0:
            y[7] = 0.0

        def rate(x: float, y: np.ndarray, side: int = side) -> list[float]:
            body, aligning, _ = car.moves(speed, y[6], y[:6])
            if side == 0:
                return [*body, 0.0, 0.0]
            friction = (side * car.kinetic if dry else 0.0) + car.viscous * y[7]
            return [*body, y[7], (car.column(float(hand(x)), y[6]) + aligning - friction) / car.inertia]

        def leaves(x: float, y: np.ndarray, side: int = side) -> float:
            return held - abs(torque(x, y)) if side == 0 else side * y[7]

        leaves.terminal, leaves.direction = dry, -1.0  # type: ignore[attr-defined]
        begin = t
        if side != 0 and dry:
            # A first instant by hand, so that the event at the start is not taken for one.
            first = min(1e-7, 0.5 * (end - t))
            pull = rate(t, y)[7]
            y = y.copy()
            y[6] += y[7] * first + 0.5 * pull * first**2
            y[7] += pull * first
            begin = t + first
            if side * y[7] <= 0.0:
                side, t = 0, begin
                continue
        wanted = times[times > begin]
        solved = solve_ivp(
            rate,
            (begin, end),
            y,
            method="DOP853",
            rtol=tolerance,
            atol=1e-3 * tolerance,
            t_eval=wanted,
            events=leaves,
            max_step=4.0 / SCANS_PER_S,
        )
        if len(solved.t):
            states[np.isin(times, solved.t)] = solved.y.T
        if solved.status != 1:
            break
        t, y = float(solved.t_events[0][0]), solved.y_events[0][0].copy()
        pull = torque(t, y)
        if side == 0:
            side = 1 if pull > 0.0 else -1
        else:
            y[7] = 0.0
            side = 0 if abs(pull) <= held else (1 if pull > 0.0 else -1)
    side_acceleration = np.array([car.moves(speed, s[6], s[:6])[2] for s in states])
    return {
        "handwheel": np.asarray(hand(times)),
        "yaw_rate": states[:, 1],
        "lateral_acceleration": side_acceleration,
        "roll_angle": states[:, 4],
        "roadwheel": states[:, 6],
    }


# White noise of the sensors: rad/s, m/s2, rad, rad.
NOISE = {"yaw_rate": 1.5e-3, "lateral_acceleration": 0.03, "roll_angle": 4e-4, "roadwheel": 4e-4}


def car_run(
    car: CarTruth,
    chance: np.random.Generator,
    *,
    speed: float = 22.0,
    seconds: float = 12.0,
    rate_hz: float = 100.0,
    reach: float = 0.08,
    channels: tuple[str, ...] = tuple(NOISE),
) -> dict[str, np.ndarray]:
    """Return time, handwheel, speed and what the car does, with noise, for a hand that weaves up to 1 Hz.

    ``reach`` is the largest amplitude of one sine of the hand; several add up to some four of it.
    """
    times = np.arange(round(seconds * rate_hz)) / rate_hz
    count = 7
    hand = Hand(
        tuple(chance.uniform(0.3 * reach, reach, count)),
        tuple(chance.uniform(0.1, 1.0, count)),
        tuple(chance.uniform(0.0, 2.0 * math.pi, count)),
    )
    made = drive(car, hand, speed, times, tolerance=RUN_TOLERANCE)
    out = {"time": times, "handwheel": made["handwheel"], "speed": np.full(times.size, speed)}
    for name in channels:
        out[name] = made[name] + chance.normal(0.0, NOISE[name], times.size)
    return out
