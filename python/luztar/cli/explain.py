"""The cards of the effects as text."""

from __future__ import annotations

import math
import textwrap
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from ..model import Card, Parameter

WIDTH = 100


def listed() -> list[dict[str, Any]]:
    """Return name, title and kind of every effect that stands for something physical."""
    from ..model import cards

    return [{"name": c.name, "title": c.title, "kind": c.kind} for c in cards() if not c.is_decoy]


def list_text() -> str:
    """Return the list of effects as text."""
    effects = listed()
    width = max(len(e["name"]) for e in effects)
    lines = [f"  {e['name']:<{width}}  {e['title']}" for e in effects]
    return "\n".join([*lines, "", "luztar explain EFFECT shows the card of one."])


def card_text(card: Card) -> str:
    """Return one card as text."""
    lines = [f"{card.name}: {card.title}", ""]
    for head, text in (
        ("law", card.equation),
        ("kind", card.kind),
        ("needs", card.needs),
        ("tried on", ", ".join(card.structures)),
        ("looks like", card.look),
        ("typical", card.typical),
        ("cause", card.cause),
        ("check", card.check),
        ("source", card.source),
    ):
        if text:
            lines += textwrap.wrap(text, WIDTH, initial_indent=f"{head:<12}", subsequent_indent=" " * 12)
    if card.parameters:
        lines += ["", "parameters"]
        width = max(len(p.key) for p in card.parameters)
        lines += [f"  {p.key:<{width}}  {_meaning(p)}" for p in card.parameters]
    return "\n".join(lines)


def _meaning(p: Parameter) -> str:
    symbol = f"{p.symbol}: " if p.symbol else ""
    unit = f" [{p.unit}]" if p.unit else ""
    return f"{symbol}{p.meaning}{unit}{_bounds(p.low, p.high)}"


def _bounds(low: float, high: float) -> str:
    if math.isinf(low) and math.isinf(high):
        return ", any value"
    if math.isinf(high):
        return f", at least {low:g}"
    return f", at most {high:g}" if math.isinf(low) else f", {low:g} to {high:g}"


def write_card(path: str, card: Card) -> None:
    """Write a card with the picture of its effect as one HTML page."""
    from ..errors import ModelError
    from ..planning.looks import look
    from ..report.leaf import write_leaf
    from .report import check_place, written

    check_place(path)
    try:
        figure, instead = look(card.name).figure(), "This figure is drawn by the browser."
    except ModelError as error:
        figure, instead = None, str(error)
    written(path, lambda: write_leaf(path, card.title, card_text(card), figure, instead))
