"""The weights of the criterion: three numbers that depend on speed."""

from __future__ import annotations

import math
import tomllib
from collections.abc import Mapping
from dataclasses import dataclass
from importlib.resources import files
from pathlib import Path
from typing import Any

import numpy as np

from .._arrays import number
from ..errors import ModelError, ParameterError

KEYS = ("calm_s2_per_rad2", "precision_m2", "comfort_s4_per_m2")


@dataclass(frozen=True)
class Weights:
    """w1, w2, w3 of equation (6).

    Parameters
    ----------
    calm_s2_per_rad2 : float, >= 0
        w1, of the mean square of the handwheel's speed.
    precision_m2 : float, >= 0
        w2, of the square of kappa.
    comfort_s4_per_m2 : float, >= 0
        w3, of the square of the largest lateral acceleration.

    Raises
    ------
    ParameterError
        A weight below 0 or not finite, or three zeros.
    """

    calm_s2_per_rad2: float
    precision_m2: float
    comfort_s4_per_m2: float

    def __post_init__(self) -> None:
        for key in KEYS:
            value = number(key, getattr(self, key))
            if not (math.isfinite(value) and value >= 0.0):
                raise ParameterError(f"the weight {key} is {value:g}", key, "Give a finite number, 0 or above.")
        if not any(getattr(self, key) for key in KEYS):
            raise ParameterError("all three weights are 0", "weights", "Give at least one above 0.")

    def to_dict(self) -> dict[str, float]:
        """Return the weights by name."""
        return {key: float(getattr(self, key)) for key in KEYS}


def weights_at(speed_m_s: float, table: str | Path | None = None) -> Weights:
    """Return the weights at a speed, from luztar's table or another of the same form.

    Parameters
    ----------
    speed_m_s : float
    table : path, optional
        A TOML file with ``[[weights]]`` rows of ``speed_m_s`` and the three weights.

    Raises
    ------
    ParameterError
        A speed outside the table.
    ModelError
        A file that is no such table.
    """
    where = "weights.toml" if table is None else str(table)
    try:
        source = files("luztar") / "manoeuvre" / "weights.toml" if table is None else Path(table)
        rows = _rows(tomllib.loads(source.read_text(encoding="utf-8")), where)
    except (OSError, UnicodeDecodeError, tomllib.TOMLDecodeError) as problem:
        raise ModelError(f"is no table of weights: {problem}", where, "Give a TOML file in UTF-8.") from None
    speeds = [row["speed_m_s"] for row in rows]
    if not speeds[0] <= speed_m_s <= speeds[-1]:
        raise ParameterError(
            f"the table of weights ({where}) goes from {speeds[0]:g} to {speeds[-1]:g} m/s, not to {speed_m_s:g}",
            "speed_m_s",
            "Give weights of your own.",
        )
    return Weights(**{key: float(np.interp(speed_m_s, speeds, [row[key] for row in rows])) for key in KEYS})


def _rows(read: Mapping[str, Any], where: str) -> list[dict[str, float]]:
    wanted = {"speed_m_s", *KEYS}
    rows = read.get("weights")
    if read.get("schema") != 1 or not isinstance(rows, list) or not rows:
        raise ModelError("has no 'schema = 1' and rows [[weights]]", where, "See the table of luztar.")
    for row in rows:
        if not isinstance(row, dict) or set(row) != wanted:
            raise ModelError(f"a row has not the keys {', '.join(sorted(wanted))}", where, "Give these and no other.")
        if not all(isinstance(v, int | float) and math.isfinite(v) for v in row.values()):
            raise ModelError(f"a row holds no finite numbers: {row}", where, "Give finite numbers.")
    speeds = [row["speed_m_s"] for row in rows]
    if any(b <= a for a, b in zip(speeds, speeds[1:], strict=False)):
        raise ModelError("its speeds do not ascend", where, "Sort the rows by speed.")
    return rows
