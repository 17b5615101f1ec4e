"""Quantiles: the sketch within its bound of the exact rank, the counts exact, merging without any loss."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from luztar import stats
from luztar.errors import ParameterError
from nist_data import EPS

finite = st.floats(allow_nan=False, allow_infinity=False, allow_subnormal=False)
samples = arrays(np.float64, st.integers(1, 400), elements=finite)
shares = st.floats(0.0, 1.0)


@given(samples, st.lists(shares, min_size=1, max_size=8), st.sampled_from([0.2, 0.01, 1e-3, 1e-4]))
def test_sketch_is_within_its_bound_of_the_exact_rank(x: np.ndarray, qs: list[float], error: float) -> None:
    sketch = stats.QuantileSketch(error)
    sketch.push(x)
    assert sketch.relative_error <= error < 2 * sketch.relative_error or error == 0.2
    ordered = np.sort(x)
    for q in [0.0, 1.0, *qs]:
        exact = ordered[int(np.floor(q * (x.size - 1)))]
        # the bound itself, with no allowance but the rounding of this comparison
        assert abs(sketch.quantile(q) - exact) <= sketch.relative_error * abs(exact) * (1 + 4 * EPS)
    assert (sketch.quantile(0.0), sketch.quantile(1.0)) == (sketch.min, sketch.max) or x.size > 1
    assert (sketch.min, sketch.max, sketch.count) == (x.min(), x.max(), x.size)


@given(samples, samples, st.sampled_from([0.1, 0.01]))
def test_merged_sketches_are_the_sketch_of_the_whole(a: np.ndarray, b: np.ndarray, error: float) -> None:
    whole, left, right = (stats.QuantileSketch(error) for _ in range(3))
    whole.push(np.concatenate([a, b]))
    left.push(a)
    right.push(b)
    left.merge(right)
    assert left.state() == whole.state()


@given(samples, st.integers(1, 50))
def test_neither_chunks_nor_order_change_a_sketch(x: np.ndarray, chunk: int) -> None:
    whole, parts = stats.QuantileSketch(), stats.QuantileSketch()
    whole.push(x)
    shuffled = np.random.default_rng(0).permutation(x)
    for start in range(0, x.size, chunk):
        parts.push(shuffled[start : start + chunk])
    assert parts.state() == whole.state()


def test_sketch_refuses_what_it_cannot_bound() -> None:
    sketch = stats.QuantileSketch()
    for bad in ([np.nan], [1.0, np.inf], ["a"], [1j]):
        with pytest.raises(ParameterError):
            sketch.push(bad)
    assert sketch.count == 0 and sketch.quantile(0.5) is None
    for error in (0.0, 0.5, 1e-9, np.nan):
        with pytest.raises(ParameterError, match="relative_error"):
            stats.QuantileSketch(error)
    with pytest.raises(ParameterError, match="q is 1.5"):
        sketch.quantile(1.5)
    with pytest.raises(ParameterError, match="relative_error of the other"):
        sketch.merge(stats.QuantileSketch(0.1))


counts = arrays(np.int16, st.integers(1, 500), elements=st.integers(-32768, 32767))


@given(counts, shares)
def test_counts_give_numpys_quantiles(x: np.ndarray, q: float) -> None:
    c = stats.Counts()
    c.push(x)
    assert c.quantile(q, "lower") == np.sort(x)[int(np.floor(q * (x.size - 1)))]
    # interpolated between the same two samples; numpy takes the weight from the other side above one half
    assert c.quantile(q) == pytest.approx(np.quantile(x.astype(float), q), rel=4 * EPS, abs=65536 * 400 * EPS)
    assert (c.min, c.max, c.count) == (x.min(), x.max(), x.size)


@given(counts)
def test_counts_have_the_exact_mean_and_deviation(x: np.ndarray) -> None:
    c = stats.Counts()
    c.push(x)
    n, total, squares = x.size, int(x.sum(dtype=np.int64)), int((x.astype(np.int64) ** 2).sum())
    # one division of whole numbers, rounded once or twice
    assert c.mean == pytest.approx(total / n, rel=2 * EPS, abs=EPS)
    assert c.std_population == pytest.approx(((n * squares - total**2) / n**2) ** 0.5, rel=4 * EPS)


@given(counts, counts)
def test_merged_counts_are_those_of_the_whole(a: np.ndarray, b: np.ndarray) -> None:
    whole, part, other = stats.Counts(), stats.Counts(), stats.Counts()
    whole.push(np.concatenate([a, b]))
    part.push(a)
    other.push(b.astype(np.int32))
    part.merge(other)
    assert part.state() == whole.state()
    values, times = whole.values()
    expected = np.unique(np.concatenate([a, b]), return_counts=True)
    assert np.array_equal(values, expected[0]) and np.array_equal(times, expected[1])


def test_counts_of_extremes_of_32_bits() -> None:
    c = stats.Counts()
    c.push([-(2**31), 2**31 - 1, 0])
    assert (c.min, c.quantile(0.5), c.max, c.mean) == (-(2**31), 0.0, 2**31 - 1, -1 / 3)


def test_counts_refuse_what_is_not_whole_or_spreads_too_far() -> None:
    c = stats.Counts()
    for bad in ([1.0], [2**31], ["a"], [[1]], [2**70]):
        with pytest.raises(ParameterError):
            c.push(bad)
    c.push([])
    assert c.count == 0 and c.quantile(0.5) is None and c.mean is None
    c.push([5])
    with pytest.raises(ParameterError, match="QuantileSketch"):
        c.push(np.arange(0, 2**31 - 1, 2**17, dtype=np.int32))
    assert c.count == 1 and c.values()[1].tolist() == [1]
