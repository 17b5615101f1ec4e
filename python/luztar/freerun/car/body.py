"""Which parameters a car model has, and whether its body rolls."""

from __future__ import annotations

from ...errors import ModelError
from ...model import Model
from ...model.car_words import ESTIMATED, GIVEN, GIVEN_OR_STARTED, OWN, ROLL
from ..plant import keys_of


def rolls(model: Model) -> bool:
    """Whether everything is there that makes the body roll."""
    return all(key in model.known or key in model.start for key in ROLL)


def relaxes(model: Model) -> bool:
    """Whether a relaxation length of an axle is there without an effect."""
    there = {**model.known, **model.start}
    return any(there.get(f"{axle}.relaxation_m", 0.0) > 0.0 for axle in ("front", "rear"))


def keys(model: Model) -> tuple[str, ...]:
    """Return the parameters that a car model has: of the optional ones those that are known or started."""
    optional = {f"{name}.{key}" for name, (_, own) in OWN.items() for key, *_ in own}
    optional -= {*GIVEN, *GIVEN_OR_STARTED, *ESTIMATED}
    return tuple(k for k in keys_of(model) if k not in optional or k in model.known or k in model.start)


def require(model: Model) -> None:
    """Refuse a car without mass, geometry or steering, or one that rolls by halves.

    Raises
    ------
    ModelError
    """
    for key in GIVEN:
        if key not in model.known:
            raise ModelError(f"{key} is not given", "known", "Weigh or measure it: the motion does not show it.")
    for key in GIVEN_OR_STARTED:
        if key not in model.known and key not in model.start:
            remedy = "Give it in [known], or in [start] to have it estimated (record the road wheels then)."
            raise ModelError(f"{key} is not given", "known", remedy)
    there = [key for key in ROLL if key in model.known or key in model.start]
    lacking = [key for key in ROLL if key not in there]
    if "body.roll_inertia_kg_m2" in there and lacking:
        raise ModelError(f"{lacking[0]} is not given, and the body rolls", "known", "Give it, or no roll inertia.")
    if "tyre_relaxation" in model.effects and relaxes(model):
        remedy = "Take front.relaxation_m and rear.relaxation_m out, or the effect."
        raise ModelError("'tyre_relaxation' stands beside a relaxation length that is given", "known", remedy)
    if "roll_steer" in model.effects and not rolls(model):
        remedy = f"Give {', '.join(ROLL)}."
        raise ModelError("'roll_steer' needs a body that rolls", "known", remedy)
