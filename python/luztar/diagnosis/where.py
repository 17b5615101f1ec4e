"""Where a model fails: the error split by what the mechanism was doing, in words and as a map."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from .fit import Fit
from .prepare import Prepared

# A reversal's influence is looked for this long after the motion starts, and an angle zone is an eighth of the range.
AFTER_REVERSAL_S = 0.5
ANGLE_ZONES = 8
# A regime is worth a sentence where it holds more of the excess than of the samples.
WORTH_SHARE = 0.1
WORTH_OVER_SAMPLES = 1.25
MAP_ANGLES, MAP_SPEEDS = 16, 6


@dataclass(frozen=True)
class Regime:
    """One regime with its part of the error.

    Attributes
    ----------
    regime : str
        ``after_reversal``, ``at_rest``, ``low_speed``, ``high_speed``, ``increasing``, ``decreasing``, ``angle_zone``,
        ``early``, ``late`` or ``run``.
    share : float
        Of the excess over the noise floor; regimes overlap.
    floor_ratio : float
        The regime's rms over the floor.
    text : str
    """

    regime: str
    share: float
    floor_ratio: float
    text: str

    def to_dict(self) -> dict[str, Any]:
        """Return the regime as the JSON interface prints it."""
        return {"regime": self.regime, "share": self.share, "floor_ratio": self.floor_ratio, "text": self.text}


@dataclass(frozen=True)
class Map:
    """Mean residual by position, speed and direction.

    Attributes
    ----------
    position, speed : ndarray
        Centres of the cells, in the structure's units.
    increasing, decreasing : ndarray, shape (speeds, positions)
        Mean of measured less modelled; NaN where no sample fell.
    """

    position: np.ndarray
    speed: np.ndarray
    increasing: np.ndarray
    decreasing: np.ndarray


def _direction(r: Prepared) -> np.ndarray:
    direction = np.zeros(r.motion.size)
    for s in r.strokes:
        direction[s.onset : s.last] = s.direction
    return direction


def _stack(runs: Sequence[Prepared], of: Sequence[np.ndarray]) -> np.ndarray:
    return np.concatenate([v[r.usable] for r, v in zip(runs, of, strict=True)])


def regimes(fitted: Fit, residual: Sequence[np.ndarray] | None = None) -> tuple[Regime, ...]:
    """Return the regimes that hold more of the excess error than their share of the samples, the largest first."""
    runs = fitted.runs
    error = _stack(runs, residual if residual is not None else fitted.residual) ** 2
    floor = fitted.noise_floor.moving_rms
    reversal_floor = fitted.noise_floor.zone_rms
    zone = _stack(runs, [r.zone for r in runs])
    expected = np.where(zone, reversal_floor**2, floor**2)
    excess_total = float(error.sum() - expected.sum())
    if excess_total <= 0.0 or not error.size:
        return ()
    found = []
    for name, mask, text in _masks(fitted):
        count = int(mask.sum())
        if count < 5:
            continue
        share = float(error[mask].sum() - expected[mask].sum()) / excess_total
        ratio = math.sqrt(float(error[mask].sum()) / max(float(expected[mask].sum()), np.finfo(float).tiny))
        if share > WORTH_SHARE and share > WORTH_OVER_SAMPLES * count / error.size and ratio > 1.1:
            percent = f"{100 * min(share, 1.0):.0f} % of the excess error lies {text}, where the error is"
            found.append(Regime(name, min(share, 1.0), ratio, f"{percent} {ratio:.1f} times the noise floor."))
    return tuple(sorted(found, key=lambda r: -r.share))


def _masks(fitted: Fit) -> list[tuple[str, np.ndarray, str]]:
    runs = fitted.runs
    turns = fitted.model.structure.turns
    speed = np.abs(_stack(runs, [r.speed for r in runs]))
    motion = _stack(runs, [r.motion for r in runs])
    direction = _stack(runs, [_direction(r) for r in runs])
    since = _stack(runs, [_since_onset(r) for r in runs])
    clock = _stack(runs, [r.time_s / max(r.duration_s, 1e-9) for r in runs])
    owner = np.concatenate([np.full(int(r.usable.sum()), i) for i, r in enumerate(runs)])
    top = float(speed.max())
    rest = fitted.model.structure.rest_speed or 0.03 * top
    moving = speed >= rest
    slow_limit, fast_limit = np.quantile(speed[moving], [0.25, 0.75]) if moving.any() else (rest, rest)

    def place(value: float) -> str:
        return f"{math.degrees(value):.0f}°" if turns else f"{value * 1000:.0f} mm"

    def pace(value: float) -> str:
        return f"{math.degrees(value):.0f} deg/s" if turns else f"{value * 1000:.0f} mm/s"

    masks = [
        ("after_reversal", since < AFTER_REVERSAL_S, f"within {AFTER_REVERSAL_S:g} s after a reversal"),
        ("at_rest", ~moving & (since >= AFTER_REVERSAL_S), "at rest"),
        ("low_speed", moving & (speed <= slow_limit), f"at low speed (below {pace(slow_limit)})"),
        ("high_speed", moving & (speed >= fast_limit), f"at high speed (above {pace(fast_limit)})"),
        (
            "increasing",
            moving & (direction > 0),
            "while the angle increases" if turns else "while the position increases",
        ),
        (
            "decreasing",
            moving & (direction < 0),
            "while the angle decreases" if turns else "while the position decreases",
        ),
        ("early", clock < 1.0 / 3.0, "in the first third of the runs"),
        ("late", clock > 2.0 / 3.0, "in the last third of the runs"),
    ]
    edges = np.linspace(float(motion.min()), float(motion.max()), ANGLE_ZONES + 1)
    for low, high in zip(edges[:-1], edges[1:], strict=True):
        masks.append(
            ("angle_zone", moving & (motion >= low) & (motion <= high), f"between {place(low)} and {place(high)}")
        )
    if len(runs) > 1:
        masks += [("run", owner == i, f"in {r.name}") for i, r in enumerate(runs)]
    return masks


def _since_onset(r: Prepared) -> np.ndarray:
    since = np.full(r.motion.size, np.inf)
    for s in r.strokes:
        since[max(0, s.onset - 2) : s.last] = np.arange(s.last - max(0, s.onset - 2)) * r.step_s
    return since


def residual_map(fitted: Fit) -> Map:
    """Return the mean residual by position, speed and direction, as the report draws it."""
    runs = fitted.runs
    motion = _stack(runs, [r.motion for r in runs])
    speed = np.abs(_stack(runs, [r.speed for r in runs]))
    direction = _stack(runs, [_direction(r) for r in runs])
    residual = _stack(runs, fitted.residual)
    places = np.linspace(float(motion.min()), float(motion.max()), MAP_ANGLES + 1)
    paces = np.linspace(0.0, float(speed.max()), MAP_SPEEDS + 1)
    sides = []
    for way in (1, -1):
        chosen = direction == way
        count, _, _ = np.histogram2d(speed[chosen], motion[chosen], [paces, places])
        total, _, _ = np.histogram2d(speed[chosen], motion[chosen], [paces, places], weights=residual[chosen])
        sides.append(np.divide(total, count, out=np.full_like(total, np.nan), where=count > 0))
    return Map((places[1:] + places[:-1]) / 2, (paces[1:] + paces[:-1]) / 2, sides[0], sides[1])
