"""Laws that hold for any mechanism: momentum, energy, dissipation, no creep."""

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from luztar.mechanism import (
    Body,
    Damper,
    Driven,
    Friction,
    Load,
    Mechanism,
    RearAxle,
    Spring,
    power_assistance,
    simulate,
    steering_mechanism,
)

positive = st.floats(0.1, 10.0)
PROPERTY = settings(max_examples=40, deadline=None, suppress_health_check=[HealthCheck.too_slow])


@st.composite
def mechanisms(draw: st.DrawFn, *, loaded: bool = False) -> tuple[Mechanism, dict[str, float], dict[str, float]]:
    """Two to five bodies in a chain with extra elements, and a start."""
    n = draw(st.integers(2, 5))
    bodies = [Body(f"b{i}", draw(positive)) for i in range(n)]
    elements: list = []
    for i in range(1, n):
        elements.append(
            Spring(
                f"k{i}",
                f"b{i - 1}",
                f"b{i}",
                stiffness=draw(st.floats(1.0, 100.0)),
                gap=draw(st.sampled_from([0.0, 0.05])),
                ratio_b=draw(st.sampled_from([1.0, 0.5, 3.0, -1.0])),
            )
        )
    extra = draw(st.integers(0, 2 * n))
    for i in range(extra):
        a = draw(st.integers(0, n - 1))
        b = draw(st.one_of(st.just("ground"), st.integers(0, n - 1).filter(lambda k, a=a: k != a).map("b{}".format)))
        if draw(st.booleans()):
            elements.append(Damper(f"c{i}", f"b{a}", b, viscous=draw(st.floats(0.0, 3.0))))
        else:
            kinetic = draw(st.floats(0.0, 2.0))
            elements.append(
                Friction(f"f{i}", f"b{a}", b, kinetic=kinetic, static=kinetic * draw(st.sampled_from([1.0, 1.3])))
            )
    loads = tuple(Load(f"l{i}", f"b{i}") for i in range(n)) if loaded else ()
    m = Mechanism(bodies=tuple(bodies), elements=tuple(elements), loads=loads)
    value = st.floats(-0.5, 0.5)
    start = {b.name: draw(value) for b in bodies}
    speed = {b.name: draw(st.one_of(st.just(0.0), value)) for b in bodies}
    return m, start, speed


@PROPERTY
@given(mechanisms())
def test_energy_is_only_lost_and_the_ledger_adds_up(case):
    m, start, speed = case
    run = simulate(m, sample_rate_hz=200.0, seconds=3.0, start=start, start_speed=speed)
    e = run.energy_j
    frictions = [x.name for x in m.elements if isinstance(x, Friction | Damper)]
    # Heat is heat in every element, and what is stored is what is left; the residual is of second order in h w = 0.2.
    assert all(e[name] <= 0.0 for name in frictions)
    assert abs(e["residual"]) <= 0.02 * e["turnover"] + 1e-12
    assert e["stored_last"] <= e["stored_first"] * (1.0 + 0.02) + 1e-12


@PROPERTY
@given(mechanisms(loaded=True), st.integers(0, 2**32 - 1))
def test_what_holds_moves_by_nothing(case, seed):
    """Speeds and ways of frictions on the ground that hold over two samples are exactly 0."""
    m, start, speed = case
    rng = np.random.default_rng(seed)
    t = np.arange(400) / 200.0
    drives = {p.name: rng.normal(0.0, 2.0) * np.sin(rng.uniform(1.0, 9.0) * t) for p in m.loads}
    run = simulate(m, drives, sample_rate_hz=200.0, start=start, start_speed=speed)
    for name, modes in run.sliding.items():
        friction = m[name]
        if friction.b == "ground":
            holds = modes == 0
            assert not run.speed[friction.a][holds].any()
        elif friction.ratio_b == 1.0:
            holds = modes == 0
            assert (run.speed[friction.a][holds] == run.speed[friction.b][holds]).all()


@PROPERTY
@given(mechanisms())
def test_without_the_ground_momentum_stays(case):
    m, start, speed = case
    inner = tuple(
        Spring(e.name, e.a, e.b, stiffness=e.stiffness, gap=e.gap) if isinstance(e, Spring) else e
        for e in m.elements
        if e.b != "ground"
    )
    m = Mechanism(bodies=m.bodies, elements=inner)
    run = simulate(m, sample_rate_hz=200.0, seconds=3.0, start=start, start_speed=speed)
    momentum = sum(b.inertia * run.speed[b.name] for b in m.bodies)
    size = sum(b.inertia * np.abs(run.speed[b.name]).max() for b in m.bodies)
    # Rounding of a few hundred to a few thousand steps.
    assert np.ptp(momentum) <= 1e-11 * size + 1e-15


def test_a_passive_mechanism_gives_back_no_more_than_it_got():
    rng = np.random.default_rng(3)
    m = steering_mechanism(rear_axle=RearAxle())
    t = np.arange(3001) / 500.0
    for _ in range(5):
        psi = sum(rng.normal(0.0, 0.5) * np.sin(rng.uniform(0.5, 12.0) * t) for _ in range(4))
        run = simulate(m, {"handwheel": psi}, sample_rate_hz=500.0)
        e = run.energy_j
        assert run.balanced
        assert e["handwheel"] > e["stored_last"] - e["stored_first"] > 0.0
        assert all(e[x.name] <= 0.0 for x in m.elements)


def test_a_symmetric_mechanism_moves_symmetrically_to_the_bit():
    """Both wheels stop, turn and break away in the same step: they are decided together."""
    t = np.arange(2001) / 500.0
    drive = {"handwheel": 1.1 * np.sin(4.3 * t) + 0.4 * np.sin(11.0 * t)}
    for static in (None, 6.0):
        run = simulate(steering_mechanism(king_pin_static_nm=static), drive, sample_rate_hz=500.0)
        for name in ("position", "speed"):
            assert (getattr(run, name)["left_wheel"] == getattr(run, name)["right_wheel"]).all()
        left, right = (
            [(e.time_s, e.kind) for e in run.events if e.element == f"{side}_king_pin"] for side in ("left", "right")
        )
        assert left == right and len(left) > 10


def test_a_whole_steering_held_by_its_frictions_stays_for_ever():
    m = steering_mechanism()
    n = 20_001
    drives = {"handwheel": np.zeros(n), "tyre_left": np.full(n, 3.9), "tyre_right": np.full(n, -3.9)}
    run = simulate(m, drives, sample_rate_hz=1000.0)
    assert run.events == ()
    assert not any(run.position[b.name].any() or run.speed[b.name].any() for b in m.bodies)


def test_assistance_lightens_the_hand_and_is_booked_as_work():
    t = np.arange(2001) / 500.0
    drive = {"handwheel": 1.5 * np.sin(np.pi * t)}
    plain, helped = (
        simulate(steering_mechanism(assistance=a), drive, sample_rate_hz=500.0) for a in (None, power_assistance())
    )
    # The slope of the curve is 1.3 times the column's: the hand is left with less than three quarters.
    assert np.abs(helped.sensor("hand_torque")).max() < 0.75 * np.abs(plain.sensor("hand_torque")).max()
    assert helped.energy_j["assistance"] > 0.0 and helped.balanced
    assert helped.energy_j["handwheel"] < plain.energy_j["handwheel"]


def test_too_steep_an_assistance_hunts_and_the_ledger_shows_who_feeds_it():
    """The loop of assistance, freeplay and column oscillates; with half the step it does just the same."""
    t = np.arange(2001) / 500.0
    drive = {"handwheel": 1.5 * np.sin(np.pi * t)}
    m = steering_mechanism(assistance=power_assistance(2000.0))
    runs = [simulate(m, drive, sample_rate_hz=500.0, substeps=n) for n in (20, 40)]
    work = [r.energy_j["assistance"] for r in runs]
    assert work[1] == pytest.approx(work[0], rel=0.02) and work[1] > 10.0 * runs[1].energy_j["handwheel"]
    assert all(r.balanced for r in runs)


def test_friction_between_driven_and_ground_gaps_and_stops_all_show_in_the_log():
    m = Mechanism(
        bodies=(Body("mass", 1.0, "m"),),
        driven=(Driven("hand", "m"),),
        elements=(Spring("gap", "hand", "mass", stiffness=50.0, gap=0.2, unit="m"), Friction("f", "mass", kinetic=1.0)),
    )
    t = np.arange(2001) / 500.0
    run = simulate(m, {"hand": 0.5 * np.sin(t)}, sample_rate_hz=500.0)
    first = run.events[:2]
    # Contact at x = gap / 2, break-away when the spring carries the friction.
    assert [e.kind for e in first] == ["contact", "slip"]
    assert first[0].time_s == pytest.approx(np.arcsin(0.1 / 0.5), abs=1e-5)
    assert first[1].time_s == pytest.approx(np.arcsin(0.12 / 0.5), abs=1e-5)
