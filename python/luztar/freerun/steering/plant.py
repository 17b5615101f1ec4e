"""What the fits must know of the steering model: channels, scales, starts, pairs."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

import numpy as np

from ..._arrays import vector
from ...errors import ModelError
from ...model import Card, Model
from ..parameters import Parameters
from ..plant import Motion, Plant
from ..record import Record
from ..smoothing import smoothed
from .contact import are_apart, require_one_contact
from .predict import predict
from .sizes import sizes_of

if TYPE_CHECKING:
    from ...measurement import Run

# The start is read off this much of the record.
START_FIT_S = 0.05
# A start speed within so many standard errors is rest.
START_ERRORS = 3.0
# A Stribeck speed below this share of the road wheel's top speed is felt at rest only: it is stiction.
SLOW_SHARE = 0.03
# Over less than a turn of the handwheel a wave per turn and a spring are the same curve.
WHOLE_TURN_RAD = 2.0 * np.pi
# Static friction that has grown after this share of a usual rest does not show its growth: it is stiction.
SHORT_SHARE = 0.2
# What is no amount of an effect: it stands at its size until it is searched.
WHOLE = ("stribeck.speed_rad_s", "dwell.time_s", "end_stop.limit_rad", "presliding.breakaway_rad", "cogging.per_turn")
# Where an effect does next to nothing, as a share of the size.
NOTHING: Mapping[str, float] = {"presliding.breakaway_rad": 0.05}
# One of them must be known: angles alone do not show the scale of the torques.
SCALE_SETTERS = ("steering.inertia_kg_m2", "steering.stiffness_nm_per_rad", "steering.aligning_nm_per_rad")
# The level found so far stands between kinetic and static friction: a share of it is what these search.
OF_THE_LEVEL = ("coulomb.level_nm", "stiction.extra_nm", "stribeck.extra_nm", "asymmetric_coulomb.difference_nm")


class SteeringPlant(Plant):
    """Equation (5) of the paper: one mass at the road wheel."""

    # Three time constants of a mechanism as slow as 2 I / mu = 0.17 s.
    start_s = 0.5
    # A gap or a break-away moves events: the loss over it has several valleys.
    grids: Mapping[str, Mapping[str, tuple[float, ...]]] = {
        "freeplay": {"freeplay.gap_rad": (0.1, 0.4, 1.0, 2.0, 4.0)},
        "coulomb": {"coulomb.level_nm": (0.03, 0.1, 0.3, 1.0)},
        "stiction": {"coulomb.level_nm": (0.2, 0.5, 0.8, 1.0), "stiction.extra_nm": (0.1, 0.3, 0.6, 1.0)},
        "stribeck": {
            "coulomb.level_nm": (0.6, 0.95),
            "stribeck.extra_nm": (-0.3, 0.3, 0.8),
            "stribeck.speed_rad_s": (0.1, 1.0, 4.0),
        },
        "hardening": {"hardening.coefficient_nm_per_rad3": (-0.05, 0.05, 0.5)},
        "drag": {"drag.coefficient_nm_s2_per_rad2": (0.1, 0.6)},
        "asymmetric_coulomb": {"asymmetric_coulomb.difference_nm": (-0.3, 0.3)},
        "asymmetric_viscous": {"asymmetric_viscous.difference_nm_s_per_rad": (-0.3, 0.3)},
        "end_stop": {"end_stop.stiffness_nm_per_rad": (0.1, 1.0), "end_stop.limit_rad": (0.7, 0.85, 0.95)},
        "once_per_rev": {
            "once_per_rev.amplitude_nm": (0.3,),
            "once_per_rev.phase_rad": (-0.5 * math.pi, 0.0, 0.5 * math.pi, 0.95 * math.pi),
        },
        "presliding": {"presliding.breakaway_rad": (0.2, 1.0, 4.0), "presliding.shape": (0.0, 1.0)},
        "dwell": {"dwell.extra_nm": (0.3, 1.0), "dwell.time_s": (0.3, 1.0, 4.0)},
        "delay": {"delay.time_s": (0.1, 1.0, 4.0)},
        "offset": {"offset.level_rad": (0.0,)},
    }
    structure_grid: Mapping[str, tuple[float, ...]] = {
        "steering.inertia_kg_m2": (0.3, 1.0, 3.0),
        "viscous.coefficient_nm_s_per_rad": (0.3, 1.0, 3.0),
    }
    # The size of the inertia belongs to an oscillation of 6 Hz: a fiftieth of it to 42 Hz, beyond which an angle shows
    # nothing of it and the simulation needs ever more steps.
    least_share: Mapping[str, float] = {
        "steering.inertia_kg_m2": 0.02,
        "steering.stiffness_nm_per_rad": 1e-3,
        "stribeck.speed_rad_s": 1e-3,
        "dwell.time_s": 1e-2,
        "presliding.breakaway_rad": 0.02,
    }
    # Static friction below the kinetic one never holds a body.
    one_sided = frozenset(
        {
            "coulomb.level_nm",
            "viscous.coefficient_nm_s_per_rad",
            "stiction.extra_nm",
            "dwell.extra_nm",
            "freeplay.gap_rad",
        }
    )
    choices = frozenset({"presliding.shape"})
    pairs: Mapping[frozenset[str], str] = {
        frozenset({"stiction", "stribeck"}): "Turn the handwheel very slowly and at three even speeds: stiction shows "
        "at starts only, Stribeck friction also while creeping.",
        frozenset({"freeplay", "coulomb"}): "Repeat slowly with the road wheels on turn-plates and with the full load "
        "on the tyres: friction grows with the load, a gap does not.",
        frozenset({"drag", "hardening"}): "Turn to the same angles slowly and fast: drag grows with speed, a hardening "
        "spring with the angle of wind-up only.",
        frozenset({"delay", "viscous"}): "Repeat at two clearly different speeds with steps in between: a delay shifts "
        "by the same time, viscous friction rounds the corners.",
    }

    def require(self, model: Model) -> None:
        """See :meth:`Plant.require`: the ratio and one torque, and one kind of contact."""
        require_one_contact(model)
        if "steering.ratio" not in model.known:
            remedy = "Give steering.ratio: angles alone do not determine it."
            raise ModelError("the ratio is not given", "known", remedy)
        if not any(key in model.known for key in SCALE_SETTERS):
            remedy = "Give one of steering.stiffness_nm_per_rad, steering.inertia_kg_m2, steering.aligning_nm_per_rad."
            raise ModelError("nothing sets the scale of the torques; angles alone do not show it", "known", remedy)

    def outputs(self, model: Model) -> tuple[str, ...]:
        """See :meth:`Plant.outputs`."""
        return ("roadwheel",)

    def drives(self, model: Model, run: Run) -> dict[str, np.ndarray]:
        """See :meth:`Plant.drives`."""
        return {"handwheel": smoothed(vector(f"{run.name}: handwheel", run["handwheel"]), run.sample_rate_hz)}

    def start(self, model: Model, run: Run, drives: Mapping[str, np.ndarray]) -> tuple[float, ...]:
        """Return angle and speed of the road wheel."""
        phi, rate = run["roadwheel"], run.sample_rate_hz
        n = max(math.ceil(START_FIT_S * rate), 4)
        t = np.arange(n) / rate
        line, residual, *_ = np.polyfit(t, phi[:n], 1, full=True)
        noise = math.sqrt(float(residual[0]) / (n - 2)) if residual.size else 0.0
        error = noise / math.sqrt(float(np.sum((t - t.mean()) ** 2)))
        if abs(line[0]) <= START_ERRORS * error:
            return float(np.mean(phi[:n])), 0.0
        return float(line[1]), float(line[0])

    def sizes(self, records: Sequence[Record], model: Model) -> Mapping[str, float]:
        """See :meth:`Plant.sizes`."""
        return sizes_of(records, model)

    def predict(self, parameters: Parameters, records: Sequence[Record], values: np.ndarray) -> list[np.ndarray]:
        """See :meth:`Plant.predict`."""
        return [phi[:, :, None] for phi in predict(parameters, records, values)]

    def whole(self, key: str) -> bool:
        """See :meth:`Plant.whole`."""
        return key.startswith(("steering.", "viscous.")) or key in WHOLE

    def nothing(self, key: str, size: float) -> float | None:
        """See :meth:`Plant.nothing`."""
        if key in NOTHING:
            return NOTHING[key] * size
        return None if key in WHOLE else super().nothing(key, size)

    def sizes_for(self, effect: str, found: Mapping[str, float]) -> Mapping[str, float]:
        """See :meth:`Plant.sizes_for`."""
        level = found.get("coulomb.level_nm", 0.0)
        if effect in ("stiction", "stribeck", "asymmetric_coulomb") and level > 0.0:
            return dict.fromkeys(OF_THE_LEVEL, level)
        if effect == "asymmetric_viscous":
            viscous = found.get("viscous.coefficient_nm_s_per_rad", 1.0)
            return {"asymmetric_viscous.difference_nm_s_per_rad": viscous}
        return {}

    def candidates(self, model: Model, records: Sequence[Record]) -> tuple[Card, ...]:
        """See :meth:`Plant.candidates`."""
        turned = max(float(np.ptp(r.outputs[0].motion)) for r in records)
        return tuple(
            c
            for c in super().candidates(model, records)
            if (turned >= WHOLE_TURN_RAD or not c.per_turn) and not are_apart((*model.effects, c.name))
        )

    def same_as(self, card: Card, solved: Mapping[str, float], moved: Motion) -> str | None:
        """See :meth:`Plant.same_as`."""
        if card.name == "asymmetric_coulomb":
            return card.becomes
        if card.name == "stribeck" and solved["stribeck.speed_rad_s"] < SLOW_SHARE * _top_speed(moved):
            return card.becomes
        if card.name == "dwell":
            rest = typical_rest_s(moved)
            if rest is None or solved["dwell.time_s"] < SHORT_SHARE * rest:
                return "stiction"
        return None


def _top_speed(moved: Motion) -> float:
    of = zip(moved.simulated, moved.records, strict=True)
    return max(float(np.abs(np.gradient(p[:, 0], 1.0 / r.rate_hz)).max()) for p, r in of)


def typical_rest_s(moved: Motion) -> float | None:
    """Return the median time for which the modelled road wheel stands, None where it never does."""
    rests: list[float] = []
    for simulated, record in zip(moved.simulated, moved.records, strict=True):
        # At rest the model's angle is the same to the last bit.
        still = np.diff(simulated[:, 0]) == 0.0
        edges = np.flatnonzero(np.diff(np.concatenate(([0], still, [0])).astype(int)))
        rests.extend((edges[1::2] - edges[::2]) / record.rate_hz)
    return float(np.median(rests)) if rests else None
