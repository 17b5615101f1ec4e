"""What goes in: cars and their files, signals, corridors; what is wrong with them is named."""

import numpy as np
import pytest

from luztar.errors import ModelError, ParameterError
from luztar.vehicle import CARS, Car, Corridor, Pieces, Samples, simulate, summarise

GIVEN = {"handwheel_rad": 0.1, "speed_m_s": 20.0, "duration_s": 1.0}


@pytest.mark.parametrize("name", CARS)
def test_every_car_has_a_source_for_every_value_and_survives_its_file(name, tmp_path):
    car = Car.named(name)
    for key, parameter in car.parameters.items():
        assert parameter.source.partition(":")[0] in car.sources, key
    path = tmp_path / "car.toml"
    car.save(path)
    assert Car.load(path) == car
    assert Car.load(path).to_dict() == car.to_dict()
    assert car.title in str(car)


def test_a_car_is_changed_by_making_another():
    car = Car.named("bmw_5")
    other = car.with_({"freeplay.gap_rad": 0.1}, source="rig of today", tyre="brush")
    assert (car["freeplay.gap_rad"], other["freeplay.gap_rad"]) == (0.0, 0.1)
    assert other.parameters["freeplay.gap_rad"].source == "rig of today"
    assert (car.tyre, other.tyre) == ("linear", "brush")
    with pytest.raises(AttributeError):
        car.tyre = "brush"
    with pytest.raises(TypeError):
        car.parameters["freeplay.gap_rad"] = 0.1
    with pytest.raises(ParameterError, match="no parameter 'gap'"):
        car.with_({"gap": 0.1})
    with pytest.raises(ParameterError, match="body.mass_kg is nan"):
        car.with_({"body.mass_kg": float("nan")})
    with pytest.raises(ParameterError, match="no car 'lada'"):
        Car.named("lada")


@pytest.mark.parametrize(
    ("change", "said"),
    [
        (("schema = 1", "schema = 7"), "schema = 1"),
        (('tyre = "linear"', 'tyre = "square"'), "no tyre 'square'"),
        (("mass_kg = { value = 1564.0, ", "mass_kg = { value = 1564.0, x = 1, "), "body.mass_kg has no value"),
        (("mass_kg = {", "weight_kg = {"), "no parameter 'body.weight_kg'"),
        (("ratio = { value = 16.0", "ratio = { value = true"), "steering.ratio has no value"),
        (("[body]", "[body"), "is not TOML"),
        (('name = "bmw_5"', "name = 5"), "no text 'name'"),
    ],
)
def test_a_file_that_is_no_car_is_refused_with_its_name(change, said, tmp_path):
    path = tmp_path / "wrong.toml"
    Car.named("bmw_5").save(path)
    text = path.read_text(encoding="utf-8")
    assert change[0] in text
    path.write_text(text.replace(*change), encoding="utf-8")
    with pytest.raises(ModelError, match=said) as caught:
        Car.load(path)
    assert str(path) in caught.value.where


def test_a_file_that_is_not_there_is_refused(tmp_path):
    with pytest.raises(ModelError, match="cannot be read"):
        Car.load(tmp_path / "none.toml")


@pytest.mark.parametrize(
    ("given", "said"),
    [
        ({"speed_m_s": 0.0}, "speed_m_s is 0"),
        ({"speed_m_s": -3.0}, "speed_m_s is -3"),
        ({"speed_m_s": 0.5}, "the slowest speed_m_s"),
        ({"speed_m_s": "fast"}, "speed_m_s is 'fast'"),
        ({"duration_s": 0.0}, "duration_s is 0"),
        ({"duration_s": float("nan")}, "duration_s"),
        ({"step_s": 0.0}, "step_s is 0"),
        ({"step_s": 0.1}, "the spring steering.stiffness"),
        ({"every": 0}, "every is 0"),
        ({"model": "bicycle"}, "no model 'bicycle'"),
        ({"tyre": "square"}, "unknown tyre 'square'"),
        ({"width": "mmx"}, "unknown width 'mmx'"),
        ({"handwheel_rad": None}, "an angle or a torque"),
        ({"torque_nm": 1.0}, "an angle or a torque"),
        ({"handwheel_rad": float("inf")}, "handwheel_rad"),
        ({"vary": {"body.mass_kg": -1.0}}, "body.mass_kg is -1"),
        ({"vary": {"body.mass": 1.0}}, "no parameter 'body.mass'"),
        ({"vary": {"coulomb.level_nm": -1.0}}, "coulomb.level_nm is -1"),
        ({"vary": {"stribeck.extra_nm": 1.0}}, "stribeck.speed_rad_s is 0"),
        ({"vary": {"stribeck.extra_nm": -1.0}}, "stribeck.extra_nm is -1"),
        ({"vary": {"front.relaxation_m": 0.01}}, "relaxation_m"),
        ({"vary": {"freeplay.gap_rad": [0.0, 0.1]}, "speed_m_s": [1.0, 2.0, 3.0]}, "speaks of 2 cars, others of 3"),
        ({"start": {"z_m": 1.0}}, "a start has no 'z_m'"),
        ({"tyre": "brush", "vary": {"front.friction": 0.0}}, "front.friction is 0"),
        ({"tyre": "magic_formula", "vary": {"rear.shape": 2.5}}, "rear.shape is 2.5"),
        ({"tyre": "magic_formula", "vary": {"rear.curvature": 1.5}}, "rear.curvature is 1.5"),
        ({"model": "lateral_roll", "vary": {"body.roll_inertia_kg_m2": 100.0}}, "body.roll_inertia_kg_m2 is 100"),
        ({"model": "lateral_roll", "vary": {"front.track_m": 0.0}}, "front.track_m is 0"),
        (
            {
                "model": "lateral_roll",
                "vary": {"front.roll_stiffness_nm_per_rad": 10.0, "rear.roll_stiffness_nm_per_rad": 10.0},
            },
            "falls over",
        ),
        ({"model": "twelve", "vary": {"front.unsprung_kg": 0.0}}, "front.unsprung_kg is 0"),
        ({"model": "twelve", "vary": {"body.mass_kg": 2000.0}}, "body.mass_kg is 2000"),
        ({"model": "twelve", "vary": {"front.spring_n_per_m": 1e6}}, "springs and bar together"),
    ],
)
def test_what_cannot_be_driven_is_named(given, said):
    with pytest.raises(ParameterError, match=said):
        simulate(Car.named("bmw_320i"), **{**GIVEN, **given})


def test_a_car_without_data_for_a_model_says_what_is_missing():
    with pytest.raises(ParameterError, match="body.roll_inertia_kg_m2 is 0"):
        simulate(Car.named("bmw_5"), model="lateral_roll", **GIVEN)
    with pytest.raises(ParameterError, match="handwheel.inertia_kg_m2 is 0"):
        simulate(
            Car.named("bmw_5").with_({"handwheel.inertia_kg_m2": 0.0}), torque_nm=1.0, speed_m_s=20.0, duration_s=1.0
        )
    with pytest.raises(ParameterError, match="car is str"):
        simulate("bmw_5", **GIVEN)


@pytest.mark.parametrize(
    ("made", "said"),
    [
        (lambda: Pieces(start_s=[0.0, 1.0], amplitude=[1.0, 2.0, 3.0]), "do not fit together"),
        (lambda: Pieces(start_s=0.0), "shape"),
        (lambda: Pieces(start_s=[np.nan]), "not finite"),
        (lambda: Samples([1.0, np.inf, 0.0, 0.0], 10.0), "not finite"),
        (lambda: Corridor(from_m=[0.0], to_m=[1.0, 2.0], right_m=[0.0, 0.0, 0.0], left_m=1.0), "do not fit together"),
        (lambda: Corridor(from_m=0.0, to_m=1.0, right_m=0.0, left_m=1.0), "shape"),
    ],
)
def test_signals_and_corridors_that_do_not_fit_are_refused(made, said):
    with pytest.raises(ParameterError, match=said):
        made()


@pytest.mark.parametrize(
    ("given", "said"),
    [
        ({"handwheel_rad": Pieces(start_s=[1.0, 0.5], level=0.1)}, "start_s is 0.5"),
        ({"handwheel_rad": Pieces(start_s=[0.0], amplitude=0.1, frequency_hz=-1.0)}, "frequency_hz is -1"),
        ({"speed_m_s": Pieces(start_s=[0.5], level=20.0)}, "start of speed_m_s is 0.5"),
        ({"handwheel_rad": Samples([0.0, 0.1, 0.2], 100.0)}, "samples has 3 values"),
        ({"handwheel_rad": Samples([0.0, 0.1, 0.2, 0.3], 0.0)}, "sample_rate_hz is 0"),
        ({"corridor": Corridor(from_m=[5.0], to_m=[5.0], right_m=-1.0, left_m=1.0)}, "a section ends after it begins"),
        ({"corridor": Corridor(from_m=[0.0], to_m=[5.0], right_m=1.0, left_m=1.0)}, "left of the right edge"),
    ],
)
def test_signals_and_corridors_without_sense_are_refused_when_they_are_driven(given, said):
    with pytest.raises(ParameterError, match=said):
        summarise(Car.named("bmw_5"), **{**GIVEN, **given})


def outline_clearance(car: Car, run, lane: Corridor) -> tuple[float, float]:
    """Least distance to each edge, from a cloud of points along the car's sides at every sample."""
    front, rear, half = car["body.front_end_m"], car["body.rear_end_m"], 0.5 * car["body.width_m"]
    along = np.linspace(-rear, front, 4001)
    least = {1.0: np.inf, -1.0: np.inf}
    for x0, y0, yaw in zip(run.x_m, run.y_m, run.yaw_rad, strict=True):
        for way in least:
            x = x0 + along * np.cos(yaw) - way * half * np.sin(yaw)
            y = y0 + along * np.sin(yaw) + way * half * np.cos(yaw)
            for k in range(lane.sections):
                inside = (x >= lane.from_m[k]) & (x <= lane.to_m[k])
                if inside.any():
                    share = (x[inside] - lane.from_m[k]) / (lane.to_m[k] - lane.from_m[k])
                    edges = (lane.left_m, lane.left_to_m) if way > 0.0 else (lane.right_m, lane.right_to_m)
                    edge = edges[0][k] + share * (edges[1][k] - edges[0][k])
                    least[way] = min(least[way], float((way * (edge - y[inside])).min()))
    return least[1.0], least[-1.0]


def test_the_clearance_is_that_of_every_point_of_the_body():
    car = Car.named("bmw_320i")
    lane = Corridor(
        from_m=[0.0, 45.0, 80.0],
        to_m=[15.0, 70.0, 95.0],
        right_m=[-1.1, 2.0, -1.5],
        left_m=[1.3, 5.5, 2.0],
        right_to_m=[-1.1, 2.2, -1.4],
        left_to_m=[1.3, 5.2, 2.5],
    )
    hand = Pieces(
        start_s=[0.4, 2.0, 2.6, 4.3],
        amplitude=np.linspace(0.6, 1.2, 5)[:, None] * [1.0, 0.0, -1.0, 0.0],
        frequency_hz=[0.6, 0.0, 0.6, 0.0],
    )
    options = {"handwheel_rad": hand, "speed_m_s": 20.0, "duration_s": 5.5, "step_s": 0.005, "tyre": "brush"}
    kept = summarise(car, corridor=lane, **options)
    run = simulate(car, **options)
    for i in range(5):

        class One:
            x_m, y_m, yaw_rad = run.x_m[i], run.y_m[i], run.yaw_rad[i]

        left, right = outline_clearance(car, One, lane)
        # The cloud and the samples see a moving body at other instants: 5 ms at 20 m/s across a section's corner.
        assert kept["clearance_left_min_m"][i] == pytest.approx(left, abs=0.02)
        assert kept["clearance_right_min_m"][i] == pytest.approx(right, abs=0.02)
    assert np.array_equal(kept["outside_m_s"] > 0.0, kept["clearance_min_m"] < 0.0)
    # Wider by 0.2 m: each side loses half of it where the car is straight, a little less where it is turned.
    wide = summarise(car, corridor=lane, vary={"body.width_m": car["body.width_m"] + 0.2}, **options)
    lost = kept["clearance_min_m"] - wide["clearance_min_m"]
    assert np.all((lost > 0.08) & (lost < 0.12))


def test_a_straight_car_stands_where_it_should_in_a_straight_lane():
    car = Car.named("bmw_5")
    lane = Corridor(from_m=[10.0], to_m=[30.0], right_m=-1.5, left_m=2.0)
    kept = summarise(
        car, handwheel_rad=0.0, speed_m_s=20.0, duration_s=3.0, corridor=lane, start={"y_m": [0.0, 0.25, 1.25]}
    )
    half = 0.5 * car["body.width_m"]
    assert np.allclose(kept["clearance_left_min_m"], 2.0 - half - np.array([0.0, 0.25, 1.25]), atol=1e-12)
    assert np.allclose(kept["clearance_right_min_m"], 1.5 - half + np.array([0.0, 0.25, 1.25]), atol=1e-12)
    # Outside by 0.175 m over the 20 m and the car's length of 4.8 m, at 20 m/s, to a step at either end.
    assert kept["outside_m_s"][2] == pytest.approx(0.175 * 24.8 / 20.0, abs=0.175 * 0.0025 * 2)
    far = Corridor(from_m=[1000.0], to_m=[1100.0], right_m=-1.5, left_m=2.0)
    never = summarise(car, handwheel_rad=0.0, speed_m_s=20.0, duration_s=3.0, corridor=far)
    assert never["clearance_min_m"][0] == np.inf


def test_a_car_that_spins_stops_and_says_when():
    car = Car.named("bmw_320i").with_({"rear.friction": 0.3}, tyre="brush")
    kept = summarise(car, handwheel_rad=[0.01, 1.5], speed_m_s=35.0, duration_s=20.0)
    assert kept["spun_s"][0] == np.inf and 0.0 < kept["spun_s"][1] < 20.0
    assert all(np.isfinite(v[1]) for k, v in kept.items() if not k.startswith("clearance"))


def test_a_drive_prints_itself_and_becomes_plain_values():
    run = simulate(Car.named("bmw_5"), **GIVEN)
    assert "1 car" in str(run) and "m/s2" in repr(run)
    plain = run.to_dict()
    assert plain["yaw_rate_rad_s"] == run.yaw_rate_rad_s.tolist() and len(plain["time_s"]) == 401
