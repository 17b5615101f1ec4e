"""Draws effects.png and writes effects.md: the loop of every effect and its card (`python docs/pictures/effects.py`).

The pictures need matplotlib.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np

from luztar.errors import ModelError
from luztar.model import Card, cards
from luztar.planning.looks import Look, look

HERE = Path(__file__).parent
COLUMNS = 4
HEAD = """# The effects

What each effect of the catalogue adds to the torque of a friction rig, and what may cause it. The pictures show torque
over angle of six simulated strokes: grey a sound rig, blue with the effect, at a size chosen to be seen. Typical sizes
stand below. `luztar explain EFFECT` prints a card, with `--report F.html` with its picture; in Python
`luztar.effects.look("stribeck").figure()`.

![Loops of all effects](pictures/effects.png)
"""


def looks() -> list[Look]:
    """Return the looks of all effects that have one."""
    found = []
    for c in cards():
        try:
            found.append(look(c.name))
        except ModelError:
            continue
    return found


def draw(found: list[Look]) -> None:
    """Write the small multiples."""
    import matplotlib as mpl

    mpl.use("Agg")
    from matplotlib import pyplot as plt

    rows = -(-len(found) // COLUMNS)
    figure, axes = plt.subplots(rows, COLUMNS, figsize=(10.5, 1.9 * rows), sharex=True)
    for axis in axes.flat[len(found) :]:
        axis.set_visible(False)
    for axis, one in zip(axes.flat, found, strict=False):
        angle = np.rad2deg(one.angle_rad)
        axis.plot(angle, one.plain_nm, color="#9AA0A6", lw=0.8)
        axis.plot(angle, one.with_effect_nm, color="#1F5FBF", lw=0.9)
        axis.set_title(one.effect, fontsize=9)
        axis.tick_params(labelsize=7)
        axis.spines[["top", "right"]].set_visible(False)
    # The last picture of every column has no other below it.
    for axis in axes.flat[max(0, len(found) - COLUMNS) : len(found)]:
        axis.set_xlabel("angle [deg]", fontsize=8)
        axis.tick_params(labelbottom=True)
    for axis in axes[:, 0]:
        axis.set_ylabel("torque [Nm]", fontsize=8)
    figure.tight_layout()
    figure.savefig(HERE / "effects.png", dpi=130)


def section(c: Card) -> str:
    """Return one card as a section."""
    rows = (
        ("Law", f"`{c.equation}`"),
        ("Looks like", c.look),
        ("Typical", c.typical),
        ("Cause", c.cause),
        ("Check", c.check),
        ("Source", c.source),
        ("Parameters", "; ".join(f"`{p.key}` {p.meaning}" for p in c.parameters)),
    )
    body = "\n".join(f"- {head}: {text}" for head, text in rows if text)
    return f"## {c.name}: {c.title}\n\n{body}\n"


def page() -> str:
    """Return the page."""
    return "\n".join([HEAD, *(section(c) for c in cards() if not c.is_decoy)])


def main() -> None:
    """Draw and write."""
    draw(looks())
    (HERE.parent / "effects.md").write_text(page(), encoding="utf-8")


if __name__ == "__main__":
    main()
