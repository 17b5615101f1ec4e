"""What a run of a mechanism gives back: motions, torques, events, energies."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from .._stream import Mappings
from ..errors import ParameterError
from .indeterminacy import Indeterminacy, indeterminacy
from .mechanism import Mechanism

# Of the energy turned over; the residual is of second order in the step, so that a step a third as long has a tenth.
LARGEST_RESIDUAL = 0.01


@dataclass(frozen=True)
class Event:
    """One event of a run.

    Attributes
    ----------
    time_s : float
    element : str
        The friction that sticks, slips or reverses; the spring whose gap touches or opens.
    kind : str
        ``stick``, ``slip``, ``reversal``, ``contact`` or ``release``.
    direction : int
        Of the motion that follows, or the side that touches; 0 where nothing moves.
    """

    time_s: float
    element: str
    kind: str
    direction: int

    def to_dict(self) -> dict[str, Any]:
        """Return the event as plain JSON values."""
        return {"time_s": self.time_s, "element": self.element, "kind": self.kind, "direction": self.direction}


@dataclass(frozen=True, repr=False)
class MechanismRun(Mappings):
    """What :func:`simulate` returns.

    Attributes
    ----------
    mechanism : Mechanism
    time_s : ndarray, shape (n,)
    position, speed : mapping of str to ndarray, shape (n,)
        Of bodies and driven nodes, rad or m and per second. A body that friction holds has a speed of exactly 0; the
        speed of a driven node is read off its samples.
    torque : mapping of str to ndarray, shape (n,)
        Along each element, Nm or N; of assistance, what it puts out.
    sliding : mapping of str to ndarray of int8, shape (n,)
        For each friction 0 where it holds, else the direction in which it slides.
    redundant : ndarray of bool, shape (n,)
        Where more frictions hold than it takes: their torques are then not unique (:attr:`indeterminate`), the motion
        is.
    events : tuple of Event
    crowded_steps : int
        Steps in which more happened than can be located; those are of first order.
    energy_j : mapping of str to float
        For each driven node, load and element the energy it has put in (a spring that stores and a friction that heats
        are negative), ``stored_first``, ``stored_last`` (motion and springs), ``turnover`` and ``residual``.
    """

    mechanism: Mechanism
    time_s: np.ndarray
    position: Mapping[str, np.ndarray]
    speed: Mapping[str, np.ndarray]
    torque: Mapping[str, np.ndarray]
    sliding: Mapping[str, np.ndarray]
    redundant: np.ndarray
    events: tuple[Event, ...]
    crowded_steps: int
    energy_j: Mapping[str, float]

    @property
    def balanced(self) -> bool:
        """Whether the energy that the numbers do not account for is below a hundredth of what was turned over."""
        return abs(self.energy_j["residual"]) <= LARGEST_RESIDUAL * self.energy_j["turnover"]

    @property
    def indeterminate(self) -> Indeterminacy | None:
        """The last sample at which the torques of holding frictions are not unique; None if there is none."""
        samples = np.flatnonzero(self.redundant)
        return self.indeterminate_at(int(samples[-1])) if samples.size else None

    def indeterminate_at(self, sample: int) -> Indeterminacy | None:
        """Return how the torques of the frictions that hold may be split at a sample; None where they are unique."""
        if not -self.time_s.size <= sample < self.time_s.size:
            remedy = f"Give a number from 0 to {self.time_s.size - 1}."
            raise ParameterError(f"there is no sample {sample}", "sample", remedy)
        if not self.redundant[sample]:
            return None
        held = {name: float(self.torque[name][sample]) for name, row in self.sliding.items() if row[sample] == 0}
        return indeterminacy(self.mechanism, held, time_s=float(self.time_s[sample]))

    def sensor(self, name: str) -> np.ndarray:
        """Return the channel of a sensor.

        Raises
        ------
        ParameterError
            There is no such sensor.
        """
        found = next((s for s in self.mechanism.sensors if s.name == name), None)
        if found is None:
            known = ", ".join(s.name for s in self.mechanism.sensors) or "none"
            raise ParameterError(f"there is no sensor '{name}'", "sensor", f"Known are: {known}.")
        if found.quantity == "stretch":
            e = self.mechanism[found.of]
            ends = [r * (self.position[n] if n != "ground" else 0.0) for n, r in ((e.a, e.ratio_a), (e.b, e.ratio_b))]
            return found.factor * np.asarray(ends[0] - ends[1])
        return found.factor * getattr(self, found.quantity)[found.of]

    def to_dict(self) -> dict[str, Any]:
        """Return the run as plain JSON values."""
        indeterminate = self.indeterminate
        return {
            "mechanism": self.mechanism.to_dict(),
            "time_s": self.time_s.tolist(),
            "position": {name: row.tolist() for name, row in self.position.items()},
            "speed": {name: row.tolist() for name, row in self.speed.items()},
            "torque": {name: row.tolist() for name, row in self.torque.items()},
            "sliding": {name: row.tolist() for name, row in self.sliding.items()},
            "events": [e.to_dict() for e in self.events],
            "crowded_steps": self.crowded_steps,
            "energy_j": dict(self.energy_j),
            "balanced": self.balanced,
            "indeterminate": None if indeterminate is None else indeterminate.to_dict(),
        }

    def figure(self) -> Any:
        """Return positions over time, with what holds shaded below (plotly)."""
        from .picture import run

        return run(self)

    def __str__(self) -> str:
        told = Counter(e.kind for e in self.events)
        lines = [f"{self.mechanism.title or 'mechanism'}: {self.time_s[-1]:g} s"]
        for body in self.mechanism.bodies:
            q, v = self.position[body.name], self.speed[body.name]
            lines.append(
                f"  {body.name}: {q.min():.4g} to {q.max():.4g} {body.unit}, at rest {100 * np.mean(v == 0.0):.1f} %"
            )
        lines.append("events: " + (", ".join(f"{n} {kind}" for kind, n in told.items()) or "none"))
        e = self.energy_j
        spent = {n: v for n, v in e.items() if n not in ("stored_first", "stored_last", "turnover", "residual")}
        lines.append("energy: " + ", ".join(f"{n} {v:.4g} J" for n, v in spent.items() if v != 0.0))
        lines.append(f"residual {e['residual']:.2g} J of {e['turnover']:.4g} J turned over")
        if self.crowded_steps:
            lines.append(f"{self.crowded_steps} steps held more events than can be located: take more substeps.")
        if not self.balanced:
            lines.append("The energy does not add up: take more substeps.")
        found = self.indeterminate
        if found is not None:
            lines.append(str(found))
        return "\n".join(lines)

    __repr__ = __str__
