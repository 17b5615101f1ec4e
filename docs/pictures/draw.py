"""Draws ladder.png from the bundled runs: the ladder of errors above the loops before and after.

Needs playwright and Chromium (``python docs/pictures/draw.py`` from the top of the repository).
"""

from __future__ import annotations

from importlib.resources import files
from pathlib import Path

from screenshot import screenshot

import luztar
from luztar.report.figures import ladder, loops_before_after

TARGET = Path(__file__).with_name("ladder.png")


def main() -> None:
    """Study the bundled runs and take the picture."""
    demo = files("luztar") / "demo_data"
    study = luztar.study(luztar.Model.rig(), luztar.read(*(demo / f"run{n}.csv.gz" for n in (1, 2, 3))))
    top, below = ladder(study), loops_before_after(study)
    below.update_layout(height=390)
    screenshot([top, below], TARGET, scale=1.5)


if __name__ == "__main__":
    main()
