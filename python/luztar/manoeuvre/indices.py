"""Sobol indices by Saltelli's design, and first-order indices from any sample by bins; both with intervals."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

# Resamples of the intervals; their ends are then known to about 2 % of their distance.
RESAMPLES = 400
CONFIDENCE = 0.95
# Fewer rows give no interval worth the name.
LEAST_ROWS = 64
# A curve within a bin is taken for chance: of two periods of a sine over the range 40 bins lose 1 %.
MOST_BINS = 40
ROWS_PER_BIN = 16


@dataclass(frozen=True)
class Index:
    """A share of a variance, with its 95 % interval."""

    value: float
    low: float
    high: float

    def to_dict(self) -> dict[str, float]:
        """Return the index as plain JSON values."""
        return {"value": self.value, "low": self.low, "high": self.high}


@dataclass(frozen=True)
class Indices:
    """Indices of one output.

    Attributes
    ----------
    first : dict of str to Index
        Share of the variance that a parameter explains alone.
    total : dict of str to Index, or None
        Share that is left when all others are known; None where the sample cannot tell.
    rows : int
        Rows of the sample that were used.
    """

    first: dict[str, Index]
    total: dict[str, Index] | None
    rows: int

    def to_dict(self) -> dict[str, Any]:
        """Return the indices as plain JSON values."""
        return {
            "rows": self.rows,
            "first": {k: v.to_dict() for k, v in self.first.items()},
            "total": None if self.total is None else {k: v.to_dict() for k, v in self.total.items()},
        }


def design(dimension: int, samples: int, seed: int) -> np.ndarray:
    """Return Saltelli's design in the unit cube, shape (samples, dimension + 2, dimension).

    Along the second axis stand a row of A, the same row of B, and A with one column after the other from B; A and B are
    the halves of a scrambled Sobol sequence.

    Parameters
    ----------
    dimension : int
    samples : int
        A power of two: the sequence is balanced then.
    seed : int
    """
    from scipy.stats import qmc

    drawn = qmc.Sobol(2 * dimension, scramble=True, seed=seed).random(samples)
    a, b = drawn[:, :dimension], drawn[:, dimension:]
    made = np.repeat(a[:, np.newaxis, :], dimension + 2, axis=1)
    made[:, 1] = b
    for i in range(dimension):
        made[:, i + 2, i] = b[:, i]
    return made


def saltelli(names: Sequence[str], output: np.ndarray, seed: int) -> Indices | None:
    """Return first and total indices of an output on :func:`design`; None where it does not vary.

    Parameters
    ----------
    names : sequence of str
    output : ndarray, shape (samples, dimension + 2)
        Finite.
    seed : int
        Of the bootstrap over the rows, which gives the intervals.

    Notes
    -----
    First order: Saltelli et al., Comput. Phys. Commun. 181 (2010) 259, table 2 (b); total: Jansen, the same table (f).
    """
    values = output - output[:, :2].mean()
    if len(values) < LEAST_ROWS or not values[:, :2].var() > 0.0:
        return None
    random = np.random.default_rng(seed)
    draws = random.integers(0, len(values), (RESAMPLES, len(values)))
    whole = _saltelli(values)
    spread = np.array([_saltelli(values[rows]) for rows in draws])
    first, total = (
        {name: _index(whole[part, i], spread[:, part, i]) for i, name in enumerate(names)} for part in (0, 1)
    )
    return Indices(first, total, values.size)


def _saltelli(values: np.ndarray) -> np.ndarray:
    a, b, mixed = values[:, 0], values[:, 1], values[:, 2:]
    variance = values[:, :2].var()
    if not variance > 0.0:
        return np.full((2, mixed.shape[1]), np.nan)
    first = (b[:, np.newaxis] * (mixed - a[:, np.newaxis])).mean(axis=0) / variance
    total = 0.5 * ((a[:, np.newaxis] - mixed) ** 2).mean(axis=0) / variance
    return np.array([first, total])


def by_bins(names: Sequence[str], inputs: np.ndarray, output: np.ndarray, seed: int) -> Indices | None:
    """Return first-order indices from any sample; None where there are too few rows or the output does not vary.

    Where rows are missing, as those of infeasible drives are, Saltelli's design is broken. This estimator needs no
    design: it sorts the rows by one parameter into bins of equal size and compares the variance of the bins' means with
    the whole.

    Parameters
    ----------
    names : sequence of str
    inputs : ndarray, shape (n, dimension)
    output : ndarray, shape (n,)
        Finite.
    seed : int
        Of the half samples, which give the intervals.

    Notes
    -----
    The correlation ratio with what chance alone gives taken off, ``1 - (SSW / (n - K)) / (SST / (n - 1))`` (Kelley's
    epsilon squared). Its error falls with the root of n, so that the spread over halves of the sample, taken times the
    root of a half, is that of the whole.
    """
    if len(output) < LEAST_ROWS or not output.var() > 0.0:
        return None
    random = np.random.default_rng(seed)
    bins = int(np.clip(len(output) // ROWS_PER_BIN, 4, MOST_BINS))
    whole = _binned(inputs, output, bins)
    halves = [random.permutation(len(output))[: len(output) // 2] for _ in range(RESAMPLES // 2)]
    spread = np.array([_binned(inputs[rows], output[rows], bins) for rows in halves])
    centred = whole + (spread - np.nanmean(spread, axis=0)) * np.sqrt(0.5)
    first = {name: _index(whole[i], centred[:, i]) for i, name in enumerate(names)}
    return Indices(first, None, len(output))


def _binned(inputs: np.ndarray, output: np.ndarray, bins: int) -> np.ndarray:
    values = output - output.mean()
    whole = float((values**2).sum()) / (len(values) - 1)
    if not whole > 0.0:
        return np.full(inputs.shape[1], np.nan)
    borders = np.linspace(0, len(values), bins + 1).astype(int)[:-1]
    counts = np.diff(np.append(borders, len(values)))
    made = []
    for column in inputs.T:
        sums = np.add.reduceat(values[np.argsort(column, kind="stable")], borders)
        within = float((values**2).sum() - (sums**2 / counts).sum()) / (len(values) - bins)
        made.append(1.0 - within / whole)
    return np.array(made)


def _index(value: float, spread: np.ndarray) -> Index:
    tail = 0.5 * (1.0 - CONFIDENCE)
    low, high = np.nanquantile(spread, [tail, 1.0 - tail])
    return Index(float(value), float(low), float(high))
