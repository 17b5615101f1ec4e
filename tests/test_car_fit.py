"""Fits and studies of cars: a hidden effect in runs of an independent solver is named and the error is the noise."""

import json
import math

import numpy as np
import pytest

import luztar
from estimates import inside_99
from generators.hidden_car import NOISE, CarTruth, car_run, drive
from generators.steering import Hand
from luztar.errors import MeasurementError, ModelError

UNITS = {
    "time": "s",
    "handwheel": "rad",
    "speed": "m/s",
    "yaw_rate": "rad/s",
    "lateral_acceleration": "m/s^2",
    "roll_angle": "rad",
    "roadwheel": "rad",
}
# Unseen error over noise: 1 but for the parameters, which are one in a hundred samples.
NEAR_NOISE = 1.05


def generated(truth: CarTruth, seed: int, *, runs: int = 3, seconds: float = 10.0, **how) -> list[luztar.Run]:
    chance = np.random.default_rng(seed)
    made = [car_run(truth, chance, seconds=seconds, **how) for _ in range(runs)]
    return [luztar.Run(name=f"run{i}", units={k: UNITS[k] for k in run}, **run) for i, run in enumerate(made)]


@pytest.mark.parametrize(
    ("truth", "how", "hidden"),
    [
        (CarTruth(adhesion=0.8), {"reach": 0.1}, {"tyre_saturation.friction": 0.8}),
        (CarTruth(half_gap=0.03), {}, {"freeplay.gap_rad": 0.06}),
        (CarTruth(kinetic=20.0, static=20.0), {}, {"coulomb.level_nm": 20.0}),
        (CarTruth(relaxation=0.6), {}, {"tyre_relaxation.length_m": 0.6}),
        (
            CarTruth(front_roll_steer=-0.1, rear_roll_steer=0.1),
            {"reach": 0.12},
            {"roll_steer.front_rad_per_rad": -0.1, "roll_steer.rear_rad_per_rad": 0.1},
        ),
    ],
    ids=["tyre_saturation", "freeplay", "coulomb", "tyre_relaxation", "roll_steer"],
)
def test_the_hidden_effect_is_named_and_the_unseen_error_is_the_noise(truth, how, hidden):
    study = luztar.study(luztar.Model.car(truth.known()), generated(truth, 7, **how))
    assert study.named == (next(iter(hidden)).partition(".")[0],)
    fitted = study.steps[-1].fit
    assert fitted.error.held_out_rms <= NEAR_NOISE
    true = {
        "body.yaw_inertia_kg_m2": truth.yaw_inertia,
        "front.cornering_n_per_rad": truth.front_cornering,
        "rear.cornering_n_per_rad": truth.rear_cornering,
        "viscous.coefficient_nm_s_per_rad": truth.viscous,
        **hidden,
    }
    for key, value in true.items():
        assert inside_99(fitted.parameters[key], value, study.last.detection.strokes), key
    for channel in fitted.channels:
        assert channel.held_out_rms <= NEAR_NOISE * NOISE[channel.channel], channel


def test_nothing_is_named_where_nothing_is_hidden_and_the_results_are_whole(tmp_path):
    truth = CarTruth()
    runs = generated(truth, 11)
    study = luztar.study(luztar.Model.car(truth.known()), runs[:2], held_out=runs[2])
    assert study.named == () and study.verdict in ("nothing_missing", "below_practical_size")
    made = json.loads(json.dumps(study.to_dict()))
    assert made["last"]["structure"] == "car" and made["last"]["error"]["unit"] == "sigma"
    fitted = study.steps[0].fit
    assert set(fitted.to_dict()["channels"]) == set(NOISE)
    assert "yaw_rate: error" in str(fitted)
    study.report(tmp_path / "report.html")
    assert "handwheel in" in (tmp_path / "report.html").read_text()
    assert len(fitted.figure().to_dict()["data"]) == 2 * 2 * len(NOISE)


def test_two_channels_are_enough_for_saturation_and_a_known_speed_needs_no_channel():
    truth = CarTruth(adhesion=0.5)
    channels = ("yaw_rate", "lateral_acceleration")
    runs = generated(truth, 3, channels=channels, reach=0.12)
    runs = [
        luztar.Run(time=r.time_s, name=r.name, units=UNITS, **{c: r[c] for c in ("handwheel", *channels)}) for r in runs
    ]
    model = luztar.Model.car({**truth.known(), "speed_m_s": 22.0, "viscous.coefficient_nm_s_per_rad": truth.viscous})
    look = luztar.diagnose(luztar.fit(model, runs))
    assert look.verdict == "named" and look.named == ("tyre_saturation",)


def test_the_solver_of_the_generator_and_the_lanes_agree_with_everything_in():
    m = CarTruth(
        half_gap=0.03,
        kinetic=20.0,
        static=30.0,
        relaxation=0.5,
        front_roll_steer=-0.05,
        rear_roll_steer=0.04,
        adhesion=0.5,
    )
    times = np.arange(600) / 100.0
    hand = Hand((0.3, 0.2), (0.3, 0.7))
    exact = drive(m, hand, 22.0, times)
    given = {
        **m.known(),
        "body.yaw_inertia_kg_m2": m.yaw_inertia,
        "viscous.coefficient_nm_s_per_rad": m.viscous,
        "freeplay.gap_rad": 2.0 * m.half_gap,
        "coulomb.level_nm": m.kinetic,
        "stiction.extra_nm": m.static - m.kinetic,
    }
    for axle in ("front", "rear"):
        given |= {
            f"{axle}.cornering_n_per_rad": getattr(m, f"{axle}_cornering"),
            f"{axle}.relaxation_m": m.relaxation,
            f"{axle}.friction": m.adhesion,
            f"{axle}.roll_steer": getattr(m, f"{axle}_roll_steer"),
        }
    errors = []
    for substeps in (4, 16):
        run = luztar.vehicle.simulate(
            luztar.vehicle.Car.named("abe_textbook"),
            handwheel_rad=luztar.vehicle.Samples(hand(times), 100.0),
            speed_m_s=22.0,
            duration_s=float(times[-1]),
            step_s=0.01 / substeps,
            every=substeps,
            model="lateral_roll",
            tyre="brush",
            vary=given,
        )
        errors.append(float(np.abs(run.yaw_rate_rad_s - exact["yaw_rate"]).max()))
        assert np.abs(run.roadwheel_rad - exact["roadwheel"]).max() < 0.05 * NOISE["roadwheel"]
    # Second order: sixteen times less, until the cubic between the samples of the handwheel shows.
    assert errors[0] < 5e-5 and errors[1] < 5e-6


def test_a_car_without_mass_speed_or_motion_is_refused_by_name():
    truth = CarTruth()
    turning = 0.2 * np.sin(np.arange(900) / 30.0)
    noisy = turning + np.random.default_rng(0).normal(0.0, 1e-3, 900)
    run = luztar.Run(sample_rate_hz=100.0, handwheel=turning, yaw_rate=noisy, speed=np.full(900, 20.0), name="bad")
    known = truth.known()
    for key in ("body.mass_kg", "steering.ratio", "steering.stiffness_nm_per_rad"):
        with pytest.raises(ModelError, match=f"{key} is not given"):
            luztar.fit(luztar.Model.car({k: v for k, v in known.items() if k != key}), run)
    with pytest.raises(ModelError, match="needs a body that rolls"):
        flat = {k: v for k, v in known.items() if "roll" not in k}
        luztar.fit(luztar.Model.car(flat) + "roll_steer", run)
    with pytest.raises(ModelError, match="no effect of a car model"):
        luztar.Model.car(known) + "once_per_rev"
    with pytest.raises(ModelError, match=r"speed_m_s is 0"):
        luztar.Model.car({**known, "speed_m_s": 0.0})
    with pytest.raises(ModelError, match="there is no 'body.colour'"):
        luztar.Model.car(known, estimate=["body.colour"])
    for channels, word in (
        ({"handwheel": turning, "yaw_rate": noisy}, "no channel 'speed'"),
        ({"handwheel": turning, "speed": np.full(900, 20.0)}, "none of yaw_rate"),
        ({"handwheel": turning, "yaw_rate": noisy, "speed": np.full(900, 0.5)}, "drives at 0.5 m/s"),
    ):
        with pytest.raises(MeasurementError, match=word):
            luztar.fit(luztar.Model.car(known), luztar.Run(sample_rate_hz=100.0, name="bad", **channels))


def test_a_file_of_a_car_is_read_and_its_model_is_a_file(tmp_path):
    path = tmp_path / "run.csv"
    rows = "\n".join(f"{i / 100:g},{math.sin(i / 30):g},72,{math.sin(i / 30):g},0.1" for i in range(40))
    path.write_text(
        f"time_s,handwheel_deg,Vehicle speed [km/h],Yaw velocity [deg/s],lateral acceleration [g]\n{rows}\n"
    )
    (run,) = luztar.read(path)
    assert run["speed"][0] == pytest.approx(20.0)
    assert run["yaw_rate"][10] == pytest.approx(math.radians(math.sin(10 / 30)), rel=1e-5)
    assert run["lateral_acceleration"][0] == pytest.approx(0.980665)
    model = luztar.Model.car(CarTruth().known(), estimate=["steering.stiffness_nm_per_rad"])
    model.save(tmp_path / "car.toml")
    assert luztar.Model.load(tmp_path / "car.toml") == model
