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
from scipy.stats import kurtosis, skew

import exact_least_squares
from luztar import stats
from luztar.errors import ParameterError
from nist_data import EPS, digits, numacc, univariate

# Squares of values below 1e-150 underflow in NumPy's way of taking the rms; such records are tested elsewhere.
values = st.floats(-1e6, 1e6).map(lambda v: v if abs(v) > 1e-150 else 0.0)
samples = arrays(np.float64, st.integers(1, 2000), elements=values, fill=values)


# One unit in the last place: the exact mean of NumAcc2 lies half-way between two doubles, either is right.
LAST_PLACE = 15.6


def test_root_of_the_exact_reference_is_the_root() -> None:
    assert exact_least_squares.root(Fraction(2)) == math.sqrt(2)
    assert exact_least_squares.root(Fraction(1, 10**40)) == pytest.approx(1e-20, rel=EPS)


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
    assert digits(m.std_sample, exact_least_squares.moments(x)[1]) >= 14


SETS = ["Lottery", "Lew", "Mavro", "Michelso", "NumAcc1", "NumAcc2", "NumAcc3", "NumAcc4"]


@pytest.mark.parametrize("name", SETS)
def test_nist_files_have_at_least_the_digits_of_numpy(nist, name: str) -> None:
    x, mean, std = univariate(nist, name)
    found = stats.describe(x)
    # "at least numpy's" up to the last place, where rounding decides
    assert digits(found.mean, mean) >= min(digits(x.mean(), mean), LAST_PLACE)
    # the decimals of the set are not doubles: beyond some digit the certified deviation says which rounding is lucky
    assert digits(found.std_sample, std) >= min(digits(x.std(ddof=1), std), LAST_PLACE) - 0.3


@pytest.mark.parametrize("name", SETS)
def test_moments_of_the_nist_files_are_the_exact_ones(nist, name: str) -> None:
    x, _, _ = univariate(nist, name)
    found = stats.describe(x)
    mean, std, skew, kurtosis = exact_least_squares.moments(x)
    assert digits(found.mean, mean) >= LAST_PLACE
    # two sums of a thousand squares, each rounded by 2^-53: three units in the last place
    assert digits(found.std_sample, std) >= 15
    # the third powers cancel where the data are symmetric, so the skewness is held against 1
    assert found.skew == pytest.approx(skew, rel=1e-13, abs=64 * EPS)
    assert found.excess_kurtosis == pytest.approx(kurtosis, rel=0, abs=64 * EPS * (3 + abs(kurtosis)))


@given(
    pieces=st.lists(arrays(np.float64, st.integers(0, 1500), elements=values, fill=values), min_size=1, max_size=5),
    shape=st.booleans(),
    nan_every=st.integers(0, 7),
)
def test_chunks_do_not_change_a_bit(pieces: list[np.ndarray], shape: bool, nan_every: int) -> None:
    joined = np.concatenate(pieces).copy()
    policy = "raise"
    if nan_every > 1:
        joined[::nan_every], policy = np.nan, "skip"
    whole = stats.Moments(joined, shape=shape, nan=policy)
    parts = stats.Moments(shape=shape, nan=policy)
    start = 0
    for piece in pieces:
        parts.push(joined[start : start + piece.size])
        start += piece.size
    assert parts.state() == whole.state()


@given(samples)
def test_order_moves_the_moments_by_rounding_alone(x: np.ndarray) -> None:
    found, shuffled = stats.Moments(x), stats.Moments(np.random.default_rng(0).permutation(x))
    largest = np.abs(x).max()
    assert shuffled.mean == pytest.approx(found.mean, rel=0, abs=4 * EPS * largest)
    # sums in lanes of at most 64 terms: 64 roundings of positive squares
    assert shuffled.std_population == pytest.approx(found.std_population, rel=64 * EPS, abs=4 * EPS * largest)
    assert (shuffled.min, shuffled.max) == (found.min, found.max)


@given(samples)
def test_shape_is_that_of_scipy(x: np.ndarray) -> None:
    m = stats.Moments(x, shape=True)
    if m.std_population <= max(1e-6 * np.abs(x).max(), 1e-60):
        # scipy calls such a record constant, or its powers run out of exponents
        return
    # third and fourth powers of deviations up to sqrt(n) standard deviations, whose sums round n times at most
    rounding = 64 * EPS * x.size**2
    assert m.skew == pytest.approx(skew(x), rel=rounding, abs=rounding)
    assert m.excess_kurtosis == pytest.approx(kurtosis(x), rel=rounding, abs=rounding)


@given(samples, samples)
def test_merged_shape_is_that_of_the_whole(a: np.ndarray, b: np.ndarray) -> None:
    whole, m = stats.Moments(np.concatenate([a, b]), shape=True), stats.Moments(a, shape=True)
    m.merge(stats.Moments(b, shape=True))
    if whole.std_population <= max(1e-6 * max(np.abs(a).max(), np.abs(b).max()), 1e-60):
        return
    rounding = 64 * EPS * whole.count**2
    assert m.skew == pytest.approx(whole.skew, rel=rounding, abs=rounding)
    assert m.excess_kurtosis == pytest.approx(whole.excess_kurtosis, rel=rounding, abs=rounding)


def test_shape_of_nothing_that_varies_is_unknown() -> None:
    assert stats.describe([2.0, 2.0]).skew is None
    assert stats.Moments([1.0, 2.0]).skew is None
    # fourth powers of 1e-90 are no numbers any more
    assert stats.describe([1e-90, 2e-90, 4e-90]).excess_kurtosis is None


def test_skipped_nan_is_counted_and_the_rest_is_as_without_it() -> None:
    x = np.array([np.nan, 3.0, -1.0, np.nan, 7.0])
    found = stats.describe(x, nan="skip")
    plain = stats.describe(x[~np.isnan(x)])
    assert (found.nan_count, found.count, found.mean, found.std_sample) == (2, 3, plain.mean, plain.std_sample)
    # places are those of the record
    assert (found.min_index, found.max_index) == (2, 4)
    with pytest.raises(ParameterError, match="all 2 samples are NaN"):
        stats.describe([np.nan, np.nan], nan="skip")
    with pytest.raises(ParameterError, match="inf at index 1"):
        stats.describe([np.nan, np.inf], nan="skip")


def test_refused_nan_is_told_by_its_places() -> None:
    x = np.zeros(5000)
    x[[3, 4200]] = np.nan
    with pytest.raises(ParameterError, match="2 values that are not finite, at index 3, 4200"):
        stats.describe(x)


def test_clipped_samples_are_counted_and_taken() -> None:
    counts = np.array([-32768, 0, 5, 32767, 32767], dtype=np.int16)
    found = stats.describe(counts, clipped_at=(-32768, 32767))
    assert (found.clipped_count, found.count, found.max) == (3, 5, 32767.0)
    assert stats.describe(counts).clipped_count == 0
    with pytest.raises(ParameterError, match="lower limit first"):
        stats.describe(counts, clipped_at=(1, -1))


@pytest.mark.parametrize("dtype", [np.int16, np.int32, np.float32, np.int64, np.uint8, ">f8", np.float16])
def test_every_type_gives_the_figures_of_its_values(dtype) -> None:
    x = np.random.default_rng(2).integers(0, 200, 5001).astype(dtype)
    assert stats.describe(x) == stats.describe(x.astype(np.float64))


def test_one_sample_at_a_time_is_the_whole() -> None:
    x = np.random.default_rng(4).standard_normal(2500)
    m = stats.Moments()
    for v in x.tolist():
        m.push(v)
    assert m.state() == stats.Moments(x).state()


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


def test_moments_that_know_less_are_not_merged_in_silence() -> None:
    shaped, plain = stats.Moments([1.0, 2.0, 4.0], shape=True), stats.Moments([5.0])
    before = shaped.describe()
    with pytest.raises(ParameterError, match="without cannot be merged"):
        shaped.merge(plain)
    with pytest.raises(ParameterError, match="different limits"):
        plain.merge(stats.Moments([1.0], clipped_at=(0, 1)))
    assert shaped.describe() == before
    plain.merge(shaped)
    assert plain.count == 4 and plain.skew is None


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
