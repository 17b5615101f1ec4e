"""Free-run fitting: parameters of a mechanism from the motion it makes when it is driven."""

from .compare import compare as compare
from .diagnose import diagnose as diagnose
from .fit import FreeFit as FreeFit
from .fit import fit as fit
from .study import study as study
