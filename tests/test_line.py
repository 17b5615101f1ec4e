"""The straight line: certified digits, scipy's answer, and a defined answer where the data have none."""

from __future__ import annotations

import math
import pickle

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.stats import linregress
from scipy.stats import t as student

import exact_least_squares
from luztar import regression
from luztar.errors import ParameterError
from nist_data import EPS, digits
from nist_data import regression as regression_set


def points(n: int, seed: int, offset: float = 0.0) -> tuple[np.ndarray, np.ndarray]:
    rng = np.random.default_rng(seed)
    x = offset + rng.uniform(-5, 5, n)
    return x, 0.7 * (x - offset) - 2 + 0.3 * rng.standard_normal(n)


def norris(nist) -> tuple[np.ndarray, np.ndarray]:
    data = regression_set(nist, "Norris")
    return data.x[:, 0], data.y


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


def test_times_near_a_billion_seconds_give_the_exact_line(nist) -> None:
    x, y = norris(nist)
    exact, _ = exact_least_squares.polynomial(x + 1e9, y, 1)
    assert digits(regression.line(x + 1e9, y).slope, exact[1]) >= 14


def test_even_time_keeps_every_digit_at_a_billion_seconds() -> None:
    y = np.random.default_rng(5).standard_normal(3000) + 0.25 * np.arange(3000)
    near, far = regression.time_line(y, 1000.0), regression.time_line(y, 1000.0, start_s=1.7e9)
    assert far.slope == near.slope and far.slope_se == near.slope_se
    assert far.r == near.r and far.residual_std == near.residual_std
    exact, _ = exact_least_squares.polynomial(np.arange(3000.0), y, 1)
    assert digits(far.slope / 1000.0, exact[1]) >= 14
    # half a second on, which the time stamp still holds exactly
    assert far.predict([1.7e9 + 0.5])[0] == pytest.approx(near.predict([0.5])[0], rel=4 * EPS)
    stream = regression.TimeLine(1000.0, start_s=1.7e9)
    for start in range(0, 3000, 7):
        stream.push(y[start : start + 7])
    assert digits(stream.fit().slope, far.slope) >= 14


@given(n=st.integers(3, 300), seed=st.integers(0, 99))
def test_whole_weights_are_repeated_points(n: int, seed: int) -> None:
    x, y = points(n, seed)
    times = np.random.default_rng(seed).integers(0, 4, n)
    times[:2] = 1
    weighted = regression.line(x, y, weights=times)
    repeated = regression.line(np.repeat(x, times), np.repeat(y, times))
    rounding = 256 * EPS
    assert weighted.slope == pytest.approx(repeated.slope, rel=rounding)
    assert weighted.r == pytest.approx(repeated.r, rel=rounding)
    assert weighted.x_mean == pytest.approx(repeated.x_mean, rel=rounding, abs=rounding)


@given(seed=st.integers(0, 99), factor=st.floats(0.5, 1.0), chunk=st.integers(1, 700))
def test_forgetting_is_a_weight_that_falls_with_age(seed: int, factor: float, chunk: int) -> None:
    n = 1500
    x, y = points(n, seed)
    sums = regression.LineSums(forgetting=factor)
    for start in range(0, n, chunk):
        sums.push(x[start : start + chunk], y[start : start + chunk])
    weights = factor ** np.arange(n - 1.0, -1.0, -1.0)
    direct = regression.line(x, y, weights)
    found = sums.fit()
    # powers of the factor round once a step: n of them, on points that hardly count any more
    assert found.slope == pytest.approx(direct.slope, rel=64 * EPS * n)
    assert found.intercept == pytest.approx(direct.intercept, rel=64 * EPS * n)
    assert found.degrees_of_freedom == pytest.approx(weights.sum() - 2, rel=4 * EPS * n, abs=4 * EPS * n)


@given(seed=st.integers(0, 99), window=st.integers(2, 200), extra=st.integers(0, 500))
def test_rolling_line_is_the_line_of_the_last_points(seed: int, window: int, extra: int) -> None:
    x, y = points(window + extra, seed, 1e4)
    # an outlier that has left the window must not be seen
    y[: extra // 2] += 1e12
    rolling = regression.RollingLine(window)
    rolling.push(x, y)
    found, direct = rolling.fit(), regression.line(x[-window:], y[-window:])
    rounding = 64 * EPS * window
    scale = abs(direct.slope) + np.abs(y[-window:] - direct.y_mean).max() / np.abs(x[-window:] - direct.x_mean).max()
    assert found.slope == pytest.approx(direct.slope, rel=0, abs=rounding * scale)
    assert found.n == window


def test_intervals_are_those_of_student() -> None:
    x, y = points(40, 3)
    fit = regression.line(x, y)
    half = student.ppf(0.975, 38) * fit.slope_se
    assert fit.slope_interval() == pytest.approx((fit.slope - half, fit.slope + half), rel=1e-14)
    low, high = fit.band(x)
    assert np.all((low < fit.predict(x)) & (fit.predict(x) < high))
    # at x = 0 the band is the intercept's interval
    assert (fit.band([0.0])[0][0], fit.band([0.0])[1][0]) == pytest.approx(fit.intercept_interval(), rel=1e-13)
    assert regression.line([0.0, 1.0], [1.0, 2.0]).slope_interval() is None
    with pytest.raises(ParameterError, match="level"):
        fit.slope_interval(95)


def test_intervals_hold_the_truth_as_often_as_they_say() -> None:
    rng = np.random.default_rng(11)
    x = np.linspace(-1, 1, 12)
    hits = 0
    for _ in range(2000):
        low, high = regression.line(x, 3 * x + rng.standard_normal(12)).slope_interval(0.9)
        hits += low <= 3 <= high
    # binomial: three standard deviations of 2000 trials at 0.9
    assert abs(hits / 2000 - 0.9) < 3 * math.sqrt(0.9 * 0.1 / 2000)


def test_residuals_have_no_mean_and_the_stated_spread() -> None:
    x, y = points(200, 9)
    fit = regression.line(x, y)
    residuals = fit.residuals(x, y)
    assert abs(residuals.mean()) < 64 * EPS
    assert math.sqrt(residuals @ residuals / 198) == pytest.approx(fit.residual_std, rel=1e-13)


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


def test_a_point_of_weight_zero_is_no_observation():
    with_it = regression.line([1.0, 2.0, 3.0, 4.0], [1.0, 2.0, 4.0, 5.0], [1.0, 1.0, 1.0, 0.0])
    without = regression.line([1.0, 2.0, 3.0], [1.0, 2.0, 4.0])
    assert (with_it.n, with_it.slope, with_it.slope_se) == (
        3,
        without.slope,
        pytest.approx(without.slope_se, rel=1e-14),
    )
