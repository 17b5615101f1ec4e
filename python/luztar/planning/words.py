"""A plan in plain text."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from ..model import card

if TYPE_CHECKING:
    from .plan import Plan
    from .sizes import Smallest

FEWEST_STROKES = 6
WIDTH = 110


def value(amount: float, unit: str) -> str:
    """Return a value with three digits; radians as degrees, metres of a gap as micrometres where they are few."""
    if unit == "rad":
        return f"{math.degrees(amount):.2g} deg"
    if unit == "rad/s":
        return f"{math.degrees(amount):.2g} deg/s"
    if unit == "m" and abs(amount) < 1e-3:
        return f"{1e6 * amount:.3g} um"
    if unit == "s" and abs(amount) < 0.1:
        return f"{1e3 * amount:.2g} ms"
    return f"{amount:.2g} {unit}".strip()


def at(entry: Smallest, structure: str) -> str:
    """Return the inner parameters that a size holds for."""
    inner = {p.key: p for p in card(entry.effect, structure).inner}
    said = []
    for key, amount in entry.at.items():
        if key == "shape":
            said.append("exponential" if amount > 0.5 else "stop")
        elif key == "per_turn":
            said.append(f"{amount:.0f} per turn")
        else:
            said.append(value(amount, inner[key].unit))
    return ", ".join(said)


def rows(plan: Plan) -> list[tuple[str, str, str, str, str]]:
    """Return the table: effect, smallest size, at what, nearest rival with cosine, told from it at what size."""
    structure = plan.model.structure_name
    made = []
    for s in plan.sizes:
        size = "not at all" if s.size is None else value(s.size, s.unit)
        rival = f"{s.rival} ({s.cosine:.2f})" if s.rival and s.cosine > 0.5 else ""
        told = value(s.told_from, s.unit) if rival and s.told_from is not None else ""
        made.append((s.effect, size, at(s, structure), rival, told))
    return made


HEADS = ("effect", "smallest size", "at", "looks most like (cosine)", "told from it at")


def plan_text(plan: Plan) -> str:
    """Return a plan as text."""
    sensor, unit = plan.sensor, plan.model.structure.effort_unit
    step = value(sensor.step, plan.model.structure.motion_unit)
    table = [HEADS, *rows(plan)]
    widths = [max(len(r[i]) for r in table) for i in range(len(HEADS))]
    lines = [
        f"{plan.model.structure_name}: {plan.test}; position step {step}, noise {sensor.noise_rms:g} {unit} in "
        f"{plan.model.band_hz:g} Hz",
        f"what this test can see beside {', '.join(plan.model.effects)} ({formula(plan)}):",
        *("  " + "  ".join(c.ljust(w) for c, w in zip(r, widths, strict=True)).rstrip() for r in table),
    ]
    if plan.strokes < FEWEST_STROKES:
        lines.append(f"{plan.strokes} strokes are too few to name anything: make it {FEWEST_STROKES} at least.")
    if not plan.pairs:
        return "\n".join([*lines, "It can tell all effects of the catalogue apart, where they are large enough."])
    lines.append("what it cannot tell apart:")
    tests: dict[str, list[str]] = {}
    for p in plan.pairs:
        there = "" if p.trial_cosine is None else f", {p.trial_cosine:.2f} there"
        tests.setdefault(p.text, []).append(f"{p.effects[0]} / {p.effects[1]} (cosine {p.cosine:.3f}{there})")
    for text, pairs in tests.items():
        lines += [f"  {pair}" for pair in pairs]
        lines.append(f"    -> {text}")
    return "\n".join(lines)


def formula(plan: Plan) -> str:
    """Return how the smallest size is found, in words."""
    if plan.gain_errors > plan.chance_errors:
        return f"{plan.gain_errors:.1f} standard errors: from there an effect takes 1 % off the unseen error"
    return f"{plan.chance_errors:.1f} standard errors: from there an effect stands out from chance"
