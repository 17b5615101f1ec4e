"""Draws the picture of vehicle.md: a car beside that of commonroad-vehicle-models. Needs matplotlib and the peer.

``PYTHONPATH=tests python docs/pictures/vehicle.py`` from the top of the repository.
"""

from __future__ import annotations

from pathlib import Path

import matplotlib as mpl

mpl.use("Agg")

from matplotlib import pyplot as plt  # noqa: E402

from generators import commonroad  # noqa: E402
from luztar.vehicle import Car, Pieces, simulate  # noqa: E402

BLUE, ORANGE, GREY = "#2458a6", "#c8641b", "#9aa3ad"
FOLDER = Path(__file__).parent
SPEED_M_S = 20.0


def main() -> None:
    """Drive one sine of the handwheel and draw yaw rate and roll of both."""
    hand = Pieces(start_s=[0.5, 3.0], amplitude=[0.8, 0.0], frequency_hz=0.4)
    figure, axes = plt.subplots(1, 2, figsize=(9.6, 3.4))
    quick = {"front.relaxation_m": 0.0, "rear.relaxation_m": 0.0}
    for model, tyre, colour in (("single_track", "linear", BLUE), ("twelve", "magic_formula", ORANGE)):
        run = simulate(
            Car.named("bmw_320i"),
            handwheel_rad=hand,
            speed_m_s=SPEED_M_S,
            duration_s=5.0,
            step_s=0.001,
            model=model,
            tyre=tyre,
            vary=quick,
        )
        theirs = commonroad.drive(run, SPEED_M_S, multi_body=model == "twelve")
        label = {"single_track": "single track", "twelve": "12 degrees of freedom"}[model]
        other = {"single_track": "their single track", "twelve": "their multi-body"}[model]
        axes[0].plot(run.time_s, run.yaw_rate_rad_s, color=colour, lw=3, alpha=0.5, label=label)
        axes[0].plot(theirs["time_s"], theirs["yaw_rate_rad_s"], color=colour, ls="--", lw=1.2, label=other)
        if model == "twelve":
            axes[1].plot(run.time_s, run.roll_rad, color=colour, lw=3, alpha=0.5, label=label)
            axes[1].plot(theirs["time_s"], theirs["roll_rad"], color=colour, ls="--", lw=1.2, label=other)
    for axis, title in zip(axes, ("Yaw rate, rad/s", "Roll angle, rad"), strict=True):
        axis.set_title(title, loc="left", fontsize=10)
        axis.set_xlabel("time, s")
        axis.axhline(0.0, color=GREY, lw=0.6)
        axis.legend(frameon=False, fontsize=8)
        axis.spines[["top", "right"]].set_visible(False)
    figure.tight_layout()
    figure.savefig(FOLDER / "vehicle.png", dpi=110)


if __name__ == "__main__":
    main()
