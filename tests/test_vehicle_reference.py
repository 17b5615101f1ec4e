"""Cars against the same equations written down a second time, with matrices, and solved by a general solver."""

import numpy as np
import pytest

from generators import car as reference
from luztar.vehicle import Car, Pieces, simulate

# A smooth hand that is already turning at the start: nothing is left to the position of a kink on the grid.
AMPLITUDE, FREQUENCY, PHASE = 0.9, 0.45, 0.3
HAND = Pieces(start_s=[0.0], amplitude=AMPLITUDE, frequency_hz=FREQUENCY, phase_rad=PHASE)
SPEED, SECONDS, STEP = 22.0, 2.5, 0.0005
# The error of second order at this step, relative to the largest value of the channel; measured 1e-8 (place) to
# 2.3e-4 (lateral acceleration of the car of 12 degrees, whose wheels hop).
AGREE = 3e-4
RICH = {
    "front.load_ratio": 0.4,
    "rear.load_ratio": 0.3,
    "front.friction_load": 0.1,
    "rear.friction_load": 0.15,
    "front.roll_steer": -0.05,
    "rear.roll_steer": 0.04,
    "front.roll_centre_m": 0.05,
    "rear.roll_centre_m": 0.1,
    "rear.steer_ratio": -0.05,
    "assist.gain": 20.0,
    "assist.threshold_nm": 0.5,
    "steering.aligning_nm_per_rad": 300.0,
}


def hand(t: float) -> float:
    return AMPLITUDE * np.sin(2.0 * np.pi * FREQUENCY * t + PHASE)


@pytest.mark.parametrize("tyre", ["linear", "brush", "magic_formula"])
@pytest.mark.parametrize("model", ["single_track", "lateral_roll", "twelve"])
def test_a_car_moves_as_the_same_equations_in_matrix_form(model, tyre):
    car = Car.named("bmw_320i").with_(RICH)
    run = simulate(
        car,
        handwheel_rad=HAND,
        speed_m_s=SPEED,
        duration_s=SECONDS,
        step_s=STEP,
        every=40,
        model=model,
        tyre=tyre,
    )
    values = {key: p.value for key, p in car.parameters.items()}
    told = reference.drive(values, model, tyre, hand, SPEED, run.time_s)
    for name, expected in told.items():
        most = np.abs(expected - expected[0]).max()
        found = getattr(run, name)
        assert np.abs(found - expected).max() <= AGREE * max(most, 1e-9), name
    # What is compared moves: the car corners hard enough to bend the tyres.
    assert np.abs(told["lateral_acceleration_m_s2"]).max() > 4.0
    if model != "single_track":
        assert np.abs(told["roll_rad"]).max() > 0.02
