"""Angle trajectories of a steering wheel turned by hand: strokes, dwells, uneven speed."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np


@dataclass(frozen=True)
class Motion:
    """A trajectory at a fine, even time step; units rad (rig) or m (axis)."""

    time_s: np.ndarray
    position: np.ndarray
    speed: np.ndarray
    acceleration: np.ndarray

    @property
    def step_s(self) -> float:
        return float(self.time_s[1] - self.time_s[0])


def smooth_step(u: np.ndarray) -> np.ndarray:
    """0 to 1 with zero slope and curvature at both ends (minimum jerk)."""
    u = np.clip(u, 0.0, 1.0)
    return u * u * u * (10.0 + u * (6.0 * u - 15.0))


def smooth_wobble(time_s: np.ndarray, rng: np.random.Generator, frequencies_hz: tuple[float, float]) -> np.ndarray:
    """A few slow sines with random frequency and phase, within [-1, 1]."""
    wobble = np.zeros_like(time_s)
    for frequency_hz in rng.uniform(*frequencies_hz, size=4):
        wobble += rng.uniform(0.4, 1.0) * np.sin(2.0 * np.pi * (frequency_hz * time_s + rng.random()))
    return wobble / max(1e-9, float(np.max(np.abs(wobble))))


def stroke_speed(
    distance: float,
    rng: np.random.Generator,
    *,
    step_s: float,
    speeds: tuple[float, float],
    wobble_ratio: tuple[float, float],
    ramp_s: tuple[float, float],
    creep: tuple[float, float] | None = None,
) -> np.ndarray:
    """Speed over one stroke (start and end at rest) that covers `distance`; always above zero in between.

    Away from the ramps the speed stays inside `speeds`. `creep` = (speed, distance) is a slow first part.
    """
    low, high = speeds
    ratio = min(rng.uniform(*wobble_ratio), np.sqrt(high / low))
    centre = rng.uniform(low * ratio, max(low * ratio, high / ratio))
    guess_s = distance / centre
    # The shape is drawn over a guessed duration; stretching time afterwards makes the distance right and
    # leaves the speeds alone.
    u = np.linspace(0.0, 1.0, 4096)
    shape = centre * ratio ** smooth_wobble(u * guess_s, rng, (0.2, 1.4))
    up_s, down_s = rng.uniform(*ramp_s, size=2)
    fade = min(1.0, 0.8 * guess_s / (up_s + down_s))
    shape *= smooth_step(u * guess_s / (up_s * fade)) * smooth_step((1.0 - u) * guess_s / (down_s * fade))
    duration_s = distance / float(np.mean(shape))
    grid_s = u * duration_s
    if creep is not None:
        creep_speed, creep_distance = creep
        creep_s = creep_distance / creep_speed
        ramp = smooth_step(np.linspace(0.0, 1.0, 400))
        blend_s = 0.3
        slow_s = np.concatenate([np.linspace(0.0, blend_s, 400), [blend_s + creep_s]])
        slow = np.concatenate([creep_speed * ramp, [creep_speed]])
        late_s = slow_s[-1]
        # Never slower than the creep until the final ramp, so that the stroke does not stop half way.
        floor = np.where(u < 0.5, creep_speed, 0.0)
        grid_s = np.concatenate([slow_s, late_s + grid_s[1:]])
        shape = np.concatenate([slow, np.maximum(shape, floor)[1:]])
    covered = float(np.sum(0.5 * (shape[1:] + shape[:-1]) * np.diff(grid_s)))
    count = max(8, round(float(grid_s[-1]) * distance / covered / step_s))
    speed = np.interp(np.linspace(0.0, grid_s[-1], count + 1), grid_s, shape)
    # The rest, below a thousandth for ordinary strokes, is taken up by the speed itself.
    return speed * (distance / (step_s * float(np.sum(speed))))


def from_speed(speed: np.ndarray, start: float, step_s: float) -> Motion:
    """Integrate a speed array (trapezoid) and differentiate it."""
    position = np.empty_like(speed)
    position[0] = start
    np.cumsum(0.5 * step_s * (speed[1:] + speed[:-1]), out=position[1:])
    position[1:] += start
    return Motion(np.arange(speed.size) * step_s, position, speed, np.gradient(speed, step_s))


def hand_motion(
    rng: np.random.Generator,
    *,
    step_s: float = 2e-4,
    amplitude_deg: float = 54.0,
    overshoot_deg: tuple[float, float] = (0.0, 9.0),
    speeds_deg_s: tuple[float, float] = (5.0, 60.0),
    strokes: int = 6,
    duration_s: float | None = None,
    first_dwell_s: tuple[float, float] = (0.75, 0.9),
    dwell_s: tuple[float, float] = (0.3, 0.9),
    last_dwell_s: tuple[float, float] = (0.4, 0.8),
    wobble_ratio: tuple[float, float] = (1.5, 2.4),
    ramp_s: tuple[float, float] = (0.2, 0.35),
    slow_breakaway: bool = False,
    small_reversals: int = 0,
    small_reversal_deg: tuple[float, float] = (1.5, 8.0),
    centre_deg: float = 0.0,
) -> Motion:
    """Strokes from beyond +amplitude to beyond -amplitude and back, with dwells.

    duration_s: draw strokes until this time is reached instead of counting `strokes`.
    slow_breakaway: each stroke starts with a creep of 0.6-2 deg/s over 0.5-2 deg.
    small_reversals: number of short back movements, each in the middle of a stroke drawn at random.
    """
    if duration_s is None and strokes < 1:
        raise ValueError("strokes must be at least 1")
    backs_in = rng.integers(0, max(strokes, 1), size=small_reversals)

    def rest(range_s: tuple[float, float]) -> np.ndarray:
        return np.zeros(max(1, round(rng.uniform(*range_s) / step_s)))

    def end(side: int) -> float:
        return centre_deg + side * (amplitude_deg + rng.uniform(*overshoot_deg))

    def move(distance_deg: float, *, creeping: bool) -> np.ndarray:
        creep = (rng.uniform(0.6, 2.0), rng.uniform(0.5, 2.0)) if creeping else None
        travel = abs(distance_deg)
        low, high = speeds_deg_s
        # A short movement has no room for the fast end of the range.
        top = max(low * 1.3, min(high, travel / 0.5))
        speed = stroke_speed(
            travel,
            rng,
            step_s=step_s,
            speeds=(low, top),
            wobble_ratio=wobble_ratio,
            ramp_s=ramp_s,
            creep=creep if creep is not None and creep[1] < 0.5 * travel else None,
        )
        return np.sign(distance_deg) * speed

    side = int(rng.choice([-1, 1]))
    start_deg = end(side)
    here_deg = start_deg
    pieces = [rest(first_dwell_s)]
    elapsed_s = pieces[0].size * step_s
    done = 0
    while done < strokes if duration_s is None else elapsed_s < duration_s:
        side = -side
        target_deg = end(side)
        stops = [target_deg]
        for _ in range(int(np.count_nonzero(backs_in == done))):
            turn_deg = here_deg + rng.uniform(0.25, 0.75) * (target_deg - here_deg)
            stops = [turn_deg, turn_deg - side * rng.uniform(*small_reversal_deg), target_deg]
        for stop_deg in stops:
            pieces.append(move(stop_deg - here_deg, creeping=slow_breakaway))
            pieces.append(rest(dwell_s))
            here_deg = stop_deg
        done += 1
        elapsed_s = sum(piece.size for piece in pieces) * step_s
    pieces[-1] = rest(last_dwell_s)
    return from_speed(np.deg2rad(np.concatenate(pieces)), np.deg2rad(start_deg), step_s)
