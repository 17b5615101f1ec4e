"""Draws the pictures of docs/double-lane-change.md: a drive, the table of signals on cars, angle beside torque.

Needs playwright and Chromium (``python docs/pictures/lane_change.py [FOLDER]`` from the top of the repository). With a
folder the journals of the studies are kept there: the first time takes minutes, a second time seconds.
"""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Any

import numpy as np
from screenshot import screenshot

from luztar.manoeuvre import Robustness, load, optimise, robust
from luztar.report.manoeuvre_figures import drives, table
from luztar.report.style import AFTER, BEFORE, dressed, numbers, panels

HERE = Path(__file__).parent
EXAMPLES = HERE.parents[1] / "examples"


def excitations(found: dict[str, dict[str, Robustness]]) -> Any:
    """Return J_w of the nominal signal over friction and over freeplay, by angle and by torque."""
    titles = [f"{name}, over {what}" for name in found for what in ("friction", "freeplay")]
    picture = panels(rows=2, cols=2, subplot_titles=titles, vertical_spacing=0.16, horizontal_spacing=0.09)
    for row, results in enumerate(found.values(), start=1):
        for steer, colour in (("angle", AFTER), ("torque", BEFORE)):
            result = results[steer]
            own = result.fine_criterion[0]
            ratio = np.where(np.isfinite(own), own, np.nan) / own[0, 0]
            for col, (x, y) in enumerate(
                [(result.fine_friction_nm, ratio[0]), (result.fine_freeplay_rad, ratio[:, 0])], start=1
            ):
                picture.add_scatter(
                    x=numbers(x),
                    y=numbers(y),
                    mode="lines+markers",
                    marker={"size": 5},
                    line={"color": colour},
                    name=f"by {steer}",
                    legendgroup=steer,
                    showlegend=row == col == 1,
                    row=row,
                    col=col,
                )
                lost = np.flatnonzero(~np.isfinite(y))
                if lost.size:
                    # Where the line ends, the car has left the limits.
                    at = x[lost[0]]
                    picture.add_vline(x=float(at), line={"color": colour, "dash": "dot", "width": 1}, row=row, col=col)
                picture.update_yaxes(title_text="J_w / J_w of the nominal car", row=row, col=col)
                picture.update_xaxes(
                    title_text="friction at the king-pins [Nm]" if col == 1 else "half freeplay z0 [rad]",
                    row=row,
                    col=col,
                )
    picture.update_yaxes(range=[0.9, 2.2])
    return dressed(picture, height=640, legend=True)


def main() -> None:
    """Compute what the page shows and take the pictures."""
    folder = Path(sys.argv[1]) if len(sys.argv) > 1 else None
    found: dict[str, dict[str, Robustness]] = {}
    for name in ("overtaking", "avoiding"):
        found[name] = {}
        for steer in ("angle", "torque"):
            task = load(EXAMPLES / f"{name}.toml", steer=steer).task()
            journal = None if folder is None else folder / f"{name}-{steer}.jsonl"
            found[name][steer] = robust(task, journal=journal)
    screenshot([drives(optimise(load(EXAMPLES / "avoiding.toml").task()))], HERE / "lane_change_drive.png")
    screenshot([table(found["avoiding"]["angle"])], HERE / "lane_change_table.png")
    screenshot([excitations(found)], HERE / "lane_change_excitation.png")


if __name__ == "__main__":
    main()
