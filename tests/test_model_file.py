"""Model files and models: what is refused, and what a start value does."""

from __future__ import annotations

from pathlib import Path

import pytest

import luztar
from generators.rig import simulate_rig_set
from luztar.errors import ModelError
from luztar.model import Model, cards

HEAD = 'schema = 1\nstructure = "rig"\neffects = ["offset", "coulomb", "viscous", "stribeck"]\n'


def load(tmp_path: Path, text: str) -> Model:
    path = tmp_path / "m.toml"
    path.write_text(text)
    return Model.load(path)


@pytest.mark.parametrize(
    ("text", "word"),
    [
        (HEAD.replace("= 1", '= "1"'), "schema"),
        (HEAD.replace("= 1", "= true"), "schema"),
        (HEAD + "[known]\ncoulomb.level_nm = '0.7'\n", "coulomb"),
        (HEAD + "[known]\ncoulomb.level_nm = true\n", "coulomb"),
        (HEAD + "[comparison]\nband_hz = '6'\n", "band_hz"),
        (HEAD + "[comparison]\ndecimate = 2.0\n", "decimate"),
        (HEAD + "[comparison]\nfilter_already_applied = 1\n", "filter_already_applied"),
        (HEAD + "[start]\nstribeck.speed_rad_s = -1.0\n", "between"),
        (HEAD + "[start]\nstribeck.speed_rad_s = 0.1\n[known]\nstribeck.speed_rad_s = 0.1\n", "start value too"),
        (HEAD.replace('"stribeck"', '"decoy_time"'), "decoy"),
        ('schema = 1\nstructure = "axis"\neffects = ["once_per_rev"]\n', "pitch"),
    ],
)
def test_a_mistake_names_its_place_and_remedy(tmp_path: Path, text: str, word: str) -> None:
    with pytest.raises(ModelError, match=word) as caught:
        load(tmp_path, text)
    assert "m.toml" in caught.value.where and caught.value.remedy


def test_a_whole_number_is_a_number(tmp_path: Path) -> None:
    assert load(tmp_path, HEAD + "[known]\ncoulomb.level_nm = 1\n").known["coulomb.level_nm"] == 1


def test_what_is_saved_is_loaded_and_a_missing_folder_is_named(tmp_path: Path) -> None:
    model = Model.rig() + luztar.effects.Stribeck(speed_rad_s=0.1)
    model.save(tmp_path / "m.toml")
    assert Model.load(tmp_path / "m.toml") == model
    with pytest.raises(ModelError, match="nowhere") as caught:
        model.save(tmp_path / "nowhere" / "m.toml")
    assert caught.value.remedy


def test_decoys_are_for_diagnoses_alone() -> None:
    for c in cards():
        if c.is_decoy:
            with pytest.raises(ModelError, match="decoy"):
                Model.rig() + c.name
            assert "".join(p.capitalize() for p in c.name.split("_")) not in dir(luztar.effects)


def test_a_poor_start_value_does_not_keep_the_search_from_the_answer() -> None:
    made = simulate_rig_set(
        {"stribeck": {"extra_nm": 0.4, "speed_rad_s": 0.08}},
        runs=2,
        seed=2,
        motion={"strokes": 8},
        sample_rate_hz=100.0,
    )
    runs = [luztar.Run(time=r.time_s, angle=r.angle_rad, torque=r.torque_nm) for r in made]
    plain = luztar.fit(Model.rig() + "stribeck", runs)
    poor = luztar.fit(Model.rig() + luztar.effects.Stribeck(speed_rad_s=5.0), runs)
    key = "stribeck.speed_rad_s"
    assert poor.parameters[key].value == pytest.approx(plain.parameters[key].value, rel=0.02)
