"""The cards of the effects, read from the core, where each stands beside its law."""

from __future__ import annotations

import difflib
import functools
import math
from dataclasses import dataclass, replace
from typing import Any

from .. import _core
from ..errors import ModelError
from . import axis_words, steering_words

# An axis has newtons and metres where a rig has newton metres and radians. A phase stays an angle.
_AXIS_UNITS = (("kg_m2", "kg"), ("nm", "n"), ("rad3", "m3"), ("rad2", "m2"), ("rad", "m"))


@dataclass(frozen=True)
class Parameter:
    """One parameter of an effect.

    Attributes
    ----------
    key : str
        Name with unit, as in JSON and model files.
    symbol, meaning : str
        The letter in the equation and what it is.
    low, high : float
        Bounds.
    role : str
        ``linear``, ``amplitude``, ``phase`` or ``inner``.
    grid : tuple or None
        How an inner parameter is searched: a word and the numbers that go with it.
    """

    key: str
    symbol: str
    meaning: str
    low: float
    high: float
    role: str
    grid: tuple[str, float, float] | None

    @property
    def unit(self) -> str:
        """The unit, read off the key."""
        words = self.key.split("_")
        shown = {"nm": "Nm", "n": "N", "rad": "rad", "m": "m", "s": "s", "kg": "kg", "m2": "m²", "rad2": "rad²"}
        shown |= {"s2": "s²", "rad3": "rad³", "m3": "m³"}
        if "per" in words:
            at = words.index("per")
            above = [shown[w] for w in words[:at] if w in shown]
            below = [shown[w] for w in words[at + 1 :] if w in shown]
            return f"{'·'.join(above) or '1'}/{'·'.join(below)}"
        units = [shown[w] for w in words[1:] if w in shown]
        return "/".join(units) if units in (["rad", "s"], ["m", "s"]) else "·".join(units)


@dataclass(frozen=True)
class Card:
    """Everything there is to know about an effect besides its law."""

    name: str
    title: str
    kind: str
    equation: str
    look: str
    cause: str
    check: str
    typical: str
    source: str
    behind_gap: bool
    per_turn: bool
    shapes_others: bool
    becomes: str | None
    channel: str | None
    needs: str | None
    structures: tuple[str, ...]
    parameters: tuple[Parameter, ...]

    @property
    def inner(self) -> tuple[Parameter, ...]:
        """The parameters inside the law, in its order."""
        return tuple(p for p in self.parameters if p.role == "inner")

    @property
    def linear(self) -> tuple[Parameter, ...]:
        """The parameters that multiply columns, in the order of the columns."""
        return tuple(p for p in self.parameters if p.role != "inner")

    def is_searched_on(self, structure: str) -> bool:
        """Whether a search on a structure tries the effect; a model may hold it anywhere."""
        return not self.structures or structure in self.structures

    @property
    def is_decoy(self) -> bool:
        """Whether the effect has no physics and serves as a ruler."""
        return self.kind == "decoy"

    def to_dict(self) -> dict[str, Any]:
        """Return the card as plain JSON values."""
        bound = {float("inf"): None, float("-inf"): None}
        return {
            "name": self.name,
            "title": self.title,
            "kind": self.kind,
            "equation": self.equation,
            "look": self.look,
            "cause": self.cause,
            "check": self.check,
            "typical": self.typical,
            "source": self.source,
            "parameters": [
                {
                    "key": p.key,
                    "symbol": p.symbol,
                    "unit": p.unit,
                    "meaning": p.meaning,
                    "low": bound.get(p.low, p.low),
                    "high": bound.get(p.high, p.high),
                    "role": p.role,
                }
                for p in self.parameters
            ],
        }


def axis_key(key: str) -> str:
    """Return a rig's parameter key as an axis names it: newtons for newton metres, metres for radians."""
    if key == "phase_rad":
        return key
    words = key.split("_")
    text = "_".join(words)
    for rig, axis in _AXIS_UNITS:
        text = "_".join(axis if w == rig else w for w in text.split("_")) if "_" not in rig else text.replace(rig, axis)
    return text


@functools.cache
def _all(structure: str) -> dict[str, Card]:
    found = {}
    for raw in _core.effect_cards():
        parameters = tuple(Parameter(**p) for p in raw["parameters"])
        if structure == "axis":
            parameters = tuple(
                replace(p, key=axis_key(p.key), meaning=axis_words.meaning(p.meaning)) for p in parameters
            )
            raw |= {"typical": "", **axis_words.WORDS.get(raw["name"], {})}
        if structure == "steering":
            if raw["name"] not in steering_words.WORDS:
                continue
            raw |= {"typical": "", **steering_words.WORDS[raw["name"]]}
            parameters = tuple(_for_steering(raw["name"], p) for p in parameters)
            parameters = tuple(p for p in parameters if f"{raw['name']}.{p.key}" not in steering_words.RIGID)
        fields: dict[str, Any] = {**raw, "structures": tuple(raw["structures"]), "parameters": parameters}
        found[raw["name"]] = Card(**fields)
    return found


def _for_steering(effect: str, p: Parameter) -> Parameter:
    if effect == "offset":
        return replace(p, key="level_rad", meaning="shift of the road wheel's angle")
    own = steering_words.MEANINGS.get(f"{effect}.{p.key}", steering_words.MEANINGS.get(p.key, {}))
    return replace(p, **own)


@functools.cache
def own_card(structure: str) -> Card | None:
    """Return the card of a structure's own parameters, named as the structure; None where it has none."""
    if structure != "steering":
        return None
    parameters = tuple(
        Parameter(key, symbol, meaning, low, math.inf, "linear", None)
        for key, symbol, meaning, low in steering_words.OWN
    )
    words = dict.fromkeys(("look", "cause", "check", "typical"), "")
    return Card(
        **words,
        name="steering",
        title="steering mechanism",
        kind="structure",
        equation="I phi'' = p K luz(psi - p phi, gap/2) - c phi - friction",
        source="paper eq. (5)",
        behind_gap=False,
        per_turn=False,
        shapes_others=True,
        becomes=None,
        channel=None,
        needs=None,
        structures=(),
        parameters=parameters,
    )


def cards(structure: str = "rig") -> tuple[Card, ...]:
    """Return every card, decoys included, in the order of the catalogue.

    Parameters
    ----------
    structure : str
        ``rig``, ``axis`` or ``steering``: decides the units in the parameters' keys and which effects there are.
    """
    return tuple(_all(structure).values())


def card(name: str, structure: str = "rig") -> Card:
    """Return the card of one effect.

    Raises
    ------
    ModelError
        Where there is no such effect; the nearest names are in the remedy.
    """
    known = _all(structure)
    if name in known:
        return known[name]
    own = own_card(structure)
    if own is not None and name == own.name:
        return own
    near = difflib.get_close_matches(name, known, n=3, cutoff=0.5)
    guess = f"Did you mean {' or '.join(near)}? " if near else ""
    listed = ", ".join(c.name for c in known.values() if not c.is_decoy)
    if structure == "steering" and name in _all("rig"):
        raise ModelError(f"'{name}' is no effect of a steering model", "effects", f"{guess}Its effects are: {listed}.")
    raise ModelError(f"there is no effect '{name}'", "effects", f"{guess}Known effects: {listed}.")
