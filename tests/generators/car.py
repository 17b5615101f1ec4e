"""Cars written down a second time: matrices, numpy's functions and a general solver; nothing of luztar.

Axes of ISO 8855. The steering has no friction and no freeplay here, so that every equation is smooth.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping

import numpy as np
from scipy.integrate import solve_ivp

GRAVITY = 9.80665
# Far below what a run of luztar at 1 ms leaves.
TOLERANCE = 1e-10

Parameters = Mapping[str, float]


def static_loads(p: Parameters) -> tuple[float, float]:
    """Return the loads of front and rear axle, N."""
    base = p["body.front_axle_m"] + p["body.rear_axle_m"]
    weight = p["body.mass_kg"] * GRAVITY
    return weight * p["body.rear_axle_m"] / base, weight * p["body.front_axle_m"] / base


def wheel(p: Parameters, axle: str, tyre: str, tan_slip: float, load: float) -> tuple[float, float]:
    """Return lateral force and aligning moment of one wheel at a load, N and Nm."""
    static = 0.5 * static_loads(p)[0 if axle == "front" else 1]
    n = load / static
    ratio = p.get(f"{axle}.load_ratio", 0.0)
    # Pacejka's load dependence as he writes it, with the angle.
    peak = np.sin(2.0 * np.arctan(ratio)) if ratio else 1.0
    grown = np.sin(2.0 * np.arctan(ratio * n)) / peak if ratio else n
    stiffness = 0.5 * p[f"{axle}.cornering_n_per_rad"] * grown
    trail = p.get(f"{axle}.pneumatic_trail_m", 0.0)
    if tyre == "linear":
        force = -stiffness * tan_slip
        return force, force * trail
    mu = p[f"{axle}.friction"] * (1.0 - p.get(f"{axle}.friction_load", 0.0) * (n - 1.0))
    if load <= 0.0 or mu <= 0.0:
        return 0.0, 0.0
    critical = 3.0 * mu * load / stiffness
    theta = min(abs(tan_slip) / critical, 1.0)
    # Fiala: sliding from the trailing edge; moment from the parabola of pressure over the half length 3 t0.
    fiala = mu * load * (1.0 - (1.0 - theta) ** 3)
    moment = mu * load * 3.0 * trail * theta * (1.0 - theta) ** 3
    if tyre == "brush":
        return -np.sign(tan_slip) * fiala, -np.sign(tan_slip) * moment
    c, e = p[f"{axle}.shape"], p.get(f"{axle}.curvature", 0.0)
    b = stiffness / (c * mu * load)
    inner = b * tan_slip - e * (b * tan_slip - np.arctan(b * tan_slip))
    force = -mu * load * np.sin(c * np.arctan(inner))
    lever = moment / fiala if fiala > 0.0 else trail
    return force, force * lever


def tan_slip(speed: float, side: float, steer: float, tyre: str) -> float:
    """Return the tangent of the slip angle from the velocity in the wheel's own frame."""
    if tyre == "linear":
        return side / speed - steer
    across = side * np.cos(steer) - speed * np.sin(steer)
    ahead = speed * np.cos(steer) + side * np.sin(steer)
    return across / ahead


class Plant:
    """Equations of a car of one of the three models behind its steering, in matrix form."""

    def __init__(self, p: Parameters, model: str, tyre: str) -> None:
        self.p = {"rear.steer_ratio": 0.0, **p}
        self.model, self.tyre = model, tyre
        p = self.p
        # Wheels: axle, x, y (m). The single-track model has one wheel pair per axle in its middle.
        a, b = p["body.front_axle_m"], p["body.rear_axle_m"]
        half = {axle: 0.5 * p.get(f"{axle}.track_m", 0.0) for axle in ("front", "rear")}
        self.wheels = [
            ("front", a, half["front"]),
            ("front", a, -half["front"]),
            ("rear", -b, half["rear"]),
            ("rear", -b, -half["rear"]),
        ]
        if model != "single_track":
            self.arm = p["body.sprung_mass_kg"] * p["body.roll_arm_m"]
            m, ix = p["body.mass_kg"], p["body.roll_inertia_kg_m2"]
            self.lateral_mass = np.array([[m, -self.arm], [-self.arm, ix]])

    # State: v, r, lag of 4 wheels, roll, roll rate, phi, phi rate, x, y, yaw, then (12) heave, pitch, 4 hubs and rates.
    SIZE = 13

    def start(self) -> np.ndarray:
        return np.zeros(self.SIZE + (12 if self.model == "twelve" else 0))

    def loads(self, s: np.ndarray, u: float) -> np.ndarray:
        p = self.p
        static = np.repeat(0.5 * np.array(static_loads(p)), 2)
        if self.model == "single_track":
            return static
        if self.model == "twelve":
            stiffness = np.repeat([p[f"{x}.tyre_stiffness_n_per_m"] for x in ("front", "rear")], 2)
            return np.maximum(static - stiffness * s[15:19], 0.0)
        moved = []
        for axle, load in zip(("front", "rear"), static_loads(p), strict=True):
            torque = p[f"{axle}.roll_stiffness_nm_per_rad"] * s[6] + p[f"{axle}.roll_damping_nm_s_per_rad"] * s[7]
            torque += p.get(f"{axle}.roll_centre_m", 0.0) * load / GRAVITY * u * s[1]
            moved.append(torque / p[f"{axle}.track_m"])
        return static + np.array([-moved[0], moved[0], -moved[1], moved[1]])

    def rates(self, s: np.ndarray, psi: float, u: float) -> tuple[np.ndarray, float, float]:
        """Return the rates of the state, the lateral acceleration and the tyres' torque on the king-pins."""
        p, model = self.p, self.model
        v, r, lag, roll, roll_rate, phi, phi_rate, yaw = s[0], s[1], s[2:6], s[6], s[7], s[8], s[9], s[12]
        out = np.zeros_like(s)
        loads = self.loads(s, u)
        forces, pins = np.zeros((4, 2)), 0.0
        for i, (axle, x, y) in enumerate(self.wheels):
            steer = phi if axle == "front" else p["rear.steer_ratio"] * phi
            if model != "single_track":
                steer += p.get(f"{axle}.roll_steer", 0.0) * roll
            own = u if self.tyre == "linear" or model != "twelve" else u - r * y
            slip = tan_slip(own, v + x * r, steer, self.tyre)
            length = p.get(f"{axle}.relaxation_m", 0.0)
            used = lag[i] if length > 0.0 else slip
            out[2 + i] = u / length * (slip - lag[i]) if length > 0.0 else 0.0
            force, moment = wheel(p, axle, self.tyre, used, loads[i])
            small = self.tyre == "linear"
            forces[i] = (0.0 if small else -force * np.sin(steer), force if small else force * np.cos(steer))
            if axle == "front":
                pins -= moment + p.get("front.caster_trail_m", 0.0) * force
        side = forces[:, 1].sum()
        lever_x, lever_y = (np.array([w[k] for w in self.wheels]) for k in (1, 2))
        turn = lever_x @ forces[:, 1]
        if model == "twelve":
            turn -= lever_y @ forces[:, 0]
        if model == "single_track":
            acceleration = side / p["body.mass_kg"]
        elif model == "lateral_roll":
            k = sum(p[f"{x}.roll_stiffness_nm_per_rad"] for x in ("front", "rear")) - self.arm * GRAVITY
            c = sum(p[f"{x}.roll_damping_nm_s_per_rad"] for x in ("front", "rear"))
            acceleration, out[7] = np.linalg.solve(self.lateral_mass, [side, -k * roll - c * roll_rate])
            out[6] = roll_rate
        else:
            acceleration = self._bounce(s, out, side, loads, -r * v)
        out[0] = acceleration - u * r
        out[1] = turn / p["body.yaw_inertia_kg_m2"]
        column = p["steering.stiffness_nm_per_rad"] * (psi - p["steering.ratio"] * phi)
        torque = p["steering.ratio"] * column + pins - p.get("steering.aligning_nm_per_rad", 0.0) * phi
        torque += (
            p.get("assist.gain", 0.0) * np.sign(column) * max(abs(column) - p.get("assist.threshold_nm", 0.0), 0.0)
        )
        torque -= p.get("viscous.coefficient_nm_s_per_rad", 0.0) * phi_rate
        out[8], out[9] = phi_rate, torque / p["steering.inertia_kg_m2"]
        out[10] = u * np.cos(yaw) - v * np.sin(yaw)
        out[11] = u * np.sin(yaw) + v * np.cos(yaw)
        out[12] = r
        return out, acceleration, pins

    def _bounce(self, s: np.ndarray, out: np.ndarray, side: float, loads: np.ndarray, forward: float) -> float:
        """Heave, pitch, roll and hubs: q = (heave, pitch, roll, 4 hubs), springs through one matrix of reaches."""
        p = self.p
        q = np.concatenate((s[[13, 14, 6]], s[15:19]))
        rate = np.concatenate((s[[19, 20, 7]], s[21:25]))
        x, y = (np.array([w[k] for w in self.wheels]) for k in (1, 2))
        reach = np.column_stack((np.ones(4), -x, y, -np.eye(4)))
        each = [w[0] for w in self.wheels]
        track = np.array([p[f"{a}.track_m"] for a in each])
        spring = np.array([p[f"{a}.spring_n_per_m"] for a in each])
        damper = np.array([2.0 * p[f"{a}.roll_damping_nm_s_per_rad"] for a in each]) / track**2
        force = -reach.T @ (spring * (reach @ q) + damper * (reach @ rate))
        for axle, (left, right) in (("front", (0, 1)), ("rear", (2, 3))):
            t = p[f"{axle}.track_m"]
            twist = np.zeros(7)
            twist[2], twist[3 + left], twist[3 + right] = 1.0, -1.0 / t, 1.0 / t
            bar = p[f"{axle}.roll_stiffness_nm_per_rad"] - 0.5 * p[f"{axle}.spring_n_per_m"] * t * t
            force -= bar * (twist @ q) * twist
        force[2] += self.arm * GRAVITY * q[2]
        static = np.repeat(0.5 * np.array(static_loads(p)), 2)
        force[3:] += loads - static
        acceleration, out[7] = np.linalg.solve(self.lateral_mass, [side, force[2]])
        sprung = p["body.sprung_mass_kg"]
        out[19] = force[0] / sprung
        out[20] = (force[1] - sprung * p["body.cg_height_m"] * forward) / p["body.pitch_inertia_kg_m2"]
        for i, (axle, _, _) in enumerate(self.wheels):
            load = static_loads(p)[0 if axle == "front" else 1]
            unsprung = p[f"{axle}.unsprung_kg"]
            moved = (load / GRAVITY - unsprung) * p.get(f"{axle}.roll_centre_m", 0.0)
            moved += unsprung * p["body.wheel_radius_m"]
            way = 1.0 if self.wheels[i][2] > 0.0 else -1.0
            out[21 + i] = (force[3 + i] + way * moved * acceleration / track[i]) / (0.5 * unsprung)
        out[13:15], out[15:19], out[6] = s[19:21], s[21:25], s[7]
        return float(acceleration)


def drive(
    p: Parameters, model: str, tyre: str, psi: Callable[[float], float], u: float, times: np.ndarray
) -> dict[str, np.ndarray]:
    """Return channels at the times, from a solver of order 8."""
    plant = Plant(p, model, tyre)
    solved = solve_ivp(
        lambda t, s: plant.rates(s, psi(t), u)[0],
        (float(times[0]), float(times[-1])),
        plant.start(),
        method="DOP853",
        t_eval=times,
        rtol=TOLERANCE,
        atol=TOLERANCE,
    )
    s = solved.y
    told = [plant.rates(s[:, i], psi(t), u) for i, t in enumerate(times)]
    return {
        "roadwheel_rad": s[8],
        "yaw_rate_rad_s": s[1],
        "lateral_speed_m_s": s[0],
        "lateral_acceleration_m_s2": np.array([t[1] for t in told]),
        "tyre_torque_nm": np.array([t[2] for t in told]),
        "roll_rad": s[6],
        "x_m": s[10],
        "y_m": s[11],
        "yaw_rad": s[12],
        "load_front_left_n": np.array([plant.loads(s[:, i], u)[0] for i in range(len(times))]),
    }


def linear_matrices(p: Parameters, u: float) -> tuple[np.ndarray, np.ndarray]:
    """Return A and B of the single-track model: states (v, r), input the angle of the front wheels."""
    m, iz = p["body.mass_kg"], p["body.yaw_inertia_kg_m2"]
    a, b = p["body.front_axle_m"], p["body.rear_axle_m"]
    cf, cr = p["front.cornering_n_per_rad"], p["rear.cornering_n_per_rad"]
    matrix = np.array(
        [
            [-(cf + cr) / (m * u), -u - (a * cf - b * cr) / (m * u)],
            [-(a * cf - b * cr) / (iz * u), -(a * a * cf + b * b * cr) / (iz * u)],
        ]
    )
    return matrix, np.array([cf / m, a * cf / iz])
