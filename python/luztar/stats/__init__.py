"""Statistics of records and streams: pushed in chunks, merged across parts, without cancellation."""

from .groups import by_direction as by_direction
from .groups import by_label as by_label
from .groups import by_window as by_window
from .moments import Description as Description
from .moments import Moments as Moments
from .moments import describe as describe
from .quantiles import Counts as Counts
from .quantiles import QuantileSketch as QuantileSketch
from .rolling import Rolling as Rolling
from .rolling import RollingFigures as RollingFigures
from .rolling import rolling as rolling
