"""The work-precision diagram: error against cost, both logarithmic, a panel for each problem. Needs matplotlib."""

from __future__ import annotations

from collections.abc import Mapping

import matplotlib as mpl

mpl.use("Agg")

from matplotlib import pyplot as plt  # noqa: E402

BLUE, ORANGE, GREY, GREEN, PINK = "#2458a6", "#c8641b", "#9aa3ad", "#3d8b57", "#b5518f"
# Colour, marker and line by the first words of a way.
STYLES = {
    "luztar split, one": (BLUE, "o", "--"),
    "luztar split": (BLUE, "o", "-"),
    "luztar moreau": (BLUE, "s", ":"),
    "numba, the": (GREEN, "^", "-"),
    "numba, tanh": (GREEN, "v", ":"),
    "scipy RK45": (ORANGE, "o", "-"),
    "scipy DOP853": (ORANGE, "s", "-"),
    "scipy LSODA": (ORANGE, "^", "-"),
    "MuJoCo, tuned": (PINK, "s", "-"),
    "MuJoCo, def": (PINK, "v", ":"),
}


def draw(panels: Mapping[str, list[tuple[str, str, float, float]]], path: str) -> None:
    """Draw the points of every problem and write the picture."""
    plt.rcParams.update({"font.size": 9, "axes.spines.top": False, "axes.spines.right": False, "figure.dpi": 120})
    figure, axes = plt.subplots(1, len(panels), figsize=(9.6, 4.4), sharex=True, sharey=True)
    shown = {}
    for place, (title, found) in zip(axes, panels.items(), strict=True):
        for way in dict.fromkeys(way for way, *_ in found):
            colour, marker, line = next(style for start, style in STYLES.items() if way.startswith(start))
            curve = [(1e6 * cost, error) for w, _, cost, error in found if w == way]
            (shown[way],) = place.loglog(
                *zip(*curve, strict=True), line, color=colour, marker=marker, ms=4, lw=1.2, label=way
            )
        place.set(title=title, xlabel="processor time per simulated second [us]")
        place.grid(color="#eeeeee")
    axes[0].set_ylabel("largest error [rad]")
    figure.legend(shown.values(), shown.keys(), loc="upper center", ncol=3, frameon=False, bbox_to_anchor=(0.5, 0.02))
    figure.tight_layout()
    figure.savefig(path, bbox_inches="tight", metadata={"Software": None})
    plt.close(figure)
