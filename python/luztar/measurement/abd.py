"""The text export of AB Dynamics steering robots.

cp1252, tabs; line 1 a description, line 2 ``Points=N``, line 3 names, line 4 units, then N rows, then lines that are no
data.
"""

from __future__ import annotations

import re

from ..errors import MeasurementError
from .csv import loader
from .headers import parse_header
from .lines import Block
from .table import Table

_POINTS = re.compile(rb"\s*Points\s*=\s*([^\t\r\n]*?)\s*\Z", re.IGNORECASE)

# More rows than a file of the largest size can hold: a damaged number, not a count.
_MOST_ROWS = 10**10


def is_export(data: bytes) -> bool:
    """Whether the second line declares ``Points=``."""
    lines = data[:65536].split(b"\n", 2)
    return len(lines) > 1 and _POINTS.match(lines[1]) is not None


def table_from_export(data: bytes, where: str, *, sha256: str | None, broken_off: bool) -> Table:
    """Read the head of an export.

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
        Where ``Points`` is no count, or the names and units are missing.
    """
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
