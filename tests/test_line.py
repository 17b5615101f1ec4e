"""The straight line: certified digits, scipy's answer, and a defined answer where the data have none."""

from __future__ import annotations

import math
import pickle

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.stats import linregress

from luztar import regression
from luztar.errors import ParameterError

EPS = np.finfo(np.float64).eps


def digits(found: float, certified: float) -> float:
    """The log relative error: how many leading digits agree, 15.95 at most."""
    return -math.log10(max(abs(found - certified) / abs(certified), EPS / 2))


def points(n: int, seed: int, offset: float = 0.0) -> tuple[np.ndarray, np.ndarray]:
    rng = np.random.default_rng(seed)
    x = offset + rng.uniform(-5, 5, n)
    return x, 0.7 * (x - offset) - 2 + 0.3 * rng.standard_normal(n)


def norris(nist) -> tuple[np.ndarray, np.ndarray]:
    text = (nist / "Norris.dat").read_text().splitlines()
    start = max(i for i, line in enumerate(text) if line.startswith("Data:"))
    table = np.array([[float(v) for v in line.split()] for line in text[start + 1 :] if line.strip()])
    return table[:, 1], table[:, 0]


def test_norris_has_the_certified_line(nist) -> None:
    fit = regression.line(*norris(nist))
    assert fit.n == 36
    assert digits(fit.slope, 1.00211681802045) >= 13
    assert digits(fit.intercept, -0.262323073774029) >= 12
    assert digits(fit.slope_se, 0.429796848199937e-03) >= 12
    assert digits(fit.intercept_se, 0.232818234301152) >= 12
    assert digits(fit.residual_std, 0.884796396144373) >= 12
    assert digits(fit.r**2, 0.999993745883712) >= 14


def test_norris_in_chunks_has_the_certified_slope(nist) -> None:
    x, y = norris(nist)
    sums = regression.LineSums()
    for start in range(0, x.size, 5):
        sums.push(x[start : start + 5], y[start : start + 5])
    fit = sums.fit()
    assert digits(fit.slope, 1.00211681802045) >= 13
    # the residual is 6e-6 of the sum it is a difference of: five digits less than sixteen, one for the sums
    assert digits(fit.residual_std, 0.884796396144373) >= 10


def test_time_stamps_near_a_billion_seconds_keep_their_digits(nist) -> None:
    x, y = norris(nist)
    # 1e9 + x is rounded by 6e-8 in 1e3, spread over 36 points: ten digits are all the data still hold
    assert digits(regression.line(x + 1e9, y).slope, 1.00211681802045) >= 10


@given(n=st.integers(3, 2000), seed=st.integers(0, 999), offset=st.floats(-100, 100))
def test_line_is_that_of_scipy(n: int, seed: int, offset: float) -> None:
    x, y = points(n, seed, offset)
    fit, other = regression.line(x, y), linregress(x, y)
    # linregress sums n products and takes the residual as 1 - r^2, so its own rounding decides: sqrt(n) of them
    # times the condition of the residual
    rounding = 64 * EPS * math.sqrt(n) / max(1 - other.rvalue**2, 1e-4)
    assert fit.slope == pytest.approx(other.slope, rel=rounding)
    assert fit.intercept == pytest.approx(other.intercept, rel=rounding, abs=rounding * (1 + abs(offset)))
    assert fit.r == pytest.approx(other.rvalue, rel=rounding)
    assert fit.slope_se == pytest.approx(other.stderr, rel=rounding)
    assert fit.intercept_se == pytest.approx(other.intercept_stderr, rel=rounding)


@given(n=st.integers(2, 2000), value=st.floats(-1e9, 1e9), seed=st.integers(0, 99))
def test_constant_y_has_slope_exactly_zero(n: int, value: float, seed: int) -> None:
    fit = regression.line(points(n, seed)[0], np.full(n, value))
    assert (fit.slope, fit.intercept, fit.r) == (0.0, value, 0.0)
    assert fit.residual_std in (None, 0.0)


@given(n=st.integers(2, 2000), value=st.floats(-1e9, 1e9))
def test_constant_x_is_refused_in_words(n: int, value: float) -> None:
    with pytest.raises(ParameterError, match="x does not vary"):
        regression.line(np.full(n, value), np.arange(n))


def test_two_points_give_the_line_and_no_standard_errors() -> None:
    fit = regression.line([1.0, 3.0], [5.0, 9.0])
    assert (fit.slope, fit.intercept, fit.r) == (2.0, 3.0, 1.0)
    assert fit.slope_se is None and fit.intercept_se is None and fit.residual_std is None


@given(n=st.integers(2, 1500), m=st.integers(0, 1500), seed=st.integers(0, 99), offset=st.floats(-1e6, 1e6))
def test_merging_two_parts_is_pushing_both(n: int, m: int, seed: int, offset: float) -> None:
    x, y = points(n + m, seed, offset)
    joined, a, b = regression.LineSums(), regression.LineSums(), regression.LineSums()
    joined.push(x, y)
    a.push(x[:n], y[:n])
    b.push(x[n:], y[n:])
    a.merge(b)
    # the sums round a handful of times; the slope's condition is sqrt(Sxx Syy)/|Sxy| <= 10 for these points
    rounding = 256 * EPS
    found, expected = a.fit(), joined.fit()
    assert found.n == expected.n
    assert found.slope == pytest.approx(expected.slope, rel=rounding)
    assert found.intercept == pytest.approx(expected.intercept, rel=rounding, abs=rounding * (1 + abs(offset)))


@pytest.mark.parametrize(
    ("x", "y", "culprit"),
    [
        ([1.0], [1.0], "x"),
        ([], [], "x"),
        ([1.0, 2.0], [1.0, 2.0, 3.0], "y"),
        ([1.0, np.nan], [1.0, 2.0], "x"),
        ([1.0, 2.0], [1.0, np.inf], "y"),
        ([1.0, 2.0], [1j, 2.0], "y"),
        ([[1.0, 2.0]], [1.0, 2.0], "x"),
    ],
)
def test_unusable_points_are_refused_by_name(x, y, culprit: str) -> None:
    with pytest.raises(ParameterError, match=f"^{culprit}"):
        regression.line(x, y)


def test_sums_pickle_and_copy_with_the_same_bits() -> None:
    x, y = points(1000, 1, 1e6)
    sums = regression.LineSums()
    sums.push(x[:400], y[:400])
    twins = [sums.copy(), pickle.loads(pickle.dumps(sums))]
    sums.push(x[400:], y[400:])
    for twin in twins:
        assert twin.count == 400
        twin.push(x[400:], y[400:])
        assert twin.fit() == sums.fit()


def test_fit_needs_two_points() -> None:
    sums = regression.LineSums()
    with pytest.raises(ParameterError, match="at least 2"):
        sums.fit()


def test_line_is_frozen_and_becomes_a_dictionary() -> None:
    fit = regression.line([0.0, 1.0, 2.0], [1.0, 3.0, 5.0])
    assert fit.to_dict()["slope"] == 2.0 and list(fit.to_dict())[:2] == ["slope", "intercept"]
    with pytest.raises(AttributeError):
        fit.slope = 1.0
