"""The cards' words for an effect that came out with the opposite sign of what its card describes.

An extra may be negative as far as the law goes. Then the card's picture, cause and workshop check are wrong, and
following them (regreasing against friction that is too low at low speed) does harm.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

from .cards import Card

# effect: what the loop looks like, what may cause it, what to check.
WORDS: Mapping[str, Mapping[str, str]] = {
    "stribeck": {
        "look": "Less friction at low speed than at medium speed: it rises with speed and levels off.",
        "cause": "Viscous friction that saturates, such as eddy currents or a thin film of oil; the opposite of "
        "Stribeck friction, its extra is negative.",
        "check": "Compare three even speeds before anything is regreased; look for a motor that is still energised.",
    },
    "tight_spot": {
        "look": "The loop narrows at one place, inward on both sides.",
        "cause": "Wear or lost preload at this place; the extra is negative.",
        "check": "Feel for play there and compare the preload on either side of it.",
    },
    "warmup": {
        "look": "The first loops of a run are narrower than the last.",
        "cause": "Friction that grows while it runs, such as parts that tighten as they warm; the extra is negative.",
        "check": "Let it rest until it is cold and repeat; feel what becomes warm.",
    },
    "dwell": {
        "look": "The spike at a start is lower after a longer pause.",
        "cause": "Stress that relaxes at rest, in a belt or a seal; the extra is negative.",
        "check": "Start after pauses of different length.",
    },
}


def in_sense(card: Card, values: Mapping[str, float]) -> Card:
    """Return the card with the words that fit the sign of what was found.

    Parameters
    ----------
    card : Card
    values : mapping of str to float
        The effect's parameters by key; those that are missing count as positive.
    """
    if card.name in WORDS and values.get(card.linear[0].key, 0.0) < 0.0:
        return replace(card, **WORDS[card.name])
    return card
