"""--json: one object on standard output, the keys of the interface, nothing that is not JSON."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

import tb038_records
from command_line import luztar, rig_texts, write_gz

ERROR = {"rms", "held_out_rms", "relative", "held_out_relative", "floor_ratio", "unit"}
FLOOR = {"rms", "low", "high", "unit", "method"}
ESTIMATE = {"value", "low", "high", "identifiable"}
CANDIDATE = {"effect", "rms", "held_out_rms", "p_value", "in_set", "decoy", "same_as", "parameters"}
FIT = {"schema", "effects", "parameters", "error", "noise_floor"}
COMPARE = FIT | {"structure", "band_hz", "where", "lack_of_fit"}
DIAGNOSE = COMPARE | {"verdict", "named", "candidates", "next_experiment"}
STEP = {"added", "set", "provisional", "effects", "error", "parameters", "next_experiment"}
VERIFICATION = {
    *("run", "direction", "mean_nm", "std_nm", "max_abs_nm", "min_abs_nm", "slope_nm_per_deg", "intercept_nm"),
    *("samples", "angle_from_deg", "angle_to_deg", "max_speed_deg_s", "below_max", "above_min", "steady"),
    *("verdict", "why"),
}


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    here = tmp_path_factory.mktemp("runs")
    hidden = {"stribeck": {"extra_nm": 0.4, "speed_rad_s": 0.2}}
    for i, text in enumerate(rig_texts(hidden, runs=2, strokes=10), start=1):
        write_gz(here / f"run{i}.csv.gz", text)
    whole = (here / "run1.csv.gz").read_bytes()
    (here / "cut.csv.gz").write_bytes(whole[: len(whole) // 2])
    return here


def _check_diagnosis(look: dict) -> None:
    assert set(look) >= DIAGNOSE
    _check_fit(look)
    assert look["schema"] == 1 and look["structure"] == "rig" and look["band_hz"] == 6.0
    assert look["candidates"] and all(set(c) >= CANDIDATE for c in look["candidates"])
    assert all(set(w) == {"regime", "share", "floor_ratio", "text"} for w in look["where"])
    assert set(look["lack_of_fit"]) >= {"p_value", "along"}


def _check_fit(fit: dict) -> None:
    assert set(fit["error"]) == ERROR
    assert set(fit["noise_floor"]) >= FLOOR
    assert fit["parameters"] and all(set(p) >= ESTIMATE for p in fit["parameters"].values())


def test_fit(folder: Path) -> None:
    done = luztar("fit", "run1.csv.gz", "--model", "rig", "--add", "stribeck", "--json", folder=folder)
    assert set(done.json) >= FIT
    _check_fit(done.json)
    assert "stribeck.extra_nm" in done.json["parameters"]
    assert not done.err


def test_compare(folder: Path) -> None:
    found = luztar("compare", "run1.csv.gz", "--model", "rig", "--json", folder=folder).json
    assert set(found) >= COMPARE
    assert not set(found) & {"verdict", "named", "candidates", "next_experiment"}
    _check_fit(found)


def test_diagnose(folder: Path) -> None:
    done = luztar("diagnose", "run1.csv.gz", "--model", "rig", "--json", folder=folder)
    _check_diagnosis(done.json)
    assert not done.err


def test_study_finds_what_was_hidden(folder: Path) -> None:
    done = luztar("study", "run1.csv.gz", "run2.csv.gz", "--model", "rig", "--json", folder=folder)
    found = done.json
    assert set(found) == {"schema", "verdict", "named", "noise_floor", "steps", "last"}
    assert all(set(s) == STEP for s in found["steps"])
    first, *added = found["steps"]
    assert first["added"] is None and first["set"] == [] and first["provisional"] is False
    assert [s["added"] for s in added] == found["named"] == ["stribeck"]
    assert "stribeck" in added[0]["set"]
    assert added[0]["error"]["held_out_rms"] < first["error"]["held_out_rms"]
    _check_diagnosis(found["last"])
    assert found["verdict"] == found["last"]["verdict"]
    assert not done.err


def test_too_few_strokes_still_prints_the_whole_object(tmp_path: Path) -> None:
    (tmp_path / "few.csv").write_text(rig_texts(strokes=3)[0])
    done = luztar("diagnose", "few.csv", "--model", "rig", "--json", folder=tmp_path)
    assert done.code == 2
    assert done.json["verdict"] == "too_few_strokes" and done.json["named"] == []


def test_tb038(tmp_path: Path) -> None:
    t, angle, sign = tb038_records.turning(crossings=2, rate_hz=100.0)
    for i in (1, 2, 3):
        tb038_records.write_csv(tmp_path / f"run{i}.csv", t, angle, tb038_records.torque(angle, sign, seed=i))
    done = luztar("tb038", "run1.csv", "run2.csv", "run3.csv", "--json", folder=tmp_path)
    found = done.json
    keys = {"schema", "rule_set", "verdict", "filter", "verifications", "offset_nm", "once_per_rev", "integrity"}
    assert set(found) == keys | {"advice"}
    assert (done.code, found["verdict"]) == (0, "pass")
    assert len(found["verifications"]) == 6 and all(set(v) == VERIFICATION for v in found["verifications"])
    assert set(found["filter"]) == {"poles", "cutoff_hz", "passes", "text", "verdict_depends_on_it"}
    centred = luztar("tb038", "run1.csv", "--centre", "--json", folder=tmp_path)
    assert (centred.code, centred.json["as_recorded"]["verdict"]) == (2, "inconclusive")


def test_explain() -> None:
    listed = luztar("explain", "--json").json
    names = [e["name"] for e in listed["effects"]]
    assert listed["schema"] == 1 and {"stribeck", "freeplay", "coulomb"} <= set(names)
    assert not any("decoy" in name for name in names)
    card = luztar("explain", "stribeck", "--json").json
    assert card["schema"] == 1 and card["name"] == "stribeck"
    assert {"title", "equation", "look", "typical", "cause", "check", "source", "parameters"} <= set(card)
    assert set(card["parameters"][0]) >= {"key", "unit", "low", "high", "meaning"}


@pytest.mark.parametrize(
    ("code", "words", "where"),
    [
        (2, "study cut.csv.gz --model rig", "cut.csv.gz"),
        (2, "diagnose cut.csv.gz --model rig", "cut.csv.gz"),
        (3, "compare cut.csv.gz --model rig", "cut.csv.gz"),
        (3, "study none.csv --model rig", "none.csv"),
        (3, "study run1.csv.gz --model none.toml", "--model"),
        (3, "fit run1.csv.gz --model rig --add stribek", "--add"),
        (3, "fit run1.csv.gz --model rig --map angle", "--map"),
        (3, "fit run1.csv.gz --model rig --map angel=x", "--map"),
        (3, "fit run1.csv.gz --model rig --unit torque=volt", "--unit torque"),
        (3, "fit run1.csv.gz --model rig --band 0", "--band"),
        (3, "fit run1.csv.gz --model rig --resample nan", "--resample"),
        (3, "tb038 run1.csv.gz --link-distance-m -1", "--link-distance-m"),
        (3, "explain stribek", "effects"),
        (3, "study run1.csv.gz --model rig --fast", "luztar study"),
        (3, "study run1.csv.gz", "luztar study"),
        (3, "study --model rig", "luztar study"),
        (3, "guess run1.csv.gz", "luztar"),
        (3, "", "luztar"),
    ],
)
def test_errors_are_objects_too(code: int, words: str, where: str, folder: Path, monkeypatch, capsys) -> None:
    from luztar.cli import main

    monkeypatch.chdir(folder)
    assert main([*words.split(), "--json"]) == code
    out, err = capsys.readouterr()
    found = json.loads(out)
    assert set(found) == {"schema", "error"} and found["schema"] == 1
    assert set(found["error"]) == {"kind", "where", "remedy"}
    assert all(isinstance(text, str) and text for text in found["error"].values())
    assert where in found["error"]["where"] or where in found["error"]["kind"]
    assert err.startswith("error: ")


def test_a_fault_of_the_program_is_an_object_too(folder: Path, monkeypatch: pytest.MonkeyPatch, capsys) -> None:
    import luztar as package
    from luztar.cli import main

    monkeypatch.setattr(package.tb038, "evaluate", lambda *_, **__: 1 / 0)
    assert main(["tb038", str(folder / "run1.csv.gz"), "--json"]) == 4
    found = json.loads(capsys.readouterr().out)
    assert "ZeroDivisionError" in found["error"]["kind"] and package.__version__ in found["error"]["remedy"]


def test_json_after_the_end_of_options_is_a_file(capsys) -> None:
    from luztar.cli import main

    assert main(["study", "--model", "rig", "--", "--json"]) == 3
    out, err = capsys.readouterr()
    assert not out and "--json: there is no such file" in err


def test_what_is_not_finite_becomes_null() -> None:
    import numpy as np

    from luztar.cli.output import as_json

    odd = {"a": float("nan"), "b": [np.float64("inf"), np.int64(3)], "c": np.array([1.0, np.nan]), "d": (True, None)}
    assert json.loads(as_json(odd)) == {"a": None, "b": [None, 3], "c": [1.0, None], "d": [True, None]}
