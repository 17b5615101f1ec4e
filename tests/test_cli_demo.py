"""The demo: from bundled runs to a named effect, in a folder that may hold other things."""

from __future__ import annotations

import json
import os
import shlex
import sys
import types
from pathlib import Path

import pytest

from command_line import luztar, rig_texts
from luztar.cli import main

OWN = {"run1.csv.gz", "run2.csv.gz", "run3.csv.gz", "truth.json", "report.html", "study.json"}


@pytest.fixture
def quick(monkeypatch: pytest.MonkeyPatch) -> None:
    """Replace the study and the report, which have tests of their own."""
    import luztar.diagnosis

    report = types.ModuleType("luztar.report")
    report.write_report = lambda path, *, study=None, check=None: Path(path).write_text("report")
    monkeypatch.setitem(sys.modules, "luztar.report", report)

    class Study:
        def __str__(self) -> str:
            return "the ladder"

        def to_dict(self) -> dict:
            return {"schema": 1}

    monkeypatch.setattr(luztar.diagnosis, "study", lambda *_, **__: Study())


def test_demo_from_end_to_end(tmp_path: Path) -> None:
    before = os.times()
    done = luztar("demo", folder=tmp_path)
    after = os.times()
    assert done.code == 0, done.err
    folder = tmp_path / "luztar-demo"
    assert {p.name for p in folder.iterdir()} == OWN
    truth = json.loads((folder / "truth.json").read_text())
    study = json.loads((folder / "study.json").read_text())
    assert set(study["named"]) == set(truth["hidden"])
    assert "TB 038 v1.0: PASS" in done.out and "stribeck" in done.out and "luztar-demo/report.html" in done.out
    assert str(tmp_path) not in done.out
    page = (folder / "report.html").read_text()
    assert "stribeck" in page and "TB 038 v1.0" in page
    # Computing time, so that what else the computer does meanwhile does not count.
    took_s = after.children_user + after.children_system - before.children_user - before.children_system
    assert took_s < 10.0


def test_demo_shows_check_ladder_and_places(tmp_path: Path, quick: None, monkeypatch, capsys) -> None:
    monkeypatch.chdir(tmp_path)
    assert main(["demo"]) == 0
    out, err = capsys.readouterr()
    assert out.index("TB 038 v1.0: PASS") < out.index("the ladder") < out.index("luztar-demo/report.html")
    assert not err
    assert {p.name for p in Path("luztar-demo").iterdir()} == OWN


def test_demo_as_json(tmp_path: Path, quick: None, capsys) -> None:
    assert main(["demo", "--out", str(tmp_path / "here"), "--json"]) == 0
    found = json.loads(capsys.readouterr().out)
    assert set(found) == {"schema", "files", "tb038", "study"} and len(found["files"]) == len(OWN)


def test_demo_leaves_other_files_alone_and_may_run_again(tmp_path: Path, quick: None) -> None:
    (tmp_path / "mine.txt").write_text("mine")
    (tmp_path / "run9.csv").write_text("mine too")
    assert main(["demo", "--out", str(tmp_path)]) == 0
    (tmp_path / "study.json").write_text("old")
    assert main(["demo", "--out", str(tmp_path)]) == 0
    assert json.loads((tmp_path / "study.json").read_text())["schema"] == 1
    assert (tmp_path / "mine.txt").read_text() == "mine" and (tmp_path / "run9.csv").read_text() == "mine too"


@pytest.mark.parametrize("name", sorted(OWN))
def test_demo_never_overwrites_what_is_not_its_own(name: str, tmp_path: Path, quick: None, capsys) -> None:
    (tmp_path / name).write_text("a measurement of mine")
    assert main(["demo", "--out", str(tmp_path)]) == 3
    assert [p.name for p in tmp_path.iterdir()] == [name]
    assert (tmp_path / name).read_text() == "a measurement of mine"
    assert "nothing was written" in capsys.readouterr().err


def test_demo_needs_a_folder(tmp_path: Path, capsys) -> None:
    (tmp_path / "file").write_text("")
    assert main(["demo", "--out", str(tmp_path / "file")]) == 3
    assert "is a file" in capsys.readouterr().err


@pytest.mark.parametrize("name", ["", "  "])
def test_demo_needs_a_name_for_its_folder(name: str, tmp_path: Path, quick: None, monkeypatch, capsys) -> None:
    monkeypatch.chdir(tmp_path)
    assert main(["demo", "--out", name]) == 3
    assert "--out" in capsys.readouterr().err
    assert not list(tmp_path.iterdir())


def test_demo_says_a_command_that_a_shell_understands(tmp_path: Path, quick: None, capsys) -> None:
    assert main(["demo", "--out", str(tmp_path / "my folder")]) == 0
    tried = next(line for line in capsys.readouterr().out.splitlines() if line.startswith("Try"))
    words = shlex.split(tried)
    assert [Path(w).name for w in words[3:6]] == ["run1.csv.gz", "run2.csv.gz", "run3.csv.gz"]


def test_reports_are_written_where_asked(tmp_path: Path, quick: None, capsys) -> None:
    assert main(["demo", "--out", str(tmp_path)]) == 0
    runs = [str(tmp_path / f"run{i}.csv.gz") for i in (1, 2, 3)]
    place = tmp_path / "check.html"
    assert main(["tb038", *runs, "--report", str(place)]) == 0
    assert place.read_text() == "report"
    capsys.readouterr()
    assert main(["tb038", *runs, "--report", str(tmp_path)]) == 3
    assert "is a folder" in capsys.readouterr().err


def test_study_and_check_write_whole_reports(tmp_path: Path) -> None:
    (tmp_path / "run.csv").write_text(rig_texts()[0])
    done = luztar("study", "run.csv", "--model", "rig", "--json", "--report", "study.html", folder=tmp_path)
    assert done.code == 0, done.err
    assert done.json["schema"] == 1 and "report: study.html" in done.err
    done = luztar("tb038", "run.csv", "--report", "check.html", folder=tmp_path)
    assert done.code == 2
    for name in ("study.html", "check.html"):
        page = (tmp_path / name).read_text()
        assert page.lstrip().startswith("<!") and "</html>" in page
