"""An axis that runs freely as a plant: force in, position out."""

from .plant import AxisPlant as AxisPlant
