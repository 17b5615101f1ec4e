"""The linear and univariate reference sets of NIST (StRD): files where they are at hand, NumAcc1 to 4 made by rule."""

from __future__ import annotations

import math
import re
from dataclasses import dataclass
from pathlib import Path

import numpy as np

EPS = np.finfo(np.float64).eps
MOST_DIGITS = -math.log10(EPS / 2)


def digits(found: float, certified: float) -> float:
    """The log relative error: how many leading digits agree, 15.95 at most; of zero the absolute one."""
    scale = abs(certified) or 1.0
    return -math.log10(max(abs(found - certified) / scale, EPS / 2))


def worst(found, certified) -> float:
    """The fewest digits of several figures."""
    return min(digits(f, c) for f, c in zip(found, certified, strict=True))


@dataclass(frozen=True)
class Regression:
    """A linear set: y, predictors (n, p), certified coefficients, their errors, residual deviation and r squared."""

    y: np.ndarray
    x: np.ndarray
    coefficients: np.ndarray
    standard_errors: np.ndarray
    residual_std: float
    r_squared: float


_NUMBER = r"[-+]?\d*\.?\d+(?:[Ee][-+]?\d+)?"


def regression(folder: Path, name: str) -> Regression:
    """Read a linear set."""
    text = (folder / f"{name}.dat").read_text()
    rows = re.findall(rf"^\s+B\d+\s+({_NUMBER})\s+({_NUMBER})\s*$", text, re.MULTILINE)
    certified = np.array(rows, dtype=float)
    after = text[text.index("Certified Regression Statistics") :]
    spread = float(re.search(rf"Residual\s+Standard Deviation\s+({_NUMBER})", after).group(1))
    r_squared = float(re.search(rf"R-Squared\s+({_NUMBER})", after).group(1))
    lines = text.splitlines()
    start = max(i for i, line in enumerate(lines) if line.startswith("Data:"))
    table = np.array([[float(v) for v in line.split()] for line in lines[start + 1 :] if line.strip()])
    return Regression(table[:, 0], table[:, 1:], certified[:, 0], certified[:, 1], spread, r_squared)


def univariate(folder: Path, name: str) -> tuple[np.ndarray, float, float]:
    """Read a univariate set: samples, certified mean, certified sample standard deviation."""
    text = (folder / f"{name}.dat").read_text()
    lines = text.splitlines()
    mean = float(re.search(rf"Sample Mean.*?:\s*({_NUMBER})", text).group(1))
    std = float(re.search(rf"Sample Standard Deviation.*?:\s*({_NUMBER})", text).group(1))
    dashes = max(i for i, line in enumerate(lines) if line.startswith("---"))
    return np.array([float(line) for line in lines[dashes + 1 :] if line.strip()]), mean, std


def numacc(which: int) -> np.ndarray:
    """The patterns of NumAcc1 to 4, which are made by rule."""
    if which == 1:
        return np.array([10000001.0, 10000003.0, 10000002.0])
    first, low, high = {
        2: (1.2, 1.1, 1.3),
        3: (1000000.2, 1000000.1, 1000000.3),
        4: (10000000.2, 10000000.1, 10000000.3),
    }[which]
    return np.array([first] + [low, high] * 500)
