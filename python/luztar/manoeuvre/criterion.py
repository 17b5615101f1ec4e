"""The paper's criterion, equation (6), and its smooth companion."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, fields
from typing import Any

import numpy as np

from .weights import Weights

# The paper's permissible lateral acceleration.
LATERAL_ACCELERATION_LIMIT_M_S2 = 4.0
# Below this clearance the companion goes on along the tangent of 1/c^2 instead of into its pole.
LEAST_CLEARANCE_M = 0.1
# Companion's price of a lateral acceleration beyond the limit, per (m/s2)^2, and of a run that ended in a spin or
# never came to the exit. Every one is far above what a drive within the limits costs.
ACCELERATION_PRICE = 100.0
LOST_PRICE = 1e5


@dataclass(frozen=True)
class Scores:
    """The criterion of many drives; every array has the shape (cars,).

    Attributes
    ----------
    criterion : ndarray
        J_w; infinite where the corridor was left, the lateral acceleration passed its limit or the car was lost.
    companion : ndarray
        Finite everywhere, continuous, and equal to J_w wherever that is finite and the clearance at least 0.1 m.
    feasible : ndarray of bool
    handwheel_rate_mean_square_rad2_s2, kappa_max_per_m, lateral_acceleration_max_m_s2 : ndarray
        The three terms before weights and squares. kappa is 0 where no edge was passed, infinite outside.
    clearance_min_m : ndarray
        Least distance of the body from an edge, negative outside.
    """

    criterion: np.ndarray
    companion: np.ndarray
    feasible: np.ndarray
    handwheel_rate_mean_square_rad2_s2: np.ndarray
    kappa_max_per_m: np.ndarray
    lateral_acceleration_max_m_s2: np.ndarray
    clearance_min_m: np.ndarray

    def __len__(self) -> int:
        return len(self.criterion)

    def row(self, car: int) -> dict[str, Any]:
        """Return the numbers of one car as JSON values; what is not finite is None."""
        made = {}
        for f in fields(self):
            value = getattr(self, f.name)[car].item()
            made[f.name] = value if np.isfinite(value) else None
        return made


def score(kept: Mapping[str, np.ndarray], weights: Weights, *, limit_m_s2: float, exit_m: float) -> Scores:
    """Return the criterion of drives.

    Parameters
    ----------
    kept : mapping
        From :func:`luztar.vehicle.summarise` with a corridor.
    weights : Weights
    limit_m_s2 : float
        Largest permissible lateral acceleration.
    exit_m : float
        Where the exit lane begins; a car that does not come so far is lost.

    Notes
    -----
    ``J_w = w1 mean(psi'^2) + w2 kappa_max^2 + w3 a_y,max^2``, ``kappa = 1 / clearance``.
    """
    rate = kept["handwheel_rate_mean_square_rad2_s2"]
    side = kept["lateral_acceleration_max_m_s2"]
    clearance = kept["clearance_min_m"]
    lost = np.isfinite(kept["spun_s"]) | ~(kept["end_x_m"] >= exit_m) | ~np.isfinite(rate + side)
    rate, side = np.where(lost & ~np.isfinite(rate), 0.0, rate), np.where(lost & ~np.isfinite(side), 0.0, side)
    inside = clearance > 0.0
    kappa = np.where(inside, 1.0 / np.where(inside, clearance, 1.0), np.inf)
    calm = weights.calm_s2_per_rad2 * rate
    comfort = weights.comfort_s4_per_m2 * side**2
    feasible = inside & (side <= limit_m_s2) & ~lost
    with np.errstate(invalid="ignore"):
        value = calm + weights.precision_m2 * kappa**2 + comfort
    least = LEAST_CLEARANCE_M
    precision = weights.precision_m2
    companion = (
        calm
        + precision / np.maximum(clearance, least) ** 2
        # A weight of 0 makes the edges free of charge, not permeable.
        + max(precision, 1.0) * 2.0 * np.maximum(least - clearance, 0.0) / least**3
        + comfort
        + ACCELERATION_PRICE * np.maximum(side - limit_m_s2, 0.0) ** 2
        + np.where(lost, LOST_PRICE, 0.0)
    )
    return Scores(
        criterion=np.where(feasible, value, np.inf),
        companion=companion,
        feasible=feasible,
        handwheel_rate_mean_square_rad2_s2=rate,
        kappa_max_per_m=kappa,
        lateral_acceleration_max_m_s2=side,
        clearance_min_m=clearance,
    )
