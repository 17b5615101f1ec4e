"""The lines of a delimited block, and what each of them is: a row, a damaged row, the beginning of one, or text."""

from __future__ import annotations

import csv
import re
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

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
PLAIN = re.compile(r"[+-]?\d*(?:\.(?P<decimals>\d*))?(?:[eE](?P<exponent>[+-]?\d*))?\Z")


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


def split(line: str, separator: str) -> list[str]:
    """Return the fields of one line, quotes taken off, blanks around them too."""
    if '"' in line:
        try:
            return [field.strip() for field in next(csv.reader([line], delimiter=separator), [])]
        except csv.Error:
            # A quote that never ends, in what is no table at all: its fields are text either way.
            pass
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


class Lines:
    """The lines of a block, looked at one by one only where something is odd.

    Parameters
    ----------
    block : Block
    use : sequence of int
        The fields that are read.

    Attributes
    ----------
    data : bytes
        The block without quotes.
    separator : str
        Between the fields of ``data``.
    starts, ends : ndarray of int
        Of every line in ``data``.
    n : int
        Lines up to the last that is not blank.
    terminated : bool
        Whether the last of them has its line end.
    """

    def __init__(self, block: Block, use: Sequence[int]) -> None:
        self.block = block
        self.use = sorted(set(use))
        self.separator = "\x1f" if b'"' in block.data else block.separator
        self.data = _unquoted(block)
        self.starts, self.ends = _bounds(self.data)
        self.n = int(self.starts.size)
        self.terminated = self.data.endswith(b"\n") or not self.data
        while self.n and not self.text(self.n - 1).strip():
            self.n -= 1
            self.terminated = True

    def text(self, i: int) -> str:
        """Return line ``i``."""
        return self.data[int(self.starts[i]) : int(self.ends[i])].decode("utf-8", "replace")

    def fields(self, i: int) -> list[str]:
        """Return the fields of line ``i``, without blanks around them."""
        return [field.strip() for field in self.text(i).split(self.separator)]

    def is_row(self, i: int) -> bool:
        """Whether line ``i`` has all its fields, and numbers or missing values in those that are read."""
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
        fields, decimal = self.fields(i), self.block.decimal
        last = len(fields) - 1
        if last >= self.block.n_fields:
            return False
        first_is_number = is_number(self.fields(0)[0], decimal)
        for k, field in enumerate(fields[:-1]):
            wanted = k in self.use or (k == 0 and first_is_number)
            if wanted and not is_number(field, decimal) and not is_missing(field):
                return False
        if last not in self.use and not (last == 0 and first_is_number):
            # Text may stand here; alone it says nothing.
            return last > 0
        rest = fields[-1].replace(decimal, ".")
        return rest == "" or PLAIN.match(rest) is not None or any(m.startswith(rest) for m in MISSING)

    def line(self, i: int) -> int:
        """Return the line number in the file, from 1."""
        return int(i) + self.block.first_line


def _unquoted(block: Block) -> bytes:
    """Take quotes off and keep their meaning: rewritten with a separator that no field can hold."""
    if b'"' not in block.data:
        return block.data
    lines = block.data.decode("utf-8", "replace").split("\n")
    return "\n".join("\x1f".join(split(line, block.separator)) for line in lines).encode()


def _bounds(data: bytes) -> tuple[np.ndarray, np.ndarray]:
    breaks = np.flatnonzero(np.frombuffer(data, np.uint8) == 10)
    starts = np.concatenate(([0], breaks + 1))
    ends = np.concatenate((breaks, [len(data)]))
    if starts.size and starts[-1] == len(data):
        starts, ends = starts[:-1], ends[:-1]
    return starts, ends
