"""The score tests applied to a fitted model."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from .fit import Fit
from .jacobian import continuous, jacobian
from .score import Detection, Feature, detect


def detection(fitted: Fit, candidates: Sequence[Feature], gains: np.ndarray | None = None) -> Detection:
    """Test a fitted model against candidates and for what repeats without any."""
    problem, state = fitted.problem, fitted.state
    made = jacobian(problem, state, continuous(problem, state, sharpness=True))
    shift = float(state.coefficients[-1])
    return detect(problem.runs, made.matrix, candidates, problem.weights, shift, state.blocks.bound, gains)


def lack_of_fit(fitted: Fit) -> Detection:
    """Test for what repeats without reference to any candidate."""
    return detection(fitted, ())
