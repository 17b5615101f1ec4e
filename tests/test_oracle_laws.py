"""Laws of every mechanism: the mirror, the moving frame, the clock, twins. The oracle has no favourite side."""

import math

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from luztar.dynamics import GapSpring, Signal, exact, exact_bodies

from .one_mass_cases import body

# Two ways to round the same motion of a few seconds; a speed that starts elsewhere moves every sum.
SAME = 1e-10
SECONDS = 3.0


@st.composite
def runs(draw):
    """A mechanism with every piecewise-linear effect, a hand, a load and a start."""

    def some(low, high):
        return draw(st.floats(low, high))

    def maybe(low, high):
        return draw(st.one_of(st.just(0.0), st.floats(low, high)))

    viscous, level = maybe(0.05, 3.0), some(0.05, 3.0)
    parts = {
        "inertia": some(0.5, 3.0),
        "ratio": some(0.5, 4.0),
        "stiffness": some(1.0, 60.0),
        "aligning": maybe(0.5, 20.0),
        "gap": maybe(0.01, 0.5),
        "viscous": viscous,
        "asymmetric_viscous": viscous * maybe(-1.0, 1.0),
        "coulomb": level,
        "asymmetric_coulomb": level * maybe(-1.0, 1.0),
        "stiction": maybe(0.05, 2.0),
    }
    hand = [(some(0.1, 1.5), some(0.5, 12.0), some(-3.0, 3.0)) for _ in range(2)]
    load = (maybe(0.1, 4.0), some(0.5, 20.0), some(-3.0, 3.0))
    return parts, hand, load, (some(-1.0, 1.0), maybe(-1.0, 1.0))


def drives(hand, load, factor: float = 1.0) -> tuple[Signal, Signal]:
    total = Signal.sine(*hand[0]) + Signal.sine(*hand[1])
    return factor * total, factor * Signal.sine(*load)


T = np.linspace(0.0, SECONDS, 121)


@settings(max_examples=100, deadline=None, derandomize=True)
@given(run=runs())
def test_the_mirrored_run_is_the_mirror_of_the_run(run):
    parts, hand, load, (angle, speed) = run
    flipped = {k: -v if k.startswith("asymmetric") else v for k, v in parts.items()}
    psi, torque = drives(hand, load)
    one = exact(body(**parts), psi, T, load_nm=torque, start_rad=angle, start_speed_rad_s=speed)
    psi, torque = drives(hand, load, -1.0)
    other = exact(body(**flipped), psi, T, load_nm=torque, start_rad=-angle, start_speed_rad_s=-speed)
    assert np.abs(one.roadwheel_rad + other.roadwheel_rad).max() < SAME
    assert [(e.kind, e.direction) for e in one.events] == [(e.kind, -e.direction) for e in other.events]


@settings(max_examples=100, deadline=None, derandomize=True)
@given(run=runs(), belt=st.floats(-1.0, 1.0))
def test_on_a_belt_the_motion_is_that_of_the_belts_frame(run, belt):
    parts, hand, load, (angle, speed) = run
    psi, torque = drives(hand, load)
    p, c = parts["ratio"], parts["aligning"]
    carried = exact(
        body(**parts), psi, T, load_nm=torque, start_rad=angle, start_speed_rad_s=speed, ground_speed_rad_s=belt
    )
    within = exact(
        body(**parts),
        psi + Signal.polynomial(0.0, -p * belt),
        T,
        load_nm=torque + Signal.polynomial(0.0, -c * belt),
        start_rad=angle,
        start_speed_rad_s=speed - belt,
    )
    assert np.abs(carried.roadwheel_rad - (within.roadwheel_rad + belt * T)).max() < SAME
    assert [e.kind for e in carried.events] == [e.kind for e in within.events]


@settings(max_examples=50, deadline=None, derandomize=True)
@given(run=runs(), late=st.floats(-1e3, 1e3))
def test_a_later_clock_changes_nothing(run, late):
    parts, hand, load, (angle, speed) = run
    psi, torque = drives(hand, load)
    start = {"start_rad": angle, "start_speed_rad_s": speed}
    now = exact(body(**parts), psi, T, load_nm=torque, **start)
    shifted = [[(a, w, q - w * late) for a, w, q in sines] for sines in (hand, [load])]
    psi, torque = drives(shifted[0], shifted[1][0])
    then = exact(body(**parts), psi, T + late, load_nm=torque, **start)
    # A time of 1000 s has 1e-13 s of rounding, a phase of 20 000 rad 4e-12.
    assert np.abs(now.roadwheel_rad - then.roadwheel_rad).max() < 1e-8
    assert [e.kind for e in now.events] == [e.kind for e in then.events]


@settings(max_examples=50, deadline=None, derandomize=True)
@given(run=runs())
def test_twins_do_the_same_at_the_same_instants(run):
    # Every event happens twice at once: none may swallow the other.
    parts, hand, load, (angle, speed) = run
    psi, torque = drives(hand, load)
    alone = exact(body(**parts), psi, T, load_nm=torque, start_rad=angle, start_speed_rad_s=speed)
    sides = [[parts[k] + parts[f"asymmetric_{k}"], parts[k] - parts[f"asymmetric_{k}"]] for k in ("viscous", "coulomb")]
    kinetic = np.array([sides[1]] * 2)
    both = exact_bodies(
        [parts["inertia"]] * 2,
        T,
        stiffness=parts["aligning"] * np.eye(2),
        viscous=[sides[0]] * 2,
        kinetic=kinetic,
        static=kinetic + parts["stiction"],
        loads=[torque] * 2,
        springs=[GapSpring(parts["stiffness"], parts["gap"], at=row, end=psi) for row in parts["ratio"] * np.eye(2)],
        start=angle,
        start_speed=speed,
    )
    for i in range(2):
        assert np.abs(both.angle[i] - alone.roadwheel_rad).max() < SAME
        own = [e for e in both.events if e.element == i]
        assert [e.kind for e in own] == [e.kind for e in alone.events]
        assert all(
            math.isclose(a.time_s, b.time_s, rel_tol=1e-9, abs_tol=1e-12)
            for a, b in zip(own, alone.events, strict=True)
        )
