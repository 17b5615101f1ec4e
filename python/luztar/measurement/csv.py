"""Delimited text: find the separator, the decimal mark, the header and the units, then read the rows."""

from __future__ import annotations

import re
from collections.abc import Callable, Sequence
from dataclasses import dataclass

from ..errors import MeasurementError
from . import units as _units
from .headers import parse_header
from .lines import Block, is_missing, is_number, split
from .rows import read_rows
from .table import Loaded, Table

# The first row of numbers must stand within so many lines; more would be no preamble but another kind of file.
PREVIEW_LINES = 400
PREVIEW_BYTES = 1 << 20

_SEPARATORS = ("\t", ";", ",")
_COMMENT = re.compile(r"\s*(#|%|//)+\s*")
_RATE = re.compile(
    r"sampl\w*[ _]*(?:rate|frequency)?[ _]*(?:\[|\()?(hz|khz)?(?:\]|\))?\s*[=:;,\t]\s*([\d.]+)\s*(hz|khz)?", re.I
)


@dataclass(frozen=True)
class Dialect:
    """How a delimited file is written.

    Attributes
    ----------
    separator, decimal : str
    headers : tuple of str
    unit_row : tuple of str or None
    header_line, first_line : int
        Lines of the header and of the first row, from 1.
    """

    separator: str
    decimal: str
    headers: tuple[str, ...]
    unit_row: tuple[str, ...] | None
    header_line: int
    first_line: int


def table_from_text(data: bytes, where: str, *, sha256: str | None, broken_off: bool) -> Table:
    """Read the head of a delimited file.

    Parameters
    ----------
    data : bytes
        UTF-8 text with LF line ends.
    where : str
        The file, for messages.
    sha256 : str or None
    broken_off : bool
        Whether the bytes are known to end too early.

    Raises
    ------
    MeasurementError
        Where there is no header, no row of numbers, or more than one way to read it.
    """
    head = data[:PREVIEW_BYTES]
    lines = head.decode("utf-8", "replace").split("\n")
    if len(data) > len(head):
        lines.pop()
    dialect = sniff(lines[:PREVIEW_LINES], where)
    offset = 0
    for _ in range(dialect.first_line - 1):
        offset = data.index(b"\n", offset) + 1
    rows = data[offset:]
    decimal = dialect.decimal
    if decimal == "?":
        # The numbers seen so far are whole; the first mark in the rows settles it.
        decimal = "," if dialect.separator != "," and b"," in rows and b"." not in rows else "."
    columns = [
        parse_header(i, header, dialect.unit_row[i] if dialect.unit_row else None)
        for i, header in enumerate(dialect.headers)
    ]
    block = Block(
        rows, dialect.separator, decimal, len(columns), dialect.first_line, where, dialect.headers, None, broken_off
    )
    return Table(columns, loader(block), where, sha256, _declared_rate(lines[: dialect.header_line - 1]))


def loader(block: Block, rows_declared: int | None = None) -> Callable[[Sequence[int]], Loaded]:
    """Return the function that turns the columns asked for into numbers."""

    def load(use: Sequence[int]) -> Loaded:
        read = read_rows(block, use)
        return Loaded(
            read.values, read.complete, read.findings, lambda row: f"line {int(read.lines[row])}", rows_declared
        )

    return load


def _declared_rate(preamble: Sequence[str]) -> float | None:
    for line in preamble:
        found = _RATE.search(line)
        if found and (found[1] or found[3]) and is_number(found[2]) and float(found[2]) > 0.0:
            return float(found[2]) * (1000.0 if (found[1] or found[3]).lower() == "khz" else 1.0)
    return None


def sniff(lines: Sequence[str], where: str) -> Dialect:
    """Find out how the file is written, from its first lines."""
    if not any(line.strip() for line in lines):
        raise MeasurementError("the file is empty", where, "Export the record again.")
    found = None
    for with_text in (False, True):
        for separator in _SEPARATORS:
            first = _first_row(lines, separator, with_text)
            if first is not None and (found is None or first[1] > found[1][1]):
                found = (separator, first)
        if found is not None:
            break
    if found is None:
        raise MeasurementError(
            f"no row of numbers in the first {len(lines)} lines",
            where,
            "The file must be text with a header and columns between commas, semicolons or tabs.",
        )
    separator, (row, n_fields) = found
    header_at, unit_row = _header_above(lines, row, separator, where)
    headers = _header_fields(lines[header_at], separator)
    if len(headers) == n_fields + 1 and not headers[-1]:
        headers = headers[:-1]
    if len(headers) + 1 == n_fields and not split(lines[row], separator)[-1]:
        headers = [*headers, ""]
    first_bad = row
    for i in range(header_at + (2 if unit_row else 1), row):
        if lines[i].strip() and not _COMMENT.match(lines[i]):
            first_bad = i
            break
    if len(headers) != n_fields:
        remedy = "Give every column a name."
        if separator == "," and n_fields > len(headers):
            remedy = "If the numbers have decimal commas, export with semicolons between the columns."
        raise MeasurementError(
            f"{n_fields} fields where the header (line {header_at + 1}) has {len(headers)}",
            f"{where}, line {row + 1}",
            remedy,
        )
    if unit_row is not None:
        unit_row = (unit_row + [""] * n_fields)[:n_fields]
    return Dialect(
        separator,
        _decimal(lines[row:], separator, row, where),
        tuple(headers),
        tuple(unit_row) if unit_row is not None else None,
        header_at + 1,
        first_bad + 1,
    )


def _header_fields(line: str, separator: str) -> list[str]:
    return split(_COMMENT.sub("", line, count=1) if _COMMENT.match(line) else line, separator)


def _first_row(lines: Sequence[str], separator: str, with_text: bool) -> tuple[int, int] | None:
    """Return the first line that is a row of numbers, and its number of fields.

    ``with_text`` allows columns of text (clock, status) beside at least two of numbers; the next line must be like it.
    """
    for i, line in enumerate(lines):
        if not line.strip():
            continue
        fields = split(line, separator)
        numbers = sum(is_number(f) or is_number(f, ",") for f in fields)
        rest = sum(is_missing(f) for f in fields)
        following = next((split(later, separator) for later in lines[i + 1 :] if later.strip()), None)
        if with_text:
            if numbers >= 2 and following is not None and len(following) == len(fields):
                more = sum(is_number(f) or is_number(f, ",") for f in following)
                if more >= 2:
                    return i, len(fields)
        elif numbers and numbers + rest == len(fields) and 2 * numbers >= len(fields):
            if following is not None and len(following) != len(fields) and len(fields) == 1:
                # A lone number in a preamble.
                continue
            return i, len(fields)
    return None


def _header_above(lines: Sequence[str], row: int, separator: str, where: str) -> tuple[int, list[str] | None]:
    above = [i for i in range(row) if lines[i].strip()]
    if not above:
        raise MeasurementError(
            "there is no header: the first line is numbers",
            f"{where}, line {row + 1}",
            "Add a line with names and units, such as time_s,angle_deg,torque_Nm.",
        )
    at = above[-1]
    fields = _header_fields(lines[at], separator)
    # A line with numbers among its fields is a damaged row, and the header stands above it.
    while len(above) > 1 and len(fields) > 1 and any(is_number(f) or is_number(f, ",") for f in fields):
        above.pop()
        at = above[-1]
        fields = _header_fields(lines[at], separator)
    if len(above) > 1:
        names = _header_fields(lines[above[-2]], separator)
        inside = [f for f in fields if f]
        known = sum(_units.find(f) is not None for f in inside)
        bracketed = bool(inside) and all(re.fullmatch(r"[\[(].*[\])]", f) for f in inside)
        named = len(names) == len(fields) and all(name for name, unit in zip(names, fields, strict=True) if unit)
        if named and (bracketed or 2 * known > len(inside)):
            return above[-2], fields
    return at, None


def _decimal(lines: Sequence[str], separator: str, row: int, where: str) -> str:
    if separator == ",":
        if any('"' in line for line in lines):
            fields = [f for line in lines for f in split(line, separator)]
            if any("," in f and is_number(f, ",") for f in fields):
                return ","
        return "."
    comma = point = None
    for i, line in enumerate(lines):
        for f in split(line, separator):
            if "," in f and is_number(f, ","):
                comma = i if comma is None else comma
            if "." in f and is_number(f):
                point = i if point is None else point
    if comma is not None and point is not None:
        raise MeasurementError(
            "decimal points and decimal commas in one file",
            f"{where}, lines {row + point + 1} and {row + comma + 1}",
            "Export with one decimal mark and no thousands separators.",
        )
    return "," if comma is not None else "." if point is not None else "?"
