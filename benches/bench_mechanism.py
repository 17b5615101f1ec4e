"""How fast mechanisms of several bodies run: `python benches/bench_mechanism.py`.

Microseconds per step of the named structures, in the core (a lane of many, one thread) and through the stepper as a
loop in Python calls it; the slowest steps, which a loop in real time must allow for; a two-body chain against
``solve_ivp`` with an event function, restarted at every event, at the same error. All take turns in one run; medians of
processor time are printed, for the machine may do other work as well.
"""

from __future__ import annotations

import os

# One thread: what is measured is the step.
os.environ.setdefault("RAYON_NUM_THREADS", "1")

import time  # noqa: E402
from collections.abc import Callable  # noqa: E402

import numpy as np  # noqa: E402
from interleaved import measure  # noqa: E402
from scipy.integrate import solve_ivp  # noqa: E402

from luztar.mechanism import (  # noqa: E402
    Body,
    Friction,
    Load,
    Mechanism,
    RearAxle,
    Spring,
    Stepper,
    power_assistance,
    simulate_lanes,
    single_mass,
    steering_mechanism,
    steering_one_mass,
    steering_torque_driven,
)

ROUNDS = 9
STEP_S = 1e-4
SECONDS = 1.0
ONE_MASS = {
    "steering.inertia_kg_m2": 3.0,
    "steering.ratio": 16.0,
    "steering.stiffness_nm_per_rad": 60.0,
    "viscous.coefficient_nm_s_per_rad": 40.0,
    "coulomb.level_nm": 8.1,
    "freeplay.gap_rad": 0.1,
}
STRUCTURES = {
    "single mass": single_mass(stiffness=400.0, kinetic=1.0),
    "one-mass steering": steering_one_mass(ONE_MASS),
    "torque-driven steering": steering_torque_driven(),
    "figure 3": steering_mechanism(),
    "figure 3, assistance, 4WS": steering_mechanism(assistance=power_assistance(), rear_axle=RearAxle()),
}


def drive(m: Mechanism) -> np.ndarray:
    """Return a sine on the first channel: a radian of the handwheel, or 5 Nm."""
    t = np.arange(round(SECONDS / STEP_S) + 1) * STEP_S
    rows = np.zeros((t.size, len(m.channels)))
    rows[:, 0] = (1.0 if m.driven else 5.0) * np.sin(2.0 * np.pi * t)
    return rows


def in_the_core(m: Mechanism) -> Callable[[], object]:
    """Return a run of one lane, all steps in the core."""
    rows = drive(m)
    drives = {m.channels[0]: rows[:, 0]}
    name, value = next(iter(m.parameters().items()))
    return lambda: simulate_lanes(m, {name: [value]}, drives, sample_rate_hz=1.0 / STEP_S, substeps=1)


def stepped(m: Mechanism) -> Callable[[], object]:
    """Return the same in a loop of Python."""
    rows = drive(m)

    def run() -> None:
        stepper = Stepper(m, STEP_S, substeps=1)
        step = stepper.step
        for row in rows[1:]:
            step(row)

    return run


def slowest(m: Mechanism) -> tuple[float, float]:
    """Return the 99.9th percentile and the largest time of a step, the best of three passes each, in microseconds."""
    rows = drive(m)
    best = np.full(rows.shape[0] - 1, np.inf)
    for _ in range(3):
        stepper = Stepper(m, STEP_S, substeps=1)
        for i, row in enumerate(rows[1:]):
            started = time.perf_counter()
            stepper.step(row)
            best[i] = min(best[i], time.perf_counter() - started)
    return 1e6 * float(np.quantile(best, 0.999)), 1e6 * float(best.max())


K1, K2, F1, M1, M2 = 30.0, 50.0, 1.1, 1.0, 0.6


def push(t: float | np.ndarray) -> np.ndarray:
    """Return the load on the second body."""
    return 4.0 * np.sin(5.3 * t) + 2.0 * np.sin(2.2 * t)


def with_events(tolerance: float) -> np.ndarray:
    """Return the chain's last state by DOP853 from event to event."""
    t, y = 0.0, np.array([0.3, -0.1, 0.0, 0.0])

    def held(y: np.ndarray) -> float:
        return float(-K1 * y[0] - K2 * (y[0] - y[1]))

    s = float(np.sign(held(y)))
    while t < 3.0:

        def rate(t: float, y: np.ndarray, s: float = s) -> list[float]:
            first = (held(y) - s * F1) / M1 if s else 0.0
            return [y[2], y[3], first, (float(push(t)) - K2 * (y[1] - y[0])) / M2]

        def event(t: float, y: np.ndarray, s: float = s) -> float:
            return s * y[2] if s else F1 - abs(held(y))

        event.terminal, event.direction = True, -1.0  # type: ignore[attr-defined]
        part = solve_ivp(rate, (t, 3.0), y, method="DOP853", events=event, rtol=tolerance, atol=1e-2 * tolerance)
        t, y = float(part.t[-1]), part.y[:, -1].copy()
        if part.status == 1:
            force = held(y)
            y[2] = 0.0
            s = float(np.sign(force)) if not s or abs(force) > F1 else 0.0
    return y[:2]


def chain(steps: int) -> np.ndarray:
    """Return the same by luztar."""
    m = Mechanism(
        bodies=(Body("one", M1), Body("two", M2)),
        loads=(Load("push", "two"),),
        elements=(
            Spring("k1", "one", stiffness=K1),
            Spring("k2", "one", "two", stiffness=K2),
            Friction("f1", "one", kinetic=F1),
        ),
    )
    h = 3.0 / steps
    run = simulate_lanes(
        m,
        {"k1.stiffness_nm_per_rad": [K1]},
        {"push": push(np.arange(steps + 1) * h)},
        sample_rate_hz=1.0 / h,
        substeps=1,
        start={"one": 0.3, "two": -0.1},
    )
    return np.array([run.position["one"][0, -1], run.position["two"][0, -1]])


def main() -> None:
    """Measure and print."""
    steps = round(SECONDS / STEP_S)
    calls: dict[str, Callable[[], object]] = {}
    for name, m in STRUCTURES.items():
        calls[f"{name}: core"] = in_the_core(m)
        calls[f"{name}: stepper"] = stepped(m)
    timed = measure(calls, rounds=ROUNDS)
    print(f"{'microseconds per step':<28}{'core':>8}{'stepper':>9}{'99.9 %':>9}{'largest':>9}")
    for name, m in STRUCTURES.items():
        core, loop = (1e6 * timed[f"{name}: {way}"].cpu_s / steps for way in ("core", "stepper"))
        most, worst = slowest(m)
        print(f"{name:<28}{core:>8.3f}{loop:>9.3f}{most:>9.2f}{worst:>9.2f}")
    exact = with_events(1e-12)
    for tolerance in (1e-4, 1e-6):
        wanted = float(np.abs(with_events(tolerance) - exact).max())
        n = 500
        while np.abs(chain(n) - exact).max() > wanted:
            n *= 2
        timed = measure({"solve_ivp": lambda t=tolerance: with_events(t), "luztar": lambda n=n: chain(n)}, ROUNDS)
        slow, quick = (1e3 * timed[name].cpu_s / 3.0 for name in ("solve_ivp", "luztar"))
        print(
            f"two bodies to {wanted:.1e}: solve_ivp with events {slow:.2f} ms per simulated s, luztar {quick:.3f} ms "
            f"({n} steps); median of ratios {timed.ratio('solve_ivp', 'luztar'):.0f}"
        )


if __name__ == "__main__":
    main()
