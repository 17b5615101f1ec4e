"""How far a fitted free-run model is from the measurement, and where."""

from __future__ import annotations

from ..diagnosis.compare import Comparison
from ..diagnosis.where import regimes, residual_map
from .detect import detection
from .fit import FreeFit


def compare(fitted: FreeFit) -> Comparison:
    """Say how far a fitted model is from the measurement and where; see ``luztar.compare``."""
    return Comparison(fitted, regimes(fitted), residual_map(fitted), detection(fitted, {}))
