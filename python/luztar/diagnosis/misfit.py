"""How far a model is from the measurement, as figures."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from .floor import NoiseFloor
from .prepare import Prepared


@dataclass(frozen=True)
class Misfit:
    """The error of a model.

    Attributes
    ----------
    rms, held_out_rms : float
        Root of the mean square error over the comparison's samples: fitted, and predicted without having been seen.
    relative, held_out_relative : float
        The same over the rms of the measurement.
    floor_ratio : float
        ``rms`` over the noise floor.
    unit : str
    """

    rms: float
    held_out_rms: float
    relative: float
    held_out_relative: float
    floor_ratio: float
    unit: str

    def to_dict(self) -> dict[str, Any]:
        """Return the figures as the JSON interface prints them."""
        return {
            "rms": self.rms,
            "held_out_rms": self.held_out_rms,
            "relative": self.relative,
            "held_out_relative": self.held_out_relative,
            "floor_ratio": self.floor_ratio,
            "unit": self.unit,
        }


def usable(runs: Sequence[Prepared], values: Sequence[np.ndarray]) -> np.ndarray:
    """Return the values at the comparison's samples of all runs, one after the other."""
    return np.concatenate([v[r.usable] for r, v in zip(runs, values, strict=True)])


def rms(values: np.ndarray) -> float:
    """Return the root of the mean square."""
    return float(np.sqrt(np.mean(values**2))) if values.size else 0.0


def misfit(
    runs: Sequence[Prepared],
    residual: Sequence[np.ndarray],
    unseen_runs: Sequence[Prepared],
    unseen_residual: Sequence[np.ndarray],
    floor: NoiseFloor,
) -> Misfit:
    """Return the figures for residuals, one array per run."""
    measured, held_measured = (rms(usable(rs, [r.effort for r in rs])) for rs in (runs, unseen_runs))
    error, unseen = rms(usable(runs, residual)), rms(usable(unseen_runs, unseen_residual))
    tiny = np.finfo(float).tiny
    return Misfit(
        rms=error,
        held_out_rms=unseen,
        relative=error / max(measured, tiny),
        held_out_relative=unseen / max(held_measured, tiny),
        floor_ratio=error / max(floor.rms, tiny),
        unit=floor.unit,
    )
