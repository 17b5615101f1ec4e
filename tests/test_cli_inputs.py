"""From words to runs and models: --map, --unit, --held-out, --model, copies of a run."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from command_line import columns, rig_texts, with_header
from luztar.cli import main
from luztar.cli.inputs import pairs
from luztar.errors import ParameterError


@pytest.fixture(scope="module")
def texts() -> list[str]:
    return rig_texts(runs=3)


@pytest.fixture
def answer(tmp_path: Path, texts: list[str], monkeypatch: pytest.MonkeyPatch, capsys):
    """Call a command with --json in a folder with three runs; returns the object."""
    for i, text in enumerate(texts, start=1):
        (tmp_path / f"run{i}.csv").write_text(text)
    monkeypatch.chdir(tmp_path)

    def call(*words: str, code: int = 0) -> dict[str, Any]:
        assert main([*words, "--json"]) == code, capsys.readouterr()
        out, call.err = capsys.readouterr()
        return json.loads(out)

    return call


@pytest.mark.parametrize(
    ("word", "value"),
    [
        ("angle=SR Angle", "SR Angle"),
        ('angle="SR Angle"', "SR Angle"),
        ("angle='SR Angle'", "SR Angle"),
        ("angle = SR Angle ", "SR Angle"),
        ("angle=ADC6*0.52", "ADC6*0.52"),
        ('angle="ADC 6"*0.52', "ADC 6*0.52"),
        ('angle="ADC6 * 0.52"', "ADC6 * 0.52"),
        ("angle=a=b", "a=b"),
        ('angle="a" and "b', '"a" and "b'),
    ],
)
def test_pairs(word: str, value: str) -> None:
    assert pairs("--map", [word]) == {"angle": value}


@pytest.mark.parametrize("words", [["angle"], ["=x"], ["angle=a", "angle=b"]])
def test_pairs_that_make_no_sense(words: list[str]) -> None:
    with pytest.raises(ParameterError) as caught:
        pairs("--map", words)
    assert caught.value.where == "--map" and caught.value.remedy


def test_map_names_a_column_in_quotes_and_scales_another(answer, texts: list[str]) -> None:
    table = columns(texts[0])
    table[:, 2] /= 0.52
    text = "\n".join(["Zeit [s],Rad Winkel [deg],ADC6 [N]", *(",".join(f"{v:.10g}" for v in row) for row in table)])
    Path("other.csv").write_text(text + "\n")
    mapped = ["--map", "time=Zeit", "--map", 'angle="Rad Winkel"', "--map", "torque=ADC6*0.52"]
    plain = answer("fit", "run1.csv", "--model", "rig")
    other = answer("fit", "other.csv", "--model", "rig", *mapped)
    for key, estimate in plain["parameters"].items():
        assert other["parameters"][key]["value"] == pytest.approx(estimate["value"], rel=1e-6)


def test_unit_says_what_the_file_does_not(answer, texts: list[str]) -> None:
    table = columns(texts[0])
    table[:, 2] *= 1000.0
    Path("bare.csv").write_text(with_header("time,angle,torque", table))
    units = ["--unit", "time=s", "--unit", "angle=deg"]
    assert "no unit" in answer("fit", "bare.csv", "--model", "rig", *units, code=3)["error"]["kind"]
    plain = answer("fit", "run1.csv", "--model", "rig")
    bare = answer("fit", "bare.csv", "--model", "rig", *units, "--unit", "torque=mNm")
    level = plain["parameters"]["coulomb.level_nm"]["value"]
    assert bare["parameters"]["coulomb.level_nm"]["value"] == pytest.approx(level, rel=1e-6)
    assert "torque is taken as mNm" in answer.err


def test_a_held_out_run_among_the_runs_is_taken_out_of_them(answer) -> None:
    named_twice = answer("fit", "run1.csv", "run2.csv", "run3.csv", "--held-out", "./run3.csv", "--model", "rig")
    assert "only predicted" in answer.err
    named_once = answer("fit", "run1.csv", "run2.csv", "--held-out", "run3.csv", "--model", "rig")
    assert not answer.err
    assert named_twice == named_once


def test_a_copy_of_a_held_out_run_is_taken_out_too(answer, texts: list[str]) -> None:
    Path("copy.csv").write_text(texts[2])
    with_copy = answer("fit", "run1.csv", "copy.csv", "--held-out", "run3.csv", "--model", "rig")
    assert with_copy == answer("fit", "run1.csv", "--held-out", "run3.csv", "--model", "rig")


def test_a_run_given_twice_counts_once(answer, texts: list[str]) -> None:
    Path("copy.csv").write_text(texts[0])
    once = answer("fit", "run1.csv", "run2.csv", "--model", "rig")
    assert answer("fit", "run1.csv", "run2.csv", "run1.csv", "copy.csv", "--model", "rig") == once
    assert answer.err.count("counts once") == 2


@pytest.mark.parametrize("command", ["fit", "compare", "diagnose"])
def test_a_held_out_run_changes_nothing_but_its_own_error(answer, texts: list[str], command: str) -> None:
    table = columns(texts[2])
    table[:, 2] = 3.0 * table[:, 2] + 0.3 * np.sin(table[:, 0])
    Path("nonsense.csv").write_text(with_header("time_s,angle_deg,torque_Nm", table))
    sound = answer(command, "run1.csv", "--held-out", "run3.csv", "--model", "rig")
    odd = answer(command, "run1.csv", "--held-out", "nonsense.csv", "--model", "rig")
    assert odd["error"]["held_out_rms"] > 2.0 * sound["error"]["held_out_rms"]
    for found in (sound, odd):
        for key in ("held_out_rms", "held_out_relative"):
            del found["error"][key]
    assert odd == sound


def test_band_reaches_the_comparison(answer) -> None:
    assert answer("fit", "run1.csv", "--model", "rig", "--band", "3")["band_hz"] == 3.0
    assert "too slowly" in answer("fit", "run1.csv", "--model", "rig", "--band", "60", code=3)["error"]["kind"]


def test_a_model_file(answer) -> None:
    Path("mine.toml").write_text('schema = 1\nstructure = "rig"\neffects = ["offset", "coulomb"]\n')
    assert answer("fit", "run1.csv", "--model", "mine.toml")["effects"] == ["offset", "coulomb"]
    Path("mine.toml").write_text('schema = 1\nstructure = "rig"\neffect = ["offset"]\n')
    assert "mine.toml" in answer("fit", "run1.csv", "--model", "mine.toml", code=3)["error"]["where"]


def test_an_unknown_model_offers_the_nearest(answer) -> None:
    error = answer("fit", "run1.csv", "--model", "rigs", code=3)["error"]
    assert "Did you mean rig?" in error["remedy"] and "axis" in error["remedy"]


def test_an_unknown_effect_offers_the_nearest(answer) -> None:
    error = answer("fit", "run1.csv", "--model", "rig", "--add", "stribek", code=3)["error"]
    assert "Did you mean stribeck" in error["remedy"]


def test_effects_are_added_in_the_order_given(answer) -> None:
    found = answer("fit", "run1.csv", "--model", "rig", "--add", "stiffness", "--add", "inertia")
    assert found["effects"] == ["offset", "coulomb", "viscous", "stiffness", "inertia"]


def test_uneven_sampling_is_told_apart_from_an_unreadable_part(answer, texts: list[str]) -> None:
    table = columns(texts[0])
    table[:, 0] += 0.004 * np.sin(np.arange(len(table)))
    Path("uneven.csv").write_text(with_header("time_s,angle_deg,torque_Nm", table))
    assert "uneven" in answer("diagnose", "uneven.csv", "--model", "rig", code=3)["error"]["kind"]
    found = answer("fit", "uneven.csv", "--model", "rig", "--resample", "100")
    assert found["parameters"]["coulomb.level_nm"]["value"] == pytest.approx(0.75, abs=0.1)


def test_findings_reach_the_reader(answer, capsys, texts: list[str]) -> None:
    table = columns(texts[0])
    Path("bare.csv").write_text(with_header("time_s,angle_deg,torque", table))
    assert main(["fit", "bare.csv", "--model", "rig", "--unit", "torque=Nm"]) == 0
    out, err = capsys.readouterr()
    assert "torque is taken as Nm" in out.split("Data")[1]
    assert not err


def test_another_mistake_with_a_run_that_has_a_hole_is_still_a_mistake(answer, texts: list[str]) -> None:
    lines = texts[0].splitlines()
    lines[900] = lines[900].rsplit(",", 1)[0] + ","
    Path("hole.csv").write_text("\n".join(lines) + "\n")
    error = answer("diagnose", "hole.csv", "--model", "rig", code=2)["error"]
    assert "hole.csv" in error["where"]
    wrong = answer("diagnose", "run1.csv", "hole.csv", "--model", "rig", "--band", "60", code=3)["error"]
    assert wrong["where"] == "run1.csv"


def test_a_folder_is_named_as_one(answer) -> None:
    error = answer("fit", ".", "--model", "rig", code=3)["error"]
    assert error == {"kind": "this is a folder", "where": ".", "remedy": "Name the files in it."}
