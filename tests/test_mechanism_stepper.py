"""A mechanism in a loop: the same motion as a run, states that travel, lanes with the same bits."""

import copy
import hashlib
import json
import os
import pickle
import subprocess
import sys

import numpy as np
import pytest

from luztar.errors import ParameterError
from luztar.mechanism import (
    Stepper,
    simulate,
    simulate_lanes,
    steering_mechanism,
    steering_torque_driven,
    summarise_lanes,
)
from mechanism_parts import chain, push

H = 1e-3
T = np.arange(1501) * H


def hand(t: np.ndarray) -> np.ndarray:
    return 1.2 * np.sin(4.0 * t) * np.sin(1.1 * t)


def test_a_stepper_goes_the_way_of_a_run_to_third_order_between_the_samples():
    """A run knows the sample ahead, a stepper does not: they differ by what that changes."""
    off = []
    for n in (1, 2, 4):
        h = H / n
        t = np.arange(1500 * n + 1) * h
        run = simulate(chain(), {"push": push(t)}, sample_rate_hz=1.0 / h, substeps=1, start={"one": 0.3})
        stepper = Stepper(chain(), h, channels=push(t[:1]), start={"one": 0.3}, substeps=1)
        for value in push(t[1:]):
            stepper.step([value])
        off.append(max(abs(stepper.position[i] - run.position[b][-1]) for i, b in enumerate(("one", "two"))))
        assert stepper.time_s == pytest.approx(t[-1])
    assert off[0] < 1e-7 and off[2] < off[0] / 4.0**2


def drive(stepper: Stepper, first: int, last: int) -> None:
    for i in range(first, last):
        stepper.step(np.array([hand(T[i]), 0.0, 0.0]))


def test_copies_pickles_and_json_go_on_with_the_same_bits():
    m = steering_mechanism()
    stepper = Stepper(m, H)
    drive(stepper, 1, 700)
    assert len(stepper.sliding) == 4
    twins = [
        stepper.copy(),
        copy.deepcopy(stepper),
        pickle.loads(pickle.dumps(stepper)),
        Stepper.from_state(json.loads(json.dumps(stepper.to_state()))),
    ]
    drive(stepper, 700, 1500)
    for twin in twins:
        drive(twin, 700, 1500)
        assert twin.state() == stepper.state()
        assert (twin.position == stepper.position).all() and (twin.speed == stepper.speed).all()
        assert twin.torque("left_king_pin") == stepper.torque("left_king_pin") != 0.0


def test_torques_of_a_stepper_are_those_of_a_run_and_survive_a_restore():
    m = steering_mechanism(king_pin_static_nm=6.0)
    t = np.arange(301) * H
    tyres = 2.0 * np.sin(3.0 * t)
    drives = {"handwheel": hand(t), "tyre_left": tyres}
    run = simulate(m, drives, sample_rate_hz=1.0 / H)
    stepper = Stepper(m, H, channels=[hand(t[:1])[0], 0.0, 0.0])
    held = 0
    for i in range(1, t.size):
        stepper.step([hand(t[i : i + 1])[0], tyres[i], 0.0])
        twin = pickle.loads(pickle.dumps(stepper))
        for element in ("column", "left_damper", "left_king_pin", "rack_friction"):
            assert twin.torque(element) == stepper.torque(element)
            # The two know the drive between the samples differently, to third order.
            assert stepper.torque(element) == pytest.approx(run.torque[element][i], abs=0.02)
        held += run.sliding["left_king_pin"][i] == 0
    assert held > 10
    with pytest.raises(ParameterError, match="no element 'tow'"):
        stepper.torque("tow")


def test_restore_goes_back_and_refuses_what_is_no_state():
    stepper = Stepper(steering_mechanism(), H)
    drive(stepper, 1, 300)
    stored, place = stepper.state(), stepper.position.copy()
    drive(stepper, 300, 400)
    for wrong in ((stored[0][:-1], stored[1]), (stored[0], stored[1][:-1]), (stored[0], [np.nan] * len(stored[1]))):
        before = stepper.state()
        with pytest.raises(ParameterError, match="state"):
            stepper.restore(*wrong)
        assert stepper.state() == before
    stepper.restore(*stored)
    assert (stepper.position == place).all()
    with pytest.raises(ParameterError, match="not one of to_state"):
        Stepper.from_state({"schema": 1, "kind": "Stepper"})
    with pytest.raises(ParameterError, match="of a Filter"):
        Stepper.from_state({"schema": 1, "kind": "Filter"})


def test_a_refused_value_leaves_the_stepper_as_it_was():
    stepper = Stepper(steering_mechanism(), H)
    drive(stepper, 1, 50)
    before = stepper.state()
    with pytest.raises(ParameterError, match="tyre_left: the drive holds NaN"):
        stepper.step(np.array([0.1, np.nan, 0.0]))
    with pytest.raises(ParameterError, match="channels has 2 values"):
        stepper.step(np.array([0.1, 0.0]))
    assert stepper.state() == before
    with pytest.raises(ParameterError, match="a step of 2.000e-3 s is too long"):
        Stepper(steering_mechanism(), 2e-3, substeps=1)
    with pytest.raises(ParameterError, match="Give one for each of: handwheel, tyre_left, tyre_right"):
        Stepper(steering_mechanism(), H, channels=[0.0])


LANES = """
import hashlib, numpy as np
from luztar.mechanism import simulate_lanes, steering_torque_driven
n = 37
levels = {"king_pin.kinetic_nm": np.linspace(0.0, 12.0, n), "king_pin.static_nm": np.linspace(1.0, 16.0, n),
          "column.gap_rad": np.linspace(0.0, 0.2, n)}
t = np.arange(801) / 400.0
made = simulate_lanes(steering_torque_driven(), levels, {"hand": 3.0 * np.sin(5.0 * t)}, sample_rate_hz=400.0)
print(hashlib.sha256(made.position["roadwheel"].tobytes() + made.speed["handwheel"].tobytes()).hexdigest())
"""


def test_lanes_have_the_bits_of_single_runs_whatever_the_number_of_threads():
    found = set()
    for threads in ("1", "2", "4"):
        own = {**os.environ, "RAYON_NUM_THREADS": threads}
        done = subprocess.run([sys.executable, "-c", LANES], capture_output=True, text=True, env=own, check=True)
        found.add(done.stdout.strip())
    assert len(found) == 1
    t = np.arange(801) / 400.0
    m = steering_torque_driven()
    places, speeds = [], []
    for i in range(37):
        own = {
            "king_pin.kinetic_nm": np.linspace(0.0, 12.0, 37)[i],
            "king_pin.static_nm": np.linspace(1.0, 16.0, 37)[i],
            "column.gap_rad": np.linspace(0.0, 0.2, 37)[i],
        }
        run = simulate(m.with_parameters(own), {"hand": 3.0 * np.sin(5.0 * t)}, sample_rate_hz=400.0)
        places.append(run.position["roadwheel"])
        speeds.append(run.speed["handwheel"])
    digest = hashlib.sha256(np.array(places).tobytes() + np.array(speeds).tobytes()).hexdigest()
    assert found == {digest}


@pytest.mark.parametrize(
    ("parameters", "words"),
    [
        ({}, "there are no lanes"),
        ({"king_pin.kinetic": [1.0]}, "no parameter 'king_pin.kinetic'"),
        ({"king_pin.kinetic_nm": [1.0, 2.0], "column.gap_rad": [0.1]}, "column.gap_rad has 1 values, others 2"),
        ({"king_pin.kinetic_nm": [1.0, np.nan]}, "index 1"),
        ({"column.gap_rad": [0.1, 0.2, -0.1]}, "lane 2, column: its gap is -0.1"),
        ({"king_pin.kinetic_nm": [1.0, 9.0], "king_pin.static_nm": [2.0, 8.0]}, "lane 1, king_pin: static friction"),
        ({"column.stiffness_nm_per_rad": [60.0, 1e7]}, "lane 1, column: a step of"),
    ],
)
def test_a_lane_that_makes_no_sense_is_named(parameters, words):
    with pytest.raises(ParameterError, match=words):
        simulate_lanes(steering_torque_driven(), parameters, {"hand": np.zeros(9)}, sample_rate_hz=400.0)


def test_the_parameters_that_follow_others_do_so_in_lanes():
    """A limit is half a gap to the core, static friction what it adds to kinetic friction."""
    from luztar.mechanism import Body, EndStop, Friction, Mechanism

    m = Mechanism(
        (Body("mass", 1.0, "m"),),
        (
            EndStop("stop", "mass", stiffness=100.0, limit=0.5, unit="m"),
            Friction("f", "mass", kinetic=0.2, unit="m", stribeck=0.1, stribeck_speed=0.3),
        ),
    )
    changes = {"stop.limit_m": [0.3, 0.5], "f.kinetic_n": [0.1, 0.4], "f.stribeck_n": [0.3, 0.1]}
    made = simulate_lanes(m, changes, sample_rate_hz=500.0, seconds=3.0, start_speed={"mass": 1.0})
    for lane in range(2):
        own = {k: v[lane] for k, v in changes.items()}
        run = simulate(
            m.with_parameters(own),
            sample_rate_hz=500.0,
            seconds=3.0,
            start_speed={"mass": 1.0},
        )
        assert (made.position["mass"][lane] == run.position["mass"]).all()
    assert "2 runs of 3 s" in str(made) and len(made) == 2


def test_progress_is_told_and_counts_all_lanes():
    seen = []
    # A chunk holds 600 000 steps: 250 lanes of 2400.
    drives, levels = {"push": np.zeros(2400)}, {"k1.stiffness_nm_per_rad": np.linspace(20.0, 40.0, 300)}
    options = {"sample_rate_hz": 500.0, "substeps": 1, "progress": lambda done, of: seen.append((done, of))}
    simulate_lanes(chain(), levels, drives, **options)
    assert seen == [(250, 300), (300, 300)]
    levels["k1.stiffness_nm_per_rad"][270] = 1e9
    with pytest.raises(ParameterError, match="lane 270, k1"):
        simulate_lanes(chain(), levels, drives, **options)


def test_a_summary_is_that_of_the_samples():
    t = np.arange(801) / 400.0
    levels = {"king_pin.kinetic_nm": np.array([0.0, 5.0, 500.0]), "king_pin.static_nm": np.array([0.0, 8.0, 500.0])}
    m, drives = steering_torque_driven(king_pin_static_nm=8.1), {"hand": 3.0 * np.sin(5.0 * t)}
    whole = simulate_lanes(m, levels, drives, sample_rate_hz=400.0)
    kept = summarise_lanes(m, levels, drives, sample_rate_hz=400.0)
    for body in ("handwheel", "roadwheel"):
        q, v = whole.position[body], whole.speed[body]
        found = {
            "last": q[:, -1],
            "last_speed": v[:, -1],
            "peak": np.abs(q).max(axis=1),
            "rms": np.sqrt(np.mean(q**2, axis=1)),
            "at_rest_share": np.mean(v == 0.0, axis=1),
        }
        for name, values in found.items():
            np.testing.assert_allclose(kept[body][name], values, rtol=1e-14, atol=0.0)
    assert kept["roadwheel"]["at_rest_share"][2] == 1.0
