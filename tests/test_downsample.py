"""A picture with fewer points keeps every peak."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from luztar.report.downsample import extremes


def test_a_short_record_stays_whole() -> None:
    x = np.arange(50.0)
    assert extremes(x, points=50).tolist() == list(range(50))


@given(
    n=st.integers(100, 5000),
    points=st.integers(20, 400),
    seed=st.integers(0, 2**31),
)
def test_extremes_of_every_series_and_both_ends_stay(n: int, points: int, seed: int) -> None:
    rng = np.random.default_rng(seed)
    x, y = rng.normal(size=n).cumsum(), rng.standard_t(2, size=n)
    at = extremes(x, y, points=points)
    assert at.size <= max(points, 6)
    assert (np.diff(at) > 0).all()
    assert at[0] == 0
    assert at[-1] == n - 1
    for series in (x, y):
        assert series[at].min() == series.min()
        assert series[at].max() == series.max()


def test_one_spike_in_a_million_samples_stays() -> None:
    x = np.zeros(1_000_000)
    x[777_777] = 1.0
    assert 777_777 in extremes(x)


def test_every_stretch_keeps_its_own_extremes() -> None:
    x = np.sin(np.linspace(0.0, 40.0 * np.pi, 40_000))
    drawn = x[extremes(x, points=1000)]
    peaks = np.count_nonzero((drawn[1:-1] > drawn[:-2]) & (drawn[1:-1] >= drawn[2:]) & (drawn[1:-1] > 0.999))
    assert peaks == 20


def test_a_break_in_the_line_stays() -> None:
    x = np.linspace(0.0, 1.0, 10_000)
    x[5000:5003] = np.nan
    drawn = x[extremes(x, points=500)]
    assert np.isnan(drawn).any()
    assert np.nanmax(drawn) == 1.0


def test_series_of_unequal_length_are_refused() -> None:
    with pytest.raises(ValueError, match="differ in length"):
        extremes(np.zeros(10), np.zeros(11))
