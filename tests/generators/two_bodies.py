"""Two bodies with dry friction and a gap between them, each mode by DOP853, stopped at every event.

Shares no code with luztar: a mode is a pair of directions and a side of the gap; an event function ends each of its
parts.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from scipy.integrate import solve_ivp

# DOP853's own limit is near 100 roundings.
TIGHT = {"method": "DOP853", "rtol": 1e-13, "atol": 1e-15}
# Events are seen where their sign differs between two steps: steps far shorter than any swing.
LONGEST_STEP_S = 2e-3


@dataclass(frozen=True)
class Pair:
    """A hand wheel with a torque, a column with freeplay and a ratio, a road wheel on a spring to the ground."""

    inertia: np.ndarray
    friction: np.ndarray
    column: float
    half_gap: float
    ratio: float
    ground: float
    load: Callable[[float], float]


@dataclass(frozen=True)
class Mode:
    """The directions of both bodies (0 is held) and the side to which the gap is closed (0 is open)."""

    pair: Pair
    way: tuple[float, float]
    side: int

    def torque(self, s: float, y: np.ndarray) -> np.ndarray:
        """Return the torque on both bodies without their friction."""
        p = self.pair
        pull = 0.0 if self.side == 0 else p.column * (y[0] - p.ratio * y[1] - self.side * p.half_gap)
        return np.array([p.load(s) - pull, p.ratio * pull - p.ground * y[1]])

    def slope(self, s: float, y: np.ndarray) -> np.ndarray:
        """Return the right-hand side of the equation of motion."""
        moving = np.array(self.way) != 0.0
        pull = (self.torque(s, y) - np.array(self.way) * self.pair.friction) / self.pair.inertia
        return np.concatenate((np.where(moving, y[2:], 0.0), np.where(moving, pull, 0.0)))

    def ends(self) -> list[Callable[[float, np.ndarray], float]]:
        """Return functions that rise through 0 where a body stops or breaks away, or the gap closes or opens."""

        def body(i: int) -> Callable[[float, np.ndarray], float]:
            if self.way[i] != 0.0:
                return lambda s, y: -self.way[i] * y[2 + i]
            return lambda s, y: abs(self.torque(s, y)[i]) - self.pair.friction[i]

        def edge(to: int) -> Callable[[float, np.ndarray], float]:
            sign, place = (to, to) if self.side == 0 else (-self.side, self.side)
            return lambda s, y: sign * (y[0] - self.pair.ratio * y[1] - place * self.pair.half_gap)

        made = [body(0), body(1), edge(1), edge(-1)]
        for end in made:
            end.terminal, end.direction = True, 1.0  # type: ignore[attr-defined]
        return made

    def after(self, s: float, y: np.ndarray, fired: list[bool]) -> Mode:
        """Return the mode that follows; the speed of a body that stops is set to 0 in ``y``."""
        side = self.side
        if fired[2] or fired[3]:
            side = 0 if side != 0 else (1 if fired[2] else -1)
        torque, way = Mode(self.pair, self.way, side).torque(s, y), list(self.way)
        for i in range(2):
            if not fired[i]:
                continue
            leaves = math.copysign(1.0, torque[i])
            if way[i] == 0.0:
                way[i] = leaves
            else:
                y[2 + i] = 0.0
                way[i] = 0.0 if abs(torque[i]) <= self.pair.friction[i] else leaves
        return Mode(self.pair, (way[0], way[1]), side)


def simulate(pair: Pair, times: np.ndarray) -> np.ndarray:
    """Return both angles at some instants, from rest at 0 with the gap open."""
    out = np.empty((2, times.size))
    now, end, y, mode = float(times[0]), float(times[-1]), np.zeros(4), Mode(pair, (0.0, 0.0), 0)
    while now < end:
        solved = solve_ivp(mode.slope, (now, end), y, max_step=LONGEST_STEP_S, events=mode.ends(), **TIGHT)
        stop = float(solved.t[-1])
        # Once more up to the event: the interpolant of a step that was cut short is of the longer step.
        dense = solve_ivp(mode.slope, (now, stop), y, dense_output=True, **TIGHT)
        inside = (times >= now) & (times <= stop)
        out[:, inside] = dense.sol(times[inside])[:2]
        now, y = stop, solved.y[:, -1].copy()
        mode = mode.after(now, y, [len(found) > 0 for found in solved.t_events])
    return out
