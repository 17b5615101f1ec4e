"""Free runs of the steering model: handwheel angle in, motion out, many parameter sets at once.

The model is the seed paper's equation (5): one mass at the road wheel, driven through ratio, column spring and freeplay
by the handwheel, braked by dry and viscous friction. At rest the speed is exactly 0: nothing creeps and nothing
chatters.
"""

from .batch import simulate as simulate
from .batch import summarise as summarise
from .bodies import ExactBodies as ExactBodies
from .bodies import GapSpring as GapSpring
from .bodies import exact_bodies as exact_bodies
from .distributions import Choice as Choice
from .distributions import LogNormal as LogNormal
from .distributions import Normal as Normal
from .distributions import Uniform as Uniform
from .exact import Exact as Exact
from .exact import ExactEvent as ExactEvent
from .exact import exact as exact
from .keep import REDUCERS as REDUCERS
from .lanes import COLUMNS as COLUMNS
from .lanes import METHODS as METHODS
from .sample import sample as sample
from .signal import Signal as Signal
from .summary import Summary as Summary
from .trace import trace as trace
from .trajectory import Event as Event
from .trajectory import Trace as Trace
from .trajectory import Trajectory as Trajectory
