"""Rolling windows: numpy's figures of each window, whatever was in the stream before."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from luztar import stats
from luztar.errors import ParameterError
from nist_data import EPS

samples = arrays(np.float64, st.integers(1, 300), elements=st.floats(-1e6, 1e6).map(lambda v: round(v, 6)))


def windows(x: np.ndarray, window: int) -> np.ndarray:
    return np.lib.stride_tricks.sliding_window_view(x, window)


@given(samples, st.integers(1, 300))
def test_every_window_has_numpys_figures(x: np.ndarray, window: int) -> None:
    window = min(window, x.size)
    found, each = stats.rolling(x, window), windows(x, window)
    # rounding is measured by the window's own range and level, a few dozen joins of it
    level, spread = np.abs(each).max(axis=1), np.ptp(each, axis=1)
    assert np.all(np.abs(found.mean - each.mean(axis=1)) <= 4 * EPS * level + 16 * EPS * spread)
    assert np.all(np.abs(found.std_population - each.std(axis=1)) <= 64 * EPS * (spread + level))
    assert np.array_equal(found.min, each.min(axis=1)) and np.array_equal(found.max, each.max(axis=1))


def test_an_outlier_leaves_no_trace() -> None:
    rng = np.random.default_rng(0)
    x = 0.01 * rng.standard_normal(20_000)
    spiked = x.copy()
    spiked[5000] = 1e9
    clean, found = stats.rolling(x, 500), stats.rolling(spiked, 500)
    outside = np.ones(clean.mean.size, bool)
    outside[5000 - 499 : 5001] = False
    # to the last bit: windows without the spike are made of the same sums
    for name in ("mean", "std_population", "min", "max"):
        assert np.array_equal(getattr(clean, name)[outside], getattr(found, name)[outside]), name
    assert np.all(found.max[~outside] == 1e9)


@given(samples, st.integers(1, 50), st.integers(1, 40))
def test_chunks_do_not_change_a_bit(x: np.ndarray, window: int, chunk: int) -> None:
    whole, parts = stats.Rolling(window), stats.Rolling(window)
    out = np.empty((x.size, 4))
    whole.push_into(x, out)
    for start in range(0, x.size, chunk):
        part = np.empty((len(x[start : start + chunk]), 4))
        parts.push_into(x[start : start + chunk], part)
        assert np.array_equal(part, out[start : start + chunk])
    assert (parts.mean, parts.std_population, parts.min, parts.max) == tuple(out[-1])
    assert parts.count == min(window, x.size)


def test_a_constant_has_no_spread_at_any_level() -> None:
    found = stats.rolling(np.full(1000, 1e9 + 0.1), 37)
    assert np.all(found.std_population == 0.0) and np.all(found.mean == 1e9 + 0.1)


def test_large_offset_keeps_its_digits() -> None:
    x = 1e9 + np.random.default_rng(1).integers(-8, 9, 5000) / 8  # exact doubles
    found, each = stats.rolling(x, 100), windows(x - 1e9, 100)
    assert found.std_population == pytest.approx(each.std(axis=1), rel=128 * EPS)


def test_refusals_name_the_culprit() -> None:
    with pytest.raises(ParameterError, match="window"):
        stats.rolling([1.0, 2.0], 3)
    with pytest.raises(ParameterError, match="window"):
        stats.Rolling(0)
    r = stats.Rolling(3)
    r.push([1.0, 2.0])
    with pytest.raises(ParameterError, match="index 1"):
        r.push([5.0, np.nan])
    assert r.count == 2 and r.max == 2.0
    with pytest.raises(ParameterError, match="out has"):
        r.push_into([1.0], np.empty((2, 4)))


def test_nothing_has_no_figures() -> None:
    r = stats.Rolling(3)
    assert (r.count, r.mean, r.std_population, r.min, r.max) == (0, None, None, None, None)
