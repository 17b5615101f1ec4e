"""luztar manoeuvre, as a user types it."""

import json
from pathlib import Path

import pytest

from command_line import luztar

EXAMPLES = Path(__file__).resolve().parents[1] / "examples"
# Cheap, but through everything: the plain car, two cells, two cars.
STUDY = """schema = 1
manoeuvre = "avoiding"
length_m = 60.0
speed_m_s = 15.0
model = "single_track"
tyre = "linear"
[search]
effort = "quick"
[robust]
freeplay_half_width_rad = [0.0, 0.05]
friction_nm = [0.0]
fine = [3, 1]
[map]
lengths_m = [60.0]
speeds_m_s = [12.0, 15.0]
[sensitivity]
samples = 64
ranges = { "freeplay.gap_rad" = [0.0, 0.2], "body.mass_kg" = [1000.0, 1200.0] }
"""


@pytest.fixture
def study(tmp_path):
    path = tmp_path / "study.toml"
    path.write_text(STUDY)
    return path


def test_an_optimum_is_one_json_object_and_a_page(study, tmp_path):
    page = tmp_path / "page.html"
    done = luztar("manoeuvre", "optimise", study, "--json", "--seed", 3, "--report", page)
    assert done.code == 0, done.err
    found = done.json
    assert found["schema"] == 1 and found["study"] == "optimise" and found["seed"] == 3
    assert found["feasible"] and found["broken"] == []
    best = found["best"]
    assert set(best["parameters"]) == set(found["flat"])
    assert best["criterion"] == pytest.approx(best["companion"])
    text = page.read_text(encoding="utf-8")
    assert 'data-figure="drives"' in text and "http-equiv" in text
    start = text.index('id="luztar-manoeuvre">') + len('id="luztar-manoeuvre">')
    assert json.loads(text[start : text.index("</script>", start)])["best"] == best


def test_what_no_signal_can_do_is_inconclusive(study):
    study.write_text(STUDY.replace("length_m = 60.0", "length_m = 20.0", 1))
    done = luztar("manoeuvre", "optimise", study, "--json")
    assert done.code == 2
    assert done.json["best"]["criterion"] is None and done.json["broken"]


def test_a_table_goes_on_from_its_journal(study, tmp_path):
    journal = tmp_path / "cells.jsonl"
    first = luztar("manoeuvre", "robust", study, "--json", "--journal", journal)
    assert first.code == 0, first.err
    assert [p["freeplay_half_width_rad"] for p in first.json["pairs"]] == [0.0, 0.05]
    lines = journal.read_text().splitlines()
    journal.write_text("\n".join(lines[:2]) + "\n")
    again = luztar("manoeuvre", "robust", study, "--json", "--journal", journal)
    assert again.json == first.json
    assert journal.read_text().splitlines() == lines
    other = luztar("manoeuvre", "robust", study, "--json", "--journal", journal, "--seed", 1)
    assert other.code == 3 and "another study" in other.json["error"]["kind"]


def test_a_map_and_a_sensitivity_print_themselves(study, tmp_path):
    for what, word in (("map", "amplitude_1"), ("sensitivity", "none dropped")):
        page = tmp_path / f"{what}.html"
        done = luztar("manoeuvre", what, study, "--report", page)
        assert done.code == 0, done.err
        assert word in done.out and page.stat().st_size > 1e6


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("schema = 2", "schema = 1"),
        ("schema = 1\nspeed_m_s = 10.0", "names no manoeuvre"),
        ('schema = 1\nmanoeuvre = "avoiding"\nlength_m = 60.0', "something is missing"),
        (STUDY.replace("speed_m_s = 15.0", "speed_m_s = -3.0"), "speed_m_s is -3"),
        (STUDY.replace("speed_m_s", "velocity"), "'velocity' is not known"),
        (STUDY.replace("fine", "finer"), "does not know 'finer'"),
        (STUDY.replace("length_m = 60.0", "length_m = 5.0", 1), "no way is left to change over"),
        (STUDY + "[weights]\ncalm_s2_per_rad2 = -1.0\nprecision_m2 = 1.0\ncomfort_s4_per_m2 = 1.0", "is -1"),
        (STUDY + '[vary]\n"body.width_m" = 4.0', "does not fit"),
        (STUDY + '[vary]\n"body.size" = 4.0', "no parameter 'body.size'"),
        (STUDY.replace('"quick"', '"heroic"'), "no effort 'heroic'"),
        ("schema = ", "is not TOML"),
    ],
)
def test_a_file_that_makes_no_study_is_refused_with_the_remedy(study, text, words):
    study.write_text(text)
    done = luztar("manoeuvre", "optimise", study, "--json")
    error = done.json["error"]
    assert done.code == 3 and words in error["kind"] and error["where"] and error["remedy"]


def test_a_file_that_is_not_there_is_named(tmp_path):
    done = luztar("manoeuvre", "optimise", tmp_path / "none.toml", "--json")
    assert done.code == 3 and "none.toml" in done.json["error"]["where"]


def test_weights_may_come_from_a_table_beside_the_study(study, tmp_path):
    from luztar.manoeuvre import load

    row = "[[weights]]\nspeed_m_s = {}\ncalm_s2_per_rad2 = {}\nprecision_m2 = 1.0\ncomfort_s4_per_m2 = 0.0\n"
    (tmp_path / "w.toml").write_text("schema = 1\n" + row.format(10.0, 1.0) + row.format(20.0, 3.0))
    study.write_text(STUDY + '[weights]\ntable = "w.toml"\n')
    assert load(study).task().weights.calm_s2_per_rad2 == pytest.approx(2.0)


@pytest.mark.parametrize("name", ["avoiding", "overtaking"])
def test_the_examples_are_studies(name):
    from luztar.manoeuvre import load

    study = load(EXAMPLES / f"{name}.toml")
    assert study.task().track.name == name
    assert load(EXAMPLES / f"{name}.toml", steer="torque").task().unit == "Nm"
    assert study.robust["friction_nm"] == (0.0, 4.05, 8.1) and len(study.map["speeds_m_s"]) == 5
