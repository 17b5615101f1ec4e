"""One mass in place of a mechanism: substitute parameters as the seed paper's models are derived.

All bodies move as one, with springs rigid and gaps closed: ``q_i = g_i phi``. Inertia, damping and friction add up
along that motion. Springs and gaps lie in series: with the handwheel held, a torque on the steered wheels twists each
element by its share of the torque (virtual forces). The torque acts where the mechanism has loads, shared like their
inertia; without loads on the body itself.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from ..errors import ParameterError
from .manoeuvres import Manoeuvre, ReductionError, compare, manoeuvres
from .mechanism import Mechanism
from .parts import Assistance, Damper, EndStop, Friction, Spring

# A singular value below this share of the largest counts as 0: a second free motion, or none.
_RANK = 1e-9


@dataclass(frozen=True)
class Reduction:
    """What :func:`reduce` returns: a one-mass model in place of a mechanism.

    Attributes
    ----------
    at : str
        The body whose coordinate the one mass has.
    parameters : dict of str to float
        Keys of :func:`luztar.dynamics.simulate`.
    motion : dict of str to float
        How far each body and driven node moves per unit of the one mass.
    left_out : tuple of str
        Elements that one mass has no place for.
    errors : tuple of ReductionError
        Against the mechanism, manoeuvre by manoeuvre.
    """

    at: str
    parameters: dict[str, float]
    motion: dict[str, float]
    left_out: tuple[str, ...]
    errors: tuple[ReductionError, ...]

    def to_dict(self) -> dict[str, Any]:
        """Return the reduction as plain JSON values."""
        return {
            "at": self.at,
            "parameters": dict(self.parameters),
            "motion": dict(self.motion),
            "left_out": list(self.left_out),
            "errors": [e.to_dict() for e in self.errors],
        }

    def figure(self) -> Any:
        """Return mechanism and one mass over time, a panel per manoeuvre (plotly)."""
        from .picture import reduction

        return reduction(self)

    def __str__(self) -> str:
        lines = [f"one mass at {self.at}"]
        lines += [f"  {key:<36} {value:.6g}" for key, value in self.parameters.items()]
        if self.left_out:
            lines.append(f"left out: {', '.join(self.left_out)}")
        lines += [str(e) for e in self.errors]
        return "\n".join(lines)


def reduce(
    mechanism: Mechanism,
    *,
    at: str,
    handwheel: str = "handwheel",
    tests: Sequence[Manoeuvre] | None = None,
) -> Reduction:
    """Return the one-mass model that stands for a mechanism, and how far it is off.

    Parameters
    ----------
    mechanism : Mechanism
        Its handwheel's angle given, or a body: then as if its angle were given.
    at : str
        The body whose coordinate the one mass takes, a steered wheel.
    handwheel : str
        The driven node or body at which ratio, stiffness and freeplay are seen.
    tests : sequence of Manoeuvre, optional
        Handwheel angles over time; :func:`manoeuvres` where none are given: a step, sines of three amplitudes, an
        on-centre weave.

    Returns
    -------
    Reduction

    Raises
    ------
    ParameterError
        An unknown body, a mechanism that can move in more than one way with its springs rigid, or not at all.

    Examples
    --------
    >>> from luztar.mechanism import reduce, steering_mechanism
    >>> found = reduce(steering_mechanism(), at="left_wheel")
    >>> round(found.parameters["steering.ratio"], 6), round(found.parameters["freeplay.gap_rad"], 6)
    (16.0, 0.1)
    """
    if handwheel not in {d.name for d in mechanism.driven}:
        mechanism = mechanism.given(handwheel)
    shape = _Shape(mechanism, at, handwheel)
    friction = [e for e in mechanism.elements if isinstance(e, Friction)]
    parameters = {
        "steering.inertia_kg_m2": sum(b.inertia * shape.motion[b.name] ** 2 for b in mechanism.bodies),
        "steering.ratio": shape.motion[handwheel],
        "steering.stiffness_nm_per_rad": shape.stiffness(),
        "steering.aligning_nm_per_rad": shape.total(Spring, "stiffness", grounded=True),
        "viscous.coefficient_nm_s_per_rad": shape.total(Damper, "viscous"),
        "freeplay.gap_rad": shape.gap(),
        "coulomb.level_nm": sum(e.kinetic * abs(shape.along(e)) for e in friction),
        "stiction.extra_nm": sum((_static(e) - e.kinetic) * abs(shape.along(e)) for e in friction),
    }
    tests = manoeuvres() if tests is None else tuple(tests)
    errors = tuple(compare(mechanism, parameters, at, handwheel, test) for test in tests)
    return Reduction(at, parameters, dict(shape.motion), shape.left_out(), errors)


def _static(e: Friction) -> float:
    return e.kinetic + e.stribeck if e.static is None else e.static


class _Shape:
    """The motion of all bodies as one, and the share of each element in a torque."""

    def __init__(self, m: Mechanism, at: str, handwheel: str) -> None:
        self.m, self.at, self.handwheel = m, at, handwheel
        self.nodes = [p.name for p in (*m.bodies, *m.driven)]
        if at not in {b.name for b in m.bodies}:
            known = ", ".join(b.name for b in m.bodies)
            raise ParameterError(f"there is no body '{at}'", "at", f"Known are: {known}.")
        if len(m.driven) != 1:
            given = ", ".join(d.name for d in m.driven)
            raise ParameterError(f"the motions of {given} are given", "mechanism", "Give the handwheel's only.")
        self.springs = [
            e for e in m.elements if isinstance(e, Spring) and e.stiffness > 0.0 and "ground" not in (e.a, e.b)
        ]
        rows = np.array([self._row(e) for e in self.springs]).reshape(-1, len(self.nodes))
        _, s, vt = np.linalg.svd(rows, full_matrices=True)
        rank = int(np.sum(s > _RANK * s[0])) if s.size else 0
        ways = len(self.nodes) - rank
        if ways != 1:
            problem = "it cannot move with its springs rigid" if ways == 0 else f"it can move in {ways} ways at once"
            remedy = "Reduce a mechanism whose springs join all bodies with the handwheel, without loops of two ratios."
            raise ParameterError(problem, "mechanism", remedy)
        way = vt[-1] / vt[-1][self.nodes.index(at)]
        self.motion = dict(zip(self.nodes, way.tolist(), strict=True))
        self._share_of_torque(rows)

    def _row(self, e: Any) -> np.ndarray:
        row = np.zeros(len(self.nodes))
        for node, share in ((e.a, e.ratio_a), (e.b, -e.ratio_b)):
            if node in self.nodes:
                row[self.nodes.index(node)] += share
        return row

    def along(self, e: Any) -> float:
        """Return how far an element is moved per unit of the one mass."""
        return float(self._row(e) @ np.array(list(self.motion.values())))

    def total(self, kind: type, field: str, grounded: bool = False) -> float:
        """Return the sum of a parameter, seen at the one mass."""
        found = [e for e in self.m.elements if type(e) is kind and (not grounded or "ground" in (e.a, e.b))]
        return float(sum(getattr(e, field) * self.along(e) ** 2 for e in found))

    def _share_of_torque(self, rows: np.ndarray) -> None:
        """Find the static twist of every spring per torque at the one mass, the handwheel held."""
        bodies = len(self.m.bodies)
        load = np.zeros(len(self.nodes))
        loaded = {p.on for p in self.m.loads} or {self.at}
        for i, b in enumerate(self.m.bodies):
            if b.name in loaded:
                load[i] = b.inertia * self.motion[b.name]
        load /= load @ np.array(list(self.motion.values()))
        stiffness = np.array([e.stiffness for e in self.springs])
        free = rows[:, :bodies]
        matrix = free.T @ (stiffness[:, None] * free)
        moved = np.linalg.solve(matrix, load[:bodies])
        self.compliance = float(load[:bodies] @ moved)
        self.torque = stiffness * (free @ moved)

    def stiffness(self) -> float:
        """Return the springs in series, at the handwheel."""
        return 1.0 / (self.motion[self.handwheel] ** 2 * self.compliance)

    def gap(self) -> float:
        """Return the freeplay at the handwheel: every gap by its share of the torque."""
        lost = sum(abs(t) * e.gap for t, e in zip(self.torque, self.springs, strict=True))
        return float(lost * abs(self.motion[self.handwheel]))

    def left_out(self) -> tuple[str, ...]:
        """Return the elements, or parts of them, that the one mass has no place for."""
        lost = []
        for e in self.m.elements:
            still = not isinstance(e, Assistance | Spring | EndStop) and abs(self.along(e)) <= _RANK
            curved = (isinstance(e, Damper) and e.drag > 0.0) or (isinstance(e, Spring) and e.hardening > 0.0)
            shaped = isinstance(e, Friction) and (e.difference != 0.0 or e.stribeck != 0.0)
            gap = isinstance(e, Spring) and "ground" in (e.a, e.b) and e.gap > 0.0
            if isinstance(e, Assistance | EndStop) or still or curved or shaped or gap:
                lost.append(e.name)
        return tuple(lost)
