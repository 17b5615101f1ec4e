"""The exit codes that scripts rely on, each command in a process of its own."""

from __future__ import annotations

import sys
from pathlib import Path

import pytest

import tb038_records
from command_line import luztar, rig_texts, write_gz


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Run files of every fate."""
    here = tmp_path_factory.mktemp("runs")
    (text,) = rig_texts({"stiffness": {"stiffness_nm_per_rad": 0.4}})
    write_gz(here / "run.csv.gz", text)
    whole = (here / "run.csv.gz").read_bytes()
    (here / "cut.csv.gz").write_bytes(whole[: len(whole) // 2])
    lines = text.splitlines()
    lost = len(lines) // 2
    (here / "gap.csv").write_text("\n".join([*lines[:lost], *lines[lost + 60 :]]) + "\n")
    (here / "hole.csv").write_text("\n".join([*lines[:lost], f"{lines[lost].rsplit(',', 1)[0]},", *lines[lost + 1 :]]))
    rows = [line.split(",") for line in lines]
    flat = [[*r[:-1], f"{min(max(float(r[-1]), -0.8), 0.8)}"] for r in rows[1:]]
    (here / "flat.csv").write_text("\n".join(",".join(r) for r in [rows[0], *flat]) + "\n")
    (here / "few.csv").write_text(rig_texts(strokes=4)[0])
    (here / "text.csv").write_text("not a measurement\n")
    motion = {"reach_deg": 60.0, "speed_deg_s": 30.0, "crossings": 2, "rate_hz": 100.0}
    t, angle, sign = tb038_records.turning(**motion)
    for i in (1, 2, 3):
        sound = tb038_records.torque(angle, sign, seed=i)
        tb038_records.write_csv(here / f"good{i}.csv", t, angle, sound)
        tb038_records.write_csv(here / f"bad{i}.csv", t, angle, 2.5 * sound)
        tb038_records.write_csv(here / f"turned{i}.csv", t, angle, -sound)
    return here


GOOD = "good1.csv good2.csv good3.csv"

TABLE = [
    (0, "--version"),
    (0, "--help"),
    (0, "study --help"),
    (0, "explain"),
    (0, "explain stribeck"),
    (0, f"tb038 {GOOD}"),
    (0, "compare run.csv.gz --model rig"),
    (0, "fit run.csv.gz --model rig --add stiffness"),
    (0, "diagnose run.csv.gz --model rig"),
    (0, "study run.csv.gz --model rig --max-effects 0"),
    (1, "tb038 bad1.csv bad2.csv bad3.csv"),
    (2, "tb038 good1.csv"),
    (2, "diagnose few.csv --model rig"),
    (2, "study few.csv --model rig"),
    (2, "diagnose cut.csv.gz --model rig"),
    (2, "study run.csv.gz cut.csv.gz --model rig"),
    (2, "study run.csv.gz --held-out cut.csv.gz --model rig"),
    (2, "study gap.csv --model rig"),
    (2, "study hole.csv --model rig"),
    (2, "study flat.csv --model rig"),
    (2, "diagnose flat.csv --model rig"),
    (0, "compare flat.csv --model rig"),
    (3, ""),
    (3, "fit turned1.csv --model rig"),
    (3, "study turned1.csv turned2.csv --model rig"),
    (3, "stdy run.csv.gz"),
    (3, "study run.csv.gz --model rig --fast"),
    (3, "study --model rig"),
    (3, "study run.csv.gz"),
    (3, "study run.csv.gz --model rig --max-effects -1"),
    (3, "study run.csv.gz --model rig --band much"),
    (3, "study run.csv.gz --model rigg"),
    (3, "study none.csv --model rig"),
    (3, "study . --model rig"),
    (3, "study text.csv --model rig"),
    (3, "study run.csv.gz --model rig --report nowhere/report.html"),
    (3, "study run.csv.gz --held-out run.csv.gz --model rig"),
    (3, "compare cut.csv.gz --model rig"),
    (3, "fit cut.csv.gz --model rig"),
    (3, "fit run.csv.gz --model rig --add stribek"),
    (3, "explain stribek"),
    (3, "tb038 turned1.csv turned2.csv turned3.csv"),
    (3, f"tb038 {GOOD} --link-distance-m 0"),
    (3, "demo --out run.csv.gz"),
]


@pytest.mark.parametrize(("code", "words"), TABLE, ids=[f"{code} {words}" for code, words in TABLE])
def test_exit_code(code: int, words: str, folder: Path, monkeypatch: pytest.MonkeyPatch, capsys) -> None:
    from luztar.cli import main

    monkeypatch.chdir(folder)
    assert main(words.split()) == code
    out, err = capsys.readouterr()
    assert "Traceback" not in err
    if code == 3:
        assert not out
        assert "error: " in err or not words
        assert str(Path.cwd()) not in err
    else:
        assert out or code == 2


def test_the_process_ends_with_the_code_that_main_returns(folder: Path) -> None:
    assert luztar("tb038", *GOOD.split(), folder=folder).code == 0
    assert luztar("tb038", "bad1.csv", "bad2.csv", "bad3.csv", folder=folder).code == 1
    assert luztar("tb038", "good1.csv", folder=folder).code == 2
    assert luztar("tb038", "none.csv", folder=folder).code == 3


def test_a_fault_of_the_program_is_4_and_asks_for_a_report(
    folder: Path, monkeypatch: pytest.MonkeyPatch, capsys
) -> None:
    import luztar as package
    from luztar.cli import main

    def fails(*_: object, **__: object) -> None:
        raise RuntimeError("a fault")

    monkeypatch.setattr(package.tb038, "evaluate", fails)
    monkeypatch.chdir(folder)
    assert main(["tb038", "good1.csv"]) == 4
    out, err = capsys.readouterr()
    assert not out
    assert "a fault" in err and package.__version__ in err and "report" in err and "Traceback" not in err
    assert main(["tb038", "good1.csv", "--debug"]) == 4
    assert "Traceback" in capsys.readouterr().err


def test_an_interrupt_is_130_with_one_word(folder: Path, monkeypatch: pytest.MonkeyPatch, capsys) -> None:
    import luztar as package
    from luztar.cli import main

    def interrupted(*_: object, **__: object) -> None:
        raise KeyboardInterrupt

    monkeypatch.setattr(package.tb038, "evaluate", interrupted)
    monkeypatch.chdir(folder)
    assert main(["tb038", "good1.csv"]) == 130
    assert capsys.readouterr() == ("", "stopped\n")


@pytest.mark.skipif(sys.platform == "win32", reason="a process is interrupted in another way there")
def test_a_running_study_stops_at_once_when_interrupted(folder: Path) -> None:
    import signal
    import subprocess
    import time

    # Six runs take long enough to be interrupted in the middle.
    runs = rig_texts({"stribeck": {"extra_nm": 0.3, "speed_rad_s": 0.1}}, runs=6)
    names = []
    for i, one in enumerate(runs):
        names.append(f"long{i}.csv")
        (folder / names[-1]).write_text(one)
    # Before the program has started, an interrupt is Python's own to answer: the word says that it has.
    started = "import sys; from luztar.cli import main; print('started', file=sys.stderr, flush=True); sys.exit(main())"
    command = [sys.executable, "-c", started, "study", *names, "--model", "rig", "--json"]
    process = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, cwd=folder)
    assert process.stderr is not None and process.stderr.readline() == "started\n"
    time.sleep(1.0)
    process.send_signal(signal.SIGINT)
    sent = time.monotonic()
    out, err = process.communicate(timeout=20)
    assert process.returncode == 130, err
    assert time.monotonic() - sent < 2.0
    assert (out, err) == ("", "stopped\n")
