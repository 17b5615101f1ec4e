"""Compare a model with measurements, find what is missing, add it and watch the error fall."""

from .compare import Comparison as Comparison
from .compare import compare as compare
from .diagnose import Diagnosis as Diagnosis
from .diagnose import diagnose as diagnose
from .fit import Fit as Fit
from .fit import fit as fit
from .study import Study as Study
from .study import study as study
