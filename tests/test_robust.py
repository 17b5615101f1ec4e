"""Robust fits: scipy's answer, outliers that do not bend the line, the interval that holds the truth."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.optimize import minimize
from scipy.stats import theilslopes

from luztar import _core, regression
from luztar.errors import ParameterError
from nist_data import EPS


def points(n: int, seed: int) -> tuple[np.ndarray, np.ndarray]:
    rng = np.random.default_rng(seed)
    x = rng.uniform(0, 10, n)
    return x, 1.5 * x + 2 + rng.standard_normal(n)


@given(n=st.integers(2, 60), seed=st.integers(0, 999), ties=st.booleans())
def test_median_slope_and_interval_are_those_of_scipy(n: int, seed: int, ties: bool) -> None:
    x, y = points(n, seed)
    if ties:
        x, y = np.round(x), np.round(y)
        x[0] = 20.0
    found, theirs = regression.theil_sen(x, y), theilslopes(y, x, method="joint")
    scale = np.abs(y).max() * 1e3
    assert found.slope == pytest.approx(theirs.slope, rel=16 * EPS, abs=4 * EPS * scale)
    assert found.intercept == pytest.approx(theirs.intercept, rel=64 * EPS, abs=4 * EPS * scale)
    if n > 3:
        # for fewer points scipy takes the lower rank from the end of its list
        assert found.slope_low == pytest.approx(theirs.low_slope, rel=16 * EPS, abs=4 * EPS * scale)
        assert found.slope_high == pytest.approx(theirs.high_slope, rel=16 * EPS, abs=4 * EPS * scale)


@pytest.mark.parametrize("ties", [False, True])
def test_both_ways_to_the_median_slope_agree(ties: bool) -> None:
    # 2100 points go by inversions; all 2.2 million pairs are made here by numpy
    x, y = points(2100, 1)
    if ties:
        x, y = np.round(x, 1), np.round(y, 1)
    found = regression.theil_sen(x, y)
    i, j = np.triu_indices(2100, 1)
    apart = x[j] != x[i]
    slopes = (y[j] - y[i])[apart] / (x[j] - x[i])[apart]
    # where slopes tie, rounding of y - slope x decides how many lie below: within a few units of the last place
    assert found.slope == pytest.approx(np.median(slopes), rel=1e-12)
    assert found.slope_low < found.slope < found.slope_high


def test_a_quarter_of_wild_points_does_not_bend_the_median_slope() -> None:
    x, y = points(400, 2)
    clean = regression.theil_sen(x, y)
    y[:100] += 1e6 * np.random.default_rng(0).standard_normal(100)
    wild = regression.theil_sen(x, y)
    # a quarter of the points leaves 56 % of the pairs untouched: the median moves within their bulk
    assert abs(wild.slope - clean.slope) < 0.15


def test_the_interval_of_the_median_slope_holds_the_truth() -> None:
    rng = np.random.default_rng(5)
    x = np.arange(20.0)
    hits = 0
    for _ in range(400):
        fit = regression.theil_sen(x, 0.5 * x + rng.standard_t(3, 20), level=0.9)
        hits += fit.slope_low <= 0.5 <= fit.slope_high
    # binomial: three standard deviations of 400 trials at 0.9
    assert abs(hits / 400 - 0.9) < 3 * (0.9 * 0.1 / 400) ** 0.5


def test_constant_x_has_no_slope() -> None:
    with pytest.raises(ParameterError, match="x does not vary"):
        regression.theil_sen([2.0, 2.0], [1.0, 3.0])


def test_huber_minimises_what_it_says(seed: int = 3) -> None:
    x, y = points(150, seed)
    y[:12] += 40
    fit = regression.huber(x, y)
    scale, k = fit.scale, 1.345

    def loss(b: np.ndarray) -> float:
        r = np.abs(y - b[0] - b[1] * x) / scale
        return float(np.sum(np.where(r <= k, 0.5 * r**2, k * (r - 0.5 * k))))

    best = minimize(loss, [0.0, 0.0], method="BFGS", options={"gtol": 1e-9})
    # a quasi-Newton search on finite differences finds a minimum of this curvature to some 1e-5
    assert fit.fit.coefficients == pytest.approx(best.x, abs=1e-4)
    assert fit.outliers >= 12
    residuals = np.abs(y - fit.fit.predict(x))
    assert fit.scale == pytest.approx(np.median(residuals) / 0.6744897501960817, rel=1e-9)


def test_huber_without_outliers_is_nearly_least_squares() -> None:
    rng = np.random.default_rng(1)
    x = rng.uniform(0, 10, 4000)
    y = 1.5 * x + 2 + rng.standard_normal(4000)
    robust, plain = regression.huber(x, y), regression.linear(x, y)
    # 95 % efficient for normal residuals: standard errors 1 / sqrt(0.95) = 1.026 of least squares
    assert robust.fit.standard_errors / plain.standard_errors == pytest.approx([1.026, 1.026], rel=0.03)
    assert np.all(np.abs(robust.fit.coefficients - plain.coefficients) < plain.standard_errors)


def test_huber_of_an_exact_line_is_that_line() -> None:
    x = np.arange(10.0)
    fit = regression.huber(x, 2 * x + 1)
    assert fit.fit.coefficients == pytest.approx([1.0, 2.0], rel=1e-12)
    assert fit.scale <= 1e-12


def test_huber_takes_several_predictors_and_refuses_a_threshold_of_nothing() -> None:
    rng = np.random.default_rng(4)
    x = rng.standard_normal((200, 3))
    y = x @ [1.0, -2.0, 0.5] + 0.01 * rng.standard_normal(200)
    y[::20] += 100
    fit = regression.huber(x, y, intercept=False)
    assert fit.fit.coefficients == pytest.approx([1.0, -2.0, 0.5], abs=0.01)
    with pytest.raises(ParameterError, match="threshold"):
        regression.huber(x, y, threshold=0.0)


def test_core_takes_any_quantile_without_leaving_the_list() -> None:
    slope, _, low, high, _ = _core.theil_sen(np.arange(3.0), np.array([0.0, 1.0, 5.0]), 1e9)
    assert (low, slope, high) == (1.0, 2.5, 4.0)
