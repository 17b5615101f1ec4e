"""Read measurement files: the one call a user needs."""

from __future__ import annotations

import codecs
import hashlib
import os
import zlib
from collections.abc import Mapping, Sequence
from pathlib import Path

from ..errors import MeasurementError
from .columns import check_keys
from .run import Run
from .runs import Runs
from .table import Table, to_run

# A file, or what an archive unpacks to, beyond this is refused before it fills the memory. A 10 min record of 20
# channels at 1 kHz is 0.12 GB of text.
MOST_BYTES = 2 << 30

_GZIP = b"\x1f\x8b"
_OTHER_FORMATS: tuple[tuple[bytes, str, str], ...] = (
    (b"PK\x03\x04", "a zip archive or an Excel workbook", "Export the sheet as CSV."),
    (b"\xd0\xcf\x11\xe0", "an old Excel workbook", "Export the sheet as CSV."),
    (b"MDF ", "an MDF file", "Export the channels as CSV or MAT v5."),
    (b"TDSm", "a TDMS file", "Export the channels as CSV."),
    (b"PAR1", "a Parquet file", "Read it with pandas and call luztar.read_frame(frame)."),
    (b"\x28\xb5\x2f\xfd", "a zstd archive", "Unpack it first."),
    (b"BZh", "a bzip2 archive", "Unpack it first."),
    (b"\xfd7zXZ", "an xz archive", "Unpack it first."),
)


def read(
    *paths: str | os.PathLike[str] | Sequence[str | os.PathLike[str]],
    map: Mapping[str, str] | None = None,
    units: Mapping[str, str] | None = None,
    resample_hz: float | None = None,
    sample_rate_hz: float | None = None,
) -> Runs:
    """Read one run per file: CSV (also .gz), AB Dynamics text export, MAT v5; told apart by content.

    Parameters
    ----------
    *paths : path, or a list of paths
        The files, in order.
    map : mapping of channel to ``"COLUMN"`` or ``"COLUMN*FACTOR"``, optional
        Names the column of a channel (time, angle, torque, force, position, handwheel, roadwheel, load) where its name
        does not say it. The rules for units are at the head of ``columns.py``.
    units : mapping of channel to unit, optional
        Units where a file has none.
    resample_hz : float [Hz], > 0, optional
        Brings every run to this even rate by straight lines between samples; refused across gaps.
    sample_rate_hz : float [Hz], > 0, optional
        Declares the sample rate of files without a time column.

    Returns
    -------
    Runs
        Named after the files; names that repeat get their folder or a number.

    Raises
    ------
    MeasurementError
        Names the file, the line or column, and the remedy. A damaged file that still holds whole rows is read, with
        ``integrity.complete`` False and a doubtful finding; it never passes as whole.
    """
    from .arrays import check_rate

    files: list[Path] = []
    for path in paths:
        if isinstance(path, (str, os.PathLike)):
            files.append(Path(path))
        else:
            files += [Path(p) for p in path]
    if not files:
        raise MeasurementError("no file was named", "read", "Give at least one path.")
    mapped = check_keys("--map", map)
    said = check_keys("--unit", units)
    rate = None if sample_rate_hz is None else check_rate(sample_rate_hz)
    runs: list[Run] = []
    for name, path in zip(_names(files), files, strict=True):
        run = to_run(_table(path), name=name, mapped=mapped, units=said, sample_rate_hz=rate)
        runs.append(run if resample_hz is None else run.resample(resample_hz))
    return Runs(_marked_copies(runs))


def _names(files: Sequence[Path]) -> list[str]:
    """Return the file names, with as much of the folders as tells them apart."""
    names = []
    for path in files:
        others = [p for p in files if p.name == path.name and p.parent != path.parent]
        depth = 1
        while others and depth < len(path.parts):
            depth += 1
            others = [p for p in others if p.parts[-depth:] == path.parts[-depth:]]
        names.append(Path(*path.parts[-depth:]).as_posix())
    return names


def _marked_copies(runs: Sequence[Run]) -> list[Run]:
    from .integrity import Finding

    seen: dict[str, str] = {}
    marked = []
    for run in runs:
        if run.sha256 in seen:
            text = f"the same bytes as {seen[run.sha256]}: not a run of its own"
            run = run.with_finding(Finding("note", text, False))
        elif run.sha256 is not None:
            seen[run.sha256] = run.name
        marked.append(run)
    return marked


def _table(path: Path) -> Table:
    where = path.as_posix()
    raw = _bytes(path, where)
    digest = hashlib.sha256(raw).hexdigest()
    broken_off = False
    if raw.startswith(_GZIP):
        raw, broken_off = unpack(raw, where)
    if not raw:
        raise MeasurementError(
            "the file is empty" if not broken_off else "the archive is truncated before its first byte",
            where,
            "Copy or export the record again.",
        )
    for magic, what, remedy in _OTHER_FORMATS:
        if raw.startswith(magic):
            raise MeasurementError(f"this is {what}", where, remedy)
    suffixes = [s.lower() for s in path.suffixes]
    if raw.startswith((b"MATLAB", b"\x89HDF")) or ".mat" in suffixes:
        from .mat import table_from_mat

        return table_from_mat(raw, where, sha256=digest, broken_off=broken_off)
    from . import abd
    from .csv import table_from_text

    text, cut_inside = as_utf8(raw, where)
    reader = abd.table_from_export if abd.is_export(text) else table_from_text
    return reader(text, where, sha256=digest, broken_off=broken_off or cut_inside)


def _bytes(path: Path, where: str) -> bytes:
    try:
        if path.is_dir():
            raise MeasurementError("this is a folder", where, "Name the files in it.")
        if path.exists() and not path.is_file():
            raise MeasurementError("this is not a regular file", where, "Save the record to a file first.")
        if path.stat().st_size > MOST_BYTES:
            raise MeasurementError(
                f"the file is larger than {MOST_BYTES >> 30} GiB", where, "Split the record, or export fewer channels."
            )
        return path.read_bytes()
    except MeasurementError:
        # It is a ValueError too, and already says what is wrong.
        raise
    except FileNotFoundError:
        raise MeasurementError("there is no such file", where, "Check the path.") from None
    except (OSError, ValueError) as error:
        reason = getattr(error, "strerror", None) or str(error)
        raise MeasurementError(
            f"the file cannot be opened: {reason}", where, "Check the path and its rights."
        ) from None


def unpack(raw: bytes, where: str) -> tuple[bytes, bool]:
    """Return the content of a gzip file, and whether the file ends too early.

    Raises
    ------
    MeasurementError
        Where the archive is damaged (its checksum disagrees) or unpacks beyond the limit.
    """
    parts: list[bytes] = []
    size = 0
    rest = raw
    while rest:
        if not rest.strip(b"\0"):
            break
        stream = zlib.decompressobj(wbits=31)
        while not stream.eof:
            try:
                part = stream.decompress(rest, 1 << 24)
            except zlib.error:
                raise MeasurementError(
                    "the archive is damaged: its content does not match its checksum", where, "Copy the file again."
                ) from None
            size += len(part)
            if size > MOST_BYTES:
                raise MeasurementError(
                    f"the archive unpacks to more than {MOST_BYTES >> 30} GiB", where, "Split the record."
                )
            parts.append(part)
            rest = stream.unconsumed_tail
            if not part and not rest and not stream.eof:
                return b"".join(parts), True
        rest = stream.unused_data
    return b"".join(parts), False


def as_utf8(raw: bytes, where: str) -> tuple[bytes, bool]:
    """Return text as UTF-8 with LF line ends, and whether it breaks off inside a character.

    UTF-8 (with or without mark), UTF-16 with mark, else cp1252.
    """
    cut = False
    if raw.startswith(codecs.BOM_UTF8):
        raw = raw[3:]
    elif raw.startswith((codecs.BOM_UTF16_LE, codecs.BOM_UTF16_BE)):
        try:
            cut = len(raw) % 2 == 1
            raw = raw[: len(raw) - len(raw) % 2].decode("utf-16").encode()
        except UnicodeError:
            raise MeasurementError("the text is neither UTF-8, UTF-16 nor cp1252", where, "Save it as UTF-8.") from None
    if b"\0" in raw:
        # A file system that lost power leaves zeros where the end of the file was to be written.
        n_bytes = len(raw)
        raw = raw.rstrip(b"\0")
        cut = cut or len(raw) < n_bytes
        if b"\0" in raw or not raw:
            raise MeasurementError("this is not text", where, "Export the record as CSV, AB Dynamics text or MAT v5.")
    if not raw.isascii():
        try:
            raw.decode("utf-8")
        except UnicodeDecodeError as error:
            if error.end == len(raw) and error.reason == "unexpected end of data":
                raw, cut = raw[: error.start], True
            else:
                raw = raw.decode("cp1252", "replace").encode()
    if b"\r" in raw:
        raw = raw.replace(b"\r\n", b"\n").replace(b"\r", b"\n")
    return raw, cut
