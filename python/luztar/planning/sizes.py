"""The smallest size of each effect that a test can show, and what it may be taken for."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from ..diagnosis.candidates import PRACTICAL_GAIN, SET_ERRORS
from ..model import Card, card
from .rehearse import Sensor
from .signatures import Signatures, Variant

# One test among the thirty or so directions of the catalogue stands at 5 % where a single one stands at 3.3.
STANDARD_ERRORS = 3.3
# Two effects whose torques are ``d`` standard errors apart differ in their losses by ``d^2`` with a standard error of
# ``2 d``: the worse one leaves the set in nineteen of twenty tests where that is 1.64 more than the set allows.
TOLD_ERRORS = 2.0 * (SET_ERRORS + 1.64)
# A gap or break-away smaller than this many times the first point of its grid is folded into a sharp one.
FOLDED_BELOW = 1.5
# Effects whose cosine is above this leave less than a tenth of their power to tell them by.
CONFUSABLE = 0.95


@dataclass(frozen=True)
class Smallest:
    """What a test can see of one effect.

    Attributes
    ----------
    effect : str
    parameter, unit : str
        The effect's main parameter, in SI.
    size : float or None
        The smallest value that the test shows; None where it shows none of the values looked at.
    at : dict of str to float
        The inner parameters this holds for.
    rival : str or None
        The effect that imitates it best.
    cosine : float
        How well.
    told_from : float or None
        The size from which it is told from that rival; None where it never is, or depends on more than its size.
    """

    effect: str
    parameter: str
    unit: str
    size: float | None
    at: dict[str, float]
    rival: str | None
    cosine: float
    told_from: float | None

    def to_dict(self) -> dict[str, Any]:
        """Return the entry as the JSON interface prints it."""
        return {
            "effect": self.effect,
            "parameter": self.parameter,
            "unit": self.unit,
            "size": self.size,
            "at": self.at,
            "rival": self.rival,
            "cosine": self.cosine,
            "told_from": self.told_from,
        }


def chance_errors(strokes: int) -> float:
    """Return how many standard errors an effect needs to stand out from chance.

    The tests take the stroke as the unit: their statistic ``z / sqrt(1 + z^2 / strokes)`` cannot exceed the root of the
    number of strokes, however large the effect. It must reach 3.3, with few strokes three quarters of what it can.
    """
    squared = min(STANDARD_ERRORS**2, 0.6 * strokes)
    return math.sqrt(squared / (1.0 - squared / strokes))


def gain_errors(table: Signatures, sensor: Sensor) -> float:
    """Return how many standard errors an effect has that takes 1 % off the error.

    Before, the mean square is that of the noise plus the effect's, after, that of the noise alone.
    """
    share = 1.0 / (1.0 - PRACTICAL_GAIN) ** 2 - 1.0
    # The noise's variance over that of one sample of the same density.
    step_s = 60.0 * table.minutes / max(table.samples, 1)
    independent = sensor.noise_rms**2 * step_s / sensor.density(table.model.band_hz)
    return math.sqrt(share * independent * table.samples)


def folds_into(rival: str, effect: str, structure: str) -> bool:
    """Whether a rival that imitates an effect has become that effect, and is then counted as it."""
    return card(rival, structure).becomes == effect


def nearest(table: Signatures, effect: str) -> tuple[str | None, float]:
    """Return the effect that imitates another best, with the cosine."""
    structure = table.model.structure_name
    found = [
        (table.cosine(effect, rival), rival)
        for rival in table.effects
        if rival != effect and not folds_into(rival, effect, structure)
    ]
    if not found:
        return None, 0.0
    cosine, rival = max(found)
    return rival, cosine


def smallest(table: Signatures, sensor: Sensor) -> tuple[Smallest, ...]:
    """Return the smallest size of every effect that a test can show, in the order of the catalogue."""
    return tuple(_smallest(table, sensor, name) for name in table.effects)


def _smallest(table: Signatures, sensor: Sensor, name: str) -> Smallest:
    structure = table.model.structure_name
    c = card(name, structure)
    variant = table.typical[name]
    rival, cosine = nearest(table, name)
    main = c.parameters[0]
    inner = dict(zip((p.key for p in c.inner), variant.inner, strict=True))
    inner.pop(main.key, None)
    told: float | None = None
    errors = max(chance_errors(table.strokes), gain_errors(table, sensor))
    if c.linear:
        strength = table.strength(variant)
        size = errors / strength if strength > 0.0 else None
        left = strength * math.sqrt(max(0.0, 1.0 - cosine**2))
        if size is not None and left > 0.0:
            told = max(size, TOLD_ERRORS / left)
    else:
        size = _crossing(table, c, variant, errors)
    if c.becomes and not c.inner:
        # Whatever its value, the data show it as the simpler one: a test never sees it for itself.
        size = told = None
    return Smallest(name, main.key, main.unit, size, inner, rival, cosine, told)


def _crossing(table: Signatures, c: Card, typical: Variant, errors: float) -> float | None:
    """Return the value of a contact's parameter at which the effect stands out, between the points of its grid."""
    # Of several parameters the first is the size; the others stay typical.
    same = [v for v in table.grid[c.name] if v.inner[1:] == typical.inner[1:]]
    same.sort(key=lambda v: v.inner[0])
    values = np.array([v.inner[0] for v in same])
    heights = np.maximum.accumulate([table.strength(v) for v in same])
    above = np.flatnonzero(heights >= errors)
    if not above.size:
        return None
    first = int(above[0])
    if c.name in ("delay", "lead"):
        # The sensor may show the starts late by their uncertainty, and the fit allows for as much again.
        return _between(values, heights, first, errors) + 2.0 * table.start_s
    # Below half above the first point of the grid a verdict calls it sharp friction.
    return max(_between(values, heights, first, errors), FOLDED_BELOW * float(values[0]))


def _between(values: np.ndarray, heights: np.ndarray, first: int, errors: float) -> float:
    if first == 0:
        return float(values[0])
    low, high = max(heights[first - 1], 1e-9), heights[first]
    share = math.log(errors / low) / math.log(high / low)
    return float(values[first - 1] * (values[first] / values[first - 1]) ** share)


@dataclass(frozen=True)
class Pair:
    """Two effects that a test cannot tell apart.

    Attributes
    ----------
    effects : tuple of str
        The effect and what imitates it.
    cosine : float
    trial : str or None
        Name of the test that would tell them apart; None where none of the list does.
    text : str
        That test in the words of the workshop.
    trial_cosine : float or None
        What their cosine is in that test.
    """

    effects: tuple[str, str]
    cosine: float
    trial: str | None
    text: str
    trial_cosine: float | None

    def to_dict(self) -> dict[str, Any]:
        """Return the pair as the JSON interface prints it."""
        return {
            "effects": list(self.effects),
            "cosine": self.cosine,
            "trial": self.trial,
            "text": self.text,
            "trial_cosine": self.trial_cosine,
        }


def confusable(table: Signatures, among: Sequence[str] | None = None) -> list[tuple[str, str, float]]:
    """Return the pairs (effect, imitator, cosine) that a test cannot tell apart, the worst first."""
    structure = table.model.structure_name
    names = list(table.effects if among is None else among)
    found = []
    for i, a in enumerate(names):
        for b in names[i + 1 :]:
            ways = [(table.cosine(x, y), x, y) for x, y in ((a, b), (b, a)) if not folds_into(y, x, structure)]
            # Where both ways are alike to what can be shown, the order of the catalogue decides, not a rounding.
            cosine, effect, rival = max(ways, key=lambda way: round(way[0], 4))
            if cosine > CONFUSABLE:
                found.append((effect, rival, cosine))
    return sorted(found, key=lambda p: -p[2])
