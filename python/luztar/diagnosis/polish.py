"""The last steps of a fit: all inner parameters together, by Gauss and Newton.

One at a time, parameters that do nearly the same (a delay and a break-away, a speed and a level) creep along their
valley and stop before its end. The derivative of the model by all of them points along it.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from ..model import card
from .equations import blocks
from .grids import limits
from .jacobian import Inner, continuous, jacobian
from .profile import Problem, State, state
from .terms import Terms

STEPS = 4
# A step that lowers the loss by less than this is not worth another.
WORTH = 1e-5
# The loss over a gap has corners at the steps of the sensor: a step that does not help is shortened.
SHARES = (1.0, 0.5, 0.2)


def polish(problem: Problem, start: State, visit: Callable[[State], None]) -> State:
    """Step all continuous inner parameters together while the sum of squares falls.

    Parameters
    ----------
    problem : Problem
    start : State
    visit : callable
        Is shown every state tried.
    """
    best = start
    for _ in range(STEPS):
        varied = continuous(problem, best, sharpness=True)
        if not varied:
            break
        parts = blocks(problem.runs, jacobian(problem, best, varied), problem.weights)
        # After the columns of the effects come the derivatives, last the common shift of the starts.
        move = parts.solve()[-1 - len(varied) : -1]
        before = best.loss
        for share in SHARES:
            tried = state(problem, _moved(problem, best.terms, varied, share * move))
            visit(tried)
            if tried.loss < best.loss:
                best = tried
                break
        if best.loss > before * (1.0 - WORTH):
            break
    return best


def _moved(problem: Problem, terms: Terms, varied: list[Inner], move: np.ndarray) -> Terms:
    inner = {name: list(values) for name, values in terms.inner.items()}
    for v, by in zip(varied, move, strict=True):
        low, high = limits(card(v.effect, problem.model.structure_name).inner[v.index], problem.runs)
        # No further than half-way to an end at a time: beyond it the law is another.
        now = inner[v.effect][v.index]
        inner[v.effect][v.index] = float(np.clip(now + by, now - 0.5 * (now - low), now + 0.5 * (high - now)))
    return Terms(terms.effects, {name: tuple(values) for name, values in inner.items()})
