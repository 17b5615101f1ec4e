"""Pictures of a calibration: names, null p-values, intervals, peers. Needs matplotlib."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import matplotlib as mpl
import numpy as np

mpl.use("Agg")

from matplotlib import pyplot as plt  # noqa: E402
from matplotlib.axes import Axes  # noqa: E402

from .cases import EFFECTS, NOISES, OUTSIDE  # noqa: E402
from .tally import Rate, Record, coverage, of_kind, rate  # noqa: E402

BLUE, ORANGE, GREY, GREEN = "#2458a6", "#c8641b", "#9aa3ad", "#3d8b57"


def draw(records: Sequence[Record], folder: Path) -> list[str]:
    """Draw what there is something to draw of; return the names of the files."""
    folder.mkdir(parents=True, exist_ok=True)
    plt.rcParams.update({"font.size": 9, "axes.spines.top": False, "axes.spines.right": False, "figure.dpi": 120})
    made = []
    for name, picture in (
        ("calibration_names.png", _names),
        ("calibration_nothing_hidden.png", _nulls),
        ("calibration_intervals.png", _intervals),
    ):
        figure = picture(records)
        if figure is not None:
            figure.savefig(folder / name, bbox_inches="tight", metadata={"Software": None})
            plt.close(figure)
            made.append(name)
    return made


def _whisker(axes: Axes, y: float, found: Rate, colour: str, label: str | None = None) -> None:
    low, high = found.interval
    axes.plot([100 * low, 100 * high], [y, y], color=colour, lw=1.4, alpha=0.6, solid_capstyle="round")
    axes.plot(100 * found.share, y, "o", color=colour, ms=5, label=label)


def _names(records: Sequence[Record]) -> plt.Figure | None:
    mine = of_kind(records, "effect")
    outside = of_kind(records, "outside")
    if not mine:
        return None
    effects = [e for e in EFFECTS if any(r["effect"] == e for r in mine)]
    sizes = sorted({r["size"] for r in mine}, reverse=True)
    rows = len(effects) + (len(OUTSIDE) if outside else 0)
    figure, all_axes = plt.subplots(1, len(sizes), figsize=(2.9 * len(sizes) + 1.6, 0.24 * rows + 1.1), sharey=True)
    for axes, size in zip(np.atleast_1d(all_axes), sizes, strict=True):
        for y, effect in enumerate(effects):
            here = [r for r in mine if r["effect"] == effect and r["size"] == size]
            if here:
                _whisker(
                    axes, y + 0.17, rate(here, lambda r: r["in_set"]), GREY, "in a set of at most 3" if not y else None
                )
                _whisker(axes, y - 0.17, rate(here, lambda r: r["exact"]), BLUE, "exact" if not y else None)
        if size == sizes[0] and outside:
            for y, effect in enumerate(dict.fromkeys(r["effect"] for r in outside), start=len(effects)):
                here = [r for r in outside if r["effect"] == effect]
                found = rate(here, lambda r: r["verdict"] == "unexplained")
                _whisker(axes, y, found, ORANGE, "unexplained" if y == len(effects) else None)
        axes.axvline(95, color="k", lw=0.7, ls=":")
        axes.set(title=f"size {size:g}", xlabel="% of cases", xlim=(-4, 104))
        axes.grid(axis="x", color="#eeeeee")
    first = np.atleast_1d(all_axes)[0]
    shown = effects + (list(dict.fromkeys(r["effect"] for r in outside)) if outside else [])
    first.set_yticks(range(len(shown)), [e.replace("_", " ") for e in shown])
    first.invert_yaxis()
    figure.legend(
        *first.get_legend_handles_labels(), loc="upper center", ncol=3, frameon=False, bbox_to_anchor=(0.5, 0.05)
    )
    return figure


def _nulls(records: Sequence[Record]) -> plt.Figure | None:
    mine = of_kind(records, "null")
    if len(mine) < 5:
        return None
    figure, (left, right) = plt.subplots(1, 2, figsize=(7.6, 3.2))
    for noise, colour in zip(NOISES, (BLUE, ORANGE, GREEN), strict=True):
        p = np.sort([r["p_value"] for r in mine if r["noise"] == noise])
        if p.size:
            left.step(p, np.arange(1, p.size + 1) / p.size, where="post", color=colour, label=f"{noise} (N = {p.size})")
    left.plot([0, 1], [0, 1], color="k", lw=0.7, ls=":")
    left.set(xlabel="p-value of the first look", ylabel="share of cases below", title="Nothing hidden")
    left.legend(frameon=False)
    kinds = list(dict.fromkeys(k for r in mine for k in r.get("kinds", {})))
    for y, kind in enumerate(kinds):
        here = [r for r in mine if kind in r.get("kinds", {})]
        _whisker(right, y, rate(here, lambda r, k=kind: r["kinds"][k][0] <= 0.05), BLUE)
    right.axvline(5, color="k", lw=0.7, ls=":")
    right.set_yticks(range(len(kinds)), kinds)
    right.invert_yaxis()
    right.set(xlabel="% of cases rejected at 5 %", title="Each kind of test by itself", xlim=(0, None))
    figure.tight_layout()
    return figure


def _intervals(records: Sequence[Record]) -> plt.Figure | None:
    mine = [r for r in records if not r["peers"] and "intervals" in r]
    rows = {k: found for k, (found, _) in coverage(mine).items() if found.tries}
    if not rows:
        return None
    figure, axes = plt.subplots(figsize=(6.4, 0.2 * len(rows) + 0.9))
    axes.axvspan(93, 97, color="#e5eefb", label="93–97 %")
    for y, found in enumerate(rows.values()):
        _whisker(axes, y, found, BLUE)
    axes.set_yticks(range(len(rows)), [f"{k}  ({v.tries})" for k, v in rows.items()])
    axes.invert_yaxis()
    axes.axvline(95, color="k", lw=0.7, ls=":")
    axes.set(xlabel="% of 95 % intervals that hold the truth", xlim=(0, 102))
    axes.margins(y=0.01)
    return figure
