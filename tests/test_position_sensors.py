"""Whatever measures the angle, the verdict is the same: encoders fine and coarse, noisy and exact sensors."""

import numpy as np
import pytest

import luztar
from generators.rig import simulate_rig_set
from luztar.diagnosis.prepare import prepare

# What stands between the true angle and the record; the noises are standard deviations.
SENSORS = {
    "encoder of 0.005 degrees": lambda x, rng: np.round(x / 0.005) * 0.005,
    "encoder of 0.1 degrees": lambda x, rng: np.round(x / 0.1) * 0.1,
    "exact": lambda x, rng: x,
    "potentiometer, 0.01 degrees of noise": lambda x, rng: x + 0.01 * rng.normal(size=x.size),
    "potentiometer, 0.05 degrees of noise": lambda x, rng: x + 0.05 * rng.normal(size=x.size),
    "converter of 0.02 degrees, one step of noise": lambda x, rng: (
        np.round((x + 0.02 * rng.normal(size=x.size)) / 0.02) * 0.02
    ),
}


def recorded(sensor, hidden, seed, **options):
    rng = np.random.default_rng([31, seed])
    made = simulate_rig_set(hidden, runs=3, seed=seed, duration_s=30.0, **options)
    return [
        luztar.Run(
            time=r.time_s,
            angle=np.deg2rad(SENSORS[sensor](np.rad2deg(r.true_angle_rad), rng)),
            torque=r.torque_nm,
            units={"angle": "rad", "torque": "Nm"},
            name=f"run{i}",
        )
        for i, r in enumerate(made, start=1)
    ]


@pytest.mark.parametrize("sensor", SENSORS)
def test_nothing_is_named_where_nothing_is_hidden(sensor):
    assert luztar.study(luztar.Model.rig(), recorded(sensor, {}, seed=4)).named == ()


@pytest.mark.parametrize("sensor", SENSORS)
def test_stribeck_friction_is_named(sensor):
    hidden = {"stribeck": {"extra_nm": 0.35, "speed_rad_s": 0.08}}
    assert luztar.study(luztar.Model.rig(), recorded(sensor, hidden, seed=7)).named == ("stribeck",)


def test_a_gap_is_found_behind_a_noisy_sensor():
    gap_rad = np.deg2rad(2.0)
    runs = recorded("potentiometer, 0.05 degrees of noise", {"freeplay": {"gap_rad": gap_rad}}, seed=12)
    found = luztar.study(luztar.Model.rig(), runs)
    assert found.named == ("freeplay",)
    # A start is certain after 0.2 degrees of such noise taken down by the low pass: a tenth of the gap.
    assert found.steps[-1].fit.parameters["freeplay.gap_rad"].value == pytest.approx(gap_rad, rel=0.1)


def test_an_exact_angle_resolves_a_ten_thousandth_of_the_range():
    # The quick corners of the first of these runs leave more behind the smoothing than the others do.
    for run in prepare(recorded("exact", {}, seed=7), luztar.Model.rig()):
        assert run.recording.resolution == pytest.approx(1e-4 * run.recording.range, rel=1e-3)
