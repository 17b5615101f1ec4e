"""luztar simulate --monte-carlo: a row for each lane, bad studies named, an interrupt keeps what is done."""

import re
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from command_line import luztar
from luztar import Model
from luztar.cli import main
from luztar.dynamics import Uniform, sample, summarise
from luztar.freerun.monte_carlo import MonteCarlo, draw
from test_cli_simulate import MODEL

STUDY = """schema = 1
lanes = 40
seed = 3
keep = ["peak", "events"]
[vary]
stiffness = { uniform = [40, 60] }
coulomb.level_nm = { uniform = [4, 12] }
"""


@pytest.fixture
def files(tmp_path):
    (tmp_path / "model.toml").write_text(MODEL)
    (tmp_path / "study.toml").write_text(STUDY)
    return tmp_path


def run(folder, *words):
    return luztar("simulate", folder / "model.toml", "--monte-carlo", folder / "study.toml", *words)


def test_every_lane_has_a_row_and_the_numbers_of_a_call(files):
    done = run(files, "--sine", 1, 0.5, "--seconds", 2, "--out", files / "lanes.csv", "--json")
    assert done.code == 0, done.err
    table = np.genfromtxt(files / "lanes.csv", delimiter=",", names=True)
    drawn = sample({"steering.stiffness_nm_per_rad": Uniform(40, 60), "coulomb.level_nm": Uniform(4, 12)}, 40, seed=3)
    assert np.allclose(table["coulomblevel_nm"], drawn["coulomb.level_nm"], rtol=1e-8)
    psi = np.sin(np.pi * np.arange(1001) / 500)
    rest = {
        "steering.inertia_kg_m2": 3.0,
        "steering.ratio": 16.0,
        "viscous.coefficient_nm_s_per_rad": 40.0,
        "freeplay.gap_rad": 0.1,
    }
    # 30 steps a radian of the stiffest: 16 sqrt(60 / 3) rad/s at 500 Hz need 5.
    kept = summarise({**rest, **drawn}, psi, sample_rate_hz=500, substeps=5, keep=("peak", "events"))
    assert np.allclose(table["peak_rad"], kept["peak_rad"], rtol=1e-8)
    assert np.array_equal(table["stick_count"], kept["stick_count"])
    assert done.json["lanes"] == 40 and done.json["varied"] == ["steering.stiffness_nm_per_rad", "coulomb.level_nm"]
    assert done.json["percentiles"]["peak_rad"]["50"] == pytest.approx(np.median(kept["peak_rad"]))
    told = run(files, "--sine", 1, 0.5, "--seconds", 2)
    assert told.out.startswith("sine: 40 lanes") and "slip_count" in told.out


@pytest.mark.parametrize(
    ("change", "word"),
    [
        (("lanes = 40", "lanes = 0"), "lanes is 0"),
        (("lanes = 40", "lane = 40"), "no key lane"),
        (("schema = 1", "schema = 2"), "schema"),
        (("[4, 12]", "[12, 4]"), "coulomb.level_nm: uniform from 12 to 4"),
        (("[4, 12]", "[-4, 12]"), "coulomb_nm is -"),
        (("uniform = [4", "gamma = [4"), "uniform, normal, lognormal"),
        (("coulomb.level_nm", "coulomb.levl_nm"), "no parameter coulomb.levl_nm"),
        (('"peak"', '"peek"'), "no reducer 'peek'"),
        (("[vary]", "[very]"), "no key very"),
    ],
)
def test_a_study_that_makes_no_sense_is_named(files, change, word, capsys):
    (files / "study.toml").write_text(STUDY.replace(*change))
    words = ["simulate", files / "model.toml", "--monte-carlo", files / "study.toml", "--sine", 1, 1]
    assert main([*map(str, words)]) == 3
    assert word in " ".join(capsys.readouterr().err.split())


def test_the_study_on_the_page_can_be_drawn(files):
    page = (Path(__file__).resolve().parents[1] / "docs" / "dynamics.md").read_text(encoding="utf-8")
    (block,) = [b for b in re.findall(r"^```toml\n(.*?)^```$", page, re.MULTILINE | re.DOTALL) if "lanes =" in b]
    (files / "study.toml").write_text(block, encoding="utf-8")
    drawn = draw(Model.load(files / "model.toml"), MonteCarlo.load(files / "study.toml"))
    assert drawn["freeplay.gap_rad"].shape == (10_000,) and set(drawn["stiction.extra_nm"]) == {0.0, 4.0}


def test_a_page_and_many_lanes_do_not_go_together(files):
    done = run(files, "--sine", 1, 1, "--report", files / "page.html")
    assert done.code == 3 and "--out" in done.err


INTERRUPTED = """
import _thread, sys, threading
from luztar import _core
from luztar import Model
from luztar.cli import main
run = _core.run_lanes
def begun(*given, **options):
    threading.Timer(0.5, _thread.interrupt_main).start()
    return run(*given, **options)
_core.run_lanes = begun
sys.exit(main(sys.argv[1:]))
"""


def test_an_interrupt_writes_the_lanes_that_are_done(files):
    # 7.5e10 steps: a minute on a quick machine.
    (files / "study.toml").write_text(STUDY.replace("lanes = 40", "lanes = 500000"))
    out = files / "lanes.csv"
    words = ["simulate", files / "model.toml", "--monte-carlo", files / "study.toml", "--out", out]
    words += ["--sine", "1", "0.5", "--seconds", "60"]
    done = subprocess.run([sys.executable, "-c", INTERRUPTED, *map(str, words)], capture_output=True, text=True)
    assert done.returncode == 130, done.stderr
    rows = out.read_text().splitlines()
    assert f"{len(rows) - 1} of 500000 lanes are done and stand in" in done.stderr
    assert rows[0].startswith("lane,") and len(rows) < 500_001


@pytest.mark.parametrize(
    ("change", "word"),
    [
        (("inertia = 3.0", "inertia = -3.0"), "inertia_kg_m2"),
        (("coulomb.level_nm = 8.1", "coulomb.level_nm = -8.1"), "level_nm"),
        (("freeplay.gap_rad = 0.1", "freeplay.gap_rad = -0.1"), "gap_rad"),
        (("stiffness = 60.0", "stiffness = -60.0"), "stiffness_nm_per_rad"),
        (('"freeplay"]', '"freeplay", "stiction"]'), "stiction.extra_nm"),
        (("stiffness = 60.0", "stiffness = 60.0\nstiction.extra_nm = -1.0"), "stiction"),
        (("inertia = 3.0", "inertia = 1e-12"), "stiffness_nm_per_rad"),
    ],
)
def test_a_mechanism_that_makes_no_sense_is_named_on_the_command_line(files, change, word, capsys):
    (files / "model.toml").write_text(MODEL.replace(*change))
    assert main(["simulate", str(files / "model.toml"), "--sine", "1", "1"]) == 3
    assert word in " ".join(capsys.readouterr().err.split())
