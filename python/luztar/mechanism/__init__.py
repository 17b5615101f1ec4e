"""Mechanisms of several bodies: described once, checked, run, stepped, reduced.

Bodies with one coordinate each; springs with freeplay, end stops, dampers, dry friction and assistance between two
bodies, a body and the ground, or a body and a node whose motion is given, all seen through ratios. In stick the
relative speed is exactly 0; where static friction is not unique the motion still is, and the result says so.
"""

from .batch import Lanes as Lanes
from .batch import simulate_lanes as simulate_lanes
from .batch import summarise_lanes as summarise_lanes
from .indeterminacy import Indeterminacy as Indeterminacy
from .manoeuvres import Manoeuvre as Manoeuvre
from .manoeuvres import ReductionError as ReductionError
from .manoeuvres import manoeuvres as manoeuvres
from .mechanism import Mechanism as Mechanism
from .parts import Assistance as Assistance
from .parts import Body as Body
from .parts import Damper as Damper
from .parts import Driven as Driven
from .parts import EndStop as EndStop
from .parts import Friction as Friction
from .parts import Load as Load
from .parts import Sensor as Sensor
from .parts import Spring as Spring
from .reduction import Reduction as Reduction
from .reduction import reduce as reduce
from .result import Event as Event
from .result import MechanismRun as MechanismRun
from .run import simulate as simulate
from .stepper import Stepper as Stepper
from .structures import RearAxle as RearAxle
from .structures import power_assistance as power_assistance
from .structures import single_mass as single_mass
from .structures import steering_mechanism as steering_mechanism
from .structures import steering_one_mass as steering_one_mass
from .structures import steering_torque_driven as steering_torque_driven
