"""Which plant a model is run with."""

from __future__ import annotations

from ..model import Model
from .axis import AxisPlant
from .car import CarPlant
from .plant import Plant
from .steering import SteeringPlant


def plant_of(model: Model) -> Plant:
    """Return the plant of a model that runs freely."""
    return _PLANTS[model.structure_name]


_PLANTS: dict[str, Plant] = {"axis": AxisPlant(), "car": CarPlant(), "steering": SteeringPlant()}
