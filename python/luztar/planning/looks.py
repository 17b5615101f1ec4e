"""What an effect looks like: the loop of a sound mechanism with and without it, by the same law as every fit."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np

from ..diagnosis.profile import owners
from ..diagnosis.terms import start_terms
from ..errors import ModelError
from ..model import Model, card
from .rehearse import Sensor, rehearse
from .signatures import added
from .trials import as_planned
from .typical import SOUND, Reach, typical_inner

# Six strokes of a TB 038 test, slow and fast ones.
AMPLITUDE_DEG, OVERSHOOT_DEG, SPEEDS_DEG_S, STROKES, RATE_HZ = 50.0, 8.0, (5.0, 38.0), 6, 200.0
# What the picture shows an effect to add at most, as a share of the friction: enough to be seen, not to hide the rest.
SHOWN_OVER_FRICTION = 0.6


@dataclass(frozen=True)
class Look:
    """Torque over angle of a sound rig, plain and with one effect.

    Attributes
    ----------
    effect, title, text : str
    time_s, angle_rad : ndarray, shape (n,)
    plain_nm, with_effect_nm : ndarray, shape (n,)
    """

    effect: str
    title: str
    text: str
    time_s: np.ndarray
    angle_rad: np.ndarray
    plain_nm: np.ndarray
    with_effect_nm: np.ndarray

    def figure(self) -> Any:
        """Return a plotly figure: the loops on the left, what the effect adds over time on the right."""
        from ..report.style import dressed, numbers, panels

        angle = numbers(np.rad2deg(self.angle_rad))
        picture = panels(rows=1, cols=2, subplot_titles=("the loop", "what it adds"), horizontal_spacing=0.1)
        for torque, name, colour in (
            (self.plain_nm, "a sound rig", "#9AA0A6"),
            (self.with_effect_nm, f"with {self.title}", "#1F5FBF"),
        ):
            picture.add_scatter(
                x=angle, y=numbers(torque), name=name, mode="lines", line={"color": colour, "width": 1.8}, row=1, col=1
            )
        picture.add_scatter(
            x=numbers(self.time_s),
            y=numbers(self.with_effect_nm - self.plain_nm),
            mode="lines",
            line={"color": "#1F5FBF", "width": 1.8},
            showlegend=False,
            row=1,
            col=2,
        )
        made = dressed(picture, height=380, title=f"{self.title}: {self.text}", legend=True)
        made.update_xaxes(title_text="angle [deg]", row=1, col=1)
        made.update_xaxes(title_text="time [s]", row=1, col=2)
        made.update_yaxes(title_text="torque [Nm]", row=1, col=1)
        return made


def look(effect: str) -> Look:
    """Simulate what an effect looks like on a friction rig, at typical inner parameters.

    Parameters
    ----------
    effect : str
        Its name. Its size is chosen to be seen: at most 0.6 of the friction.

    Returns
    -------
    Look

    Raises
    ------
    ModelError
        An effect that there is not, or that needs a channel which a plain test does not record.
    """
    c = card(effect)
    if c.is_decoy or c.channel or c.name in Model.rig().effects:
        what = f"needs the channel '{c.channel}'" if c.channel else "is part of the loop itself"
        raise ModelError(f"there is no picture of '{c.name}': it {what}", "effect", "Ask for another effect.")
    model, unit = Model.rig(), math.pi / 180.0
    sensor = Sensor(0.02 * unit, RATE_HZ, 0.02)
    low, high = SPEEDS_DEG_S
    make = as_planned(AMPLITUDE_DEG * unit, (low * unit, high * unit), STROKES, OVERSHOOT_DEG * unit)
    runs = rehearse([make(1.0 / RATE_HZ, 1)], sensor, model)
    (run,) = runs
    sound = SOUND["rig"]
    base = start_terms(model, runs)
    nominal = np.array([sound.get(name, 0.0) if i == 0 else 0.0 for name, i in owners(base, model)])
    plain = run.recording.columns(base.pairs(), list(range(len(base.effects)))).T @ nominal
    terms = base.having(c.name, typical_inner(c, model, Reach.of(runs)))
    more = added(run, terms, c, nominal, plain)[:, 0]
    if not c.shapes_others:
        more = more * SHOWN_OVER_FRICTION * sound["coulomb"] / max(float(np.abs(more[run.usable]).max()), 1e-12)
    keep = run.usable
    return Look(c.name, c.title, c.look, run.time_s[keep], run.motion[keep], plain[keep], (plain + more)[keep])
