"""Cars: handwheel angle or steering torque in, motion of the car out, many of them side by side.

A car is a set of named parameters with their sources (:class:`Car`); its equations (``model``) and the law of its
tyres (``tyre``) are chosen when it is driven. The steering in front of it has freeplay, dry friction and power
assistance, and the torque of the front tyres turns its wheels back.
"""

from .car import CARS as CARS
from .car import Car as Car
from .car import Parameter as Parameter
from .corridor import Corridor as Corridor
from .drive import Drive as Drive
from .frequency_response import FrequencyResponse as FrequencyResponse
from .frequency_response import frequency_response as frequency_response
from .run_cars import simulate as simulate
from .run_cars import summarise as summarise
from .signals import Pieces as Pieces
from .signals import Samples as Samples
from .step_steer import StepSteer as StepSteer
from .step_steer import step_steer as step_steer
from .weave import Weave as Weave
from .weave import weave as weave
