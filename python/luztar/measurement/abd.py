"""The text export of AB Dynamics steering robots.

cp1252, tabs; line 1 a description, line 2 ``Points=N``, line 3 names, line 4 units, then N rows, then lines that are no
data.
"""

from __future__ import annotations

import re

from ..errors import MeasurementError
from .columns import parse_header
from .csv import loader
from .rows import Block
from .table import Table

_POINTS = re.compile(rb"\s*Points\s*=\s*([^\t\r\n]*?)\s*\Z", re.IGNORECASE)

# More rows than a file of the largest size can hold: a damaged number, not a count.
_MOST_ROWS = 10**10


def is_export(raw: bytes) -> bool:
    """Whether the second line declares ``Points=``."""
    lines = raw[:65536].splitlines()
    return len(lines) > 1 and _POINTS.match(lines[1]) is not None


def table_from_export(raw: bytes, where: str, *, sha256: str | None, broken_off: bool) -> Table:
    """Read the head of an export.

    Raises
    ------
    MeasurementError
        Where ``Points`` is no count, or the names and units are missing.
    """
    if raw.startswith(b"\xef\xbb\xbf"):
        raw = raw[3:]
    try:
        text = raw.decode("utf-8")
    except UnicodeDecodeError:
        text = raw.decode("cp1252", "replace")
    data = text.encode().replace(b"\r\n", b"\n").replace(b"\r", b"\n")
    lines = data.split(b"\n", 4)
    found = _POINTS.match(lines[1])
    assert found is not None
    points = found[1].decode("utf-8", "replace")
    if not (points.isascii() and points.isdigit()) or not 0 < int(points) < _MOST_ROWS:
        raise MeasurementError(
            f"Points={points} is not a number of rows", f"{where}, line 2", "Export the record again."
        )
    if len(lines) < 5:
        raise MeasurementError("the file ends before its first row", where, "Export the record again.")
    names = [n.strip() for n in lines[2].decode().split("\t")]
    units = [u.strip() for u in lines[3].decode().split("\t")]
    while names and not names[-1]:
        names.pop()
    units += [""] * (len(names) - len(units))
    first = lines[4].split(b"\n", 1)[0].decode().split("\t")
    n_fields = len(first)
    if n_fields < len(names) or any(f.strip() for f in first[len(names) :]):
        raise MeasurementError(
            f"{n_fields} fields where line 3 names {len(names)}", f"{where}, line 5", "Export the record again."
        )
    headers = names + [""] * (n_fields - len(names))
    columns = [parse_header(i, name, units[i] or None) for i, name in enumerate(names)]
    decimal = "," if any("," in f and "." not in f for f in first) else "."
    block = Block(lines[4], "\t", decimal, n_fields, 5, where, headers, int(points), broken_off)
    return Table(columns, loader(block, int(points)), where, sha256)
