"""What goes into a batch: parameters, starts and drives of every lane, handed out a few lanes at a time."""

from __future__ import annotations

import hashlib
import zlib
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from .. import _core
from .._arrays import refuse_not_finite, rows, whole_number
from ..errors import ParameterError
from . import lanes

# Rows of the core and drives that are held at a time.
CHUNK_BYTES = 64 * 2**20
# Whole blocks of the core; more lanes than this at a time gain nothing.
LEAST_LANES, MOST_LANES = 64, 65_536

Channel = np.ndarray | Callable[[np.ndarray], Any]


@dataclass(frozen=True)
class Inputs:
    """The inputs of a batch, checked.

    A channel is an array of shape (1, n) for all lanes, (lanes, n), or a function of the lanes' numbers.
    """

    columns: Mapping[str, np.ndarray]
    starts: np.ndarray
    handwheel: Channel
    load: Channel | None
    lanes: int
    many: bool
    samples: int
    rate_hz: float
    substeps: int

    def part(self, index: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray | None]:
        """Return parameters, starts, handwheel and load of some lanes, as the core takes them."""
        load = None if self.load is None else self._channel("load_nm", self.load, index)
        psi = self._channel("handwheel_rad", self.handwheel, index)
        return lanes.rows(self.columns, index), np.ascontiguousarray(self.starts[index]), psi, load

    def _channel(self, name: str, channel: Channel, index: np.ndarray) -> np.ndarray:
        if callable(channel):
            made = _drive(name, channel(index))
            if made.shape != (index.size, self.samples):
                wanted = f"Return an array of the shape ({index.size}, {self.samples}) for {index.size} lanes."
                raise ParameterError(f"{name} returned the shape {made.shape}", name, wanted)
            return made
        return channel if len(channel) == 1 else np.ascontiguousarray(channel[index])

    def chunk(self, row_values: int) -> int:
        """Return how many lanes to run at a time where each needs so many values of its own."""
        own = sum(self.samples for c in (self.handwheel, self.load) if c is not None and (callable(c) or len(c) > 1))
        each = 8 * (len(_core.steering_parameters()) + own + row_values)
        return int(np.clip(CHUNK_BYTES // each // LEAST_LANES * LEAST_LANES, LEAST_LANES, MOST_LANES))

    def check(self, chunk: int, method: str) -> None:
        """Refuse a lane that makes no sense before any of them runs; what functions return is looked at when asked."""
        for first in range(0, self.lanes, chunk):
            index = np.arange(first, min(first + chunk, self.lanes))
            psi = np.zeros((1, self.samples)) if callable(self.handwheel) else self.handwheel
            load = None if callable(self.load) else self.load
            psi, load = (c[index] if c is not None and len(c) > 1 else c for c in (psi, load))
            _core.check_lanes(
                lanes.rows(self.columns, index),
                np.ascontiguousarray(self.starts[index]),
                psi,
                load,
                sample_rate_hz=self.rate_hz,
                substeps=self.substeps,
                method=method,
                first=first,
            )

    def digest(self, *more: object) -> str:
        """Return a digest of all inputs and of ``more``: against mistakes, not against forgery."""
        first = np.arange(1)
        arrays = {f"columns.{name}": column for name, column in self.columns.items()} | {"starts": self.starts}
        for name, channel in (("handwheel_rad", self.handwheel), ("load_nm", self.load)):
            if channel is not None:
                arrays[name] = self._channel(name, channel, first) if callable(channel) else channel
        told = [(name, a.shape, zlib.crc32(np.ascontiguousarray(a))) for name, a in sorted(arrays.items())]
        text = repr((told, self.lanes, self.samples, self.rate_hz, self.substeps, *more))
        return hashlib.blake2b(text.encode(), digest_size=16).hexdigest()


def inputs(
    parameters: Mapping[str, Any],
    handwheel_rad: Any,
    load_nm: Any,
    start_rad: Any,
    start_speed_rad_s: Any,
    *,
    sample_rate_hz: Any,
    substeps: Any,
) -> Inputs:
    """Return the inputs of a batch.

    Raises
    ------
    ParameterError
        Names what is not right.
    """
    columns = lanes.columns(parameters)
    channels = {"handwheel_rad": handwheel_rad, "load_nm": load_nm}
    made = {k: c if c is None or callable(c) else _drive(k, c) for k, c in channels.items()}
    sizes = {key: a.size for key, a in columns.items() if a.ndim == 1}
    sizes |= {k: len(c) for k, c in made.items() if isinstance(c, np.ndarray) and np.ndim(channels[k]) == 2}
    sizes |= {
        name: np.size(value)
        for name, value in (("start_rad", start_rad), ("start_speed_rad_s", start_speed_rad_s))
        if np.ndim(value) == 1
    }
    count = lanes.agreed(sizes)
    samples = {}
    for name, channel in made.items():
        if channel is not None:
            array = _drive(name, channel(np.arange(1))) if callable(channel) else channel
            samples[name] = array.shape[1]
    n = samples["handwheel_rad"]
    if n < 2:
        raise ParameterError(f"handwheel_rad holds {n} values", "handwheel_rad", "Give at least 2.")
    if samples.get("load_nm", n) != n:
        remedy = "Give as many samples of both."
        raise ParameterError(f"load_nm has {samples['load_nm']} samples, handwheel_rad {n}", "load_nm", remedy)
    return Inputs(
        columns,
        lanes.starts(count, start_rad, start_speed_rad_s),
        made["handwheel_rad"],
        made["load_nm"],
        count,
        bool(sizes),
        n,
        lanes.rate(sample_rate_hz),
        whole_number("substeps", substeps, 1, 1_000_000),
    )


def _drive(name: str, values: Any) -> np.ndarray:
    """Return a drive as finite rows; a vector is one row."""
    array = rows(name, values) if np.ndim(values) == 2 else rows(name, values).T
    array = np.require(array, np.float64, ["C", "A"])
    refuse_not_finite(name, array if np.ndim(values) == 2 else array[0])
    return array
