"""Draws mechanisms.png: the paper's mechanism as a network, and a run of it.

Needs playwright and Chromium (``python docs/pictures/mechanisms.py`` from the top of the repository).
"""

from __future__ import annotations

from pathlib import Path

import numpy as np
from screenshot import screenshot

from luztar.mechanism import power_assistance, simulate, steering_mechanism

TARGET = Path(__file__).with_name("mechanisms.png")


def main() -> None:
    """Run the mechanism along a sine and take the picture."""
    m = steering_mechanism(assistance=power_assistance())
    psi = np.sin(np.pi * np.arange(1001) / 250.0)
    run = simulate(m, {"handwheel": psi}, sample_rate_hz=250.0)
    screenshot([m.figure(), run.figure()], TARGET)


if __name__ == "__main__":
    main()
