"""From delimited rows to columns of float64, with nothing dropped in silence.

pandas turns text into numbers, but only after the rows are known to be whole: it fills short rows with NaN and cuts
long ones without an error.
"""

from __future__ import annotations

import csv
import io
import re
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from ..errors import MeasurementError
from .ending import declared, undeclared
from .integrity import Finding
from .lines import MISSING, Block, Lines, is_missing, is_number


@dataclass(frozen=True)
class Columns:
    """Columns as read: raw numbers in the file's own units.

    Attributes
    ----------
    values : dict of field index to ndarray, shape (n,)
    n : int
    lines : ndarray of int, shape (n,)
        Line number of every row.
    complete : bool
    findings : list of Finding
    """

    values: dict[int, np.ndarray]
    n: int
    lines: np.ndarray
    complete: bool
    findings: list[Finding]


def read_rows(block: Block, use: Sequence[int]) -> Columns:
    """Turn the fields ``use`` of every row into numbers.

    Raises
    ------
    MeasurementError
        Names the line, and the column where it is one, of a row that is no row or a field that is no number.
    """
    lines = Lines(block, use)
    findings: list[Finding] = []
    if block.limit is None:
        n_lines, complete = undeclared(lines, findings)
    else:
        n_lines, complete = declared(lines, block.limit, findings)
    if lines.n and not n_lines and block.limit is None and not block.broken_off:
        # Not one row: say what is wrong with the first line rather than that there are none.
        _count_fields(lines, np.arange(1))
        _refuse(lines, np.arange(1))
    if block.broken_off:
        findings.append(Finding("cut", f"the file breaks off after {n_lines} whole lines of data", True))
    keep = _wanted(lines, n_lines, findings)
    if keep.size < 2:
        raise MeasurementError(
            f"the file holds {keep.size} whole row{'' if keep.size == 1 else 's'} of numbers",
            block.where,
            "Export the record again.",
        )
    if block.limit is not None and complete and keep.size < block.limit:
        text = f"the file declares {block.limit} rows; {block.limit - keep.size} of those lines hold none"
        findings.append(Finding("cut", text, True))
        complete = False
    return Columns(_numbers(lines, keep), int(keep.size), keep + block.first_line, complete, findings)


def _wanted(lines: Lines, n_lines: int, findings: list[Finding]) -> np.ndarray:
    """Return the indices of the rows; blank and comment lines between them are left out, with a finding."""
    keep = np.arange(n_lines)
    if not n_lines:
        return keep
    raw = np.frombuffer(lines.data, np.uint8)
    first = raw[np.minimum(lines.starts[:n_lines], raw.size - 1)]
    odd = (first == 10) | (first == 35) | (first == 37)
    if lines.separator != "\t":
        odd |= (first == 32) | (first == 9)
    skip = [i for i in np.flatnonzero(odd).tolist() if not lines.text(i).strip() or lines.text(i).lstrip()[0] in "#%"]
    if skip:
        at = ", ".join(str(i + lines.block.first_line) for i in skip[:10])
        more = f" and {len(skip) - 10} more" if len(skip) > 10 else ""
        findings.append(Finding("note", f"blank or comment lines between the rows: {at}{more}", False))
        keep = np.delete(keep, skip)
    return keep


def _numbers(lines: Lines, keep: np.ndarray) -> dict[int, np.ndarray]:
    import pandas as pd

    _count_fields(lines, keep)
    last = int(keep[-1])
    if keep.size == last + 1:
        body = lines.data[: int(lines.ends[last])]
    else:
        body = b"\n".join(lines.data[int(lines.starts[i]) : int(lines.ends[i])] for i in keep)
    if lines.block.decimal == ",":
        if b"." in body:
            _refuse(lines, keep)
        body = body.replace(b",", b".")
    try:
        frame = pd.read_csv(
            io.BytesIO(body),
            header=None,
            names=list(range(lines.block.n_fields)),
            usecols=lines.use,
            index_col=False,
            sep=lines.separator,
            dtype=np.float64,
            na_values=list(MISSING),
            keep_default_na=False,
            skip_blank_lines=False,
            skipinitialspace=True,
            quoting=csv.QUOTE_NONE,
            engine="c",
            **_exact(pd.__version__),
            encoding="utf-8",
            encoding_errors="replace",
        )
    except (ValueError, OverflowError, MemoryError, pd.errors.ParserError) as error:
        _refuse(lines, keep)
        raise MeasurementError(f"the rows cannot be read ({error})", lines.block.where, "Export it again.") from None
    if len(frame) != keep.size:
        raise MeasurementError(
            f"{keep.size} rows were counted and {len(frame)} read", lines.block.where, "Export the record again."
        )
    return {k: frame[k].to_numpy(np.float64, copy=True) for k in lines.use}


def _exact(version: str) -> dict[str, Any]:
    """Ask pandas for correctly rounded numbers: the default since 3.1, off by a unit in the last place before."""
    major, minor = (int(part) for part in version.split(".")[:2])
    return {} if (major, minor) >= (3, 1) else {"float_precision": "round_trip"}


def _count_fields(lines: Lines, keep: np.ndarray) -> None:
    marks = np.frombuffer(lines.data, np.uint8) == ord(lines.separator)
    count = np.add.reduceat(marks.view(np.uint8), lines.starts, dtype=np.int32)[keep] + 1
    wrong = np.flatnonzero(count != lines.block.n_fields)
    if wrong.size:
        i = int(wrong[0])
        remedy = "Repair or remove the line in a copy of the file."
        if lines.separator == "," and wrong.size == keep.size:
            remedy = "If the numbers have decimal commas, export with semicolons between the columns."
        raise MeasurementError(
            f"{int(count[i])} fields where the header has {lines.block.n_fields}",
            f"{lines.block.where}, line {int(keep[i]) + lines.block.first_line}",
            remedy,
        )


def _refuse(lines: Lines, keep: np.ndarray) -> None:
    """Raise for the first field that is neither a number nor missing."""
    for i in keep:
        fields = lines.fields(int(i))
        for k in lines.use:
            text = fields[k] if k < len(fields) else ""
            if is_missing(text) or is_number(text, lines.block.decimal):
                continue
            remedy = "Repair the field in a copy of the file, or leave it empty for a missing value."
            if re.fullmatch(r"[+-]?\d{1,3}([.,]\d{3})+([.,]\d+)?", text):
                remedy = "Export without thousands separators."
            raise MeasurementError(
                f"{text[:40]!r} is not a number",
                f"{lines.block.where}, line {int(i) + lines.block.first_line}, column {lines.block.headers[k]!r}",
                remedy,
            )
