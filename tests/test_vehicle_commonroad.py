"""Side by side with commonroad-vehicle-models, where it is installed: the same car, the same road-wheel angle."""

import numpy as np
import pytest

from generators import commonroad
from luztar.vehicle import Car, Pieces, simulate

pytest.importorskip("vehiclemodels", reason="commonroad-vehicle-models is not installed")

SPEED = 20.0
# Their tyres act at once.
QUICK = {"front.relaxation_m": 0.0, "rear.relaxation_m": 0.0}


def both(amplitude: float, model: str, tyre: str):
    hand = Pieces(start_s=[0.5, 3.0], amplitude=[amplitude, 0.0], frequency_hz=0.4)
    run = simulate(
        Car.named("bmw_320i"),
        handwheel_rad=hand,
        speed_m_s=SPEED,
        duration_s=5.0,
        step_s=0.001,
        model=model,
        tyre=tyre,
        vary=QUICK,
    )
    return run, commonroad.drive(run, SPEED, multi_body=model == "twelve")


def apart(ours: np.ndarray, theirs: np.ndarray) -> float:
    return float(np.sqrt(np.mean((ours - theirs) ** 2)) / np.abs(theirs).max())


@pytest.mark.parametrize("amplitude", [0.2, 0.8])
def test_the_single_track_car_drives_as_theirs(amplitude):
    ours, theirs = both(amplitude, "single_track", "linear")
    # Theirs keeps the total speed, ours the forward one; g is 9.81 there. Measured 4e-5.
    assert apart(ours.yaw_rate_rad_s[::10], theirs["yaw_rate_rad_s"]) < 1e-4


@pytest.mark.parametrize("amplitude", [0.2, 0.8])
def test_the_car_of_twelve_degrees_drives_nearly_as_their_multi_body_car(amplitude):
    ours, theirs = both(amplitude, "twelve", "magic_formula")
    # Another make-up: lateral compliance between body and axles (which lets the roll ring on), camber, and nothing
    # keeps the speed. Measured 1.2 % in yaw rate; 4 % (large) and 7 % (small amplitude) in roll.
    assert apart(ours.yaw_rate_rad_s[::10], theirs["yaw_rate_rad_s"]) < 0.02
    assert apart(ours.roll_rad[::10], theirs["roll_rad"]) < 0.1
