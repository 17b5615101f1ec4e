"""A mechanism is described once, checked as a whole, and travels through files."""

import copy
import json
import math
import pickle
from dataclasses import replace

import numpy as np
import pytest

import luztar
from luztar.errors import ModelError, ParameterError
from luztar.mechanism import (
    Assistance,
    Body,
    Damper,
    Driven,
    EndStop,
    Friction,
    Load,
    Mechanism,
    RearAxle,
    Sensor,
    Spring,
    power_assistance,
    simulate,
    single_mass,
    steering_mechanism,
    steering_one_mass,
    steering_torque_driven,
)

BODIES = (Body("one", 1.0), Body("two", 2.0))
SPRING = Spring("k", "one", "two", stiffness=10.0)
ALL = {
    "single_mass": single_mass(stiffness=1.0, gap=0.1, viscous=0.1, kinetic=0.2, static=0.3, on_belt=True),
    "one_mass": steering_one_mass({"steering.inertia_kg_m2": 3.0, "steering.ratio": 16.0}),
    "torque_driven": steering_torque_driven(),
    "fig3": steering_mechanism(handwheel="torque", assistance=power_assistance(), rear_axle=RearAxle()),
    "stop": Mechanism(
        BODIES,
        (SPRING, EndStop("stop", "two", stiffness=1e3, limit=0.7)),
        sensors=(Sensor("wound", "k", "stretch", 2.0), Sensor("turn", "two", "speed")),
        title='with "quotes" and\nlines',
    ),
}


@pytest.mark.parametrize("name", ALL)
def test_a_mechanism_comes_back_from_its_file_from_pickle_and_from_json(name, tmp_path):
    m = ALL[name]
    path = tmp_path / "m.toml"
    m.save(path)
    assert Mechanism.load(path) == m
    assert pickle.loads(pickle.dumps(m)) == m == copy.deepcopy(m)
    assert json.loads(json.dumps(m.to_dict()))["structure"] == "mechanism"
    assert m.with_parameters(m.parameters()).parameters() == m.parameters()
    assert str(m).splitlines()[0].startswith((m.title or "mechanism").splitlines()[0])


@pytest.mark.parametrize(
    ("parts", "words"),
    [
        ({"bodies": ()}, "no body"),
        ({"bodies": (Body("one", -1.0), BODIES[1])}, "one: its inertia is -1"),
        ({"bodies": (Body("one", math.nan), BODIES[1])}, "one: its inertia is NaN"),
        ({"bodies": (*BODIES, BODIES[0])}, "one: its name is taken"),
        ({"bodies": (*BODIES, Body("three", 1.0))}, "three: nothing connects it with one"),
        ({"elements": ()}, "two: nothing connects it with one"),
        ({"elements": (replace(SPRING, b="ground"), Spring("s", "two", stiffness=1.0))}, "two: nothing connects"),
        ({"elements": (replace(SPRING, b="tow"),)}, "k: there is no body or driven node 'tow'"),
        ({"elements": (replace(SPRING, b="one"),)}, "k: both its ends"),
        ({"elements": (replace(SPRING, stiffness=-1.0),)}, "k: its stiffness is -1"),
        ({"elements": (replace(SPRING, gap=-0.1),)}, "k: its gap is -0.1"),
        ({"elements": (replace(SPRING, ratio_b=0.0),)}, "k: its ratio_b is 0"),
        ({"elements": (SPRING, Damper("d", "one", viscous=-1.0))}, "d: its viscous is -1"),
        ({"elements": (SPRING, Friction("f", "one", kinetic=-1.0))}, "f: its level is -1"),
        ({"elements": (SPRING, Friction("f", "one", kinetic=4.0, static=3.0))}, "static friction 3 is below kinetic"),
        ({"elements": (SPRING, Friction("f", "one", kinetic=1.0, difference=2.0))}, "f: its difference 2"),
        ({"elements": (SPRING, Friction("f", "one", kinetic=1.0, stribeck=1.0))}, "f: its stribeck_speed"),
        ({"elements": (SPRING, Assistance("a", "q", "one", (0.1,), (1.0,)))}, "a: there is no element 'q'"),
        ({"elements": (SPRING, Assistance("a", "k", "ground", (0.1,), (1.0,)))}, "a: it acts on a node that is no"),
        ({"loads": (Load("push", "three"),)}, "push: there is no body or driven node 'three'"),
        ({"loads": (Load("k", "one"),)}, "its name is taken"),
        ({"driven": (Driven("hand"),)}, "hand: nothing connects it"),
        ({"sensors": (Sensor("s", "one", "torque"),)}, "s: there is no 'one' of which it could measure the torque"),
    ],
)
def test_a_mechanism_that_makes_no_sense_is_refused_by_name(parts, words):
    with pytest.raises(ParameterError, match=words):
        Mechanism(**{"bodies": BODIES, "elements": (SPRING,), **parts})


@pytest.mark.parametrize(
    ("make", "words"),
    [
        (lambda: Body("one", "heavy"), "one.inertia_kg_m2"),
        (lambda: Body("one", 1.0, "deg"), "one: its unit is 'deg'"),
        (lambda: Assistance("a", "k", "one", (0.2, 0.1), (1.0, 2.0)), "rising twists"),
        (lambda: Assistance("a", "k", "one", (), ()), "rising twists"),
        (lambda: Sensor("s", "one", "colour"), "colour"),
        (lambda: steering_mechanism(handwheel="foot"), "angle or torque"),
        (lambda: ALL["stop"].with_parameters({"k.stiffness_n_per_m": 1.0}), "no parameter 'k.stiffness_n_per_m'"),
        (lambda: ALL["stop"].given("three"), "no body 'three'"),
        (lambda: ALL["stop"]["three"], "no 'three'"),
        (lambda: steering_one_mass({"steering.ratio": 2.0}), "inertia_kg_m2 is missing"),
        (
            lambda: steering_one_mass(
                {"steering.inertia_kg_m2": 1.0, "steering.ratio": 2.0, "asymmetric_viscous.difference": 1.0}
            ),
            "no place in a mechanism",
        ),
    ],
)
def test_a_part_that_makes_no_sense_is_refused_by_name(make, words):
    with pytest.raises(ParameterError, match=words):
        make()


HEAD = 'schema = 1\nstructure = "mechanism"\n[bodies.one]\ninertia_kg_m2 = 1.0\n'


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("structure = ", "is not TOML"),
        (HEAD.replace("schema = 1", "schema = 2"), "schema is 2"),
        (HEAD.replace('"mechanism"', '"rig"'), "structure is 'rig'"),
        (HEAD + "[wheels.a]\nx = 1\n", "no key 'wheels'"),
        (HEAD + "[bodies.two]\nmass_kg = 1.0\n", "bodies.two: there is no key 'mass_kg'. With unit rad"),
        (HEAD + "[bodies.two]\n", "a key is missing"),
        (HEAD + '[elements.k]\nkind = "rope"\na = "one"\n', "elements.k: its kind is 'rope'"),
        (HEAD + '[elements.k]\nkind = "spring"\na = "one"\nstiffness_nm_per_rad = "soft"\n', "soft"),
        (HEAD + '[elements.k]\nkind = "spring"\na = "two"\n', "m.toml, k: there is no body or driven node 'two'"),
        (HEAD + "loads = 3\n", "no key 'loads'|no table of tables"),
    ],
)
def test_a_file_that_makes_no_sense_is_refused_with_its_place(text, words, tmp_path):
    path = tmp_path / "m.toml"
    path.write_text(text, encoding="utf-8")
    with pytest.raises(ModelError, match=words):
        Mechanism.load(path)


def test_a_model_to_fit_is_told_from_a_mechanism(tmp_path):
    path = tmp_path / "m.toml"
    ALL["fig3"].save(path)
    with pytest.raises(ModelError, match="luztar.mechanism.Mechanism.load"):
        luztar.Model.load(path)


def test_a_file_that_is_not_there_is_named(tmp_path):
    with pytest.raises(ModelError, match="nowhere.toml"):
        Mechanism.load(tmp_path / "nowhere.toml")
    with pytest.raises(ModelError, match="cannot be written"):
        ALL["stop"].save(tmp_path / "no" / "m.toml")


@pytest.mark.parametrize(
    ("options", "words"),
    [
        ({"drives": {"push": np.full(9, 1.0)}, "substeps": 1}, "a step of 1.000e-2 s is too long for this spring"),
        ({"drives": {"push": [0.0, 1.0, math.nan, 2.0]}}, "push holds 1 values that are not finite, at index 2"),
        ({"drives": {"pull": [0.0, 1.0]}}, "nothing is driven by 'pull'"),
        ({"drives": {"push": [0.0]}}, "push holds 1 values"),
        ({"drives": {}}, "there is no drive"),
        ({"drives": {}, "seconds": -1.0}, "seconds is -1"),
        ({"drives": {"push": [0.0, 1.0]}, "start": {"three": 1.0}}, "no body 'three'"),
        ({"drives": {"push": [0.0, 1.0]}, "start_speed": {"one": math.inf}}, "one: its start_speed is inf"),
        ({"drives": {"push": [0.0, 1.0]}, "solver": "magic"}, "no solver 'magic'"),
        ({"drives": {"push": [0.0, 1.0]}, "substeps": 0}, "substeps is 0"),
        ({"drives": {"push": [0.0, 1.0]}, "sample_rate_hz": 0.0}, "sample_rate_hz is 0"),
    ],
)
def test_a_run_that_makes_no_sense_is_refused_by_name(options, words):
    stiff = Spring("k", "one", "two", stiffness=1e5)
    m = Mechanism(BODIES, (stiff, Spring("soft", "two", stiffness=1.0)), loads=(Load("push", "one"),))
    assert m.stiffest == "k"
    with pytest.raises(ParameterError, match=words):
        simulate(m, **{"sample_rate_hz": 100.0, **options})


def test_the_missing_motion_and_unequal_lengths_are_named():
    m = steering_mechanism()
    with pytest.raises(ParameterError, match="the motion of 'handwheel' is missing"):
        simulate(m, {"tyre_left": np.zeros(9)}, sample_rate_hz=100.0)
    with pytest.raises(ParameterError, match="tyre_left has 8 samples, others 9"):
        simulate(m, {"handwheel": np.zeros(9), "tyre_left": np.zeros(8)}, sample_rate_hz=100.0)


@pytest.mark.parametrize(("inertia", "stiffness"), [(1e-300, 1e300), (5e-324, 1.0), (1e300, 1e-300), (1.0, 1e308)])
def test_numbers_at_the_end_of_the_doubles_end_in_a_run_or_an_error(inertia, stiffness):
    m = Mechanism((Body("one", inertia), Body("two", 1.0)), (Spring("k", "one", "two", stiffness=stiffness),))
    try:
        run = simulate(m, sample_rate_hz=10.0, seconds=1.0, substeps=1, start={"two": 0.1})
    except ParameterError as error:
        assert error.where == "k" and "too long for this spring" in error.kind
    else:
        assert all(np.isfinite(q).all() for q in run.position.values())


def test_a_motion_without_bounds_ends_with_its_instant():
    m = Mechanism((Body("one", 1.0),), (Spring("k", "one", stiffness=1.0, hardening=1e6),))
    with pytest.raises(ParameterError, match=r"t = [0-9.]+ s: the motion grows beyond all bounds"):
        simulate(m, sample_rate_hz=100.0, seconds=10.0, substeps=1, start={"one": 5.0})


def test_sensors_and_results_read_what_they_say():
    m = ALL["stop"]
    run = simulate(m, sample_rate_hz=200.0, seconds=4.0, start={"one": 1.5})
    np.testing.assert_array_equal(run.sensor("wound"), 2.0 * (run.position["one"] - run.position["two"]))
    assert run.sensor("turn") is not run.position["two"] and (run.sensor("turn") == run.speed["two"]).all()
    with pytest.raises(ParameterError, match="no sensor 'tow'"):
        run.sensor("tow")
    assert run.indeterminate is None and run.balanced
    made = run.to_dict()
    assert made["energy_j"]["turnover"] > 0.0 and json.dumps(made)
    assert {"contact", "release"} <= {e.kind for e in run.events if e.element == "stop"}


def test_pictures_hold_every_body_and_element():
    m = ALL["fig3"]
    shown = json.dumps(m.figure().to_plotly_json(), default=str)
    assert all(p.name in shown for p in (*m.bodies, *m.elements))
    run = simulate(m, {"hand": np.sin(np.arange(50) / 20.0)}, sample_rate_hz=100.0)
    assert len(run.figure().data) == len(m.bodies) + len(run.sliding)
