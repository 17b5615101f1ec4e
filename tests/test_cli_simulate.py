"""luztar simulate, as a user types it."""

import numpy as np
import pytest

from command_line import luztar

MODEL = """schema = 1
structure = "steering"
effects = ["viscous", "coulomb", "freeplay"]
[known]
inertia = 3.0
ratio = 16.0
stiffness = 60.0
viscous.coefficient_nm_s_per_rad = 40.0
coulomb.level_nm = 8.1
freeplay.gap_rad = 0.1
"""


@pytest.fixture
def model(tmp_path):
    path = tmp_path / "model.toml"
    path.write_text(MODEL)
    return path


def test_a_sine_gives_a_trajectory_its_events_and_its_energies(model, tmp_path):
    done = luztar("simulate", model, "--sine", 1, 0.5, "--seconds", 4, "--out", tmp_path / "out.csv", "--json")
    assert done.code == 0, done.err
    (run,) = done.json["runs"]
    assert run["balanced"] and run["samples"] == 2001
    kinds = {e["kind"] for e in run["events"]}
    assert {"stick", "slip", "contact", "release"} <= kinds
    energy = run["energy_j"]
    spent = energy["dry"] + energy["viscous"] + energy["stored_last"] - energy["stored_first"]
    assert energy["handwheel"] == pytest.approx(spent, rel=1e-3)
    table = np.genfromtxt(tmp_path / "out.csv", delimiter=",", names=True)
    assert table["roadwheel_rad"].max() == pytest.approx(run["roadwheel_max_rad"], rel=1e-8)


def test_the_handwheel_of_a_run_drives_the_model(model, tmp_path):
    t = np.arange(1000) / 250
    rows = np.column_stack([t, np.sin(2 * t)])
    np.savetxt(tmp_path / "hand.csv", rows, delimiter=",", header="time_s,handwheel_rad", comments="")
    done = luztar("simulate", model, tmp_path / "hand.csv")
    assert done.code == 0, done.err
    assert done.out.startswith("hand.csv: 1 trajectory of 3.996 s") and "energy: handwheel" in done.out


def test_a_page_shows_every_run(model, tmp_path):
    t = np.arange(500) / 250
    for name, size in (("<b>one", 1.0), ("two", 0.8)):
        rows = np.column_stack([t, size * np.sin(2 * t)])
        np.savetxt(tmp_path / f"{name}.csv", rows, delimiter=",", header="time_s,handwheel_rad", comments="")
    page = tmp_path / "page.html"
    done = luztar("simulate", model, tmp_path / "<b>one.csv", tmp_path / "two.csv", "--report", page)
    assert done.code == 0, done.err
    text = page.read_text(encoding="utf-8")
    assert text.count("data-figure=") == 2 and "&lt;b&gt;one.csv" in text and "<b>one" not in text
    assert luztar("simulate", model, "--sine", 1, 1, "--report", tmp_path).code == 3


@pytest.mark.parametrize(
    ("words", "word"),
    [
        ((), "runs or a sine"),
        (("--sine", "1", "-1"), "no sine"),
        (("--sine", "1", "200"), "too slow"),
        (("--sine", "1", "1", "--seconds", "0"), "--seconds"),
        (("--sine", "1", "1", "--out", "nowhere/out.csv"), "no folder"),
    ],
)
def test_what_makes_no_drive_is_refused_by_name(model, words, word):
    done = luztar("simulate", model, *words)
    assert done.code == 3 and word in done.err


def test_a_model_that_is_not_whole_is_refused(model):
    model.write_text(MODEL.replace("inertia = 3.0\n", ""))
    done = luztar("simulate", model, "--sine", 1, 1)
    assert done.code == 3 and "steering.inertia_kg_m2" in done.err
    assert luztar("simulate", "rig", "--sine", 1, 1).code == 3


def test_a_mechanism_of_several_bodies_runs_from_its_file(tmp_path):
    from luztar.mechanism import steering_mechanism

    path = tmp_path / "mechanism.toml"
    steering_mechanism().save(path)
    out = tmp_path / "out.csv"
    done = luztar("simulate", path, "--sine", 1, 0.5, "--seconds", 2, "--out", out, "--json")
    assert done.code == 0, done.err
    (run,) = done.json["runs"]
    assert run["balanced"] and run["samples"] == 1001 and run["bodies"]["rack"]["unit"] == "m"
    assert {"column_friction", "left_king_pin", "gear"} <= {e["element"] for e in run["events"]}
    table = np.genfromtxt(out, delimiter=",", names=True)
    assert {"time_s", "handwheel_rad", "rack_m", "rack_m_per_s", "hand_torque"} <= set(table.dtype.names)
    assert table["rack_m"].max() == pytest.approx(run["bodies"]["rack"]["max"], rel=1e-8)
    done = luztar("simulate", path, "--sine", 1, 0.5, "--seconds", 2)
    assert done.code == 0 and done.out.startswith("sine: steering mechanism: 2 s")


def test_a_mechanism_that_makes_no_sense_is_refused_with_file_and_part(tmp_path):
    path = tmp_path / "mechanism.toml"
    path.write_text('schema = 1\nstructure = "mechanism"\n[bodies.one]\ninertia_kg_m2 = -1.0\n')
    done = luztar("simulate", path, "--sine", 1, 0.5)
    assert done.code == 3 and "mechanism.toml, one: its inertia is -1" in done.err
