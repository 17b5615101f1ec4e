"""Axes that run freely, force in and position out: runs of an independent solver, stroke by stroke."""

import numpy as np
import pytest

import luztar
from estimates import inside_99
from generators.steering import Hand, Mechanism, simulate
from luztar.errors import ModelError

NOISE_M = 2e-5
# What the last model leaves unseen, over the noise.
NEAR_NOISE = 1.05


def generated(seed: int, *, runs: int = 3, seconds: float = 8.0, **friction) -> list[luztar.Run]:
    """A mass of 20 kg: a mechanism whose spring to the ground takes the column's off, so that its hand is a force."""
    chance = np.random.default_rng(seed)
    given = {"viscous": 60.0, "kinetic": 15.0, "static": 15.0, **friction}
    mass = Mechanism(inertia=20.0, ratio=1.0, stiffness=1.0, aligning=-1.0, **given)
    times = np.arange(round(seconds * 250.0)) / 250.0
    out = []
    for i in range(runs):
        force = Hand(
            tuple(chance.uniform(8.0, 25.0, 5)), tuple(chance.uniform(0.3, 1.5, 5)), tuple(chance.uniform(0.0, 6.28, 5))
        )
        position = simulate(mass, force, times, tolerance=1e-8) + chance.normal(0.0, NOISE_M, times.size)
        units = {"time": "s", "force": "N", "position": "m"}
        out.append(luztar.Run(name=f"run{i}", time=times, force=force(times), position=position, units=units))
    return out


@pytest.mark.parametrize(
    ("friction", "hidden"),
    [
        ({}, {}),
        ({"static": 25.0}, {"stiction.extra_n": 10.0}),
        ({"drag": 150.0}, {"drag.coefficient_n_s2_per_m2": 150.0}),
    ],
    ids=["nothing", "stiction", "drag"],
)
def test_the_hidden_effect_is_named_and_the_unseen_error_is_the_noise(friction, hidden):
    study = luztar.study(luztar.Model.axis(free=True), generated(3, **friction))
    assert study.named == tuple(key.partition(".")[0] for key in hidden)
    fitted = study.steps[-1].fit
    assert fitted.error.held_out_rms <= NEAR_NOISE * NOISE_M and fitted.error.unit == "m"
    true = {
        "inertia.inertia_kg": 20.0,
        "viscous.coefficient_n_s_per_m": 60.0,
        "coulomb.level_n": 15.0,
        "offset.level_n": 0.0,
        **hidden,
    }
    for key, value in true.items():
        assert inside_99(fitted.parameters[key], value, study.last.detection.strokes), key


def test_stribeck_friction_is_found_beside_a_force_sensor_that_is_not_zeroed():
    runs = [
        luztar.Run(name=r.name, time=r.time_s, force=r["force"] + 2.0, position=r["position"], units={"time": "s"})
        for r in generated(5, seconds=16.0, stribeck=8.0, stribeck_speed=0.1)
    ]
    fitted = luztar.fit(luztar.Model.axis(free=True), runs)
    look = luztar.diagnose(fitted)
    assert look.verdict == "named" and look.named == ("stribeck",)
    found = look.tried[0].solution.found
    assert found["offset.level_n"] == pytest.approx(2.0, abs=0.02)
    assert found["stribeck.extra_n"] == pytest.approx(8.0, rel=0.02)
    assert fitted.figure().layout.xaxis.title.text == "time [s]"


def test_what_a_mass_under_a_force_has_no_place_for_is_refused_by_name(tmp_path):
    (run,) = generated(3, runs=1)
    model = luztar.Model.axis(free=True)
    for name, word in (("freeplay", "behind a gap there is nothing"), ("asymmetric_coulomb", "told from offset")):
        with pytest.raises(ModelError, match=f"'{name}' has no place here.*{word}"):
            luztar.fit(model + name, run)
    with pytest.raises(ModelError, match="needs 'inertia'"):
        luztar.fit(model - "inertia", run)
    with pytest.raises(ModelError, match="'offset' needs 'coulomb'"):
        luztar.fit(model - "coulomb", run)
    with pytest.raises(ModelError, match="a rig is driven"):
        luztar.Model("rig", ("offset",), free=True)
    with pytest.raises(ModelError, match="without a filter"):
        luztar.Model.axis(free=True, band_hz=40.0)
    model.save(tmp_path / "axis.toml")
    assert "free = true" in (tmp_path / "axis.toml").read_text()
    assert luztar.Model.load(tmp_path / "axis.toml") == model
