"""From the bytes of delimited rows to columns of float64, with nothing dropped in silence.

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
from .integrity import Finding

# Words for "no value here" that loggers and spreadsheets write. Any other text in a column that is read is an error.
MISSING = (
    "",
    "-",
    "--",
    "nan",
    "NaN",
    "NAN",
    "-nan",
    "-NaN",
    "na",
    "NA",
    "n/a",
    "N/A",
    "#N/A",
    "#NV",
    "#NUM!",
    "#VALUE!",
    "null",
    "NULL",
    "None",
    "-nan(ind)",
    "nan(ind)",
    "1.#QNAN",
    "-1.#QNAN",
    "1.#IND",
    "-1.#IND",
    "1.#INF",
    "-1.#INF",
)
_MISSING = frozenset(MISSING)

_NUMBER = re.compile(r"[+-]?((\d+\.?\d*|\.\d+)([eE][+-]?\d+)?|inf|Inf|INF|infinity|Infinity)\Z")
_PLAIN = re.compile(r"[+-]?\d*(?:\.(?P<decimals>\d*))?(?:[eE](?P<exponent>[+-]?\d*))?\Z")

# How many rows before the last are looked at to tell how its numbers are usually written.
_WRITING_ROWS = 1000


@dataclass(frozen=True)
class Block:
    """The rows of a file, before they are numbers.

    Attributes
    ----------
    data : bytes
        Lines ending in LF, from the first row to the end of the file.
    separator : str
        One character.
    decimal : str
        ``"."`` or ``","``.
    n_fields : int
        Fields per row.
    first_line : int
        The line number of the first row in the file, from 1.
    where : str
        The file, for messages.
    headers : sequence of str
        One per field, for messages.
    limit : int or None
        The number of rows the file declares; what follows them is not data.
    broken_off : bool
        Whether the file is already known to end too early (a truncated archive).
    """

    data: bytes
    separator: str
    decimal: str
    n_fields: int
    first_line: int
    where: str
    headers: Sequence[str]
    limit: int | None = None
    broken_off: bool = False


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


def split(line: str, separator: str) -> list[str]:
    """Return the fields of one line, quotes taken off, blanks around them too."""
    if '"' in line:
        return [field.strip() for field in next(csv.reader([line], delimiter=separator), [])]
    return [field.strip() for field in line.split(separator)]


def is_number(text: str, decimal: str = ".") -> bool:
    """Whether ``text`` is one number, written with this decimal mark."""
    if decimal == ",":
        if "." in text:
            return False
        text = text.replace(",", ".")
    return bool(_NUMBER.match(text))


def is_missing(text: str) -> bool:
    """Whether ``text`` says that there is no value."""
    return text in _MISSING


def read_rows(block: Block, use: Sequence[int]) -> Columns:
    """Turn the fields ``use`` of every row into numbers.

    Raises
    ------
    MeasurementError
        Names the line, and the column where it is one, of a row that is no row or a field that is no number.
    """
    data = _unquoted(block)
    starts, ends = _lines(data)
    body = _Body(block, data, starts, ends, sorted(set(use)))
    findings: list[Finding] = []
    complete = not block.broken_off
    n_lines = starts.size
    terminated = data.endswith(b"\n") if data else True
    while n_lines and not body.text(n_lines - 1).strip():
        n_lines -= 1
        terminated = True
    if block.limit is None:
        n_lines, complete = _without_tail(body, n_lines, terminated, complete, findings)
    else:
        n_lines, complete = _declared(body, n_lines, block.limit, terminated, complete, findings)
    if block.broken_off:
        findings.append(Finding("cut", f"the file breaks off after {n_lines} whole lines of data", True))
    keep = body.wanted_lines(n_lines, findings)
    if keep.size < 2:
        raise MeasurementError(
            f"the file holds {keep.size} whole row{'' if keep.size == 1 else 's'} of numbers",
            block.where,
            "Export the record again.",
        )
    return Columns(body.numbers(keep), int(keep.size), keep + block.first_line, complete, findings)


def _unquoted(block: Block) -> bytes:
    """Take quotes off and keep their meaning: rewritten with a separator that no field can hold."""
    if b'"' not in block.data:
        return block.data
    lines = block.data.decode("utf-8", "replace").split("\n")
    return "\n".join("\x1f".join(split(line, block.separator)) for line in lines).encode()


def _lines(data: bytes) -> tuple[np.ndarray, np.ndarray]:
    breaks = np.flatnonzero(np.frombuffer(data, np.uint8) == 10)
    starts = np.concatenate(([0], breaks + 1))
    ends = np.concatenate((breaks, [len(data)]))
    if starts.size and starts[-1] == len(data):
        starts, ends = starts[:-1], ends[:-1]
    return starts, ends


def _exact(version: str) -> dict[str, Any]:
    """Ask pandas for correctly rounded numbers: the default since 3.1, off by a unit in the last place before."""
    major, minor = (int(part) for part in version.split(".")[:2])
    return {} if (major, minor) >= (3, 1) else {"float_precision": "round_trip"}


class _Body:
    """The lines of a block, looked at one by one only where something is odd."""

    def __init__(self, block: Block, data: bytes, starts: np.ndarray, ends: np.ndarray, use: list[int]) -> None:
        self.block, self.data, self.starts, self.ends, self.use = block, data, starts, ends, use
        self.separator = "\x1f" if b'"' in block.data else block.separator

    def text(self, i: int) -> str:
        return self.data[int(self.starts[i]) : int(self.ends[i])].decode("utf-8", "replace")

    def fields(self, i: int) -> list[str]:
        return [field.strip() for field in self.text(i).split(self.separator)]

    def is_row(self, i: int) -> bool:
        fields = self.fields(i)
        if len(fields) != self.block.n_fields:
            return False
        used = [fields[k] for k in self.use]
        return all(is_number(f, self.block.decimal) or is_missing(f) for f in used) and any(used)

    def is_damaged_row(self, i: int) -> bool:
        """Whether the line has the fields of a row and some of its numbers: "0.03;over", not "Mean;1.2"."""
        fields = self.fields(i)
        if len(fields) != self.block.n_fields:
            return False
        first = is_number(fields[0], self.block.decimal) == is_number(self.fields(0)[0], self.block.decimal)
        return first and any(is_number(fields[k], self.block.decimal) for k in self.use)

    def begins_like_a_row(self, i: int) -> bool:
        """Whether the line can be the beginning of a row: no text where a number should stand."""
        fields = self.fields(i)
        if len(fields) > self.block.n_fields:
            return False
        whole = fields[:-1]
        if not all(is_number(f, self.block.decimal) or is_missing(f) for f in whole):
            return False
        rest = fields[-1].replace(self.block.decimal, ".")
        return rest == "" or _PLAIN.match(rest) is not None or any(m.startswith(rest) for m in MISSING)

    def wanted_lines(self, n_lines: int, findings: list[Finding]) -> np.ndarray:
        """Return the indices of the rows; blank and comment lines between them are left out, with a finding."""
        keep = np.arange(n_lines)
        if not n_lines:
            return keep
        raw = np.frombuffer(self.data, np.uint8)
        first = raw[np.minimum(self.starts[:n_lines], raw.size - 1)]
        odd = (first == 10) | (first == 35) | (first == 37)
        if self.separator != "\t":
            odd |= (first == 32) | (first == 9)
        skip = [i for i in np.flatnonzero(odd).tolist() if not self.text(i).strip() or self.text(i).lstrip()[0] in "#%"]
        if skip:
            at = ", ".join(str(i + self.block.first_line) for i in skip[:10])
            more = f" and {len(skip) - 10} more" if len(skip) > 10 else ""
            findings.append(Finding("note", f"blank or comment lines between the rows: {at}{more}", False))
            keep = np.delete(keep, skip)
        return keep

    def numbers(self, keep: np.ndarray) -> dict[int, np.ndarray]:
        import pandas as pd

        self._count_fields(keep)
        last = int(keep[-1])
        if keep.size == last + 1:
            body = self.data[: int(self.ends[last])]
        else:
            body = b"\n".join(self.data[int(self.starts[i]) : int(self.ends[i])] for i in keep)
        if self.block.decimal == ",":
            if b"." in body:
                self._refuse(keep)
            body = body.replace(b",", b".")
        try:
            frame = pd.read_csv(
                io.BytesIO(body),
                header=None,
                names=list(range(self.block.n_fields)),
                usecols=self.use,
                index_col=False,
                sep=self.separator,
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
            self._refuse(keep)
            raise MeasurementError(f"the rows cannot be read ({error})", self.block.where, "Export it again.") from None
        if len(frame) != keep.size:
            raise MeasurementError(
                f"{keep.size} rows were counted and {len(frame)} read", self.block.where, "Export the record again."
            )
        return {k: frame[k].to_numpy(np.float64, copy=True) for k in self.use}

    def _count_fields(self, keep: np.ndarray) -> None:
        marks = np.frombuffer(self.data, np.uint8) == ord(self.separator)
        count = np.add.reduceat(marks.view(np.uint8), self.starts, dtype=np.int32)[keep] + 1
        wrong = np.flatnonzero(count != self.block.n_fields)
        if wrong.size:
            i = int(wrong[0])
            remedy = "Repair or remove the line in a copy of the file."
            if self.separator == "," and wrong.size == keep.size:
                remedy = "If the numbers have decimal commas, export with semicolons between the columns."
            raise MeasurementError(
                f"{int(count[i])} fields where the header has {self.block.n_fields}",
                f"{self.block.where}, line {int(keep[i]) + self.block.first_line}",
                remedy,
            )

    def _refuse(self, keep: np.ndarray) -> None:
        """Raise for the first field that is neither a number nor missing."""
        for i in keep:
            fields = self.fields(int(i))
            for k in self.use:
                text = fields[k] if k < len(fields) else ""
                if is_missing(text) or is_number(text, self.block.decimal):
                    continue
                remedy = "Repair the field in a copy of the file, or leave it empty for a missing value."
                if re.fullmatch(r"[+-]?\d{1,3}([.,]\d{3})+([.,]\d+)?", text):
                    remedy = "Export without thousands separators."
                raise MeasurementError(
                    f"{text[:40]!r} is not a number",
                    f"{self.block.where}, line {int(i) + self.block.first_line}, column {self.block.headers[k]!r}",
                    remedy,
                )


def _without_tail(
    body: _Body, n_lines: int, terminated: bool, complete: bool, findings: list[Finding]
) -> tuple[int, bool]:
    """Find the end of the data in a file that does not declare its rows."""
    block = body.block
    end = n_lines
    if n_lines and not terminated:
        reason = _looks_cut(body, n_lines - 1)
        line = n_lines - 1 + block.first_line
        if reason and (body.begins_like_a_row(n_lines - 1) or block.broken_off):
            findings.append(
                Finding("cut", f"the file ends in the middle of line {line} ({reason}); it was left out", True)
            )
            complete = False
            end -= 1
        elif not reason and block.broken_off:
            end -= 1
        elif not reason:
            text = f"the last line ({line}) has no line end; if the file was cut there, its last number may be short"
            findings.append(Finding("note", text, False))
    data_end = end
    while data_end and not body.is_row(data_end - 1) and not body.is_damaged_row(data_end - 1):
        data_end -= 1
        if end - data_end > 100_000:
            line = data_end + block.first_line
            raise MeasurementError("more than 100000 lines after the data are no rows", f"{block.where}, line {line}")
    if data_end < end:
        tail = range(data_end, end)
        short = [i for i in tail if body.text(i).strip() and body.begins_like_a_row(i)]
        if short and data_end:
            line = short[0] + block.first_line
            findings.append(Finding("cut", f"line {line} holds only the beginning of a row; it was left out", True))
            complete = False
        a, b = data_end + block.first_line, end - 1 + block.first_line
        if data_end and len(short) < len(tail):
            findings.append(Finding("note", f"text after the data was not read (lines {a} to {b})", False))
        if not data_end:
            # Not one row: say what is wrong with the first line rather than that there are none.
            body._count_fields(np.arange(1))
            body._refuse(np.arange(1))
    return data_end, complete


def _declared(
    body: _Body, n_lines: int, limit: int, terminated: bool, complete: bool, findings: list[Finding]
) -> tuple[int, bool]:
    """Take the rows the file declares, and no line beyond them."""
    block = body.block
    n_rows = min(n_lines, limit)
    open_end = n_rows == n_lines and not terminated
    if n_rows == limit and body.is_row(limit - 1) and not (open_end and _looks_cut(body, limit - 1)):
        if open_end:
            text = "the last declared row has no line end; if the file was cut there, its last number may be short"
            findings.append(Finding("note", text, False))
        if n_lines > limit and body.is_row(limit):
            line = limit + block.first_line
            text = f"the file declares {limit} rows and goes on with numbers at line {line}; they were not read"
            findings.append(Finding("note", text, False))
        return limit, complete
    if open_end:
        n_rows -= 1
    while n_rows and not body.is_row(n_rows - 1):
        n_rows -= 1
    text = f"the file declares {limit} rows and holds {n_rows}: it is cut after line {n_rows - 1 + block.first_line}"
    findings.append(Finding("cut", text, True))
    return n_rows, False


def _looks_cut(body: _Body, i: int) -> str:
    """Return why the unterminated line ``i`` cannot be a whole row, or an empty text."""
    fields, decimal = body.fields(i), body.block.decimal
    if len(fields) < body.block.n_fields:
        return f"{len(fields)} fields of {body.block.n_fields}"
    last = fields[-1].replace(decimal, ".")
    earlier = []
    for j in range(max(0, i - _WRITING_ROWS), i):
        before = body.fields(j)
        if len(before) == body.block.n_fields:
            earlier.append(before[-1].replace(decimal, "."))
    if is_missing(last):
        return "" if any(text == last for text in earlier) else f"the last field is {last!r}"
    shape = _writing(last)
    if shape is None or not is_number(last):
        return f"{last[:20]!r} is not a number"
    shapes = [s for s in map(_writing, earlier) if s is not None]
    if shapes and shape[0] < min(s[0] for s in shapes):
        return f"{last!r} has fewer decimals than every number above it"
    if shapes and shape[1] < min(s[1] for s in shapes):
        return f"{last!r} has a shorter exponent than every number above it"
    numbers = np.array([float(text) for text in earlier if is_number(text)])
    if numbers.size >= 4 and len(last) < len(earlier[-1]):
        step = float(np.abs(np.diff(numbers)).max())
        if abs(float(last) - numbers[-1]) > 3.0 * step:
            return f"{last!r} is shorter than the number above it and far from it"
    return ""


def _writing(text: str) -> tuple[int, int] | None:
    """Return the digits after the point and in the exponent; None where the text is no plain number."""
    found = _PLAIN.match(text)
    if found is None or not text.strip("+-."):
        return None
    return len(found["decimals"] or ""), len((found["exponent"] or "").lstrip("+-"))
