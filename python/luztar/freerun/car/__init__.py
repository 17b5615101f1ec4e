"""A car as a plant: handwheel and speed in; yaw rate, lateral acceleration, roll, road-wheel angle out."""

from .plant import CarPlant as CarPlant
