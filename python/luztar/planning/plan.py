"""Look at a test before anybody turns a wheel: which effects it can see, and which it cannot tell apart."""

from __future__ import annotations

import math
import os
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from .._arrays import whole_number
from ..errors import ParameterError
from ..model import Model, card
from .asked import LEAST_STROKES, MOST_STROKES, asked
from .rehearse import Sensor, rehearse
from .separate import Ranked
from .signatures import Signatures, signatures
from .sizes import CONFUSABLE, Pair, Smallest, chance_errors, confusable, gain_errors, smallest
from .trials import Trial, as_planned, axis_trials, rig_trials
from .typical import SOUND

# Noise of a torque sensor with its amplifier keeps its sign for about this long.
NOISE_TIME_S = 0.05


@dataclass(frozen=True)
class Plan:
    """What ``luztar.plan`` returns.

    Attributes
    ----------
    model : Model
        The model in use; the effects are looked for beside it.
    test : str
        The test in one line.
    runs, strokes : int
        Runs, and strokes of all runs together.
    minutes : float
        Of all runs together.
    sensor : Sensor
    chance_errors, gain_errors : float
        Standard errors that an effect needs to stand out from chance, and that it has where it takes 1 % off the error.
    sizes : tuple of Smallest
        One entry per effect of the catalogue.
    pairs : tuple of Pair
        What the test cannot tell apart.
    effects : tuple of str
    cosines : ndarray, shape (effects, effects)
        How well the effect of the column imitates that of the row.
    """

    model: Model
    test: str
    runs: int
    strokes: int
    minutes: float
    sensor: Sensor
    chance_errors: float
    gain_errors: float
    sizes: tuple[Smallest, ...]
    pairs: tuple[Pair, ...]
    effects: tuple[str, ...]
    cosines: np.ndarray = field(repr=False)

    def to_dict(self) -> dict[str, Any]:
        """Return the plan as the JSON interface prints it."""
        return {
            "schema": 1,
            "structure": self.model.structure_name,
            "effects": list(self.model.effects),
            "band_hz": self.model.band_hz,
            "test": {
                "text": self.test,
                "runs": self.runs,
                "strokes": self.strokes,
                "minutes": self.minutes,
                "sensor_step": self.sensor.step,
                "noise": {
                    "rms": self.sensor.noise_rms,
                    "time_s": self.sensor.noise_time_s,
                    "unit": self.model.structure.effort_unit,
                },
            },
            "chance_errors": self.chance_errors,
            "gain_errors": self.gain_errors,
            "sizes": [s.to_dict() for s in self.sizes],
            "pairs": [p.to_dict() for p in self.pairs],
            "cosines": {
                name: dict(zip(self.effects, map(float, row), strict=True))
                for name, row in zip(self.effects, self.cosines, strict=True)
            },
        }

    def size(self, effect: str) -> Smallest:
        """Return the entry of one effect."""
        return next(s for s in self.sizes if s.effect == card(effect, self.model.structure_name).name)

    def __str__(self) -> str:
        from .words import plan_text

        return plan_text(self)

    def _repr_html_(self) -> str:
        from html import escape

        return f"<pre>{escape(str(self))}</pre>"

    def figure(self) -> Any:
        """Return a plotly figure: how well each effect can imitate each other one in this test."""
        from .picture import cosines

        return cosines(self)

    def report(self, path: str | os.PathLike[str]) -> None:
        """Write the plan as one HTML file that needs nothing but a browser."""
        from .picture import write

        write(path, self)


def plan(
    model: Model | str = "rig",
    *,
    encoder_deg: float | None = None,
    step_m: float | None = None,
    rate_hz: float | None = None,
    speed: tuple[float, float] | None = None,
    speeds: Sequence[float] = (),
    angle_deg: float | None = None,
    travel_m: float | None = None,
    runs: int = 3,
    strokes: int = 6,
    minutes: float | None = None,
    noise: float | None = None,
    noise_time_s: float = NOISE_TIME_S,
    friction: float | None = None,
    seed: int = 1,
) -> Plan:
    """Simulate a test and say which effects it can see, and which it cannot tell apart.

    Parameters
    ----------
    model : Model or str
        The model in use, or the name of a structure (``rig``, ``axis``).
    encoder_deg : float [deg], optional
        Step of the angle sensor of a rig; 0.02 where not given.
    step_m : float [m], optional
        Step of the position sensor of an axis; 1e-6 where not given.
    rate_hz : float [Hz], optional
        Sample rate; 500 for a rig, 1000 for an axis.
    speed : tuple of float [deg/s or m/s], optional
        Slowest and fastest speed of the strokes; 5 to 38 deg/s, 0.04 to 0.13 m/s.
    speeds : sequence of float [deg/s or m/s], optional
        Even speeds in place of a range: the strokes take them in turn, two each.
    angle_deg : float [deg], optional
        Strokes go from beyond plus to beyond minus this angle; 50 where not given.
    travel_m : float [m], optional
        Length of the strokes of an axis; 0.24 where not given.
    runs, strokes : int
        Runs, and strokes of each.
    minutes : float [min], optional
        Length of all runs together; takes the place of ``strokes``.
    noise : float [Nm or N], optional
        Noise inside the band of the comparison, rms: the noise floor that ``luztar compare`` shows. 0.02 Nm, 1 N.
    noise_time_s : float [s]
        How long the noise keeps its sign.
    friction : float [Nm or N], optional
        Level of Coulomb friction; 0.75 Nm, 20 N.
    seed : int
        Of the hands that turn.

    Returns
    -------
    Plan

    Raises
    ------
    ParameterError
        Names the value that makes no test.

    Examples
    --------
    >>> import luztar
    >>> narrow = luztar.plan(angle_deg=50, encoder_deg=0.02, speed=(5, 38), noise=0.02)
    >>> bool(narrow.size("once_per_rev").cosine > 0.95)
    True
    """
    if isinstance(model, str):
        model = {"rig": Model.rig, "axis": Model.axis}.get(model, lambda: Model(str(model), ()))()
    if model.structure.is_free:
        raise ParameterError(f"there is no plan for '{model.structure_name}'", "structure", "Plan a rig or an axis.")
    rig = model.structure_name == "rig"
    test = asked(
        model,
        encoder_deg=encoder_deg,
        step_m=step_m,
        rate_hz=rate_hz,
        speed=speed,
        speeds=speeds,
        angle_deg=angle_deg,
        travel_m=travel_m,
        runs=runs,
        strokes=strokes,
        minutes=minutes,
        noise=noise,
        noise_time_s=noise_time_s,
        friction=friction,
    )
    seed = whole_number("seed", seed, 0, 2**32 - 1)
    sensor, low, high, reach = test.sensor, test.low, test.high, test.reach
    unit = math.pi / 180.0 if rig else 1.0
    half = reach * unit if rig else 0.5 * reach
    ladder = tuple(v * unit for v in test.speeds)

    def positions(count: int) -> list[np.ndarray]:
        make = as_planned(half, (low * unit, high * unit), count, 8.0 * unit if rig else 0.0, ladder)
        return [make(1.0 / sensor.rate_hz, seed + k) for k in range(test.runs)]

    strokes = test.strokes
    if minutes is not None:
        # A hand that tries to turn evenly does not: how long it really takes is counted.
        once = sum(p.size for p in positions(strokes)) / sensor.rate_hz / 60.0
        strokes = min(MOST_STROKES, max(-(-LEAST_STROKES // test.runs), round(strokes * minutes / once)))
    sound = {**SOUND[model.structure_name], **({} if test.friction is None else {"coulomb": test.friction})}
    table = signatures(rehearse(positions(strokes), sensor, model), model, sensor, sound)
    shown = "/".join(f"{v:g}" for v in test.speeds) if test.speeds else f"{low:g} to {high:g}"
    place = f"beyond ±{reach:g} deg, {shown} deg/s" if rig else f"over {reach:g} m, {shown} m/s"
    each = f"{test.runs} {'run' if test.runs == 1 else 'runs'} of {strokes} strokes"
    others = rig_trials() if rig else axis_trials(-half, half, max([high, *test.speeds]))
    names = table.effects
    cosines = np.array([[1.0 if a == b else table.cosine(a, b) for b in names] for a in names])
    sizes = smallest(table, sensor)
    return Plan(
        model=model,
        test=f"{each} {place}, {table.minutes:.1f} minutes",
        runs=test.runs,
        strokes=table.strokes,
        minutes=table.minutes,
        sensor=sensor,
        chance_errors=chance_errors(table.strokes),
        gain_errors=gain_errors(table, sensor),
        sizes=sizes,
        pairs=_pairs(table, sizes, others, sensor, sound),
        effects=names,
        cosines=cosines,
    )


def _pairs(
    table: Signatures,
    sizes: Sequence[Smallest],
    trials: Sequence[Trial],
    sensor: Sensor,
    sound: Mapping[str, float],
) -> tuple[Pair, ...]:
    """Return the pairs that a test cannot tell apart, each with the trial that tells most per minute.

    The effect is taken at twice the smallest size that the test would show: there the question arises.
    """
    found = confusable(table)
    among = {n for a, b, _ in found for n in (a, b)}
    tables = []
    for trial in trials if found else ():
        run = rehearse([trial.make(1.0 / sensor.rate_hz, 1)], sensor, table.model)
        tables.append((trial, signatures(run, table.model, sensor, sound, among)))
    size_of = {s.effect: 2.0 * s.size if s.size and card(s.effect).linear else 1.0 for s in sizes}
    out = []
    for a, b, cosine in found:
        ranked = []
        for trial, there in tables:
            alike = there.cosine(a, b)
            apart = there.strength(there.typical[a]) * size_of[a] * math.sqrt(max(0.0, 1.0 - alike**2))
            if alike < CONFUSABLE and apart > 0.0:
                ranked.append((Ranked(trial, there.minutes, apart), alike))
        if not ranked:
            none = "None of the tests on the list tells them apart; look at the mechanism."
            out.append(Pair((a, b), cosine, None, none, None))
            continue
        best, alike = max(ranked, key=lambda r: r[0].per_minute)
        out.append(Pair((a, b), cosine, best.trial.name, f"{best.trial.text}.", alike))
    return tuple(out)
