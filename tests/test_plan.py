"""A planned test: what it can see and what it cannot tell apart, held against the independent generator."""

import json
import math

import numpy as np
import pytest

import luztar
from advised_trials import USUAL, measured
from luztar.errors import ParameterError
from luztar.planning.rehearse import Sensor, rehearse
from luztar.planning.signatures import signatures
from luztar.planning.sizes import CONFUSABLE
from luztar.planning.trials import as_planned

DEG = math.pi / 180.0
SENSOR = Sensor(0.02 * DEG, 144.0, 0.02)


def table(amplitude_deg, effects):
    """Signatures beside Coulomb and viscous friction; strokes of 1.2 to 6 seconds whatever their length."""
    model = luztar.Model("rig", ("coulomb", "viscous"))
    speeds = (2.0 * amplitude_deg * DEG / 6.0, 2.0 * amplitude_deg * DEG / 1.2)
    make = as_planned(amplitude_deg * DEG, speeds, 6)
    runs = rehearse([make(1.0 / SENSOR.rate_hz, seed) for seed in (1, 2, 3)], SENSOR, model)
    return signatures(runs, model, SENSOR, {"coulomb": 1.0, "viscous": 0.15}, effects)


# Cosines of the reference (strokes of another hand, no overshoot): narrow windows must agree closely, for all hands
# see nearly the same straight piece of a sine; wide ones only in being told apart.
NARROW = [
    ("stiffness", "once_per_rev", 45.0, 0.9996, 0.001),
    ("stiffness", "once_per_rev", 60.0, 0.9988, 0.003),
    ("once_per_rev", "twice_per_rev", 45.0, 0.996, 0.01),
    ("once_per_rev", "asymmetric_viscous", 45.0, 0.885, 0.05),
    ("offset", "asymmetric_viscous", 45.0, 0.861, 0.05),
]


@pytest.mark.parametrize(("a", "b", "amplitude_deg", "expected", "tolerance"), NARROW)
def test_cosines_in_a_narrow_window_are_those_of_the_reference(a, b, amplitude_deg, expected, tolerance):
    made = table(amplitude_deg, (a, b))
    assert made.alike(made.typical[a], made.typical[b]) == pytest.approx(expected, abs=tolerance)


@pytest.mark.parametrize(
    ("a", "b", "most"),
    [
        ("stiffness", "once_per_rev", (0.8, 0.45)),
        ("once_per_rev", "twice_per_rev", (0.45, 0.3)),
        ("once_per_rev", "asymmetric_viscous", (0.1, 0.1)),
    ],
)
def test_a_turn_beyond_180_degrees_tells_per_turn_effects_apart(a, b, most):
    for amplitude_deg, limit in zip((180.0, 540.0), most, strict=True):
        made = table(amplitude_deg, (a, b))
        assert made.alike(made.typical[a], made.typical[b]) < limit


def test_a_wider_turn_does_not_tell_an_offset_from_direction_dependent_viscous_friction():
    for amplitude_deg in (45.0, 540.0):
        made = table(amplitude_deg, ("offset", "asymmetric_viscous"))
        assert made.alike(made.typical["offset"], made.typical["asymmetric_viscous"]) > 0.8


@pytest.fixture(scope="module")
def noise():
    """The noise floor as compare shows it, away from reversals."""
    return luztar.fit(luztar.Model.rig(), measured({}, USUAL, seed=3)).noise_floor.moving_rms


@pytest.fixture(scope="module")
def planned(noise):
    """The plan of the strokes that the generator turns."""
    return luztar.plan(encoder_deg=0.02, rate_hz=500.0, speed=(5.0, 38.0), angle_deg=50.0, noise=noise)


def hidden_at(plan, effect, times):
    """The generator's parameters of an effect at a multiple of its smallest size; the phase that shows least."""
    entry = plan.size(effect)
    values = {entry.parameter: times * entry.size, **entry.at}
    if effect in ("once_per_rev", "twice_per_rev", "cogging"):
        values["phase_rad"] = math.pi / 2.0
    if effect == "presliding":
        values["shape"] = "exponential"
    return {effect: values}


# Effects of every kind. What the look may call them: themselves, or a set they are in.
SEEN = [
    "asymmetric_viscous",
    "drag",
    "stribeck",
    "presliding",
    "hardening",
    "inertia",
    "once_per_rev",
    "delay",
    "drift",
]


@pytest.mark.parametrize("effect", SEEN)
def test_an_effect_of_twice_the_smallest_size_is_seen(planned, effect):
    runs = measured(hidden_at(planned, effect, 2.0), USUAL, seed=7)
    look = luztar.diagnose(luztar.fit(luztar.Model.rig(), runs))
    assert look.detection.p_value <= 0.05 and look.verdict not in ("nothing_missing", "below_practical_size"), look
    assert effect in look.judgement.equivalent, look
    if planned.size(effect).told_from is not None and planned.size(effect).told_from < planned.size(effect).size * 1.2:
        assert look.named == (effect,), look


@pytest.mark.parametrize("effect", SEEN)
def test_an_effect_of_a_fifth_of_the_smallest_size_is_not_named(planned, effect):
    runs = measured(hidden_at(planned, effect, 0.2), USUAL, seed=7)
    look = luztar.diagnose(luztar.fit(luztar.Model.rig(), runs))
    assert look.named == (), look


def test_the_smallest_size_falls_with_the_noise_and_with_the_length_of_the_test():
    quiet, loud = (luztar.plan(noise=noise).size("drift").size for noise in (0.01, 0.04))
    # The noise also weighs the uncertain starts, which a drift hardly notices.
    assert loud == pytest.approx(4.0 * quiet, rel=0.01)
    few, many = (luztar.plan(strokes=n).size("asymmetric_viscous").size for n in (3, 6))
    assert many < few


def test_the_plan_says_what_it_cannot_tell_apart_and_which_test_would(planned):
    pairs = {frozenset(p.effects): p for p in planned.pairs}
    pair = pairs[frozenset(("stiffness", "once_per_rev"))]
    assert pair.cosine > 0.99 and pair.trial == "wide" and pair.trial_cosine < 0.8
    assert "180" in pair.text and pair.text in str(planned)
    assert all(p.cosine > CONFUSABLE for p in planned.pairs)
    wide = luztar.plan(angle_deg=185.0, speed=(10.0, 60.0))
    assert frozenset(("stiffness", "once_per_rev")) not in {frozenset(p.effects) for p in wide.pairs}


def test_a_plan_is_json_text_and_picture(planned, tmp_path):
    made = planned.to_dict()
    assert json.loads(json.dumps(made, allow_nan=False)) == made
    assert {s["effect"] for s in made["sizes"]} == set(made["cosines"])
    text = str(planned)
    assert all(s.effect in text for s in planned.sizes)
    assert np.allclose(np.diag(planned.cosines), 1.0) and planned.cosines.max() <= 1.0
    picture = planned.figure()
    assert len(picture.data[0].z) == len(planned.effects)
    planned.report(tmp_path / "plan.html")
    page = (tmp_path / "plan.html").read_text(encoding="utf-8")
    assert "once_per_rev" in page and page.startswith("<!DOCTYPE html>")


def test_an_axis_has_a_plan_of_its_own():
    plan = luztar.plan("axis", travel_m=0.2, speed=(0.03, 0.1), noise=1.0)
    assert plan.model.structure_name == "axis" and "inertia" not in plan.effects
    assert plan.size("stribeck").unit == "N" and plan.size("stribeck").size > 0.0
    assert "once_per_rev" not in plan.effects  # its pitch is not known
    assert not any(word in p.text.lower() for p in plan.pairs for word in ("wheel", "robot", "degree"))
    assert "over 0.2 m" in str(plan)


def test_minutes_take_the_place_of_strokes_and_a_ladder_that_of_a_range():
    assert luztar.plan(minutes=6.0).minutes == pytest.approx(6.0, rel=0.1)
    assert "3/12/40 deg/s" in luztar.plan(speeds=(3.0, 12.0, 40.0)).test


@pytest.mark.parametrize(
    "options",
    [
        {"angle_deg": -1.0},
        {"noise": 0.0},
        {"speed": (30.0, 5.0)},
        {"rate_hz": 10.0},
        {"runs": 0},
        {"strokes": 1000},
        {"encoder_deg": math.nan},
        {"minutes": -2.0},
        {"minutes": 1e9},
        {"friction": -1.0},
        {"angle_deg": 1e6},
        {"angle_deg": 0.01},
        {"speed": (0.0, 10.0)},
        {"speed": (5.0,)},
        {"speed": "fast"},
        {"speed": (0.01, 0.02)},
        {"speeds": (3.0, math.inf)},
        {"speeds": 3.0},
        {"noise": 1e200},
        {"noise": -0.1},
        {"noise_time_s": -1.0},
        {"noise_time_s": math.nan},
        {"rate_hz": "fast"},
        {"runs": 2.5},
        {"strokes": 1},
        {"encoder_deg": 30.0},
        {"step_m": 1e-6},
        {"travel_m": 0.2},
        {"seed": -1},
        {"model": "axis", "encoder_deg": 0.02},
        {"model": "axis", "angle_deg": 50.0},
        {"model": "axis", "travel_m": 1e-5, "step_m": 1e-6},
        {"model": "axis", "speed": (0.04, 0.0)},
    ],
)
def test_what_makes_no_test_is_refused_by_name_and_remedy(options):
    with pytest.raises(ParameterError) as caught:
        luztar.plan(**options)
    assert caught.value.where in options and caught.value.remedy
    assert "rad" not in str(caught.value)  # what was given in degrees is spoken of in degrees


def test_one_long_run_is_a_test_and_one_stroke_is_not():
    assert luztar.plan(runs=1, strokes=6, speeds=(20.0,)).strokes >= 6
    with pytest.raises(ParameterError, match="6 strokes over all runs"):
        luztar.plan(runs=5, strokes=1)


def test_friction_without_level_is_a_mechanism_too():
    plan = luztar.plan(friction=0.0)
    assert plan.size("stiffness").size == pytest.approx(luztar.plan().size("stiffness").size, rel=0.02)
