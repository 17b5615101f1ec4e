"""Fewer points for a picture, without losing a peak: the least and the greatest of every stretch stay."""

from __future__ import annotations

import numpy as np

from .. import signal

# A screen is 2000 to 4000 columns wide: more points cost file size and show nothing.
MAX_POINTS = 4000


def extremes(*series: np.ndarray, points: int = MAX_POINTS) -> np.ndarray:
    """Return indices of about ``points`` samples that keep the extremes of every series.

    The record is cut into stretches of equal length; of each the least and greatest value of every series are kept,
    so the overall extremes are among them. The first and last sample stay, and where a stretch holds NaN (a break in a
    line) one of them stays, too.

    Parameters
    ----------
    *series : ndarray, shape (n,)
        For a loop give both coordinates.
    points : int
        At most this many indices, unless that leaves no stretch for each series.

    Returns
    -------
    ndarray of int, strictly increasing
    """
    n = series[0].size
    if any(s.size != n for s in series):
        raise ValueError(f"the series differ in length: {[s.size for s in series]}")
    if n <= points:
        return np.arange(n)
    kept_per_stretch = sum(3 if np.isnan(s).any() else 2 for s in series)
    count = max((points - 2) // kept_per_stretch, 1)
    keep = np.zeros(n, bool)
    keep[[0, n - 1]] = True
    for values in series:
        keep[signal.extremes(values, count)] = True
    return np.flatnonzero(keep)
