"""The report of a command: where it may go, and what goes into it."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from ..errors import LuztarError, ParameterError
from .output import tell

if TYPE_CHECKING:
    from ..measurement import Run
    from ..model import Model


def check_place(path: str | None, inputs: Sequence[str] = ()) -> None:
    """Refuse a place that cannot be written, before the work and not after it.

    Raises
    ------
    ParameterError
        Where the folder does not exist, the path is a folder, or it is one of the files that are read.
    """
    if path is None:
        return
    place = Path(path)
    if any(place.resolve() == Path(name).resolve() for name in inputs):
        remedy = "Name a file of its own: the measurement would be lost."
        raise ParameterError(f"{path} is a file that is read", "--report", remedy)
    if place.is_dir():
        raise ParameterError(f"{path} is a folder", "--report", "Give the name of a file, such as report.html.")
    if not place.parent.is_dir():
        raise ParameterError(f"there is no folder {place.parent}", "--report", "Make it first, or name another place.")


def write(path: str, *, study: Any = None, check: Any = None) -> None:
    """Write the report and say where it is.

    Raises
    ------
    ParameterError
        Where the file cannot be written.
    """
    from ..report import write_report

    written(path, lambda: write_report(path, study=study, check=check))


def written(path: str, make: Callable[[], object]) -> None:
    """Let a page be written and say where it is.

    Raises
    ------
    ParameterError
        Where the file cannot be written.
    """
    try:
        make()
    except OSError as error:
        reason = error.strerror or str(error)
        raise ParameterError(f"{path} cannot be written: {reason}", "--report", "Name another place.") from None
    tell(f"report: {path}")


def check_of(runs: Sequence[Run], model: Model) -> Any:
    """Return the TB 038 check of all runs of a rig, held-out ones too, for the report.

    None where they cannot be checked: the report then says why.
    """
    if model.structure_name != "rig":
        return None
    from ..tb038 import evaluate

    try:
        return evaluate(runs)
    except LuztarError:
        return None
