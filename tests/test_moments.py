"""Moments: as many digits as the stored doubles allow, whatever the offset, the chunks and the merging."""

from __future__ import annotations

import math
import pickle
from fractions import Fraction

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from luztar import stats
from luztar.errors import ParameterError

EPS = np.finfo(np.float64).eps

# Squares of values below 1e-150 underflow in NumPy's way of taking the rms; such records are tested elsewhere.
values = st.floats(-1e6, 1e6).map(lambda v: v if abs(v) > 1e-150 else 0.0)
samples = arrays(np.float64, st.integers(1, 2000), elements=values, fill=values)


def digits(found: float, certified: float) -> float:
    """The log relative error: how many leading digits agree, 15.95 at most."""
    return -math.log10(max(abs(found - certified) / abs(certified), EPS / 2))


def numacc(which: int) -> np.ndarray:
    """The patterns of NIST's NumAcc1 to 4, which are made by rule."""
    if which == 1:
        return np.array([10000001.0, 10000003.0, 10000002.0])
    first, low, high = {
        2: (1.2, 1.1, 1.3),
        3: (1000000.2, 1000000.1, 1000000.3),
        4: (10000000.2, 10000000.1, 10000000.3),
    }[which]
    return np.array([first] + [low, high] * 500)


def exact_sample_std(x: np.ndarray) -> float:
    """The sample standard deviation of the stored doubles, by rational arithmetic."""
    values = [Fraction(v) for v in x.tolist()]
    mean = sum(values) / len(values)
    variance = sum((v - mean) ** 2 for v in values) / (len(values) - 1)
    return math.isqrt(int(variance * 10**60)) / 1e30


@pytest.mark.parametrize(("which", "least"), [(1, 15), (2, 14), (3, 9.5), (4, 8.3)])
def test_certified_deviation_has_the_digits_the_decimals_allow(which: int, least: float) -> None:
    # 9.5 and 8.3 are the ceiling: 1000000.1 and 10000000.1 are not doubles, their rounding is all that is lost
    certified = 1.0 if which == 1 else 0.1
    assert digits(stats.describe(numacc(which)).std_sample, certified) >= least - 0.05


@pytest.mark.parametrize("which", [1, 2, 3, 4])
@pytest.mark.parametrize("chunk", [1, 7, 100, 5000])
def test_standard_deviation_has_fourteen_digits_of_the_exact_answer(which: int, chunk: int) -> None:
    x = numacc(which)
    m = stats.Moments()
    for start in range(0, x.size, chunk):
        m.push(x[start : start + chunk])
    assert digits(m.std_sample, exact_sample_std(x)) >= 14


@pytest.mark.parametrize(("name", "least"), [("Lottery", 14), ("Lew", 14), ("Mavro", 13), ("Michelso", 13.7)])
def test_nist_files_have_their_certified_digits(nist, name: str, least: float) -> None:
    text = (nist / f"{name}.dat").read_text().splitlines()
    certified = next(line.split(":")[1].split()[0] for line in text if line.startswith("Sample Standard Deviation"))
    dashes = max(i for i, line in enumerate(text) if line.startswith("---"))
    x = np.array([float(line) for line in text[dashes + 1 :] if line.strip()])
    assert digits(stats.describe(x).std_sample, float(certified)) >= least


@given(samples)
def test_moments_are_those_of_numpy(x: np.ndarray) -> None:
    d = stats.describe(x)
    largest = np.abs(x).max()
    # numpy's own pairwise sums round by log2(n) <= 11 epsilons of the largest sample
    tolerance = 16 * EPS * largest
    # and its squares, summed by the hundred before the pairs begin, by at most 128 epsilons of themselves
    of_squares = 128 * EPS
    assert d.mean == pytest.approx(x.mean(), rel=0, abs=tolerance)
    assert d.std_population == pytest.approx(x.std(), rel=of_squares, abs=tolerance)
    assert d.rms == pytest.approx(np.sqrt(np.mean(x * x)), rel=of_squares, abs=tolerance)
    assert (d.count, d.min, d.max) == (x.size, x.min(), x.max())
    assert (d.min_index, d.max_index) == (x.argmin(), x.argmax())


@given(samples, samples)
def test_merging_two_parts_is_pushing_both(a: np.ndarray, b: np.ndarray) -> None:
    joined, m = stats.Moments(np.concatenate([a, b])), stats.Moments(a)
    m.merge(stats.Moments(b))
    largest = max(np.abs(a).max(), np.abs(b).max())
    assert m.count == joined.count
    assert m.mean == pytest.approx(joined.mean, rel=0, abs=4 * EPS * largest)
    # one merge adds one rounding to each of the sums, n samples at most n/512 block sums
    assert m.std_population == pytest.approx(joined.std_population, rel=16 * EPS, abs=4 * EPS * largest)
    assert (m.min_index, m.max_index) == (joined.min_index, joined.max_index)


@given(st.floats(-1e100, 1e100), st.integers(1, 3000), st.integers(1, 3000))
def test_constant_has_no_spread_at_all(value: float, n: int, chunk: int) -> None:
    m = stats.Moments()
    for start in range(0, n, chunk):
        m.push(np.full(min(chunk, n - start), value))
    assert (m.mean, m.std_population, m.min, m.max) == (value, 0.0, value, value)


def test_nothing_has_no_moments_and_one_sample_no_sample_deviation() -> None:
    m = stats.Moments()
    assert (m.count, m.mean, m.std_population, m.min, m.max_index) == (0, None, None, None, None)
    with pytest.raises(ParameterError, match="nothing was pushed"):
        m.describe()
    m.push([2.5])
    assert (m.mean, m.std_population, m.std_sample, m.rms) == (2.5, 0.0, None, 2.5)


def test_merging_nothing_changes_nothing() -> None:
    m = stats.Moments([1.0, 2.0])
    m.merge(stats.Moments())
    assert m.describe() == stats.Moments([1.0, 2.0]).describe()
    empty = stats.Moments()
    empty.merge(m)
    assert empty.describe() == m.describe()


def test_object_merges_with_itself() -> None:
    m = stats.Moments([1.0, 3.0])
    m.merge(m)
    assert m.describe() == stats.Moments([1.0, 3.0, 1.0, 3.0]).describe()


@pytest.mark.parametrize("bad", [[np.nan], [1.0, np.inf], [1j], ["a"], [1e200], [[1.0]]])
def test_refused_chunk_adds_nothing(bad) -> None:
    m = stats.Moments([1.0, 2.0])
    with pytest.raises(ParameterError):
        m.push(bad)
    assert m.describe() == stats.Moments([1.0, 2.0]).describe()


def test_pickle_and_copy_go_on_with_the_same_bits() -> None:
    x = np.random.default_rng(3).standard_normal(3000) + 1e6
    m = stats.Moments(x[:1000])
    twins = [m.copy(), pickle.loads(pickle.dumps(m))]
    m.push(x[1000:])
    for twin in twins:
        assert twin.count == 1000
        twin.push(x[1000:])
        assert twin.describe() == m.describe()
    assert pickle.loads(pickle.dumps(stats.Moments())).count == 0


def test_description_is_frozen_and_becomes_a_dictionary() -> None:
    d = stats.describe([3.0, 1.0, 2.0])
    assert d.to_dict()["min_index"] == 1
    with pytest.raises(AttributeError):
        d.mean = 0.0
