"""What a car costs: `PYTHONPATH=tests python benches/bench_vehicle.py`.

A manoeuvre of 12 s (two sines of the handwheel) with freeplay and dry friction. The lateral-roll car on brush tyres is
timed against the same step in a numba loop over all cores, interleaved, and against scipy's general solver with
tolerances that reach the error shown. The solver gets the model without dry friction: on a friction that sticks it
would not end. Then cars per second of every model and tyre. Medians of the rounds' ratios; all times are wall times.
"""

from __future__ import annotations

import math
import time
from collections.abc import Callable

import numpy as np
from interleaved import measure
from scipy.integrate import solve_ivp

from generators import car as reference
from luztar.vehicle import Car, Pieces, simulate, summarise

CARS = 512
SECONDS = 12.0
STEP_S = 0.0025
SPEED_M_S = 20.0
STARTS, SIZES, FREQUENCY_HZ = (1.0, 3.5, 6.0, 8.5), (1.0, 0.0, -1.0, 0.0), 0.4
AMPLITUDES = np.linspace(0.4, 0.8, CARS)
GAPS = np.linspace(0.0, 0.2, CARS)
FRICTIONS = np.linspace(0.0, 8.1, CARS)
ROUNDS = 9


def hand(amplitudes: np.ndarray) -> Pieces:
    """Return the handwheel's signal, one row per car."""
    return Pieces(start_s=[STARTS], amplitude=amplitudes[:, None] * SIZES, frequency_hz=FREQUENCY_HZ)


def numba_cars(car: Car) -> Callable[[], np.ndarray] | None:
    """Return the lateral-roll car on brush tyres as a loop written by hand, or None without numba."""
    try:
        import numba
    except ImportError:
        return None
    g = reference.GRAVITY
    p = {key: v.value for key, v in car.parameters.items()}
    m, iz, a, b = (p[f"body.{k}"] for k in ("mass_kg", "yaw_inertia_kg_m2", "front_axle_m", "rear_axle_m"))
    arm, ix = p["body.sprung_mass_kg"] * p["body.roll_arm_m"], p["body.roll_inertia_kg_m2"]
    det = m * ix - arm * arm
    loads = reference.static_loads(p)
    cf, cr = p["front.cornering_n_per_rad"], p["rear.cornering_n_per_rad"]
    mu_f, mu_r = p["front.friction"], p["rear.friction"]
    lag_f, lag_r = 1.0 / p["front.relaxation_m"], 1.0 / p["rear.relaxation_m"]
    k_f, k_r = p["front.roll_stiffness_nm_per_rad"], p["rear.roll_stiffness_nm_per_rad"]
    c_f, c_r = p["front.roll_damping_nm_s_per_rad"], p["rear.roll_damping_nm_s_per_rad"]
    t_f, t_r = p["front.track_m"], p["rear.track_m"]
    k_all, c_all = k_f + k_r - arm * g, c_f + c_r
    trail, caster = p["front.pneumatic_trail_m"], p["front.caster_trail_m"]
    inertia, ratio, spring = p["steering.inertia_kg_m2"], p["steering.ratio"], p["steering.stiffness_nm_per_rad"]
    mu = p["viscous.coefficient_nm_s_per_rad"]
    u, h, steps = SPEED_M_S, STEP_S, round(SECONDS / STEP_S)
    load_f, load_r = 0.5 * loads[0], 0.5 * loads[1]
    kept = h * mu / (2.0 * inertia)
    starts, sizes = np.array(STARTS), np.array(SIZES)

    @numba.njit(inline="always")
    def tyre(stiffness: float, friction: float, static: float, slip: float, load: float) -> tuple[float, float]:
        load = min(max(load, 0.0), 2.0 * static)
        limit = max(friction * load, 1e-9)
        k = 0.5 * stiffness * load / static
        th = min(k * abs(slip) / (3.0 * limit), 1.0)
        way = -math.copysign(1.0, slip)
        left = 1.0 - th
        size = 3.0 * limit * th * way
        return size * (left + th * th / 3.0), size * left * left * left

    @numba.njit(inline="always")
    def rates(
        v: float, r: float, lf: float, lr: float, roll: float, p_roll: float, phi: float
    ) -> tuple[float, float, float, float, float, float, float]:
        tan = math.tan(phi)
        side = (v + a * r) / u
        sf, sr = (side - tan) / (1.0 + side * tan), (v - b * r) / u
        move_f, move_r = (k_f * roll + c_f * p_roll) / t_f, (k_r * roll + c_r * p_roll) / t_r
        f1, m1 = tyre(cf, mu_f, load_f, lf, load_f - move_f)
        f2, m2 = tyre(cf, mu_f, load_f, lf, load_f + move_f)
        f3, _ = tyre(cr, mu_r, load_r, lr, load_r - move_r)
        f4, _ = tyre(cr, mu_r, load_r, lr, load_r + move_r)
        front, rear = (f1 + f2) * math.cos(phi), f3 + f4
        moment = -(k_all * roll + c_all * p_roll)
        across = (ix * (front + rear) + arm * moment) / det
        lean = (arm * (front + rear) + m * moment) / det
        turn = (a * front - b * rear) / iz
        pins = -(trail * (m1 + m2) + caster * (f1 + f2))
        return across, turn, u * lag_f * (sf - lf), u * lag_r * (sr - lr), p_roll, lean, pins

    @numba.njit(inline="always")
    def column(psi: float, phi: float, z0: float) -> float:
        z = psi - ratio * phi
        return ratio * spring * (z - min(max(z, -z0), z0))

    @numba.njit(inline="always")
    def wheel(t: float, size: float) -> float:
        out = 0.0
        for i in range(starts.size):
            if t >= starts[i]:
                out = size * sizes[i] * math.sin(2.0 * math.pi * FREQUENCY_HZ * (t - starts[i]))
        return out

    @numba.njit(parallel=True)
    def run(amplitudes: np.ndarray, gaps: np.ndarray, frictions: np.ndarray, out: np.ndarray) -> None:
        for lane in numba.prange(amplitudes.size):
            size, z0, dry = amplitudes[lane], 0.5 * gaps[lane], frictions[lane]
            v = r = lf = lr = roll = p_roll = phi = w = x = y = yaw = 0.0
            most = 0.0
            psi = wheel(0.0, size)
            for i in range(steps):
                t = i * h
                across, d1, d2, d3, d4, d5, pins = rates(v, r, lf, lr, roll, p_roll, phi)
                most = max(most, abs(across))
                e = 0.5 * h
                vm, rm, fm, gm = v + e * (across - u * r), r + e * d1, lf + e * d2, lr + e * d3
                om, pm, phim = roll + e * d4, p_roll + e * d5, phi + e * w
                am, d1, d2, d3, d4, d5, pins_m = rates(vm, rm, fm, gm, om, pm, phim)
                psi_m, psi_e = wheel(t + e, size), wheel(t + h, size)
                v, r, lf, lr = v + h * (am - u * rm), r + h * d1, lf + h * d2, lr + h * d3
                roll, p_roll = roll + h * d4, p_roll + h * d5
                yaw_m = yaw + e * (r - h * d1)
                x += h * (u * math.cos(yaw_m) - vm * math.sin(yaw_m))
                y += h * (u * math.sin(yaw_m) + vm * math.cos(yaw_m))
                yaw += h * rm
                s = (w > 0.0) - (w < 0.0)
                w1 = (w * (1.0 - kept) + h * (column(psi_m, phim, z0) + pins_m - dry * s) / inertia) / (1.0 + kept)
                if w1 * w > 0.0 or dry == 0.0:
                    phi, w = phim + e * w1, w1
                else:
                    share = w / (w - w1) if w != 0.0 else 0.0
                    phi += share * e * w
                    at = psi + share * (4.0 * psi_m - 3.0 * psi - psi_e + share * 2.0 * (psi - 2.0 * psi_m + psi_e))
                    slope = 2.0 * (pins_m - pins)
                    m0 = column(at, phi, z0) + pins + share * slope
                    m1 = column(psi_e, phi, z0) + pins + slope
                    if abs(m0) > dry:
                        stuck, way = 0.0, m0
                    elif abs(m1) > dry:
                        way = m1
                        stuck = min(max((math.copysign(dry, m1) - m0) / (m1 - m0), 0.0), 1.0)
                    else:
                        stuck, way = 1.0, m1
                    left = (1.0 - share) * (1.0 - stuck) * h
                    mean = 0.5 * (m0 + (m1 - m0) * stuck + m1) - math.copysign(dry, way)
                    w = left * mean / (inertia + 0.5 * left * mu)
                    if w * way <= 0.0:
                        w = 0.0
                    phi += 0.5 * left * w
                psi = psi_e
            out[lane, 0], out[lane, 1], out[lane, 2] = most, x, y

    out = np.empty((CARS, 3))

    def call() -> np.ndarray:
        run(AMPLITUDES, GAPS, FRICTIONS, out)
        return out

    return call


def main() -> None:
    """Print one line per way."""
    car = Car.named("bmw_320i")
    options = {"speed_m_s": SPEED_M_S, "duration_s": SECONDS, "step_s": STEP_S}
    rough = {"freeplay.gap_rad": GAPS, "coulomb.level_nm": FRICTIONS}
    ours = lambda: summarise(  # noqa: E731
        car, handwheel_rad=hand(AMPLITUDES), model="lateral_roll", tyre="brush", vary=rough, **options
    )
    ways: dict[str, Callable[[], object]] = {"luztar": ours}
    peer = numba_cars(car)
    if peer is None:
        print("numba is not installed: without the hand-written loop")
    else:
        ways["numba"] = peer
        told, found = ours(), peer()
        apart = np.abs(told["end_y_m"] - found[:, 2]).max()
        print(f"the two loops drive alike: end of the way {apart:.1e} m apart")
    timings = measure(ways, rounds=ROUNDS)
    per_car = timings["luztar"].median_s / CARS
    print(f"lateral_roll, brush, {CARS} cars of {SECONDS:g} s at {STEP_S:g} s: luztar {1e3 * per_car:.3f} ms a car")
    if peer is not None:
        cpu = timings["numba"].cpu_s / timings["luztar"].cpu_s
        print(f"numba over luztar, median of ratios: {timings.ratio('numba', 'luztar'):.1f} (processor time {cpu:.1f})")
    _against_solver(car, options, per_car)
    for model in ("single_track", "lateral_roll", "twelve"):
        for tyre in ("linear", "brush", "magic_formula"):
            rounds = []
            for _ in range(3):
                started = time.perf_counter()
                summarise(car, handwheel_rad=hand(AMPLITUDES), model=model, tyre=tyre, vary=rough, **options)
                rounds.append(time.perf_counter() - started)
            print(f"{model:<14}{tyre:<15}{CARS / sorted(rounds)[1]:>8.0f} cars of {SECONDS:g} s per second")


def _against_solver(car: Car, options: dict[str, float], per_car: float) -> None:
    """One car without dry friction and freeplay in scipy's RK45, in Python as one writes it."""
    p = {key: v.value for key, v in car.parameters.items()}
    size = float(AMPLITUDES[CARS // 2])
    plant = reference.Plant(p, "lateral_roll", "brush")

    def psi(t: float) -> float:
        piece = max((i for i, s in enumerate(STARTS) if t >= s), default=None)
        if piece is None:
            return 0.0
        return size * SIZES[piece] * math.sin(2.0 * math.pi * FREQUENCY_HZ * (t - STARTS[piece]))

    one = {"handwheel_rad": hand(np.array([size])), "model": "lateral_roll", "tyre": "brush"}
    fine = simulate(car, **one, **{**options, "step_s": STEP_S / 16}, every=16)
    run = simulate(car, **one, **options)
    ours = float(np.abs(run.y_m - fine.y_m).max())
    started = time.perf_counter()
    solved = solve_ivp(
        lambda t, s: plant.rates(s, psi(t), SPEED_M_S)[0],
        (0.0, SECONDS),
        plant.start(),
        rtol=1e-5,
        atol=1e-7,
        t_eval=run.time_s,
        max_step=0.05,
    )
    slow = time.perf_counter() - started
    theirs = float(np.abs(solved.y[11] - fine.y_m[0]).max())
    print(
        f"solve_ivp (RK45, rtol 1e-5): {1e3 * slow:.0f} ms a car, error {theirs:.0e} m (luztar {ours:.0e} m); "
        f"over luztar: {slow / per_car:.0f}"
    )


if __name__ == "__main__":
    main()
