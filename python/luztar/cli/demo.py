"""The demo: the whole way from run files to a named effect, on runs that come with luztar."""

from __future__ import annotations

import shlex
from importlib import resources
from pathlib import Path

from ..errors import ParameterError
from . import exits
from .output import as_json, say, tell
from .progress import bar

RUNS = ("run1.csv.gz", "run2.csv.gz", "run3.csv.gz")
# What was put into the simulated runs; its bytes also tell a folder of the demo from any other.
TRUTH = "truth.json"
REPORT = "report.html"
STUDY = "study.json"


def run_demo(out: str, json_wanted: bool) -> int:
    """Copy the bundled runs into a folder, check them, study them, and say where the results are.

    Parameters
    ----------
    out : str
        The folder. Made where it is missing; only the demo's own files are written in it.
    json_wanted : bool
        Print one JSON object in place of the text.
    """
    from ..diagnosis import study
    from ..measurement import read
    from ..model import Model
    from ..tb038 import evaluate

    if not out.strip():
        raise ParameterError("the folder has no name", "--out", "Name one: --out luztar-demo.")
    folder = Path(out)
    _lay_out(folder)
    from ..report import write_report

    with bar() as progress:
        runs = read([folder / name for name in RUNS])
        check = evaluate(runs)
        result = study(Model.rig(), runs, progress=progress)
    try:
        write_report(folder / REPORT, study=result, check=check)
        (folder / STUDY).write_text(as_json(result.to_dict()) + "\n", encoding="utf-8")
    except OSError as error:
        raise _cannot_write(folder, error) from None
    if json_wanted:
        tell(f"report: {(folder / REPORT).as_posix()}")
        files = [(folder / name).as_posix() for name in (*RUNS, TRUTH, REPORT, STUDY)]
        say({"schema": 1, "files": files, "tb038": check.to_dict(), "study": result.to_dict()})
    else:
        say(_text(folder, check, result))
    return exits.DONE


def _text(folder: Path, check: object, result: object) -> str:
    runs = shlex.join((folder / name).as_posix() for name in RUNS)
    return "\n".join(
        [
            "1. Is the friction within the limits? (luztar tb038)",
            "",
            str(check),
            "",
            "2. Is a model of offset, Coulomb and viscous friction enough? (luztar study --model rig)",
            "",
            str(result),
            "",
            f"What was hidden in the runs stands in {(folder / TRUTH).as_posix()}.",
            f"Look at    {(folder / REPORT).as_posix()}  (open it in a browser)",
            f"           {(folder / STUDY).as_posix()}",
            f"Try        luztar study {runs} --model rig",
        ]
    )


def _lay_out(folder: Path) -> None:
    """Write the runs and their truth.

    Raises
    ------
    ParameterError
        Where that would overwrite a file that is not the demo's.
    """
    source = resources.files("luztar") / "demo_data"
    content = {name: (source / name).read_bytes() for name in (*RUNS, TRUTH)}
    if folder.exists() and not folder.is_dir():
        raise ParameterError(f"{folder.as_posix()} is a file", "--out", "Name a folder.")
    truth = folder / TRUTH
    if not (truth.is_file() and truth.read_bytes() == content[TRUTH]):
        # Not laid out by a demo before: a measurement may well be called run1.csv.gz.
        for name in (*RUNS, TRUTH, REPORT, STUDY):
            if (folder / name).exists():
                raise ParameterError(
                    f"{(folder / name).as_posix()} is not a file of the demo",
                    "--out",
                    "Name another folder; nothing was written.",
                )
    try:
        folder.mkdir(parents=True, exist_ok=True)
        for name, data in content.items():
            (folder / name).write_bytes(data)
    except OSError as error:
        raise _cannot_write(folder, error) from None


def _cannot_write(folder: Path, error: OSError) -> ParameterError:
    reason = error.strerror or str(error)
    return ParameterError(f"{folder.as_posix()} cannot be written: {reason}", "--out", "Name another folder.")
