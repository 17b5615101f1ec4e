"""Motions of a test that nobody has made yet: strokes by hand, at rest between them, none quite even."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

# A hand takes about a third of a second to get a wheel going and to stop it; a driven axis is asked for the same share
# of a stroke.
RAMP_S = 0.3
RAMP_SHARE = 0.4
# A hand that tries to turn evenly still varies by a third up and down, about once in two seconds.
UNEVEN = 0.3
UNEVEN_HZ = (0.2, 0.9)


@dataclass(frozen=True)
class Move:
    """One movement to a place, and the rest after it.

    Attributes
    ----------
    to : float
        Where it ends, in the motion's unit (rad, m).
    speed : float
        Mean speed away from the ramps, per second.
    rest_s : float
        How long the mechanism then stands.
    creep : tuple of float or None
        (speed, travel) of a slow first part.
    """

    to: float
    speed: float
    rest_s: float
    creep: tuple[float, float] | None = None


def ramp(u: np.ndarray) -> np.ndarray:
    """Return 0 to 1 over u in [0, 1] with no slope and no curvature at the ends: least jerk, as a hand moves."""
    u = np.clip(u, 0.0, 1.0)
    return u * u * u * (10.0 - u * (15.0 - 6.0 * u))


def _profile(travel: float, speed: float, step_s: float, rng: np.random.Generator) -> np.ndarray:
    """Return speeds from rest to rest that cover a travel."""
    ramp_s = min(RAMP_S, RAMP_SHARE * travel / speed)
    duration_s = travel / speed + ramp_s
    count = max(8, round(duration_s / step_s))
    time = np.arange(count + 1) * (duration_s / count)
    frequency, phase = rng.uniform(*UNEVEN_HZ), rng.uniform(0.0, 2.0 * np.pi)
    shape = np.exp(UNEVEN * np.sin(2.0 * np.pi * frequency * time + phase))
    shape *= ramp(time / ramp_s) * ramp((duration_s - time) / ramp_s)
    return shape * (travel / (step_s * float(shape.sum())))


def path(start: float, moves: Sequence[Move], step_s: float, rng: np.random.Generator) -> np.ndarray:
    """Return the position over time, at rest at first.

    Parameters
    ----------
    start : float
        Where it begins, in the motion's unit.
    moves : sequence of Move
    step_s : float
        Seconds between samples.
    rng : numpy.random.Generator
        How uneven the hand is this time.
    """
    here = start
    speeds = [np.zeros(max(1, round(0.8 / step_s)))]
    for move in moves:
        travel = abs(move.to - here)
        direction = 1.0 if move.to > here else -1.0
        if move.creep is not None and move.creep[1] < 0.5 * travel:
            slow, first = move.creep
            speeds.append(direction * _creep(slow, first, step_s))
            rest = travel - step_s * float(np.abs(speeds[-1]).sum())
            main = _profile(rest, move.speed, step_s, rng)
            # It does not stop between creeping and turning.
            half = main.size // 2
            main[:half] = np.maximum(main[:half], slow)
            speeds.append(direction * main * (rest / (step_s * float(main.sum()))))
        else:
            speeds.append(direction * _profile(travel, move.speed, step_s, rng))
        speeds.append(np.zeros(max(1, round(move.rest_s / step_s))))
        here = move.to
    return start + step_s * np.cumsum(np.concatenate(speeds))


def _creep(speed: float, travel: float, step_s: float) -> np.ndarray:
    count = max(4, round(travel / speed / step_s))
    return speed * ramp(np.arange(1, count + 1) * step_s / RAMP_S)


def strokes(
    low: float,
    high: float,
    speeds: Sequence[float],
    rng: np.random.Generator,
    *,
    rests_s: Sequence[float] = (0.4, 0.8, 0.5),
    overshoot: float = 0.0,
    creep: tuple[float, float] | None = None,
) -> tuple[float, list[Move]]:
    """Return where to start and the strokes back and forth between two ends, one per speed.

    Parameters
    ----------
    low, high : float
        The ends that every stroke passes.
    speeds : sequence of float
        Mean speed of each stroke.
    rng : numpy.random.Generator
    rests_s : sequence of float
        Rests between strokes, in turn.
    overshoot : float
        The ends lie beyond ``low`` and ``high`` by up to this much.
    creep : tuple of float, optional
        (speed, travel) with which every stroke begins.
    """

    def end(side: int) -> float:
        beyond = float(rng.uniform(0.0, overshoot)) if overshoot > 0.0 else 0.0
        return high + beyond if side > 0 else low - beyond

    side = -1
    start = end(side)
    moves = []
    for i, speed in enumerate(speeds):
        side = -side
        moves.append(Move(end(side), float(speed), float(rests_s[i % len(rests_s)]), creep))
    return start, moves


def drawn_speeds(low: float, high: float, count: int, rng: np.random.Generator) -> np.ndarray:
    """Return mean speeds of strokes spread over a range, in no order."""
    # The unevenness of the hand takes up the outer parts of the range.
    margin = min(np.exp(UNEVEN), np.sqrt(high / low))
    inner = np.geomspace(low * margin, high / margin, max(count, 2))[:count]
    return rng.permutation(inner)
