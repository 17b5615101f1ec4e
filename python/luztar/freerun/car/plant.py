"""What the fits must know of a car: channels, scales, starts, pairs."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

import numpy as np

from ..._arrays import vector
from ...errors import MeasurementError
from ...model import Card, Model
from ..parameters import Parameters
from ..plant import Motion, Plant
from ..record import Record
from ..smoothing import smoothed
from . import body
from .predict import predict
from .sizes import sizes_of

if TYPE_CHECKING:
    from ...measurement import Run

# The start is read off this much of the record.
START_FIT_S = 0.05
# Nobody drives a car's speed faster up and down than this.
SPEED_BAND_HZ = 2.0
# A Stribeck speed below this share of the road wheels' top speed is felt at rest only: it is stiction.
SLOW_SHARE = 0.03
# Slower than this a car with tyres that slip is no model of driving.
LEAST_SPEED_M_S = 2.0
OF_THE_LEVEL = ("coulomb.level_nm", "stiction.extra_nm", "stribeck.extra_nm")


class CarPlant(Plant):
    """A single-track or lateral-yaw-roll car behind a steering with friction and freeplay."""

    # The lateral motion of a car has died away after three time constants of 0.3 s.
    start_s = 1.0
    scaled = True
    grids: Mapping[str, Mapping[str, tuple[float, ...]]] = {
        "freeplay": {"freeplay.gap_rad": (0.1, 0.4, 1.0, 2.0)},
        "coulomb": {"coulomb.level_nm": (0.03, 0.1, 0.3, 1.0)},
        "stiction": {"coulomb.level_nm": (0.5, 0.8, 1.0), "stiction.extra_nm": (0.1, 0.3, 1.0)},
        "stribeck": {
            "coulomb.level_nm": (0.6, 0.95),
            "stribeck.extra_nm": (-0.3, 0.3, 0.8),
            "stribeck.speed_rad_s": (0.1, 1.0, 4.0),
        },
        "delay": {"delay.time_s": (0.1, 1.0, 4.0)},
        "tyre_saturation": {"tyre_saturation.friction": (0.3, 0.5, 0.8, 1.2)},
        "tyre_relaxation": {"tyre_relaxation.length_m": (0.3, 1.0, 2.0)},
        "roll_steer": {"roll_steer.front_rad_per_rad": (-1.0, 1.0), "roll_steer.rear_rad_per_rad": (-1.0, 1.0)},
    }
    structure_grid: Mapping[str, tuple[float, ...]] = {
        "front.cornering_n_per_rad": (0.5, 1.0, 2.0),
        "rear.cornering_n_per_rad": (0.7, 1.0, 2.0),
    }
    least_share: Mapping[str, float] = {
        "body.mass_kg": 0.1,
        "body.yaw_inertia_kg_m2": 0.05,
        "body.front_axle_m": 0.1,
        "body.rear_axle_m": 0.1,
        "body.sprung_mass_kg": 0.01,
        "body.roll_inertia_kg_m2": 0.05,
        "front.cornering_n_per_rad": 0.02,
        "rear.cornering_n_per_rad": 0.02,
        "front.track_m": 0.3,
        "rear.track_m": 0.3,
        "steering.inertia_kg_m2": 0.05,
        "steering.ratio": 0.1,
        "steering.stiffness_nm_per_rad": 0.05,
        "stribeck.speed_rad_s": 1e-3,
    }
    one_sided = frozenset(
        {"coulomb.level_nm", "viscous.coefficient_nm_s_per_rad", "stiction.extra_nm", "freeplay.gap_rad"}
    )
    pairs: Mapping[frozenset[str], str] = {
        frozenset({"freeplay", "coulomb"}): "Record the road-wheel angle too and repeat the on-centre weave at two "
        "amplitudes: behind a gap the wheel floats, under friction it stands.",
        frozenset({"stiction", "stribeck"}): "Turn the handwheel very slowly and at three even rates: stiction shows "
        "at starts only, Stribeck friction also while creeping.",
        frozenset({"delay", "tyre_relaxation"}): "Repeat at half and at twice the speed: a delay stays the same time, "
        "relaxation the same distance.",
        frozenset({"roll_steer", "tyre_saturation"}): "Repeat with half the amplitude: roll steer stays the same "
        "share, saturation disappears.",
    }

    def require(self, model: Model) -> None:
        """See :meth:`Plant.require`."""
        body.require(model)

    def keys(self, model: Model) -> tuple[str, ...]:
        """See :meth:`Plant.keys`."""
        return body.keys(model)

    def outputs(self, model: Model) -> tuple[str, ...]:
        """See :meth:`Plant.outputs`: roll only where the body rolls."""
        every = ("yaw_rate", "lateral_acceleration", "roll_angle", "roadwheel")
        return tuple(c for c in every if c != "roll_angle" or body.rolls(model))

    def drives(self, model: Model, run: Run) -> dict[str, np.ndarray]:
        """See :meth:`Plant.drives`."""
        rate = run.sample_rate_hz
        hand = smoothed(vector(f"{run.name}: handwheel", run["handwheel"]), rate)
        if "speed_m_s" in model.known:
            speed = np.full(hand.size, model.known["speed_m_s"])
        else:
            if "speed" not in run:
                remedy = 'Name its column, --map speed="COLUMN", or give speed_m_s in [known].'
                raise MeasurementError("there is no channel 'speed'", run.name, remedy)
            speed = smoothed(vector(f"{run.name}: speed", run["speed"]), rate, SPEED_BAND_HZ)
        slowest = float(speed.min())
        if slowest < LEAST_SPEED_M_S:
            remedy = f"Cut the run to where the car drives at {LEAST_SPEED_M_S:g} m/s or more (run.slice)."
            raise MeasurementError(f"the car drives at {slowest:.3g} m/s", run.name, remedy)
        return {"handwheel": hand, "speed": speed}

    def start(self, model: Model, run: Run, drives: Mapping[str, np.ndarray]) -> tuple[float, ...]:
        """Return yaw rate, roll and road-wheel angle."""
        n = max(math.ceil(START_FIT_S * run.sample_rate_hz), 4)
        yaw_rate, roll = (float(np.mean(run[c][:n])) if c in run else 0.0 for c in ("yaw_rate", "roll_angle"))
        if "roadwheel" in run:
            return yaw_rate, roll, float(np.mean(run["roadwheel"][:n]))
        return yaw_rate, roll, float(drives["handwheel"][0]) / model.known["steering.ratio"]

    def sizes(self, records: Sequence[Record], model: Model) -> Mapping[str, float]:
        """See :meth:`Plant.sizes`."""
        return sizes_of(records, model)

    def predict(self, parameters: Parameters, records: Sequence[Record], values: np.ndarray) -> list[np.ndarray]:
        """See :meth:`Plant.predict`."""
        return predict(parameters, records, values)

    def whole(self, key: str) -> bool:
        """See :meth:`Plant.whole`."""
        structural = key.startswith(("body.", "front.", "rear.", "steering.", "viscous."))
        return structural or key in ("stribeck.speed_rad_s", "tyre_saturation.friction")

    def nothing(self, key: str, size: float) -> float | None:
        """See :meth:`Plant.nothing`: a tyre that never slides."""
        return 10.0 if key == "tyre_saturation.friction" else super().nothing(key, size)

    def sizes_for(self, effect: str, found: Mapping[str, float]) -> Mapping[str, float]:
        """See :meth:`Plant.sizes_for`."""
        level = found.get("coulomb.level_nm", 0.0)
        return dict.fromkeys(OF_THE_LEVEL, level) if effect in ("stiction", "stribeck") and level > 0.0 else {}

    def candidates(self, model: Model, records: Sequence[Record]) -> tuple[Card, ...]:
        """See :meth:`Plant.candidates`."""
        without = set() if body.rolls(model) else {"roll_steer"}
        if body.relaxes(model):
            without.add("tyre_relaxation")
        return tuple(c for c in super().candidates(model, records) if c.name not in without)

    def same_as(self, card: Card, solved: Mapping[str, float], moved: Motion) -> str | None:
        """See :meth:`Plant.same_as`."""
        slow = card.name == "stribeck" and solved["stribeck.speed_rad_s"] < SLOW_SHARE * _top_speed(moved)
        return card.becomes if slow else None


def _top_speed(moved: Motion) -> float:
    """Return the top speed of the road wheels, from the handwheel: no channel need show it."""
    rates = [np.abs(np.gradient(r.drives["handwheel"], 1.0 / r.rate_hz)).max() for r in moved.records]
    return float(max(rates)) / moved.model.known["steering.ratio"]
