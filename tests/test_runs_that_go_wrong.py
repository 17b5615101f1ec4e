"""What a run must never do: end in numbers that are none, lose what was done, or refuse to travel."""

import _thread
import copy
import pickle
import threading

import numpy as np
import pytest

import luztar
from luztar.dynamics import simulate, summarise, trace
from luztar.errors import Interrupted, ModelError, ParameterError
from luztar.manoeuvre import Weights, manoeuvre, optimise
from luztar.mechanism import Body, Damper, Load, Mechanism, Spring, Stepper, simulate_lanes, steering_mechanism
from luztar.mechanism import simulate as simulate_mechanism
from luztar.vehicle import Car, step_steer

PSI = np.sin(np.pi * np.arange(251) / 125)
PLAIN = {"steering.inertia_kg_m2": 1.0, "steering.ratio": 1.0, "steering.stiffness_nm_per_rad": 1.0}
# Explicit in the step: at 5 rad/s this drag asks for one of 20 us.
DRAG = {**PLAIN, "drag.coefficient_nm_s2_per_rad2": 1e4}


@pytest.mark.parametrize("method", ["split", "moreau_jean"])
@pytest.mark.parametrize("run", [simulate, summarise, trace])
def test_a_motion_beyond_all_bounds_is_refused_with_its_lane(run, method):
    with pytest.raises(ParameterError, match="lane 0 grows beyond all bounds"):
        run(DRAG, 0.0 * PSI, sample_rate_hz=250, start_speed_rad_s=5.0, method=method)


def test_a_stepper_says_when_the_motion_is_lost():
    parts = (Spring("s", "a", stiffness=1.0), Damper("d", "a", drag=1e4))
    stepper = Stepper(Mechanism((Body("a", 1.0),), parts, loads=(Load("l", "a"),)), 4e-3, start_speed={"a": 5.0})
    with pytest.raises(ParameterError, match="beyond all bounds"):
        for _ in range(10):
            stepper.step(np.zeros(1))


def test_results_with_read_only_mappings_travel():
    traced = trace(PLAIN, PSI, sample_rate_hz=250)
    run = simulate_mechanism(steering_mechanism(), {"handwheel": PSI}, sample_rate_hz=250)
    for made in (traced, run):
        for twin in (pickle.loads(pickle.dumps(made)), copy.deepcopy(made)):
            assert dict(twin.energy_j) == dict(made.energy_j)
            with pytest.raises(TypeError):
                twin.energy_j["residual"] = 0.0


def test_an_interrupted_batch_of_mechanisms_keeps_what_is_done():
    stiffness = np.linspace(50.0, 80.0, 4000)
    drive = {"handwheel": np.tile(PSI, 4)}
    m = steering_mechanism()

    def run(values, progress=None):
        return simulate_lanes(m, {"column.stiffness_nm_per_rad": values}, drive, sample_rate_hz=250, progress=progress)

    begun = threading.Event()

    def told(done, of):
        if not begun.is_set():
            begun.set()
            _thread.interrupt_main()

    with pytest.raises(Interrupted) as stopped:
        run(stiffness, told)
    done = stopped.value.done
    assert 0 < done.size < stiffness.size
    whole = run(stiffness[done])
    for name, position in stopped.value.partial.position.items():
        assert position.tobytes() == whole.position[name].tobytes()


def test_the_end_of_an_element_is_one_name():
    with pytest.raises(ParameterError, match="its a is"):
        Spring("s", ["a"], stiffness=1.0)


def test_a_car_that_comes_to_no_steady_turn_has_no_step_figures():
    car = Car.named("bmw_320i").with_({"rear.cornering_n_per_rad": 6e4})
    with pytest.raises(ParameterError, match="does not become steady"):
        step_steer(car, speed_m_s=50.0, handwheel_rad=0.5, tyre="linear")


@pytest.mark.parametrize("key", ["body.mas", "foo"])
def test_a_known_value_of_nothing_is_refused(key):
    with pytest.raises(ModelError, match=key):
        luztar.Model.car({key: 1.0})


def test_a_limit_that_binds_does_not_hide_the_drives_within_it():
    # Precision alone: the best signal uses all the lateral acceleration there is.
    task = manoeuvre("avoiding", length_m=55.0, speed_m_s=15.0, weights=Weights(0.0, 1.0, 0.0))
    found = optimise(task, effort="quick")
    assert found.feasible
    assert 3.95 < found.best.scores["lateral_acceleration_max_m_s2"] <= 4.0
