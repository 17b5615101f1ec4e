"""Cars against closed forms: steady state, eigenvalues, frequency response, symmetry, balances, rest."""

import numpy as np
import pytest

from generators import car as reference
from luztar import dynamics
from luztar.vehicle import Car, Pieces, Samples, simulate

# A hundred roundings of the largest term.
ROUNDING = 1e-13
# Friction that nothing overcomes holds the road wheels where they start.
LOCKED = {"coulomb.level_nm": 1e12}
QUICK = {"front.relaxation_m": 0.0, "rear.relaxation_m": 0.0}


def values(car: Car) -> dict[str, float]:
    return {key: p.value for key, p in car.parameters.items()}


def understeer(p: dict[str, float]) -> tuple[float, float]:
    """Wheelbase and K of the steady gain ``u/(l + K u^2)``."""
    a, b = p["body.front_axle_m"], p["body.rear_axle_m"]
    cf, cr = p["front.cornering_n_per_rad"], p["rear.cornering_n_per_rad"]
    return a + b, p["body.mass_kg"] * (b * cr - a * cf) / ((a + b) * cf * cr)


@pytest.mark.parametrize("name", ["abe_textbook", "bmw_5", "bmw_320i"])
def test_the_steady_yaw_gain_is_the_textbooks(name):
    car = Car.named(name)
    length, k = understeer(values(car))
    speeds = np.array([5.0, 10.0, 20.0, 30.0, 40.0])
    run = simulate(car, handwheel_rad=0.3, speed_m_s=speeds, duration_s=60.0, every=100, tyre="linear", vary=QUICK)
    gain = run.yaw_rate_rad_s[:, -1] / run.roadwheel_rad[:, -1]
    assert np.allclose(gain, speeds / (length + k * speeds**2), rtol=1e3 * ROUNDING, atol=0.0)


@pytest.mark.parametrize("name", ["abe_textbook", "bmw_5"])
def test_the_gain_is_largest_at_the_characteristic_speed(name):
    car = Car.named(name)
    length, k = understeer(values(car))
    characteristic = np.sqrt(length / k)
    speeds = characteristic * np.array([0.98, 0.99, 1.0, 1.01, 1.02])
    run = simulate(car, handwheel_rad=0.3, speed_m_s=speeds, duration_s=60.0, every=100, tyre="linear")
    gain = run.yaw_rate_rad_s[:, -1] / run.roadwheel_rad[:, -1]
    assert int(np.argmax(gain)) == 2
    # There it is half of that of a neutral car, u/(2 l).
    assert gain[2] == pytest.approx(characteristic / (2.0 * length), rel=1e4 * ROUNDING)


def test_rear_wheels_that_follow_take_their_share_off_the_gain():
    car = Car.named("bmw_5").with_({"rear.steer_ratio": 0.2})
    length, k = understeer(values(car))
    run = simulate(car, handwheel_rad=0.3, speed_m_s=20.0, duration_s=60.0, every=100, tyre="linear")
    gain = run.yaw_rate_rad_s[-1] / run.roadwheel_rad[-1]
    assert run.rearwheel_rad[-1] == pytest.approx(0.2 * run.roadwheel_rad[-1], rel=ROUNDING)
    assert gain == pytest.approx(0.8 * 20.0 / (length + k * 400.0), rel=1e3 * ROUNDING)


def test_the_eigenvalues_are_those_of_the_matrix():
    car, speed = Car.named("abe_textbook"), 25.0
    matrix, _ = reference.linear_matrices(values(car), speed)
    expected = np.sort_complex(np.linalg.eigvals(matrix))
    errors = []
    for step in (0.004, 0.002, 0.001):
        every = round(0.1 / step)
        run = simulate(
            car,
            handwheel_rad=0.0,
            speed_m_s=speed,
            duration_s=0.4,
            step_s=step,
            every=every,
            tyre="linear",
            vary={**QUICK, **LOCKED},
            start={"lateral_speed_m_s": [1.0, 0.0], "yaw_rate_rad_s": [0.0, 0.2]},
        )
        # Two runs span the plane: what takes one sample to the next is exp(A t).
        states = np.stack((run.lateral_speed_m_s, run.yaw_rate_rad_s))
        first, second = states[:, :, 0], states[:, :, 1]
        step_matrix = second @ np.linalg.inv(first)
        found = np.sort_complex(np.log(np.linalg.eigvals(step_matrix).astype(complex)) / 0.1)
        errors.append(np.abs(found - expected).max() / np.abs(expected).max())
    # The midpoint rule leaves a sixth of (lambda h)^2 of an eigenvalue; a half more for the inverse.
    assert errors[-1] < 0.25 * (np.abs(expected).max() * 0.001) ** 2
    assert np.all(np.log2(np.array(errors[:-1]) / errors[1:]) > 1.9)


@pytest.mark.parametrize("frequency", [0.2, 0.7, 1.5, 3.0])
def test_the_frequency_response_to_the_road_wheels_is_the_textbooks(frequency):
    car, speed = Car.named("bmw_5"), 25.0
    matrix, given = reference.linear_matrices(values(car), speed)
    jw = 2j * np.pi * frequency
    expected = np.linalg.solve(jw * np.eye(2) - matrix, given)
    hand = Pieces(start_s=[0.0], amplitude=0.3, frequency_hz=frequency)
    step = 1.0 / frequency / 4096
    run = simulate(
        car,
        handwheel_rad=hand,
        speed_m_s=speed,
        duration_s=10.0 / frequency,
        step_s=step,
        tyre="linear",
        vary=QUICK,
    )
    last = slice(-4097, -1)
    wave = np.exp(-jw * run.time_s[last])
    over = {name: getattr(run, name)[last] @ wave for name in ("roadwheel_rad", "yaw_rate_rad_s", "lateral_speed_m_s")}
    # Second order at 4096 steps a period, and the start has died away (slowest decay 3/s over nine periods).
    assert over["yaw_rate_rad_s"] / over["roadwheel_rad"] == pytest.approx(expected[1], rel=2e-5)
    assert over["lateral_speed_m_s"] / over["roadwheel_rad"] == pytest.approx(expected[0], rel=2e-5)


@pytest.mark.parametrize("model", ["lateral_roll", "twelve"])
def test_the_larger_models_turn_as_the_single_track_in_the_steady_linear_limit(model):
    car = Car.named("bmw_320i")
    # Small: pitch moves loads by the product of yaw rate and lateral speed.
    options = {"handwheel_rad": 1e-4, "speed_m_s": 20.0, "duration_s": 30.0, "every": 500, "tyre": "linear"}
    small, large = (simulate(car, model=m, **options) for m in ("single_track", model))
    # Without roll steer and load dependence roll does not act on the steady turn; the wheels' loads only add up.
    assert large.yaw_rate_rad_s[-1] == pytest.approx(small.yaw_rate_rad_s[-1], rel=1e-9)
    assert large.roadwheel_rad[-1] == pytest.approx(small.roadwheel_rad[-1], rel=1e-9)
    arm = car["body.sprung_mass_kg"] * car["body.roll_arm_m"]
    stiffness = sum(car[f"{axle}.roll_stiffness_nm_per_rad"] for axle in ("front", "rear")) - arm * 9.80665
    rolled = arm * large.lateral_acceleration_m_s2[-1] / stiffness
    if model == "lateral_roll":
        assert large.roll_rad[-1] == pytest.approx(rolled, rel=1e-9)
    else:
        # On the springs of its tyres it rolls further.
        assert 1.05 < large.roll_rad[-1] / rolled < 1.4


def test_a_body_that_cannot_roll_is_the_single_track():
    car = Car.named("bmw_320i").with_({"body.roll_arm_m": 0.0})
    hand = Pieces(start_s=[0.0], amplitude=0.6, frequency_hz=0.5)
    options = {"handwheel_rad": hand, "speed_m_s": 20.0, "duration_s": 4.0, "tyre": "magic_formula"}
    rolling, flat = (simulate(car, model=m, **options) for m in ("lateral_roll", "single_track"))
    for name in ("yaw_rate_rad_s", "y_m", "roadwheel_rad"):
        scale = np.abs(getattr(flat, name)).max()
        assert np.abs(getattr(rolling, name) - getattr(flat, name)).max() < 1e3 * ROUNDING * scale, name


@pytest.mark.parametrize("tyre", ["linear", "brush", "magic_formula"])
@pytest.mark.parametrize("model", ["single_track", "lateral_roll", "twelve"])
def test_left_and_right_are_mirror_images_to_the_last_bit(model, tyre):
    car = Car.named("bmw_320i").with_(
        {"freeplay.gap_rad": 0.1, "coulomb.level_nm": 6.0, "stiction.extra_nm": 2.0, "rear.steer_ratio": 0.1}
    )
    way = np.array([1.0, -1.0])[:, None]
    hand = Pieces(start_s=way * 0.0 + [0.5, 2.0, 3.0], amplitude=way * [0.9, 0.0, -0.5], frequency_hz=[0.6, 0.0, 1.0])
    run = simulate(car, handwheel_rad=hand, speed_m_s=24.0, duration_s=5.0, model=model, tyre=tyre)
    for name in ("yaw_rate_rad_s", "y_m", "roadwheel_rad", "roll_rad", "lateral_acceleration_m_s2"):
        left, right = getattr(run, name)
        assert np.array_equal(left, -right), name
    assert np.array_equal(run.load_front_left_n[0], run.load_front_right_n[1])


def test_without_trails_the_road_wheels_are_the_one_mass_mechanism():
    car = Car.named("bmw_320i").with_(
        {
            "front.pneumatic_trail_m": 0.0,
            "front.caster_trail_m": 0.0,
            "freeplay.gap_rad": 0.1,
            "coulomb.level_nm": 8.1,
            "stiction.extra_nm": 4.0,
            "stribeck.extra_nm": 2.0,
            "stribeck.speed_rad_s": 0.03,
            "steering.aligning_nm_per_rad": 200.0,
        }
    )
    times = np.arange(4001) / 1000.0
    psi = np.sin(np.pi * times)
    run = simulate(car, handwheel_rad=Samples(psi, 1000.0), speed_m_s=20.0, duration_s=4.0, step_s=0.001, tyre="linear")
    alone = dynamics.simulate(
        {key: car[key] for key in dynamics.COLUMNS if key in car.parameters}, psi, sample_rate_hz=1000.0
    )
    # Two texts of one step: the cubic between samples is summed in another order.
    assert np.abs(run.roadwheel_rad - alone.roadwheel_rad).max() < 1e-12
    assert np.array_equal(run.roadwheel_speed_rad_s == 0.0, alone.speed_rad_s == 0.0)


def test_the_road_wheels_feel_the_tyres_as_a_load():
    car = Car.named("bmw_320i").with_({"freeplay.gap_rad": 0.1, "coulomb.level_nm": 8.1})
    times = np.arange(8001) / 2000.0
    psi = 0.8 * np.sin(np.pi * times)
    run = simulate(car, handwheel_rad=Samples(psi, 2000.0), speed_m_s=20.0, duration_s=4.0, step_s=0.0005, tyre="brush")
    alone = dynamics.simulate(
        {key: car[key] for key in dynamics.COLUMNS if key in car.parameters},
        psi,
        sample_rate_hz=2000.0,
        load_nm=run.tyre_torque_nm,
    )
    # The load is sampled here and evaluated there: second order in 0.5 ms.
    assert np.abs(run.roadwheel_rad - alone.roadwheel_rad).max() < 1e-4 * np.abs(run.roadwheel_rad).max()


def test_tyres_turn_the_wheels_back():
    car = Car.named("bmw_320i")
    run = simulate(car, handwheel_rad=0.4, speed_m_s=20.0, duration_s=5.0, tyre="brush")
    assert run.roadwheel_rad[-1] > 0.0 > run.tyre_torque_nm[-1]
    # At rest the column's torque times the ratio carries the tyres' torque.
    assert 16.0 * run.column_torque_nm[-1] == pytest.approx(-run.tyre_torque_nm[-1], rel=1e-9)
    # Caster alone: trail times the axle's force, which carries its share of the mass around the bend.
    caster = simulate(
        car,
        handwheel_rad=0.4,
        speed_m_s=20.0,
        duration_s=20.0,
        tyre="linear",
        vary={"front.pneumatic_trail_m": 0.0},
    )
    share = car["body.rear_axle_m"] / (car["body.front_axle_m"] + car["body.rear_axle_m"])
    force = car["body.mass_kg"] * caster.lateral_acceleration_m_s2[-1] * share
    assert caster.tyre_torque_nm[-1] == pytest.approx(-car["front.caster_trail_m"] * force, rel=1e-9)


def test_without_friction_and_gap_the_car_is_linear_to_rounding():
    car = Car.named("bmw_320i")
    hand = {"start_s": [0.3, 2.1], "frequency_hz": [0.7, 1.3]}
    parts = [np.array([0.4, 0.0]), np.array([0.0, -0.2])]
    drives = [Pieces(amplitude=a, **hand) for a in (*parts, parts[0] + parts[1])]
    for model in ("single_track", "lateral_roll"):
        runs = [
            simulate(car, handwheel_rad=d, speed_m_s=25.0, duration_s=4.0, model=model, tyre="linear") for d in drives
        ]
        for name in ("roadwheel_rad", "yaw_rate_rad_s", "lateral_acceleration_m_s2", "roll_rad"):
            one, two, both = (getattr(r, name) for r in runs)
            # The selects of an event would break superposition at every reversal; 1600 steps of rounding do not.
            assert np.abs(one + two - both).max() <= 1600 * ROUNDING * np.abs(both).max(), name


def test_momentum_is_what_the_tyres_give():
    car = Car.named("bmw_320i")
    hand = Pieces(start_s=[0.0], amplitude=0.7, frequency_hz=0.5)
    run = simulate(car, handwheel_rad=hand, speed_m_s=20.0, duration_s=3.0, step_s=0.0005, model="twelve")
    h = run.time_s[1]
    across = run.lateral_acceleration_m_s2 - 20.0 * run.yaw_rate_rad_s
    gained = np.concatenate(([0.0], np.cumsum(0.5 * h * (across[1:] + across[:-1]))))
    # Trapezoids against the midpoint rule: second order in 0.5 ms.
    assert np.abs(gained - run.lateral_speed_m_s).max() < 1e-4 * np.abs(run.lateral_speed_m_s).max()
    # What the four wheels carry beyond the weight lifts body and wheels: on the average nothing.
    loads = sum(getattr(run, f"load_{w}_n") for w in ("front_left", "front_right", "rear_left", "rear_right"))
    weight = car["body.mass_kg"] * 9.80665
    assert abs(np.mean(loads) / weight - 1.0) < 1e-3
    # And they tilt against roll: moment of the loads about the ground is that of the lateral force at its height.
    tracks = {"front": car["front.track_m"], "rear": car["rear.track_m"]}
    tilt = sum(
        0.5 * t * (getattr(run, f"load_{axle}_right_n") - getattr(run, f"load_{axle}_left_n"))
        for axle, t in tracks.items()
    )
    assert np.all(np.isfinite(tilt)) and np.abs(tilt).max() > 1000.0


def test_the_steady_moment_of_the_wheel_loads_is_that_of_the_lateral_force():
    car = Car.named("bmw_320i")
    run = simulate(car, handwheel_rad=0.2, speed_m_s=20.0, duration_s=20.0, every=100, model="twelve", tyre="linear")
    tilt = sum(
        0.5
        * car[f"{axle}.track_m"]
        * (getattr(run, f"load_{axle}_right_n")[-1] - getattr(run, f"load_{axle}_left_n")[-1])
        for axle in ("front", "rear")
    )
    # Sprung mass at its height above the ground (the roll axis lies on it), leaning outward; wheels at their radius.
    sprung = car["body.sprung_mass_kg"] * car["body.roll_arm_m"]
    unsprung = (car["front.unsprung_kg"] + car["rear.unsprung_kg"]) * car["body.wheel_radius_m"]
    side, roll = run.lateral_acceleration_m_s2[-1], run.roll_rad[-1]
    assert tilt == pytest.approx((sprung + unsprung) * side + sprung * 9.80665 * roll, rel=1e-9)


def test_energy_of_the_plane_motion_is_the_work_of_the_tyres():
    car = Car.named("bmw_5")
    hand = Pieces(start_s=[0.0], amplitude=0.7, frequency_hz=0.5)
    speed = 25.0
    run = simulate(car, handwheel_rad=hand, speed_m_s=speed, duration_s=3.0, step_s=0.0005, tyre="linear")
    p = values(car)
    m, iz, a, b = (p[f"body.{k}"] for k in ("mass_kg", "yaw_inertia_kg_m2", "front_axle_m", "rear_axle_m"))
    trail = p["front.pneumatic_trail_m"] + p["front.caster_trail_m"]
    front = -run.tyre_torque_nm / trail
    rear = m * run.lateral_acceleration_m_s2 - front
    v, r, h = run.lateral_speed_m_s, run.yaw_rate_rad_s, run.time_s[1]
    power = front * (v + a * r) + rear * (v - b * r) - m * speed * r * v
    work = np.concatenate(([0.0], np.cumsum(0.5 * h * (power[1:] + power[:-1]))))
    stored = 0.5 * m * v**2 + 0.5 * iz * r**2
    assert np.abs(work - stored).max() < 1e-4 * stored.max()


def test_a_held_wheel_stands_exactly_still_and_does_not_creep():
    car = Car.named("bmw_320i").with_({"coulomb.level_nm": 8.1})
    # Torque at the king-pins 16 * 60 * 0.004 = 3.8 Nm: below the friction, for 200 000 steps.
    run = simulate(car, handwheel_rad=0.004, speed_m_s=20.0, duration_s=500.0, every=1000)
    assert np.all(run.roadwheel_speed_rad_s == 0.0) and np.all(run.roadwheel_rad == 0.0)
    assert np.all(run.y_m == 0.0)


def test_a_torque_within_the_handwheels_friction_moves_nothing():
    car = Car.named("bmw_320i").with_({"handwheel.coulomb_nm": 0.3})
    run = simulate(car, torque_nm=[0.29, 0.31], speed_m_s=20.0, duration_s=2.0)
    assert np.all(run.handwheel_rad[0] == 0.0) and np.all(run.yaw_rate_rad_s[0] == 0.0)
    assert run.handwheel_rad[1, -1] > 0.0


def test_under_torque_the_handwheel_settles_where_the_column_carries_it():
    car = Car.named("bmw_320i").with_({"assist.gain": 30.0, "assist.threshold_nm": 0.5})
    run = simulate(car, torque_nm=2.0, speed_m_s=15.0, duration_s=30.0, every=100, tyre="linear")
    assert run.column_torque_nm[-1] == pytest.approx(2.0, rel=1e-9)
    # Assistance: gain times what exceeds the threshold, on top of the ratio.
    assert -run.tyre_torque_nm[-1] == pytest.approx(16.0 * 2.0 + 30.0 * 1.5, rel=1e-9)
    assert run.handwheel_rad[-1] - 16.0 * run.roadwheel_rad[-1] == pytest.approx(2.0 / 60.0, rel=1e-9)
