"""From coefficients to parameters: the values that one effect has in a fitted state."""

from __future__ import annotations

import math

from ..model import card
from .profile import Problem, State, owners


def effect_values(problem: Problem, state: State, name: str) -> dict[str, float]:
    """Return an effect's parameters by key."""
    c = card(name, problem.model.structure_name)
    free = [o for o in owners(state.terms, problem.model) if o not in problem.fixed]
    linear = [
        problem.fixed[(name, i)] if (name, i) in problem.fixed else float(state.coefficients[free.index((name, i))])
        for i in range(len(c.linear))
    ]
    if c.linear and c.linear[0].role == "amplitude":
        linear = [math.hypot(*linear), math.atan2(linear[1], linear[0])]
    values = {p.key: v for p, v in zip(c.linear, linear, strict=True)}
    return values | {p.key: float(v) for p, v in zip(c.inner, state.terms.inner.get(name, ()), strict=True)}
