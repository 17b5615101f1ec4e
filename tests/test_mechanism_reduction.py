"""One mass in place of many: substitute parameters in closed form, and an error that is what it is said to be."""

import json

import numpy as np
import pytest

import luztar
from luztar.errors import ParameterError
from luztar.mechanism import (
    Body,
    Damper,
    Driven,
    Friction,
    Load,
    Manoeuvre,
    Mechanism,
    RearAxle,
    Spring,
    power_assistance,
    reduce,
    simulate,
    steering_mechanism,
    steering_torque_driven,
)


def test_a_chain_reduces_to_springs_in_series_and_sums_of_squares():
    """Handwheel - 3:1 - shaft - 5:1 - wheel, all numbers by hand."""
    m = Mechanism(
        bodies=(Body("shaft", 0.2), Body("wheel", 4.0)),
        driven=(Driven("handwheel"),),
        loads=(Load("tyre", "wheel"),),
        elements=(
            Spring("first", "handwheel", "shaft", stiffness=30.0, gap=0.02, ratio_b=3.0),
            Spring("second", "shaft", "wheel", stiffness=700.0, gap=0.006, ratio_b=5.0),
            Spring("aligning", "wheel", stiffness=90.0),
            Damper("d1", "shaft", viscous=0.7),
            Damper("d2", "wheel", viscous=11.0),
            Friction("f1", "shaft", kinetic=0.3, static=0.4),
            Friction("f2", "wheel", kinetic=2.0, static=2.5),
        ),
    )
    found = reduce(m, at="wheel", tests=()).parameters
    assert found["steering.ratio"] == pytest.approx(15.0)
    assert found["steering.inertia_kg_m2"] == pytest.approx(0.2 * 25.0 + 4.0)
    assert found["steering.stiffness_nm_per_rad"] == pytest.approx(1.0 / (1.0 / 30.0 + 9.0 / 700.0))
    assert found["steering.aligning_nm_per_rad"] == pytest.approx(90.0)
    assert found["viscous.coefficient_nm_s_per_rad"] == pytest.approx(0.7 * 25.0 + 11.0)
    # Both gaps at the handwheel: its own, and the second through 3:1.
    assert found["freeplay.gap_rad"] == pytest.approx(0.02 + 3.0 * 0.006)
    assert found["coulomb.level_nm"] == pytest.approx(0.3 * 5.0 + 2.0)
    assert found["stiction.extra_nm"] == pytest.approx(0.1 * 5.0 + 0.5)


def test_the_papers_mechanism_has_its_one_mass():
    found = reduce(steering_mechanism(), at="left_wheel")
    p = found.parameters
    # (J_pinion 16^2 + m_rack 0.16^2 + 2 * 1.5), friction (0.2 * 16 + 100 * 0.16 + 8.1), and so on.
    assert p["steering.inertia_kg_m2"] == pytest.approx(0.001 * 256.0 + 10.0 * 0.0256 + 3.0)
    assert p["coulomb.level_nm"] == pytest.approx(0.2 * 16.0 + 100.0 * 0.16 + 8.1)
    assert p["steering.stiffness_nm_per_rad"] == pytest.approx(
        1.0 / (1.0 / 115.0 + 1.0 / 2000.0 + 100.0**2 / (2.0 * 6.7e5)), rel=1e-9
    )
    assert p["freeplay.gap_rad"] == pytest.approx(0.1)
    assert [e.manoeuvre for e in found.errors] == ["step", "sine 0.25 rad", "sine 1 rad", "sine 2 rad", "weave"]
    # Measured: 0.3 to 2.7 % of the range; a substitute that were not one would be off by tens.
    assert max(e.relative for e in found.errors) < 0.04
    assert json.dumps(found.to_dict()) and "one mass at left_wheel" in str(found)
    assert len(found.figure().data) == 10


def test_the_stated_error_is_that_of_the_one_mass_model_of_luztar():
    """The numbers go into luztar.dynamics, which has a step of its own, and the difference is the stated one."""
    m = steering_mechanism()
    found = reduce(m, at="left_wheel")
    error = found.errors[2]
    t = np.arange(3001) / 500.0
    psi = np.sin(np.pi * t)
    one = luztar.dynamics.simulate(found.parameters, psi, sample_rate_hz=500.0, substeps=10).roadwheel_rad
    whole = simulate(m, {"handwheel": psi}, sample_rate_hz=500.0, substeps=40).position["left_wheel"]
    assert np.sqrt(np.mean((one - whole) ** 2)) == pytest.approx(error.rms_rad, rel=0.02)
    assert np.ptp(whole) == pytest.approx(error.range_rad, rel=1e-3)


def test_a_mechanism_that_is_one_mass_has_no_error():
    m = steering_torque_driven()
    found = reduce(m, at="roadwheel")
    assert found.parameters["coulomb.level_nm"] == 8.1 and found.parameters["freeplay.gap_rad"] == pytest.approx(0.1)
    # Two engines at the same step, to second order.
    assert max(e.max_rad for e in found.errors) < 1e-12


def test_what_one_mass_has_no_place_for_is_named():
    m = steering_mechanism(assistance=power_assistance(), rear_axle=RearAxle())
    found = reduce(m, at="rear_wheels", tests=(Manoeuvre("hold", np.zeros(3)),))
    assert found.left_out == ("assistance",)
    assert found.parameters["steering.ratio"] == pytest.approx(16.0 / 0.15)
    assert found.errors[0].relative == 0.0


@pytest.mark.parametrize(
    ("m", "at", "words"),
    [
        (steering_mechanism(), "front", "no body 'front'"),
        (steering_torque_driven(stiffness_nm_per_rad=0.0), "roadwheel", "move in 2 ways"),
        (
            Mechanism(
                (Body("a", 1.0),),
                (
                    Spring("k", "handwheel", "a", stiffness=1.0),
                    Spring("l", "handwheel", "a", stiffness=1.0, ratio_b=2.0),
                ),
                (Driven("handwheel"),),
            ),
            "a",
            "cannot move",
        ),
    ],
)
def test_what_cannot_be_one_mass_is_refused(m, at, words):
    with pytest.raises(ParameterError, match=words):
        reduce(m, at=at)
