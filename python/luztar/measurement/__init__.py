"""Reading measurements: files and arrays in, runs in SI units with an integrity report out."""

from .frame import read_frame as read_frame
from .integrity import Finding as Finding
from .integrity import Integrity as Integrity
from .read import read as read
from .run import CHANNEL_UNITS as CHANNEL_UNITS
from .run import Run as Run
from .runs import Runs as Runs
