"""The stretches of a record that are simulated by themselves, and where each starts.

A mass without a spring drifts: an error of 1 % in its friction is a metre after a minute. So every stroke is simulated
from its own start (multiple shooting). Position and speed there are read off the record and then corrected, for every
set of parameters, by what the stroke itself says of them.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from ..floor import noise_of

# The start of a stroke is read off a parabola over so much on either side.
HALF_S = 0.03
FEWEST = 5


@dataclass(frozen=True)
class Window:
    """One stretch.

    Attributes
    ----------
    first, last : int
        Samples, ``[first, last)``.
    start : tuple of float
        Position and speed at the first sample.
    uncertainty : tuple of float
        Their standard errors.
    noise : float
        Of a sample.
    """

    first: int
    last: int
    start: tuple[float, float]
    uncertainty: tuple[float, float]
    noise: float


def windows_of(position: np.ndarray, rate_hz: float, bounds: list[tuple[int, int]]) -> tuple[Window, ...]:
    """Return the windows of a recorded position between some bounds."""
    noise = max(noise_of([position], rate_hz)[0], np.finfo(float).tiny)
    half = max(math.ceil(HALF_S * rate_hz), FEWEST)
    out = []
    for first, last in bounds:
        begin, end = max(first - half, 0), min(first + half + 1, position.size)
        t = (np.arange(begin, end) - first) / rate_hz
        columns = np.vander(t, 3, increasing=True)
        found = np.linalg.lstsq(columns, position[begin:end], rcond=None)[0]
        spread = noise * np.sqrt(np.diag(np.linalg.inv(columns.T @ columns)))
        out.append(Window(first, last, (float(found[0]), float(found[1])), (float(spread[0]), float(spread[1])), noise))
    return tuple(out)
