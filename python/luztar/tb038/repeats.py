"""Readings that are one and the same: three tests are asked for (2.2.3), not one test three times."""

from __future__ import annotations

import os
from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from .torque_source import torque_of

if TYPE_CHECKING:
    from ..measurement.run import Run


def same_file_again(runs: Sequence[Run]) -> list[tuple[str, str]]:
    """Return (earlier, later) names of runs that were read from one file; the later one is no test of its own."""
    found = []
    first: dict[tuple[str, str], str] = {}
    for run in runs:
        if run.sha256 is None:
            continue
        key = (os.path.abspath(run.source), run.sha256)
        if key in first:
            found.append((first[key], run.name))
        else:
            first[key] = run.name
    return found


def same_torque(runs: Sequence[Run], link_distance_m: float) -> list[tuple[str, str]]:
    """Return (earlier, later) names of runs whose torque is the same number for number.

    Copies of one reading under several names look like this; so do records that were computed without noise, which is
    why this is said but does not decide.
    """
    found = []
    torques = [torque_of(run, link_distance_m).torque_nm for run in runs]
    for later, torque in enumerate(torques):
        for earlier in range(later):
            if np.array_equal(torque, torques[earlier], equal_nan=True):
                found.append((runs[earlier].name, runs[later].name))
                break
    return found
