"""The error of every channel out by itself, in its own unit."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

if TYPE_CHECKING:
    from .fit import FreeFit

UNITS = {
    "yaw_rate": "rad/s",
    "lateral_acceleration": "m/s^2",
    "roll_angle": "rad",
    "roadwheel": "rad",
    "position": "m",
}


@dataclass(frozen=True)
class ChannelError:
    """How far a model is from one channel.

    Attributes
    ----------
    channel, unit : str
    rms, held_out_rms : float
        Over the comparison's samples of all runs: as fitted, and unseen.
    noise : float
        Of the channel, from the record alone: what the errors of all channels are counted in.
    """

    channel: str
    unit: str
    rms: float
    held_out_rms: float
    noise: float

    def to_dict(self) -> dict[str, Any]:
        """Return the figures as the JSON interface prints them."""
        return {"unit": self.unit, "rms": self.rms, "held_out_rms": self.held_out_rms, "noise": self.noise}

    def __str__(self) -> str:
        return (
            f"  {self.channel}: error {self.rms:.3g}, unseen {self.held_out_rms:.3g}, noise {self.noise:.3g} "
            f"{self.unit}"
        )


def channel_errors(fitted: FreeFit) -> tuple[ChannelError, ...]:
    """Return the error by channel."""
    first = fitted.free_problem.data.records[0]
    seen = [(r, r.effort - p) for r, p in zip(fitted.runs, fitted.predicted, strict=True)]
    unseen = [(r, r.effort - p) for r, p in zip(fitted.held_out or fitted.runs, fitted.held_out_predicted, strict=True)]
    out = []
    for name, scale in zip(first.channels, map(float, first.scales), strict=True):
        both = []
        for errors in (seen, unseen):
            of = [e[r.usable] for r, e in errors if r.channel in ("", name)]
            both.append(scale * float(np.sqrt(np.mean(np.concatenate(of) ** 2))))
        out.append(ChannelError(name, UNITS[name], both[0], both[1], scale))
    return tuple(out)
