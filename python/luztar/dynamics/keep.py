"""What a batch keeps of every lane: reducers by name, and where their values stand in a lane's row."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from types import MappingProxyType
from typing import Any

import numpy as np

from .. import _core
from .._arrays import number, vector
from ..errors import ParameterError

# Reducer: the names of what it keeps; those of the core's other reducers are as the core says.
PLAIN: Mapping[str, tuple[str, ...]] = MappingProxyType(
    {
        "last": ("last_rad", "last_speed_rad_s"),
        "peak": ("peak_rad",),
        "rms": ("rms_rad",),
        "at_rest": ("at_rest_share",),
    }
)
REDUCERS = (*PLAIN, "events", "energy", "envelope", "samples", "trace")
DEFAULT = tuple(PLAIN)
# What has a row per lane.
LISTED = frozenset({"least_rad", "greatest_rad", "sample_rad", "sample_speed_rad_s"})
# A time that stands in a text with six digits after a few hundred seconds is still taken for the sample it means.
NEAR = 1e-3


@dataclass(frozen=True)
class Keep:
    """What is kept, as the core takes it."""

    names: tuple[str, ...]
    events: bool
    energy: bool
    trace: bool
    window: int
    chosen: tuple[int, ...]
    sizes: tuple[tuple[str, int], ...]

    @property
    def options(self) -> dict[str, Any]:
        """The core's arguments."""
        return {"events": self.events, "energy": self.energy, "window": self.window, "chosen": list(self.chosen)}

    @property
    def width(self) -> int:
        """Values of a row."""
        return sum(size for _, size in self.sizes)

    def unpack(self, rows: np.ndarray) -> dict[str, np.ndarray]:
        """Return what was asked for by name: one value per lane, or one row."""
        return {
            name: np.ascontiguousarray(rows[:, place] if name in LISTED else rows[:, place.start])
            for name, place in self._places().items()
        }

    def pack(self, values: Mapping[str, np.ndarray], rows: np.ndarray, index: np.ndarray) -> None:
        """Write what :meth:`unpack` returned back into the rows of some lanes."""
        for name, place in self._places().items():
            rows[index, place] = values[name] if name in LISTED else values[name][:, np.newaxis]

    def _places(self) -> dict[str, slice]:
        hidden = {name for reducer, given in PLAIN.items() if reducer not in self.names for name in given}
        out, at = {}, 0
        for name, size in self.sizes:
            if name not in hidden:
                out[name] = slice(at, at + size)
            at += size
        return out


def keep(names: Any, window_s: Any, times_s: Any, *, samples: int, rate_hz: float) -> Keep:
    """Return what reducers mean for runs of so many samples.

    Raises
    ------
    ParameterError
        An unknown reducer, a window or times that are missing, not wanted or not there.
    """
    given = (names,) if isinstance(names, str) else tuple(names) if isinstance(names, Iterable) else (names,)
    for name in given:
        if name not in REDUCERS:
            raise ParameterError(f"there is no reducer {name!r}", "keep", f"Known are: {', '.join(REDUCERS)}.")
    for option, value, reducer in (("window_s", window_s, "envelope"), ("times_s", times_s, "samples")):
        if value is None and reducer in given:
            raise ParameterError(f"'{reducer}' needs {option}", option, f"Give {option}, or leave '{reducer}' out.")
        if value is not None and reducer not in given:
            raise ParameterError(f"{option} is for '{reducer}'", option, f"Add '{reducer}' to keep.")
    window = 0 if window_s is None else _window(window_s, rate_hz)
    chosen = () if times_s is None else _chosen(times_s, samples, rate_hz)
    made = {"events": "events" in given, "energy": "energy" in given, "window": window, "chosen": list(chosen)}
    sizes = tuple(_core.lane_columns(samples, **made))
    return Keep(given, made["events"], made["energy"], "trace" in given, window, chosen, sizes)


def _window(window_s: Any, rate_hz: float) -> int:
    value = number("window_s", window_s)
    if not (math.isfinite(value) and value * rate_hz >= 1.0):
        raise ParameterError(
            f"window_s is {value:g}", "window_s", f"Give at least one sampling interval, {1.0 / rate_hz:g} s."
        )
    return round(value * rate_hz)


def _chosen(times_s: Any, samples: int, rate_hz: float) -> tuple[int, ...]:
    times = vector("times_s", np.atleast_1d(times_s))
    places = times * rate_hz
    chosen = np.rint(places)
    wrong = (np.abs(places - chosen) > NEAR) | (chosen < 0) | (chosen >= samples)
    if wrong.any():
        t = float(times[int(np.argmax(wrong))])
        last = (samples - 1) / rate_hz
        remedy = f"Give instants of samples: multiples of {1.0 / rate_hz:g} s from 0 to {last:g} s."
        raise ParameterError(f"there is no sample at {t:g} s", "times_s", remedy)
    if (np.diff(chosen) <= 0).any():
        raise ParameterError("times_s does not increase", "times_s", "Give each instant once, in order.")
    return tuple(int(c) for c in chosen)
