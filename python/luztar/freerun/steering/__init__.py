"""The seed paper's one-mass steering model as a plant: handwheel in, road wheel out."""

from .plant import SteeringPlant as SteeringPlant
