"""Two bodies against references that share no code: general solvers, eigenmodes, and finer steps."""

import math

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.linalg import eigh

from luztar.mechanism import (
    Body,
    Damper,
    Friction,
    Load,
    Mechanism,
    Spring,
    simulate,
    single_mass,
    steering_torque_driven,
)
from mechanism_parts import STEPS, chain, observed_order, push

SECONDS = 3.0
FINEST = 64 * STEPS[-1]


def gentle(t: np.ndarray) -> np.ndarray:
    """A load under which the chain sticks as often as it slides."""
    return 1.6 * np.sin(2.3 * t) + 1.1 * np.sin(5.2 * t)


def hand(t: np.ndarray) -> np.ndarray:
    return 1.5 * np.sin(4.1 * t) + 0.8 * np.sin(9.7 * t)


CHAINS = {
    "own": {},
    "own, static above kinetic": {"static": 1.4},
    "relative": {"between": 0.5},
    "relative, static above kinetic": {"between": 0.5, "static": 1.4},
}
CASES = {f"{name}, {load.__name__}": (chain(**kind), load) for name, kind in CHAINS.items() for load in (push, gentle)}
CASES |= {
    f"steering, static {static}": (steering_torque_driven(king_pin_static_nm=static, gap_rad=0.02), hand)
    for static in (8.1, 12.0)
}


def run(m: Mechanism, load, steps: int) -> tuple[np.ndarray, set[str]]:
    h = SECONDS / steps
    names = [b.name for b in m.bodies]
    made = simulate(
        m,
        {m.channels[0]: load(np.arange(steps + 1) * h)},
        sample_rate_hz=1.0 / h,
        substeps=1,
        start={names[0]: 0.3, names[1]: -0.1} if load is push else None,
    )
    places = np.stack([made.position[n] for n in names])
    return places / np.abs(places).max(axis=1, keepdims=True), {e.kind for e in made.events}


@pytest.mark.parametrize("case", CASES)
def test_order_two_through_stick_slip_and_reversals(case):
    """Own coordinates as for one body; friction between bodies has the same order here, by location, not by theorem."""
    m, load = CASES[case]
    finest, kinds = run(m, load, FINEST)
    assert kinds >= {"reversal", "contact", "release"} and (load is push or kinds >= {"stick", "slip"})
    errors = [float(np.abs(run(m, load, n)[0] - finest[:, :: FINEST // n]).max()) for n in STEPS]
    assert observed_order(errors) >= 1.9, errors
    # Of the size of (h w)^2 with the 16 rad/s of the chain.
    assert errors[-1] < 5e-5


def test_a_break_away_from_a_belt_that_accelerates_is_found_to_second_order():
    """Static above kinetic friction, and no spring: the belt's acceleration alone breaks the mass loose."""
    m = single_mass(kinetic=0.6, static=1.0, on_belt=True)
    # An acceleration of 1.8 sin(3 t) against the 1.0 that static friction gives.
    exact = np.arcsin(1.0 / 1.8) / 3.0
    for steps in STEPS:
        h = SECONDS / steps
        drive = {"belt": -0.2 * np.sin(3.0 * h * np.arange(steps + 1))}
        run = simulate(m, drive, sample_rate_hz=1.0 / h, substeps=1, start_speed={"mass": -0.6})
        slips = [e.time_s for e in run.events if e.kind == "slip"]
        # A single instant: its error is h^2 times a factor that depends on where in a step it lies, 0.2 to 0.6.
        assert abs(slips[0] - exact) <= h * h


def test_the_chain_against_a_general_solver_with_events():
    """DOP853 from event to event, with a rule of its own for what sticks: one body's friction, no gap."""
    m1, m2, k1, k2, f1 = 1.0, 0.6, 30.0, 50.0, 1.1
    m = Mechanism(
        bodies=(Body("one", m1), Body("two", m2)),
        loads=(Load("push", "two"),),
        elements=(
            Spring("k1", "one", stiffness=k1),
            Spring("k2", "one", "two", stiffness=k2),
            Friction("f1", "one", kinetic=f1),
        ),
    )
    on_one = lambda y: -k1 * y[0] - k2 * (y[0] - y[1])  # noqa: E731
    t, y, ends = 0.0, np.array([0.3, -0.1, 0.0, 0.0]), []
    s = float(np.sign(on_one(y)))
    while t < SECONDS:

        def rate(t, y, s=s):
            a1 = (on_one(y) - s * f1) / m1 if s else 0.0
            return [y[2], y[3], a1, (push(np.float64(t)) - k2 * (y[1] - y[0])) / m2]

        stop = (lambda t, y, s=s: s * y[2]) if s else (lambda t, y: f1 - abs(on_one(y)))
        stop.terminal, stop.direction = True, -1.0
        part = solve_ivp(rate, (t, SECONDS), y, method="DOP853", events=stop, rtol=1e-12, atol=1e-13, max_step=0.01)
        t, y = part.t[-1], part.y[:, -1].copy()
        if part.status == 1:
            ends.append(t)
            held = on_one(y)
            if s:
                y[2] = 0.0
                s = float(np.sign(held)) if abs(held) > f1 else 0.0
            else:
                s = float(np.sign(held))
    assert len(ends) > 10
    steps = 30_000
    h = SECONDS / steps
    made = simulate(
        m,
        {"push": push(np.arange(steps + 1) * h)},
        sample_rate_hz=1.0 / h,
        substeps=1,
        start={"one": 0.3, "two": -0.1},
    )
    # Second order at h = 1e-4 with frequencies up to 13 rad/s.
    assert made.position["one"][-1] == pytest.approx(y[0], abs=1e-6)
    assert made.position["two"][-1] == pytest.approx(y[1], abs=1e-6)
    found = [e.time_s for e in made.events]
    np.testing.assert_allclose(found, ends, atol=2e-5)


def test_smooth_motion_against_dop853():
    """Cubic spring, drag and Stribeck friction that never stops: no event, all curved laws."""
    m = Mechanism(
        bodies=(Body("one", 1.0), Body("two", 0.6)),
        elements=(
            Spring("k", "one", "two", stiffness=40.0, hardening=300.0),
            Damper("d", "one", viscous=0.2, drag=0.4),
            Friction("f", "two", kinetic=0.3, stribeck=0.5, stribeck_speed=2.0, difference=0.1),
        ),
    )
    f = lambda v: 0.3 + 0.1 + 0.5 * math.exp(-((v / 2.0) ** 2))  # noqa: E731

    def rate(_, y):
        x = y[0] - y[1]
        torque = 40.0 * x + 300.0 * x**3
        return [y[2], y[3], (-torque - 0.2 * y[2] - 0.4 * abs(y[2]) * y[2]) / 1.0, (torque - f(y[3])) / 0.6]

    start = [0.0, 0.0, 3.0, 4.0]
    truth = solve_ivp(rate, (0.0, 1.0), start, method="DOP853", rtol=1e-12, atol=1e-13)
    assert truth.y[3].min() > 0.5
    off = []
    for steps in (300, 600, 1200):
        made = simulate(
            m,
            sample_rate_hz=float(steps),
            seconds=1.0,
            substeps=1,
            start_speed={"one": 3.0, "two": 4.0},
        )
        off.append(abs(made.position["two"][-1] - truth.y[1, -1]))
    assert observed_order(off) >= 1.9
    assert off[-1] < 1e-6


def test_linear_modes_are_those_of_the_eigenproblem():
    """Started in a mode, the two masses stay in it and come back after its period."""
    m = steering_torque_driven(
        column_friction_nm=0.0,
        king_pin_friction_nm=0.0,
        gap_rad=0.0,
        column_viscous_nm_s_per_rad=0.0,
        roadwheel_viscous_nm_s_per_rad=0.0,
        aligning_nm_per_rad=500.0,
    )
    stiffness = np.array([[60.0, -16.0 * 60.0], [-16.0 * 60.0, 16.0**2 * 60.0 + 500.0]])
    squares, shapes = eigh(stiffness, np.diag([0.04, 3.0]))
    assert m.longest_step_s == pytest.approx(2.0 / math.sqrt(squares[-1]), rel=1e-12)
    assert m.stiffest == "column"
    for square, shape in zip(squares, shapes.T, strict=True):
        shape = shape / np.abs(shape).max()
        period = 2.0 * math.pi / math.sqrt(square)
        steps = 2000
        made = simulate(
            m,
            sample_rate_hz=steps / period,
            seconds=period,
            substeps=1,
            start={"handwheel": shape[0], "roadwheel": shape[1]},
        )
        # The midpoint rule is late by (h w)^2 / 24 of the period; other modes are excited by rounding only.
        late = 2.0 * math.pi * (2.0 * math.pi / steps) ** 2 / 24.0
        for i, body in enumerate(("handwheel", "roadwheel")):
            assert made.position[body][-1] == pytest.approx(shape[i], abs=2.0 * late)
            assert made.position[body][steps // 2] == pytest.approx(-shape[i], abs=2.0 * late)
