"""MATLAB files of version 5 (and 4): variables, and fields of structures, as columns.

Only whole elements are handed to SciPy, and only after their declared size and their unpacked size have been checked:
a small file can ask for any amount of memory, and a file that breaks off inside an element may otherwise be read as
whole.
"""

from __future__ import annotations

import io
import struct
import warnings
import zlib
from collections.abc import Iterator, Mapping, Sequence
from typing import Any

import numpy as np

from ..errors import MeasurementError
from .headers import Column, parse_header
from .integrity import Finding
from .table import Loaded, Table

# The most that the variables of a file may hold once unpacked: ten minutes of 200 channels at 1 kHz.
MOST_BYTES = 1 << 30

# Structures inside structures beyond this depth are not measurements.
_MOST_DEPTH = 6

_COMPRESSED = 15
_RATE_NAMES = ("fs", "Fs", "sample_rate_hz", "sampleRate", "sampling_rate_hz")


def table_from_mat(raw: bytes, where: str, *, sha256: str | None, broken_off: bool) -> Table:
    """Read the variables of a MATLAB file.

    Parameters
    ----------
    raw : bytes
        The file.
    where : str
        The file, for messages.
    sha256 : str or None
    broken_off : bool
        Whether the bytes are known to end too early.

    Raises
    ------
    MeasurementError
        For version 7.3, a damaged file, variables beyond the memory limit, or no vector of numbers.
    """
    if raw.startswith((b"MATLAB 7.3", b"\x89HDF")) or raw[512:516] == b"\x89HDF":
        raise MeasurementError(
            "this is a MAT file of version 7.3", where, "Save it in MATLAB with save(..., '-v7') and read that."
        )
    cut = broken_off
    if raw.startswith(b"MATLAB"):
        whole, kept = _whole_elements(raw, where)
        cut = cut or whole < len(raw)
        raw = raw[:whole]
        if not kept:
            raise MeasurementError("the file ends inside its first variable", where, "Copy or save it again.")
    vectors, scalars = _variables(raw, where)
    columns = [parse_header(i, name) for i, name in enumerate(vectors)]
    # "a.angle_deg" is known by its last part.
    columns = [
        Column(c.index, c.header, c.name.rsplit(".", 1)[-1] if "." in c.header else c.name, c.unit) for c in columns
    ]
    if not columns:
        raise MeasurementError("the file holds no vector of numbers", where, "Save the channels as numeric vectors.")
    rate = next((scalars[name] for name in _RATE_NAMES if scalars.get(name, 0.0) > 0.0), None)

    def load(use: Sequence[int]) -> Loaded:
        names = list(vectors)
        sizes = {names[k]: vectors[names[k]].size for k in use}
        if len(set(sizes.values())) > 1:
            listed = ", ".join(f"{name} {n}" for name, n in sizes.items())
            raise MeasurementError(
                f"the variables differ in length: {listed}", where, "Map variables that were sampled together."
            )
        values = {k: vectors[names[k]].astype(np.float64) for k in use}
        findings = []
        if cut:
            text = "the file breaks off; the variables used stand whole before that, others may be missing"
            findings.append(Finding("cut", text, True))
        return Loaded(values, not cut, findings, None, next(iter(sizes.values())))

    return Table(columns, load, where, sha256, rate, unitless_is_si=True)


def _whole_elements(raw: bytes, where: str) -> tuple[int, int]:
    """Return where the last whole element ends and how many there are, with unpacked sizes checked on the way."""
    order = {b"IM": "<", b"MI": ">"}.get(raw[126:128])
    if order is None:
        raise MeasurementError("the head of the MAT file is damaged", where, "Copy or save it again.")
    at, count, unpacked = 128, 0, 0
    while at + 8 <= len(raw):
        kind, size = struct.unpack_from(order + "II", raw, at)
        end = at + 8 + size
        if end > len(raw):
            break
        if kind == _COMPRESSED:
            unpacked += _unpacked_size(raw[at + 8 : end], where, MOST_BYTES - unpacked)
        at = end
        count += 1
    return at, count


def _unpacked_size(data: bytes, where: str, limit: int) -> int:
    stream, size, rest = zlib.decompressobj(), 0, data
    try:
        while rest and not stream.eof:
            size += len(stream.decompress(rest, 1 << 22))
            rest = stream.unconsumed_tail
            if size > limit:
                raise MeasurementError(
                    f"the variables unpack to more than {MOST_BYTES >> 20} MiB", where, "Save fewer variables."
                )
    except zlib.error:
        raise MeasurementError("a variable of the MAT file is damaged", where, "Copy or save it again.") from None
    return size


def _variables(raw: bytes, where: str) -> tuple[dict[str, np.ndarray], dict[str, float]]:
    import scipy.io

    try:
        with warnings.catch_warnings():
            # SciPy warns of duplicate names and of objects it cannot read; neither is used here.
            warnings.simplefilter("ignore")
            declared = 0
            for _, shape, kind in scipy.io.whosmat(io.BytesIO(raw)):
                size = 1
                for n in shape:
                    size *= max(int(n), 0)
                declared += size * (16 if kind in ("struct", "cell", "object") else 8)
            if declared > MOST_BYTES:
                raise MeasurementError(
                    f"the variables declare {declared >> 20} MiB, more than {MOST_BYTES >> 20}",
                    where,
                    "Save fewer variables.",
                )
            content = scipy.io.loadmat(io.BytesIO(raw), simplify_cells=True)
    except MeasurementError:
        raise
    except NotImplementedError:
        raise MeasurementError(
            "this version of MAT file is not read", where, "Save it in MATLAB with save(..., '-v7')."
        ) from None
    except Exception as error:  # SciPy raises whatever its parser trips over, from KeyError to zlib.error.
        raise MeasurementError(
            f"the MAT file is damaged ({type(error).__name__})", where, "Copy or save it again."
        ) from None
    vectors: dict[str, np.ndarray] = {}
    scalars: dict[str, float] = {}
    for name, value in _leaves(content, "", 0):
        array = np.asarray(value)
        if array.dtype.kind not in "fiub":
            continue
        if array.size == 1 and array.dtype.kind != "b":
            scalars[name.rsplit(".", 1)[-1]] = float(array.reshape(-1)[0])
        elif array.ndim == 1 and array.size >= 2:
            vectors[name] = array
    return vectors, scalars


def _leaves(value: Any, name: str, depth: int) -> Iterator[tuple[str, Any]]:
    if isinstance(value, Mapping):
        if depth <= _MOST_DEPTH:
            for key, inner in value.items():
                if not str(key).startswith("__"):
                    yield from _leaves(inner, f"{name}.{key}" if name else str(key), depth + 1)
    else:
        yield name, value
