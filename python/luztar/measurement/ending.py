"""Where the data of a file end, and whether they end too early."""

from __future__ import annotations

import numpy as np

from ..errors import MeasurementError
from .integrity import Finding
from .lines import PLAIN, Lines, is_missing, is_number

# How many rows before the last are looked at to tell how its numbers are usually written.
_WRITING_ROWS = 1000


def undeclared(lines: Lines, findings: list[Finding]) -> tuple[int, bool]:
    """Find the end of the data in a file that does not declare its rows."""
    block, n_lines, terminated = lines.block, lines.n, lines.terminated
    complete = not block.broken_off
    end = n_lines
    if n_lines and not terminated:
        reason = _looks_cut(lines, n_lines - 1)
        line = n_lines - 1 + block.first_line
        if reason and lines.begins_like_a_row(n_lines - 1):
            findings.append(
                Finding("cut", f"the file ends in the middle of line {line} ({reason}); it was left out", True)
            )
            complete = False
            end -= 1
        elif block.broken_off:
            end -= 1
        else:
            text = f"the last line ({line}) has no line end; if the file was cut there, its last number may be short"
            findings.append(Finding("note", text, False))
    data_end = end
    while data_end and not lines.is_row(data_end - 1) and not lines.is_damaged_row(data_end - 1):
        data_end -= 1
        if end - data_end > 100_000:
            line = data_end + block.first_line
            raise MeasurementError(
                "more than 100000 lines after the data are no rows", f"{block.where}, line {line}", "Remove them."
            )
    if data_end < end:
        tail = range(data_end, end)
        short = [i for i in tail if lines.text(i).strip() and lines.begins_like_a_row(i)]
        if short and data_end:
            line = short[0] + block.first_line
            findings.append(Finding("cut", f"line {line} holds only the beginning of a row; it was left out", True))
            complete = False
        a, b = data_end + block.first_line, end - 1 + block.first_line
        if data_end and len(short) < len(tail):
            findings.append(Finding("note", f"text after the data was not read (lines {a} to {b})", False))
    return data_end, complete


def declared(lines: Lines, limit: int, findings: list[Finding]) -> tuple[int, bool]:
    """Take the rows the file declares, and no line beyond them."""
    block, n_lines, terminated = lines.block, lines.n, lines.terminated
    n_rows = min(n_lines, limit)
    open_end = n_rows == n_lines and not terminated
    if n_rows == limit and lines.is_row(limit - 1) and not (open_end and _looks_cut(lines, limit - 1)):
        if open_end:
            text = "the last declared row has no line end; if the file was cut there, its last number may be short"
            findings.append(Finding("note", text, False))
        if n_lines > limit and lines.is_row(limit):
            line = limit + block.first_line
            text = f"the file declares {limit} rows and goes on with numbers at line {line}; they were not read"
            findings.append(Finding("note", text, False))
        return limit, not block.broken_off
    if open_end:
        n_rows -= 1
    while n_rows and not lines.is_row(n_rows - 1):
        n_rows -= 1
    text = f"the file declares {limit} rows and holds {n_rows}: it is cut after line {n_rows - 1 + block.first_line}"
    findings.append(Finding("cut", text, True))
    return n_rows, False


def _looks_cut(lines: Lines, i: int) -> str:
    """Return why the unterminated line ``i`` cannot be a whole row, or an empty text."""
    fields, decimal = lines.fields(i), lines.block.decimal
    if len(fields) < lines.block.n_fields:
        return f"{len(fields)} fields of {lines.block.n_fields}"
    last = fields[-1].replace(decimal, ".")
    earlier = []
    for j in range(max(0, i - _WRITING_ROWS), i):
        before = lines.fields(j)
        if len(before) == lines.block.n_fields:
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
    numbers = numbers[np.isfinite(numbers)]
    if numbers.size >= 4 and len(last) < len(earlier[-1]):
        with np.errstate(over="ignore"):
            step = float(np.abs(np.diff(numbers)).max())
        if abs(float(last) - numbers[-1]) > 3.0 * step:
            return f"{last!r} is shorter than the number above it and far from it"
    return ""


def _writing(text: str) -> tuple[int, int] | None:
    """Return the digits after the point and in the exponent; None where the text is no plain number."""
    found = PLAIN.match(text)
    if found is None or not text.strip("+-."):
        return None
    return len(found["decimals"] or ""), len((found["exponent"] or "").lstrip("+-"))
