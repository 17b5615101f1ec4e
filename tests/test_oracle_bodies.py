"""Several bodies in the oracle: against modes of vibration, against one body, against a general solver with events."""

import math

import numpy as np
import pytest
from scipy.linalg import eigh

from luztar.dynamics import GapSpring, Signal, exact, exact_bodies

from .generators import two_bodies
from .one_mass_cases import body

TRUST = 1e-10


def test_without_friction_the_bodies_swing_in_their_modes():
    inertia = np.array([10.2, 0.3, 0.5])
    stiffness = np.array([[900.0, -700.0, 0.0], [-700.0, 1900.0, -800.0], [0.0, -800.0, 1100.0]])
    squares, shapes = eigh(stiffness, np.diag(inertia))
    start = np.array([0.3, -0.1, 0.2])
    t = np.linspace(0.0, 20.0, 500)
    run = exact_bodies(inertia, t, stiffness=stiffness, start=start)
    amplitudes = shapes.T @ (inertia * start)
    wanted = shapes @ (amplitudes[:, np.newaxis] * np.cos(np.sqrt(squares)[:, np.newaxis] * t))
    assert np.abs(run.angle - wanted).max() < TRUST


def test_uncoupled_bodies_are_so_many_single_ones():
    cases = [
        {
            "inertia": 3.0,
            "stiffness": 60.0,
            "ratio": 16.0,
            "gap": 0.1,
            "viscous": 40.0,
            "coulomb": 8.1,
            "stiction": 4.0,
        },
        {"inertia": 1.0, "stiffness": 9.0, "ratio": 2.0, "gap": 0.3, "viscous": 0.2, "coulomb": 0.7},
    ]
    hand = Signal.sine(1.0, math.pi) + Signal.polynomial(0.0, 0.1)
    t = np.linspace(0.0, 6.0, 601)
    run = exact_bodies(
        [c["inertia"] for c in cases],
        t,
        viscous=[c["viscous"] for c in cases],
        kinetic=[c["coulomb"] for c in cases],
        static=[c["coulomb"] + c.get("stiction", 0.0) for c in cases],
        springs=[
            GapSpring(c["stiffness"], c["gap"], at=np.eye(2)[i] * c["ratio"], end=hand) for i, c in enumerate(cases)
        ],
    )
    for i, case in enumerate(cases):
        alone = exact(body(**case), hand, t)
        assert np.abs(run.angle[i] - alone.roadwheel_rad).max() < TRUST
        assert [e.kind for e in run.events if e.element == i] == [e.kind for e in alone.events]
        times = [e.time_s for e in run.events if e.element == i]
        assert times == pytest.approx([e.time_s for e in alone.events], abs=1e-12)


def test_two_bodies_with_friction_and_a_gap_between_them():
    pair = two_bodies.Pair(
        inertia=np.array([0.05, 3.0]),
        friction=np.array([0.3, 8.0]),
        column=20.0,
        half_gap=0.03,
        ratio=16.0,
        ground=900.0,
        load=lambda s: 4.0 * math.sin(2.0 * s),
    )
    t = np.linspace(0.0, 4.0, 401)
    run = exact_bodies(
        pair.inertia,
        t,
        stiffness=np.diag([0.0, pair.ground]),
        kinetic=pair.friction,
        loads=[Signal.sine(4.0, 2.0), 0.0],
        springs=[GapSpring(pair.column, 2.0 * pair.half_gap, at=[-1.0, pair.ratio])],
    )
    assert {e.kind for e in run.events} == {"contact", "release", "stick", "slip", "reversal"}
    assert len(run.events) > 20
    assert np.abs(run.angle - two_bodies.simulate(pair, t)).max() < 1e-9


def test_two_stuck_bodies_stay_and_a_belt_carries():
    t = np.linspace(0.0, 10.0, 11)
    held = exact_bodies(
        [1.0, 2.0], t, stiffness=[[3.0, -1.0], [-1.0, 2.0]], kinetic=[2.0, 2.0], start=[0.4, -0.3], loads=[0.5, -0.2]
    )
    assert held.events == ()
    assert (held.angle.T == [0.4, -0.3]).all() and not held.speed.any()
    carried = exact_bodies([1.0], t, kinetic=[[2.0, 1.0]], ground_speed=0.25, start_speed=0.25)
    assert carried.angle[0] == pytest.approx(0.25 * t, abs=1e-14)
    assert (carried.speed == 0.25).all()
