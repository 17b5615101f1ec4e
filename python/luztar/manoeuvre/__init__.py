"""The double lane change: avoiding and overtaking, the signal that does it best, and what freeplay and friction do.

A :class:`Manoeuvre` is a car, a track, a speed, a form of signal and the paper's criterion (6).
"""

from .criterion import Scores as Scores
from .form import Form as Form
from .map import SignalMap as SignalMap
from .map import map as map
from .optimise import Optimum as Optimum
from .optimise import optimise as optimise
from .robust import Robustness as Robustness
from .robust import robust as robust
from .sensitivity import Sensitivity as Sensitivity
from .sensitivity import sensitivity as sensitivity
from .study_file import Study as Study
from .study_file import load as load
from .synthesis import Synthesis as Synthesis
from .synthesis import synthesise as synthesise
from .task import Manoeuvre as Manoeuvre
from .task import manoeuvre as manoeuvre
from .track import Track as Track
from .track import avoiding as avoiding
from .track import iso_3888_1 as iso_3888_1
from .track import iso_3888_2 as iso_3888_2
from .track import overtaking as overtaking
from .weights import Weights as Weights
from .weights import weights_at as weights_at
