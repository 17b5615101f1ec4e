"""Steering runs from a general solver: equation (5) as a machine of modes, each integrated by DOP853 between events.

Shares no code with luztar: modes are forward, backward and stuck; an event function ends each; the handwheel is a sum
of sines, known in closed form.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field

import numpy as np
from scipy.integrate import solve_ivp

# A body at rest is looked at this often: a hand of 1.5 Hz winds no spring up and lets it go again in between.
SCANS_PER_S = 500
# A thousandth of the noise that is added to a run.
RUN_TOLERANCE = 1e-6


@dataclass(frozen=True)
class Mechanism:
    """Parameters as the paper names them: road-wheel side, the column's at the handwheel."""

    inertia: float = 2.5
    ratio: float = 16.0
    stiffness: float = 12.5
    aligning: float = 360.0
    viscous: float = 29.0
    half_gap: float = 0.0
    kinetic: float = 0.0
    static: float = 0.0
    stribeck: float = 0.0
    stribeck_speed: float = 1.0
    cubic: float = 0.0
    drag: float = 0.0
    asymmetric: float = 0.0
    # Stiffness and angle of a stop, stiffness and half width of a dead zone, both at the road wheel.
    end_stop: tuple[float, float] = (0.0, 0.0)
    dead_zone: tuple[float, float] = (0.0, 0.0)
    # Amplitude, phase and number of waves per turn of the pinion, felt `ratio` times at the road wheel.
    waves: tuple[tuple[float, float, int], ...] = ()
    # Kinetic and static friction per angle, and at a spot: extra, angle, standard deviation.
    slope: float = 0.0
    spot: tuple[float, float, float] = (0.0, 0.0, 1.0)
    # Growth of static friction after a long rest, and its time.
    dwell: tuple[float, float] = (0.0, 1.0)

    def spring(self, psi: float, phi: float) -> float:
        """Torque on the road wheel."""
        z = psi - self.ratio * phi
        wound = z - min(max(z, -self.half_gap), self.half_gap)
        column = self.ratio * (self.stiffness * wound + self.cubic * wound**3)
        beyond = sum(k * math.copysign(max(abs(phi) - w, 0.0), phi) for k, w in (self.end_stop, self.dead_zone))
        turn = sum(a * math.sin(n * self.ratio * phi + phase) for a, phase, n in self.waves)
        return column - self.aligning * phi - beyond - self.ratio * turn

    def local(self, phi: float) -> float:
        """Dry friction that an angle adds."""
        extra, angle, width = self.spot
        return self.slope * phi + extra * math.exp(-0.5 * ((phi - angle) / width) ** 2)

    def friction(self, speed: float, side: int, phi: float) -> float:
        """Torque against the motion to one side."""
        dry = self.kinetic + self.local(phi) + self.stribeck * math.exp(-((speed / self.stribeck_speed) ** 2))
        return side * dry + self.asymmetric + self.viscous * speed + self.drag * speed * abs(speed)

    def holds(self, torque: float, phi: float, rest_s: float) -> bool:
        """Whether friction at rest holds a torque after some seconds."""
        grown = self.dwell[0] * (1.0 - math.exp(-rest_s / self.dwell[1]))
        level = max(self.static, self.kinetic) + self.local(phi) + self.stribeck + grown
        return -level + self.asymmetric <= torque <= level + self.asymmetric


@dataclass(frozen=True)
class Hand:
    """A handwheel angle as a sum of sines that starts from rest at 0."""

    amplitudes: tuple[float, ...]
    frequencies_hz: tuple[float, ...]
    phases: tuple[float, ...] = field(default=())
    ramp_s: float = 1.0

    def __call__(self, t: float | np.ndarray) -> float | np.ndarray:
        phases = self.phases or (0.0,) * len(self.amplitudes)
        out = sum(
            a * np.sin(2.0 * math.pi * f * t + q)
            for a, f, q in zip(self.amplitudes, self.frequencies_hz, phases, strict=True)
        )
        rise = np.clip(np.asarray(t) / self.ramp_s, 0.0, 1.0)
        return out * rise**2 * (3.0 - 2.0 * rise)


def drawn_hand(chance: np.random.Generator, size: float = 1.0) -> Hand:
    """A hand that turns to and fro between a tenth and one and a half hertz."""
    count = 7
    amplitudes = size * chance.uniform(0.1, 0.35, count)
    frequencies = chance.uniform(0.1, 1.5, count)
    return Hand(tuple(amplitudes), tuple(frequencies), tuple(chance.uniform(0.0, 2.0 * math.pi, count)))


def simulate(m: Mechanism, hand: Hand, times: np.ndarray, *, tolerance: float = 1e-9) -> np.ndarray:
    """Return the road wheel's angle at some instants, from rest at 0."""
    out = np.empty(times.size)
    t, phi, mode = float(times[0]), 0.0, 0
    speed = 0.0
    end = float(times[-1])
    while True:
        inside = times >= t
        if mode == 0:
            # Stuck: the angle stays; the torque is scanned for the instant at which it is too much.
            grid = np.linspace(t, end, max(2, int((end - t) * SCANS_PER_S) + 1))
            torque = np.array([m.spring(float(hand(x)), phi) for x in grid])
            lost = np.array([not m.holds(q, phi, x - t) for q, x in zip(torque, grid, strict=True)])
            if not lost.any():
                out[inside] = phi
                return out
            k = int(np.argmax(lost))
            low, high = (float(grid[max(k - 1, 0)]), float(grid[k]))
            for _ in range(60):
                middle = 0.5 * (low + high)
                if m.holds(m.spring(float(hand(middle)), phi), phi, middle - t):
                    low = middle
                else:
                    high = middle
            out[inside & (times <= high)] = phi
            t, speed = high, 0.0
            mode = 1 if m.spring(float(hand(high)), phi) > 0.0 else -1
            continue
        side = mode

        def rate(x: float, y: np.ndarray, side: int = side) -> list[float]:
            return [y[1], (m.spring(float(hand(x)), y[0]) - m.friction(y[1], side, y[0])) / m.inertia]

        def stops(x: float, y: np.ndarray, side: int = side) -> float:
            return side * y[1]

        stops.terminal, stops.direction = True, -1.0  # type: ignore[attr-defined]
        # A first instant by hand, so that the event at the start is not taken for one.
        first = min(1e-7, (end - t) / 2.0)
        pull = rate(t, np.array([phi, speed]))[1]
        begin = [phi + speed * first + 0.5 * pull * first**2, speed + pull * first]
        if side * begin[1] <= 0.0:
            mode, speed = 0, 0.0
            t = t + first
            if t >= end:
                out[times >= t] = phi
                return out
            continue
        wanted = times[(times > t + first)]
        solved = solve_ivp(
            rate,
            (t + first, end),
            begin,
            method="DOP853",
            rtol=tolerance,
            atol=1e-3 * tolerance,
            t_eval=wanted,
            events=stops,
            max_step=0.02,
        )
        out[inside & (times <= t + first)] = phi
        if len(solved.t):
            out[np.isin(times, solved.t)] = solved.y[0]
        if solved.status != 1:
            return out
        t, phi, speed = float(solved.t_events[0][0]), float(solved.y_events[0][0][0]), 0.0
        torque = m.spring(float(hand(t)), phi)
        mode = 0 if m.holds(torque, phi, 0.0) else (1 if torque > 0.0 else -1)


def steering_run(
    m: Mechanism,
    chance: np.random.Generator,
    *,
    seconds: float = 15.0,
    rate_hz: float = 250.0,
    noise_rad: float = 5e-4,
    size: float = 1.0,
) -> dict[str, np.ndarray]:
    """Return time, handwheel and road wheel of one run, the road wheel with white noise."""
    times = np.arange(round(seconds * rate_hz)) / rate_hz
    hand = drawn_hand(chance, size)
    phi = simulate(m, hand, times, tolerance=RUN_TOLERANCE)
    return {
        "time": times,
        "handwheel": np.asarray(hand(times)),
        "roadwheel": phi + chance.normal(0.0, noise_rad, times.size),
    }
