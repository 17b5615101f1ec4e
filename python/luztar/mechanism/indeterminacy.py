"""Static friction that is not unique: the smallest split of the torques, and how far each may be off it.

Where more frictions hold than it takes, only their sum on each body follows from equilibrium (Zardecki 2007, JTAM
45:289). Reported are the admissible split of least norm and, for each friction, the interval of its torques over all
admissible splits: two small linear programmes each.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from types import MappingProxyType
from typing import Any

import numpy as np

from .._stream import Mappings
from .mechanism import Mechanism
from .parts import Friction

# A singular value below this share of the largest counts as 0: ratios of a steering lie within 1e3 of each other.
_RANK = 1e-10
# An interval narrower than this share of the limits is a single value.
_UNIQUE = 1e-9


@dataclass(frozen=True)
class Indeterminacy(Mappings):
    """How the torques of frictions that hold may be split.

    Attributes
    ----------
    time_s : float
    least_norm : mapping of str to float
        The admissible split with the smallest sum of squares, Nm or N.
    interval : mapping of str to (float, float)
        What each torque may be.
    """

    time_s: float
    least_norm: Mapping[str, float]
    interval: Mapping[str, tuple[float, float]]

    @property
    def undetermined(self) -> tuple[str, ...]:
        """The frictions whose torque is not unique."""
        return tuple(n for n, (low, high) in self.interval.items() if high > low)

    def to_dict(self) -> dict[str, Any]:
        """Return it as plain JSON values."""
        return {
            "time_s": self.time_s,
            "least_norm": dict(self.least_norm),
            "interval": {name: list(pair) for name, pair in self.interval.items()},
        }

    def __str__(self) -> str:
        rows = (f"{n} {self.least_norm[n]:.4g} of [{a:.4g}, {b:.4g}]" for n, (a, b) in self.interval.items())
        return f"at {self.time_s:.4g} s the motion is unique, static friction is not: {', '.join(rows)}"


def indeterminacy(m: Mechanism, held: Mapping[str, float], *, time_s: float = 0.0) -> Indeterminacy:
    """Return all splits that put the same torques on the bodies as a given one.

    Parameters
    ----------
    m : Mechanism
    held : mapping of str to float
        Torques of the frictions that hold, one admissible split.
    time_s : float

    Returns
    -------
    Indeterminacy
    """
    from scipy.optimize import linprog

    bodies = [b.name for b in m.bodies]
    names = list(held)
    directions = np.zeros((len(bodies), len(names)))
    low, high = (np.zeros(len(names)) for _ in range(2))
    for column, name in enumerate(names):
        friction = m[name]
        assert isinstance(friction, Friction)
        for node, share in ((friction.a, friction.ratio_a), (friction.b, -friction.ratio_b)):
            if node in bodies:
                directions[bodies.index(node), column] += share
        sliding = friction.kinetic + friction.stribeck
        static = sliding if friction.static is None else friction.static
        low[column], high[column] = friction.difference - static, friction.difference + static
    given = np.array([held[n] for n in names])
    # Rows that say the same twice would confuse the programme with their rounding.
    u, s, vt = np.linalg.svd(directions, full_matrices=False)
    kept = s > _RANK * s[0]
    rows, total = vt[kept], (u[:, kept] / s[kept]).T @ (directions @ given)
    low, high = np.minimum(low, given), np.maximum(high, given)
    interval = {}
    for column, name in enumerate(names):
        goal = np.zeros(len(names))
        goal[column] = 1.0
        ends = []
        for sign in (1.0, -1.0):
            found = linprog(sign * goal, A_eq=rows, b_eq=total, bounds=np.column_stack([low, high]))
            ends.append(float(found.x[column]) if found.success else float(given[column]))
        a, b = min(ends), max(ends)
        narrow = b - a <= _UNIQUE * (high[column] - low[column])
        interval[name] = (float(given[column]),) * 2 if narrow else (a, b)
    least = _least_norm(rows, total, low, high, given)
    return Indeterminacy(time_s, MappingProxyType(dict(zip(names, least.tolist(), strict=True))), interval)


def _least_norm(rows: Any, total: Any, low: Any, high: Any, given: Any) -> np.ndarray:
    """Return ``min |t|^2`` with ``rows t = total`` within the bounds: an active set from an admissible point."""
    torque = given.copy()
    bound = np.zeros(torque.size, dtype=bool)
    # Each round binds one or frees one at a lower norm: no set comes twice.
    for _ in range(4 * 2 ** min(torque.size, 12)):
        free = ~bound
        wanted = torque.copy()
        wanted[free] = np.linalg.pinv(rows[:, free]) @ (total - rows[:, bound] @ torque[bound])
        step = wanted - torque
        with np.errstate(divide="ignore", invalid="ignore"):
            room = np.where(step > 0.0, (high - torque) / step, np.where(step < 0.0, (low - torque) / step, np.inf))
        room[bound] = np.inf
        first = int(np.argmin(room))
        if room[first] < 1.0:
            torque = torque + max(float(room[first]), 0.0) * step
            torque[first] = high[first] if step[first] > 0.0 else low[first]
            bound[first] = True
            continue
        torque = wanted
        # Multipliers: t = rows' y on the free ones; a bound one that would rather be inside is freed.
        y, *_ = np.linalg.lstsq(rows[:, free].T, torque[free], rcond=None)
        pull = rows.T @ y - torque
        inward = np.where(torque >= high, -pull, pull) * bound
        worst = int(np.argmax(inward))
        if inward[worst] <= _UNIQUE * np.abs(high - low).max():
            break
        bound[worst] = False
    return torque
