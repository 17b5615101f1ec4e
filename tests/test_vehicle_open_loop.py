"""Step, sine and on-centre weave against closed forms."""

import numpy as np
import pytest
from scipy.optimize import brentq

from generators import car as reference
from luztar.errors import ParameterError
from luztar.vehicle import Car, frequency_response, step_steer, weave
from luztar.vehicle.step_steer import step_figures
from luztar.vehicle.weave import slope, width


def values(car: Car) -> dict[str, float]:
    return {key: p.value for key, p in car.parameters.items()}


def test_the_figures_of_a_step_are_those_of_an_oscillator():
    w, zeta = 9.0, 0.35
    wd = w * np.sqrt(1.0 - zeta**2)

    def response(t):
        wave = np.cos(wd * t) + zeta * w / wd * np.sin(wd * t)
        return np.where(t > 0.0, 1.0 - np.exp(-zeta * w * t) * wave, 0.0)

    times = np.arange(-0.1, 12.0, 0.001)
    told = step_figures(times, np.stack((response(times), -3.0 * response(times))))
    assert np.allclose(told["steady"], [1.0, -3.0], rtol=1e-9)
    # Sampled at 1 ms; a line between samples for the response, a parabola for the peak.
    assert np.allclose(told["peak"], np.pi / wd, atol=1e-5)
    assert np.allclose(told["overshoot"], np.exp(-np.pi * zeta * w / wd), atol=1e-6)
    assert np.allclose(told["response"], brentq(lambda t: float(response(t)) - 0.9, 0.01, 0.3), atol=1e-5)


@pytest.mark.parametrize("model", ["single_track", "lateral_roll"])
def test_the_gains_of_a_step_are_those_of_the_steady_turn(model):
    car = Car.named("bmw_320i")
    p, speed = values(car), 25.0
    figures = step_steer(car, speed_m_s=speed, handwheel_rad=0.2, model=model, tyre="linear", duration_s=20.0)
    # Road wheels: p K (psi - p phi) = trail times the front axle's force; the car: two linear equations.
    matrix, given = reference.linear_matrices(p, speed)
    v, r = -np.linalg.solve(matrix, given)
    a, b = p["body.front_axle_m"], p["body.rear_axle_m"]
    force = p["body.mass_kg"] * b / (a + b) * speed * r
    trail = p["front.pneumatic_trail_m"] + p["front.caster_trail_m"]
    spring = 16.0 * 60.0
    phi = spring / (16.0 * spring + trail * force)
    assert figures.yaw_rate_gain_per_s == pytest.approx(r * phi, rel=1e-6)
    assert figures.lateral_acceleration_gain_m_s2_per_rad == pytest.approx(speed * r * phi, rel=1e-6)
    assert figures.sideslip_rad == pytest.approx(np.arctan(0.2 * v * phi / speed), rel=1e-5)
    assert 0.0 < figures.yaw_rate_response_time_s < figures.lateral_acceleration_response_time_s
    assert figures.tb_factor_s_rad == pytest.approx(figures.yaw_rate_peak_time_s * abs(figures.sideslip_rad))


def test_a_step_to_the_right_has_the_figures_of_one_to_the_left():
    car = Car.named("bmw_320i")
    left, right = (
        step_steer(car, speed_m_s=[20.0, 30.0], handwheel_rad=angle, vary={"freeplay.gap_rad": 0.05}).to_dict()
        for angle in (0.4, -0.4)
    )
    for name, value in left.items():
        way = -1.0 if name == "sideslip_rad" else 1.0
        assert np.allclose(way * np.array(right[name]), value, rtol=1e-12), name


def test_the_frequency_response_is_that_of_the_linearised_equations():
    car, speed = Car.named("bmw_320i"), 25.0
    plant = reference.Plant(values(car), "lateral_roll", "linear")
    rest, small = plant.start(), 1e-6
    size = 10
    matrix = np.array([(plant.rates(rest + small * e, 0.0, speed)[0] / small)[:size] for e in np.eye(13)[:size]]).T
    given = plant.rates(rest, small, speed)[0][:size] / small
    side = np.array([plant.rates(rest + small * e, 0.0, speed)[1] / small for e in np.eye(13)[:size]])
    frequencies = np.array([0.2, 0.5, 1.0, 2.0, 4.0])
    found = frequency_response(
        car, speed_m_s=speed, handwheel_rad=0.1, frequency_hz=frequencies, step_s=0.0005, tyre="linear"
    )
    # Second order at half a millisecond, the steering's mode at 90 rad/s.
    near = 2e-4
    for i, f in enumerate(frequencies):
        state = np.linalg.solve(2j * np.pi * f * np.eye(size) - matrix, given)
        assert found.yaw_rate_per_s[i] == pytest.approx(state[1], rel=near)
        assert found.roll_rad_per_rad[i] == pytest.approx(state[6], rel=near)
        assert found.lateral_acceleration_m_s2_per_rad[i] == pytest.approx(side @ state, rel=near)
        assert found.column_torque_nm_per_rad[i] == pytest.approx(60.0 * (1.0 - 16.0 * state[8]), rel=near)
    late = -np.unwrap(np.angle(found.yaw_rate_per_s)) / (2.0 * np.pi * frequencies)
    assert np.allclose(found.delay_s("yaw_rate_per_s"), late) and np.all(late > 0.0)


def test_the_width_and_slope_of_a_loop_are_those_of_an_ellipse():
    turn = np.linspace(0.0, 2.0 * np.pi, 4001)
    over, of = np.sin(turn), 3.0 * np.sin(turn - 0.2)
    # At over = 0 the loop stands at -/+ 3 sin 0.2.
    assert width(of, over) == pytest.approx(6.0 * np.sin(0.2), rel=1e-5)
    assert slope(over, of) == pytest.approx(3.0 * np.cos(0.2), rel=1e-3)


@pytest.mark.parametrize(("gap", "friction"), [(0.0, 8.1), (0.1, 8.1), (0.1, 0.0)])
def test_a_slow_weave_shows_the_lost_motion_of_friction_and_freeplay(gap, friction):
    car = Car.named("bmw_320i").with_({"freeplay.gap_rad": gap, "coulomb.level_nm": friction})
    slow = weave(car, frequency_hz=0.01, lateral_acceleration_m_s2=3.0, step_s=0.005, model="single_track")
    still = weave(
        car,
        frequency_hz=0.01,
        lateral_acceleration_m_s2=3.0,
        step_s=0.005,
        model="single_track",
        vary={"coulomb.level_nm": 0.0, "freeplay.gap_rad": 0.0},
    )
    # Where the car goes straight the column carries the friction alone, on the far side of the gap.
    lost = gap + 2.0 * friction / (16.0 * 60.0)
    # What is left at 0.01 Hz is the lag of car and damper, as without friction and gap. Without friction the car goes
    # straight all across the gap, from a little after its one end.
    near = 0.002 if friction else 0.15 * gap
    assert slow.angle_hysteresis_rad - still.angle_hysteresis_rad == pytest.approx(lost, abs=near)
    assert np.abs(slow.drive.lateral_acceleration_m_s2).max() == pytest.approx(3.0, rel=2e-3)


def test_on_centre_freeplay_and_friction_take_the_sensitivity_away():
    car = Car.named("bmw_320i")
    told = weave(car, vary={"freeplay.gap_rad": [0.0, 0.1, 0.0], "coulomb.level_nm": [0.0, 0.0, 8.1]})
    clean, gap, dry = told.sensitivity_m_s2_per_rad
    assert gap < 0.5 * clean
    assert told.handwheel_rad[1] > told.handwheel_rad[0] + 0.045
    assert told.angle_hysteresis_rad[2] > told.angle_hysteresis_rad[0]
    assert told.delay_s[2] > told.delay_s[0] > 0.0
    assert set(told.to_dict()) >= {"sensitivity_m_s2_per_rad", "delay_s", "handwheel_rad"}
    assert dry > 0.0


@pytest.mark.parametrize(
    ("call", "said"),
    [
        (lambda car: step_steer(car, speed_m_s=20.0, handwheel_rad=0.0), "handwheel_rad is 0"),
        (lambda car: step_steer(car, speed_m_s=20.0, handwheel_rad=0.1, rise_s=0.0), "rise_s is 0"),
        (lambda car: frequency_response(car, speed_m_s=20.0, handwheel_rad=0.1, frequency_hz=[0.0]), "not positive"),
        (lambda car: frequency_response(car, speed_m_s=20.0, handwheel_rad=0.0, frequency_hz=[1.0]), "handwheel_rad"),
        (lambda car: weave(car, lateral_acceleration_m_s2=0.0), "lateral_acceleration_m_s2 is 0"),
        (lambda car: weave(car, lateral_acceleration_m_s2=30.0), "is not reached"),
    ],
)
def test_a_test_without_sense_is_refused(call, said):
    with pytest.raises(ParameterError, match=said):
        call(Car.named("bmw_320i"))
