"""What the fits must know of an axis that runs freely: channels, scales, starts, pairs."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

import numpy as np

from ..._arrays import vector
from ...errors import ModelError
from ...model import Card, Model
from ..parameters import Parameters
from ..plant import Motion, Plant, keys_of
from ..record import Record
from ..smoothing import smoothed
from .predict import COLUMNS, predict
from .sizes import sizes_of

if TYPE_CHECKING:
    from ...measurement import Run

# Force above this moves no position: at 100 Hz a newton on a kilogram moves 3 micrometres.
FORCE_BAND_HZ = 100.0
# A Stribeck speed below this share of the top speed is felt at rest only: it is stiction.
SLOW_SHARE = 0.03
# A contact holds a body at rest exactly: it needs no travel to full friction.
RIGID = "coulomb.breakaway_m"
OF_THE_LEVEL = ("coulomb.level_n", "stiction.extra_n", "stribeck.extra_n")
# Why an effect of the catalogue is none of a mass on which a force acts.
NO_PLACE: Mapping[str, str] = {
    "freeplay": "the force acts on the mass itself, and behind a gap there is nothing",
    "asymmetric_coulomb": "it cannot be told from offset, in motion or at rest",
}


class AxisPlant(Plant):
    """One mass under a force, with friction."""

    start_s = 0.05
    first = ("inertia", "coulomb", "viscous", "offset")
    grids: Mapping[str, Mapping[str, tuple[float, ...]]] = {
        "stiction": {"coulomb.level_n": (0.5, 0.8, 1.0), "stiction.extra_n": (0.1, 0.3, 0.6)},
        "stribeck": {
            "coulomb.level_n": (0.6, 0.95),
            "stribeck.extra_n": (-0.3, 0.3, 0.8),
            "stribeck.speed_m_s": (0.1, 1.0, 4.0),
        },
        "drag": {"drag.coefficient_n_s2_per_m2": (0.1, 0.6)},
        "asymmetric_viscous": {"asymmetric_viscous.difference_n_s_per_m": (-1.0, 1.0)},
        "stiffness": {"stiffness.stiffness_n_per_m": (0.1, 1.0)},
    }
    structure_grid: Mapping[str, tuple[float, ...]] = {
        "inertia.inertia_kg": (0.5, 1.0, 2.0),
        "coulomb.level_n": (0.5, 1.0),
    }
    least_share: Mapping[str, float] = {"inertia.inertia_kg": 0.02, "stribeck.speed_m_s": 1e-3}
    one_sided = frozenset(
        {"coulomb.level_n", "viscous.coefficient_n_s_per_m", "stiction.extra_n", "stiffness.stiffness_n_per_m"}
    )
    pairs: Mapping[frozenset[str], str] = {
        frozenset({"stiction", "stribeck"}): "Creep over the range at three even speeds: stiction shows at starts "
        "only, Stribeck friction also while creeping.",
        frozenset({"drag", "asymmetric_viscous"}): "Repeat at twice the speed in both directions: drag grows with "
        "its square, the other differs by direction.",
    }

    def require(self, model: Model) -> None:
        """See :meth:`Plant.require`."""
        tried = {key.partition(".")[0] for key in COLUMNS}
        for name in model.effects:
            if name not in tried:
                why = NO_PLACE.get(name, "a free run of an axis does not simulate it")
                remedy = f"Take it out, or fit the axis driven (free = false). Free runs have: {', '.join(tried)}."
                raise ModelError(f"'{name}' has no place here: {why}", "effects", remedy)
        if "inertia" not in model.effects:
            raise ModelError("a mass that runs freely needs 'inertia'", "effects", "Add it.")
        if "offset" in model.effects and "coulomb" not in model.effects:
            remedy = "Add coulomb, or take offset out: without friction a constant force is an acceleration."
            raise ModelError("'offset' needs 'coulomb' in a free run", "effects", remedy)

    def keys(self, model: Model) -> tuple[str, ...]:
        """See :meth:`Plant.keys`."""
        return tuple(k for k in keys_of(model) if k != RIGID)

    def outputs(self, model: Model) -> tuple[str, ...]:
        """See :meth:`Plant.outputs`."""
        return ("position",)

    def drives(self, model: Model, run: Run) -> dict[str, np.ndarray]:
        """See :meth:`Plant.drives`."""
        return {"force": smoothed(vector(f"{run.name}: force", run["force"]), run.sample_rate_hz, FORCE_BAND_HZ)}

    def start(self, model: Model, run: Run, drives: Mapping[str, np.ndarray]) -> tuple[float, ...]:
        """Return nothing: every stroke has a start of its own."""
        return ()

    def sizes(self, records: Sequence[Record], model: Model) -> Mapping[str, float]:
        """See :meth:`Plant.sizes`."""
        return sizes_of(records)

    def predict(self, parameters: Parameters, records: Sequence[Record], values: np.ndarray) -> list[np.ndarray]:
        """See :meth:`Plant.predict`."""
        return predict(parameters, records, values)

    def whole(self, key: str) -> bool:
        """See :meth:`Plant.whole`."""
        return key.startswith(("inertia.", "viscous.", "coulomb.")) or key == "stribeck.speed_m_s"

    def nothing(self, key: str, size: float) -> float | None:
        """See :meth:`Plant.nothing`."""
        return None if key == "stribeck.speed_m_s" else super().nothing(key, size)

    def sizes_for(self, effect: str, found: Mapping[str, float]) -> Mapping[str, float]:
        """See :meth:`Plant.sizes_for`."""
        if effect == "asymmetric_viscous":
            return {"asymmetric_viscous.difference_n_s_per_m": 0.3 * found.get("viscous.coefficient_n_s_per_m", 1.0)}
        level = found.get("coulomb.level_n", 0.0)
        return dict.fromkeys(OF_THE_LEVEL, level) if effect in ("stiction", "stribeck") and level > 0.0 else {}

    def candidates(self, model: Model, records: Sequence[Record]) -> tuple[Card, ...]:
        """See :meth:`Plant.candidates`."""
        tried = {key.partition(".")[0] for key in COLUMNS}
        return tuple(c for c in super().candidates(model, records) if c.name in tried)

    def same_as(self, card: Card, solved: Mapping[str, float], moved: Motion) -> str | None:
        """See :meth:`Plant.same_as`."""
        if card.name != "stribeck":
            return None
        top = max(float(np.abs(r.outputs[0].speed).max()) for r in moved.records)
        return card.becomes if solved["stribeck.speed_m_s"] < SLOW_SHARE * top else None
