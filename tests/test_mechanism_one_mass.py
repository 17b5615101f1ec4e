"""A mechanism of one body is the one-mass model, and has its exact values."""

import math

import numpy as np
import pytest

import luztar
from luztar.mechanism import simulate, single_mass, steering_one_mass

STEERING = {
    "steering.inertia_kg_m2": 3.0,
    "steering.ratio": 16.0,
    "steering.stiffness_nm_per_rad": 60.0,
    "viscous.coefficient_nm_s_per_rad": 40.0,
    "freeplay.gap_rad": 0.1,
}
RICH = {
    "coulomb.level_nm": 8.1,
    "stiction.extra_nm": 1.5,
    "stribeck.extra_nm": 2.0,
    "stribeck.speed_rad_s": 0.05,
    "asymmetric_coulomb.difference_nm": 0.7,
    "drag.coefficient_nm_s2_per_rad2": 3.0,
    "steering.aligning_nm_per_rad": 200.0,
    "hardening.coefficient_nm_per_rad3": 500.0,
}
FRICTION = {"coulomb.level_nm": 8.1, "stiction.extra_nm": 3.9}
# Both steps make the same sums in another order; they add up over 1000 steps.
ROUNDING = 1e-14
RATE_HZ = 500.0
T = np.arange(2001) / RATE_HZ
PSI = np.sin(np.pi * T)


def both(parameters: dict[str, float], psi: np.ndarray, substeps: int, **options: object) -> tuple:
    one = luztar.dynamics.trace(parameters, psi, sample_rate_hz=RATE_HZ, substeps=substeps, **options)
    start = {"roadwheel": options.get("start_rad", 0.0)}
    speed = {"roadwheel": options.get("start_speed_rad_s", 0.0)}
    made = simulate(
        steering_one_mass(parameters),
        {"handwheel": psi},
        sample_rate_hz=RATE_HZ,
        substeps=substeps,
        start=start,
        start_speed=speed,
    )
    return one, made


@pytest.mark.parametrize("extra", [{}, RICH], ids=["linear", "rich"])
def test_without_an_event_the_two_differ_by_rounding(extra):
    # The wheel already turns, and the hand goes on turning it: nothing stops.
    psi = 16.0 * 0.3 * T[:200]
    options = {"start_rad": -0.0045, "start_speed_rad_s": 0.3}
    one, made = both({**STEERING, **extra}, psi, 1, **options)
    assert one.speed_rad_s.min() > 0.0
    assert np.abs(made.position["roadwheel"] - one.roadwheel_rad).max() <= ROUNDING


@pytest.mark.parametrize("extra", [FRICTION, RICH], ids=["stiction", "rich"])
def test_through_events_the_two_agree_to_second_order(extra):
    off = []
    for substeps in (1, 2, 4, 8):
        one, made = both({**STEERING, **extra}, PSI, substeps)
        off.append(np.abs(made.position["roadwheel"] - one.roadwheel_rad).max())
    assert off[0] < 1e-5
    assert off[-1] < off[0] / 8.0**1.8


def test_events_and_energies_are_those_of_the_one_mass_model():
    one, made = both({**STEERING, **FRICTION}, PSI, 4)
    assert [(e.kind, e.direction) for e in made.events] == [(e.kind, e.direction) for e in one.events]
    np.testing.assert_allclose([e.time_s for e in made.events], [e.time_s for e in one.events], atol=1e-6)
    e, f = made.energy_j, one.energy_j
    assert e["handwheel"] == pytest.approx(f["handwheel"], rel=1e-6)
    assert -e["king_pin"] == pytest.approx(f["dry"], rel=1e-6)
    assert -e["damper"] == pytest.approx(f["viscous"], rel=1e-6)
    assert made.balanced


def test_free_decay_stops_where_the_closed_form_does():
    w = 2.0 * math.pi * 1.0618033
    m = single_mass(stiffness=w * w, kinetic=0.1 * w * w)
    run = simulate(m, sample_rate_hz=10_000, seconds=3.0, start={"mass": 1.03}, substeps=1)
    assert run.position["mass"][-1] == pytest.approx(-0.03, abs=1e-6)
    assert run.speed["mass"][-1] == 0.0
    stick = [e for e in run.events if e.kind == "stick"]
    assert len(stick) == 1 and stick[0].time_s == pytest.approx(2.3544850539, abs=1e-6)
    assert sum(e.kind == "reversal" for e in run.events) == 4


@pytest.mark.parametrize(
    ("r", "share", "zeta", "amplitude"),
    [
        (0.6, 0.2, 0.0, 1.55060285),
        (1.2, 0.5, 0.0, 1.65746747),
        (0.7, 0.3, 0.1, 1.63078610),
        (1.3, 0.4, 0.05, 1.05301703),
    ],
)
def test_den_hartogs_amplitudes(r, share, zeta, amplitude):
    # 400 cycles leave of the start what exp(-400 pi zeta) or the friction does.
    steps, cycles = 1000, 60 if zeta else 400
    period = 2.0 * math.pi / r
    h = period / steps
    t = np.arange(cycles * steps + 1) * h
    m = single_mass(stiffness=1.0, viscous=2.0 * zeta, kinetic=share)
    run = simulate(m, {"force": np.cos(r * t)}, sample_rate_hz=1.0 / h, substeps=1)
    last = run.position["mass"][-steps:]
    # Second order at 1000 steps a cycle: 4 times the errors that the reference measures at 2000.
    assert 0.5 * np.ptp(last) == pytest.approx(amplitude, rel=3e-5)


def test_the_belts_period_and_reach_at_order_two():
    m = single_mass(stiffness=1.0, kinetic=0.6, static=1.0, on_belt=True)
    off = []
    for n in (331, 662, 1324, 2648, 5296):
        h = 20.0 / n
        run = simulate(
            m,
            {"belt": 0.2 * h * np.arange(n + 1)},
            sample_rate_hz=1.0 / h,
            substeps=1,
            start_speed={"mass": 0.2},
        )
        slips = [e.time_s for e in run.events if e.kind == "slip"]
        sticks = [e.time_s for e in run.events if e.kind == "stick"]
        # The first slip is at x = F_S / k, after 5 s; a period has 4.0688878716 s of slip and 4 s of stick.
        assert slips[0] == pytest.approx(5.0, abs=1e-9)
        off.append(abs(slips[1] - slips[0] - 8.0688878716))
        assert sticks[-1] > slips[0]
    assert np.log2(off[0] / off[-1]) / 4.0 >= 1.9
    # Of the size of h^2.
    assert off[-1] < (20.0 / 5296) ** 2


def test_the_freeplay_oscillators_period():
    # T = 2 pi / w + 4 z0 / (w A) with I = 2, K = 50, z0 = 0.05, A = 0.3.
    m = single_mass(inertia=2.0, stiffness=50.0, gap=0.1)
    run = simulate(m, sample_rate_hz=20_000, seconds=1.5, start={"mass": 0.35}, substeps=1)
    v = run.speed["mass"]
    turns = np.flatnonzero((v[1:-1] < 0.0) & (v[2:] >= 0.0))
    i = turns[0] + 1
    half = (i - v[i] / (v[i + 1] - v[i])) / 20_000
    assert 2.0 * half == pytest.approx(1.38997039, abs=1e-6)


def test_a_million_steps_at_049_of_friction_move_nothing():
    m = single_mass(kinetic=1.0)
    run = simulate(m, {"force": np.full(1_000_001, 0.49)}, sample_rate_hz=1000.0)
    assert not run.position["mass"].any() and not run.speed["mass"].any()
    assert run.events == ()
