"""The noise floor from repeats: runs that go through the same motion again differ by noise alone.

A robot repeats a motion to a fraction of a degree; a hand does not. Where enough of the record was gone through twice,
at the same time since the start, the same angle, speed and direction, half the mean square of the difference is the
square of the noise, whatever the mechanism is.
"""

from __future__ import annotations

import itertools
from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from .prepare import Prepared

# The same state: speed and time since the start to this share of the top speed and of the run, the way since the
# reversal to this share of the range. The torque of an effect changes by about as little.
SAME_SPEED = 0.03
SAME_TIME = 0.03
SAME_TRAVEL = 0.01
# So much of the moving record has to be covered, or the repeats stand for a part of it only.
LEAST_COVERED = 0.5


@dataclass(frozen=True)
class Repeats:
    """What repeats say about noise.

    Attributes
    ----------
    rms : float
        Noise, away from the reversal zones.
    error : float
        Its standard error, from the scatter over pairs of strokes.
    covered : float
        Share of the moving record that was gone through twice.
    """

    rms: float
    error: float
    covered: float


def repeats(runs: Sequence[Prepared]) -> Repeats | None:
    """Return the noise that repeats show; None where too little of the record was repeated."""
    moving = sum(int((r.usable & ~r.zone).sum()) for r in runs)
    if len(runs) < 2 or not moving:
        return None
    squares, counts = [], []
    seen = [np.zeros(r.motion.size, bool) for r in runs]
    for (i, a), (j, b) in itertools.combinations(enumerate(runs), 2):
        for here, difference in _pairs(a, b):
            seen[i][here] = True
            squares.append(float(np.sum(difference**2)) / 2.0)
            counts.append(here.size)
        for here, _ in _pairs(b, a):
            seen[j][here] = True
    covered = sum(int(s.sum()) for s in seen) / moving
    if covered < LEAST_COVERED or len(counts) < 2:
        return None
    square, samples = np.array(squares), np.array(counts)
    variance = float(square.sum() / samples.sum())
    scatter = float(np.sqrt(np.sum((square - variance * samples) ** 2)) / samples.sum())
    return Repeats(float(np.sqrt(variance)), scatter / (2.0 * np.sqrt(max(variance, 1e-300))), covered)


def _pairs(a: Prepared, b: Prepared) -> Iterator[tuple[np.ndarray, np.ndarray]]:
    """Yield, for strokes of two runs, the samples of the first that the second repeats, and the difference there."""
    reach = max(a.recording.range, b.recording.range)
    top = max(float(np.abs(a.speed).max()), float(np.abs(b.speed).max()))
    longest = max(a.duration_s, b.duration_s)
    for s, t in itertools.product(a.strokes, b.strokes):
        apart = abs(float(a.motion[s.onset] - b.motion[t.onset]))
        if s.direction != t.direction or apart > SAME_TRAVEL * reach:
            continue
        if abs(float(a.time_s[s.onset] - b.time_s[t.onset])) > SAME_TIME * longest:
            continue
        there = np.arange(t.onset, t.last)
        there = there[b.usable[there] & ~b.zone[there]]
        here = np.arange(s.onset, s.last)
        here = here[a.usable[here] & ~a.zone[here]]
        if there.size < 2 or not here.size:
            continue
        # Along a stroke the position goes one way only, but for what the low pass leaves of the sensor's steps.
        place = np.maximum.accumulate(s.direction * b.motion[there])
        at = s.direction * a.motion[here]
        inside = (at >= place[0]) & (at <= place[-1])
        here, at = here[inside], at[inside]
        speed = np.interp(at, place, b.speed[there])
        same = np.abs(speed - a.speed[here]) <= SAME_SPEED * top
        if same.any():
            effort = np.interp(at[same], place, b.effort[there])
            yield here[same], a.effort[here[same]] - effort
