"""Small mechanisms that several tests need, and step sizes that fit no period."""

from __future__ import annotations

import numpy as np

from luztar.mechanism import Body, Damper, Friction, Load, Mechanism, Spring

# Steps per run, each about twice the one before and none commensurate with a period of the models.
STEPS = (331, 662, 1324, 2648, 5296)


def chain(*, static: float = 1.0, between: float = 0.0, gap: float = 0.02) -> Mechanism:
    """Two bodies on springs with a gap between them, dry friction on each, and between them if wanted."""
    elements = [
        Spring("k1", "one", stiffness=30.0),
        Spring("k2", "one", "two", stiffness=50.0, gap=gap),
        Damper("d", "one", "two", viscous=0.3),
        Friction("f1", "one", kinetic=1.1, static=1.1 * static),
        Friction("f2", "two", kinetic=0.7, static=0.7 * static),
    ]
    if between:
        elements.append(Friction("f12", "one", "two", kinetic=between, static=between * static))
    return Mechanism(
        bodies=(Body("one", 1.0), Body("two", 0.6)), loads=(Load("push", "two"),), elements=tuple(elements)
    )


def push(t: np.ndarray) -> np.ndarray:
    """A load that makes the chain slide, stick and turn."""
    return 4.0 * np.sin(5.3 * t) + 2.0 * np.sin(2.2 * t)


def observed_order(errors: list[float]) -> float:
    """The mean slope over the whole range of steps, a factor of two apart: single pairs scatter with the events."""
    return float(np.log2(errors[0] / errors[-1]) / (len(errors) - 1))
