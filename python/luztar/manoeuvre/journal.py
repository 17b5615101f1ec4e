"""Finished cells of a study in a file, one JSON line each: an interrupted study goes on where it was."""

from __future__ import annotations

import hashlib
import json
import os
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

from .. import _core
from ..errors import ParameterError

SCHEMA = 1


class Journal:
    """Keeps the cells of one study.

    A float is written with all its digits, so that a cell that is read is bit by bit the one that was computed. A last
    line that is not whole, left by a process that was ended while it wrote, is dropped.

    Parameters
    ----------
    path : path or None
        None keeps the cells in memory only.
    study : mapping
        What the cells depend on; a file of another study or another version of luztar is refused.

    Raises
    ------
    ParameterError
        The file is of another study, or no journal, or cannot be opened.
    """

    def __init__(self, path: str | os.PathLike[str] | None, study: Mapping[str, Any]) -> None:
        self.path = None if path is None else Path(path)
        self.cells: dict[str, Any] = {}
        text = json.dumps(study, sort_keys=True, allow_nan=False)
        self.head = {"schema": SCHEMA, "luztar": _core.__version__, "study": hashlib.sha256(text.encode()).hexdigest()}
        self.found = 0
        if self.path is None:
            return
        try:
            if self.path.exists() and self.path.stat().st_size:
                self._read(self.path)
            else:
                self._append(self.head)
        except (OSError, UnicodeDecodeError) as problem:
            reason = getattr(problem, "strerror", None) or str(problem)
            raise ParameterError(f"{self.path} cannot be used: {reason}", "journal", "Name another file.") from None

    def cell(self, key: str, compute: Callable[[], Any]) -> Any:
        """Return a cell: from the file where it is there, else computed and written."""
        if key not in self.cells:
            value = compute()
            self._append({"cell": key, "value": value})
            # What was just computed goes the same way as what is read.
            self.cells[key] = json.loads(json.dumps(value, allow_nan=False))
        return self.cells[key]

    def _append(self, line: Mapping[str, Any]) -> None:
        text = json.dumps(line, allow_nan=False)
        if self.path is None:
            return
        with self.path.open("a", encoding="utf-8", newline="\n") as file:
            file.write(f"{text}\n")
            file.flush()
            os.fsync(file.fileno())

    def _read(self, path: Path) -> None:
        remedy = "Name another file, or delete this one to begin anew."
        lines = path.read_bytes().split(b"\n")
        whole, rest = lines[:-1], lines[-1]
        try:
            made = [json.loads(line) for line in whole]
        except ValueError:
            raise ParameterError(f"{path} is no journal of a study", "journal", remedy) from None
        if not made or not all(isinstance(line, dict) for line in made) or "study" not in made[0]:
            raise ParameterError(f"{path} is no journal of a study", "journal", remedy)
        if not all(isinstance(line.get("value"), (dict, list)) for line in made[1:] if "cell" in line):
            raise ParameterError(f"{path} holds a cell without a value", "journal", remedy)
        if made[0] != self.head:
            other = made[0].get("luztar") if made[0].get("luztar") != self.head["luztar"] else None
            what = f"luztar {other}" if other else "another study"
            raise ParameterError(f"{path} is the journal of {what}", "journal", remedy)
        if rest:
            with path.open("r+b") as file:
                file.truncate(path.stat().st_size - len(rest))
        self.cells = {line["cell"]: line["value"] for line in made[1:] if "cell" in line}
        self.found = len(self.cells)
