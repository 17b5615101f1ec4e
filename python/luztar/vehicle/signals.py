"""What the driver does: pieces of sines and constants by their parameters, or samples."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from .._arrays import number, refuse_not_finite, rows
from ..errors import ParameterError


@dataclass(frozen=True)
class Pieces:
    """Pieces of ``level + amplitude sin(2 pi f (t - start) + phase)``, each from its start to that of the next.

    Before the first piece the signal is 0, the last one has no end. Nothing is stored: the core evaluates the pieces at
    every step, and the mean square of their rate in closed form.

    Parameters
    ----------
    start_s : array_like, shape (pieces,) or (cars, pieces)
        Ascending.
    amplitude, frequency_hz, level, phase_rad : array_like, of a shape that broadcasts with it
        Amplitude and level in the unit of the signal (rad or Nm).

    Raises
    ------
    ParameterError
        Shapes that do not fit, values that are not finite.

    Examples
    --------
    One sine of 0.4 Hz from 1 s on, then straight ahead:

    >>> import luztar
    >>> hand = luztar.vehicle.Pieces(start_s=[1.0, 3.5], amplitude=[0.8, 0.0], frequency_hz=0.4)
    """

    start_s: Any
    amplitude: Any = 0.0
    frequency_hz: Any = 0.0
    level: Any = 0.0
    phase_rad: Any = 0.0

    def __post_init__(self) -> None:
        names = ("start_s", "amplitude", "frequency_hz", "level", "phase_rad")
        try:
            arrays = np.broadcast_arrays(*(np.asarray(getattr(self, n), dtype=np.float64) for n in names))
        except (TypeError, ValueError) as problem:
            raise ParameterError(f"pieces do not fit together: {problem}", "pieces", "Give one value each.") from None
        for name, array in zip(names, arrays, strict=True):
            if not 1 <= array.ndim <= 2 or array.size == 0:
                raise ParameterError(
                    f"pieces have the shape {array.shape}", name, "Give (pieces,) or (cars, pieces) values."
                )
            refuse_not_finite(name, array)
            kept = np.array(array)
            kept.flags.writeable = False
            object.__setattr__(self, name, kept)

    @property
    def cars(self) -> int | None:
        """How many cars it speaks of; None for all alike."""
        return len(self.start_s) if self.start_s.ndim == 2 else None

    def played(self, part: slice) -> tuple[Any, ...]:
        """Return what the core takes, for some of the cars."""
        fields = (self.start_s, self.level, self.amplitude, self.frequency_hz, self.phase_rad)
        chosen = [f[part] if self.cars is not None else f for f in fields]
        return (self.start_s.shape[-1], *(np.ascontiguousarray(f).ravel() for f in chosen))


@dataclass(frozen=True)
class Samples:
    """A recorded signal; a cubic runs through the four nearest samples, after the last one its value is held.

    Parameters
    ----------
    values : array_like, shape (n,) or (cars, n), n >= 4
    sample_rate_hz : float, > 0

    Raises
    ------
    ParameterError
        Shapes that do not fit, values that are not finite.
    """

    values: Any
    sample_rate_hz: float

    def __post_init__(self) -> None:
        array = np.asarray(self.values)
        array = rows("values", array[np.newaxis] if array.ndim == 1 else array)
        refuse_not_finite("values", array)
        kept = np.array(array if np.ndim(self.values) == 2 else array[0])
        kept.flags.writeable = False
        object.__setattr__(self, "values", kept)
        object.__setattr__(self, "sample_rate_hz", number("sample_rate_hz", self.sample_rate_hz))

    @property
    def cars(self) -> int | None:
        """How many cars it speaks of; None for all alike."""
        return len(self.values) if self.values.ndim == 2 else None

    def played(self, part: slice) -> tuple[Any, ...]:
        """Return what the core takes, for some of the cars."""
        chosen = self.values[part] if self.cars is not None else self.values
        return (self.values.shape[-1], np.ascontiguousarray(chosen).ravel(), self.sample_rate_hz)


def signal(name: str, value: Any) -> Pieces | Samples:
    """Return a signal: one that is given, or constants, one for all cars or one per car."""
    if isinstance(value, Pieces | Samples):
        return value
    try:
        array = np.asarray(value, dtype=np.float64)
    except (TypeError, ValueError):
        array = None
    if array is None or array.ndim > 1 or array.size == 0:
        raise ParameterError(f"{name} is {value!r}", name, "Give Pieces, Samples, a number, or one per car.")
    refuse_not_finite(name, np.atleast_1d(array))
    return Pieces(start_s=np.zeros_like(array)[..., np.newaxis], level=array[..., np.newaxis])
