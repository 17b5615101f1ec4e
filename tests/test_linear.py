"""Several predictors: certified and exact digits, numpy's answer, streams that are the whole, dependence in words."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import exact_least_squares
from luztar import regression
from luztar.errors import ParameterError
from nist_data import EPS, digits, worst
from nist_data import regression as regression_set

SETS = {"Longley": True, "NoInt1": False, "NoInt2": False, "Norris": True}
# The certified values are of decimals that are not all doubles.
CEILING = {"Longley": 14.5, "NoInt1": 14.7, "NoInt2": 15.2, "Norris": 14.0}


def by_numpy(x: np.ndarray, y: np.ndarray, intercept: bool) -> np.ndarray:
    columns = np.column_stack([np.ones(len(y)), x]) if intercept else x
    return np.linalg.lstsq(columns, y, rcond=None)[0]


@pytest.mark.parametrize(("name", "intercept"), SETS.items())
def test_linear_sets_have_their_certified_digits(nist, name: str, intercept: bool) -> None:
    data = regression_set(nist, name)
    fit = regression.linear(data.x, data.y, intercept=intercept)
    found = worst(fit.coefficients, data.coefficients)
    assert found >= CEILING[name] - 0.1
    assert found >= min(worst(by_numpy(data.x, data.y, intercept), data.coefficients), CEILING[name] - 0.1)
    assert worst(fit.standard_errors, data.standard_errors) >= 13.5
    assert digits(fit.residual_std, data.residual_std) >= 13.5
    assert digits(fit.r_squared, data.r_squared) >= 14


@pytest.mark.parametrize(("name", "intercept"), SETS.items())
def test_coefficients_are_the_exact_ones_of_the_stored_doubles(nist, name: str, intercept: bool) -> None:
    data = regression_set(nist, name)
    exact, spread = exact_least_squares.linear(data.x, data.y, intercept)
    fit = regression.linear(data.x, data.y, intercept=intercept)
    assert worst(fit.coefficients, exact) >= 15.6
    assert digits(fit.residual_std, spread) >= 15
    stream = regression.LinearSums(data.x.shape[1], intercept=intercept)
    for row, y in zip(data.x, data.y, strict=True):
        stream.push([row], [y])
    # one row at a time and no correction: not less than numpy with all rows, but for the last digit
    assert worst(stream.fit().coefficients, exact) >= min(worst(by_numpy(data.x, data.y, intercept), exact), 15.0) - 0.5


def rows(n: int, predictors: int, seed: int) -> tuple[np.ndarray, np.ndarray]:
    rng = np.random.default_rng(seed)
    x = rng.standard_normal((n, predictors)) * 10.0 ** rng.integers(-3, 4, predictors) + rng.uniform(-9, 9, predictors)
    return x, x @ rng.standard_normal(predictors) + rng.standard_normal(n) + 5


@given(n=st.integers(12, 600), predictors=st.integers(1, 6), seed=st.integers(0, 99), intercept=st.booleans())
def test_fit_is_that_of_numpy(n: int, predictors: int, seed: int, intercept: bool) -> None:
    x, y = rows(n, predictors, seed)
    fit = regression.linear(x, y, intercept=intercept)
    theirs = by_numpy(x, y, intercept)
    # numpy's columns are not scaled: 1e3 / 1e-3 of them, times the offset of 9 against a spread of 1e-3
    assert fit.coefficients == pytest.approx(theirs, rel=1e-6, abs=1e-6)
    residuals = y - fit.predict(x)
    assert fit.residual_squares == pytest.approx(residuals @ residuals, rel=1e-9)
    # the fit is optimal: no column has anything left in common with the residual
    size = np.abs(x).T @ np.abs(y)
    assert np.all(np.abs(x.T @ residuals) <= 1e-11 * size * n**0.5)


@given(
    seed=st.integers(0, 99),
    cuts=st.lists(st.integers(0, 500), max_size=4),
    predictors=st.integers(1, 5),
    intercept=st.booleans(),
    weighted=st.booleans(),
)
def test_chunks_and_merging_are_the_whole(
    seed: int, cuts: list[int], predictors: int, intercept: bool, weighted: bool
) -> None:
    x, y = rows(500, predictors, seed)
    w = np.random.default_rng(seed).uniform(0.1, 2.0, 500) if weighted else None
    whole = regression.linear(x, y, w, intercept=intercept)
    edges = sorted({0, *cuts, 500})
    chunked = regression.LinearSums(predictors, intercept=intercept)
    merged = regression.LinearSums(predictors, intercept=intercept)
    for a, b in zip(edges[:-1], edges[1:], strict=True):
        part = regression.LinearSums(predictors, intercept=intercept)
        for sums in (chunked, part):
            sums.push(x[a:b], y[a:b], None if w is None else w[a:b])
        merged.merge(part)
    for sums in (chunked, merged):
        found = sums.fit()
        assert found.n == 500
        # an offset of 9 over a spread of 1e-3 magnifies rounding by 1e4 in the intercept's standard error units
        error = whole.standard_errors
        assert np.all(np.abs(found.coefficients - whole.coefficients) <= 1e-8 * error)
        assert found.residual_std == pytest.approx(whole.residual_std, rel=1e-11)
        assert found.standard_errors == pytest.approx(error, rel=1e-8)


def test_time_stamps_near_a_billion_seconds_keep_their_digits() -> None:
    rng = np.random.default_rng(0)
    t = 1.7e9 + np.arange(400) / 128  # exact doubles
    x = np.column_stack([t, rng.standard_normal(400)])
    y = 0.3 * (t - 1.7e9) + x[:, 1] + rng.standard_normal(400)
    exact, _ = exact_least_squares.linear(x, y)
    assert worst(regression.linear(x, y).coefficients, exact) >= 15
    sums = regression.LinearSums(2)
    sums.push(x, y)
    assert worst(sums.fit().coefficients[1:], exact[1:]) >= 13


def test_weights_are_repeated_rows() -> None:
    x, y = rows(60, 2, 4)
    times = np.random.default_rng(1).integers(0, 3, 60)
    weighted = regression.linear(x, y, times)
    repeated = regression.linear(np.repeat(x, times, axis=0), np.repeat(y, times))
    assert weighted.coefficients == pytest.approx(repeated.coefficients, rel=1e-12)
    assert weighted.residual_squares == pytest.approx(repeated.residual_squares, rel=1e-12)


def test_dependent_columns_are_named() -> None:
    x, y = rows(50, 2, 0)
    with pytest.raises(ParameterError, match="predictor 3 is a combination"):
        regression.linear(np.column_stack([x, x.sum(axis=1)]), y)
    with pytest.raises(ParameterError, match="predictor 1 does not vary"):
        regression.linear(np.column_stack([np.full(50, 7.0), x]), y)
    with pytest.raises(ParameterError, match="at least 3"):
        regression.linear(x[:2], y[:2])


@pytest.mark.parametrize(
    ("x", "y", "words"),
    [
        (np.ones((3, 2, 1)), np.ones(3), "shape"),
        (np.ones((3, 2)), np.ones(4), "4 values of y"),
        (np.array([[1.0, np.nan], [1.0, 2.0]]), np.ones(2), "nan|NaN"),
        (np.array([["a"]]), np.ones(1), "real numbers"),
    ],
)
def test_unusable_rows_are_refused(x, y, words: str) -> None:
    with pytest.raises(ParameterError, match=words):
        regression.linear(x, y)


def test_recursive_is_least_squares_with_the_start_as_rows() -> None:
    x, y = rows(80, 3, 2)
    start, error = np.array([1.0, -2.0, 0.5]), 10.0
    stream = regression.RecursiveLeastSquares(start, start_error=error)
    for a in range(0, 80, 9):
        stream.push(x[a : a + 9], y[a : a + 9])
    direct = regression.linear(np.vstack([np.eye(3) / error, x]), np.concatenate([start / error, y]), intercept=False)
    assert stream.coefficients == pytest.approx(direct.coefficients, rel=1e-10)


def test_recursive_forgets_by_age() -> None:
    x, y = rows(300, 2, 3)
    stream = regression.RecursiveLeastSquares([0.0, 0.0], start_error=1e8, forgetting=0.97)
    stream.push(x, y)
    weights = 0.97 ** np.arange(299.0, -1.0, -1.0)
    assert stream.coefficients == pytest.approx(
        regression.linear(x, y, weights, intercept=False).coefficients, rel=1e-9
    )


def test_recursive_predicts_before_it_learns() -> None:
    x, y = rows(30, 2, 5)
    stream, other = (regression.RecursiveLeastSquares([0.0, 0.0]) for _ in range(2))
    errors = stream.push_and_compare(x, y)
    for i in range(30):
        assert errors[i] == pytest.approx(y[i] - other.predict(x[i : i + 1])[0], rel=1e-9, abs=1e-9)
        other.push(x[i : i + 1], y[i : i + 1])


def test_recursive_keeps_its_estimate_where_nothing_excites_it() -> None:
    rng = np.random.default_rng(6)
    stream = regression.RecursiveLeastSquares([0.0, 0.0], start_error=1e3, forgetting=0.98)
    x = rng.standard_normal((500, 2))
    stream.push(x, x @ [2.0, -3.0])
    quiet = np.column_stack([rng.standard_normal(200_000), np.zeros(200_000)])
    stream.push(quiet, quiet @ [2.0, -3.0])
    # 0.98^200000 is no number any more; the direction keeps the information of its start
    assert stream.coefficients == pytest.approx([2.0, -3.0], rel=1e-6)


def test_recursive_keeps_its_digits_where_the_covariance_form_loses_its_sign() -> None:
    # nearly parallel regressors and a weak start: the textbook update of P becomes indefinite here
    rng = np.random.default_rng(7)
    a = rng.standard_normal(20_000)
    x = np.column_stack([a, a + 1e-6 * rng.standard_normal(20_000)])
    stream = regression.RecursiveLeastSquares([0.0, 0.0], start_error=1e9)
    stream.push(x, x @ [1.0, 2.0])
    # condition 2e6, no residual: 1e-16 * 2e6 and a few thousand rotations
    assert stream.coefficients == pytest.approx([1.0, 2.0], rel=1e-7)


def test_r_squared_is_about_the_mean_only_with_an_intercept() -> None:
    x, y = rows(40, 1, 8)
    fit = regression.linear(x, y)
    residuals = y - fit.predict(x)
    assert fit.r_squared == pytest.approx(1 - (residuals @ residuals) / np.sum((y - y.mean()) ** 2), rel=1e-12)
    bare = regression.linear(x, y, intercept=False)
    residuals = y - bare.predict(x)
    assert bare.r_squared == pytest.approx(1 - (residuals @ residuals) / (y @ y), rel=1e-10)
    assert digits(regression.line(x[:, 0], y).slope, fit.coefficients[1]) >= 15 - np.log10(1 + EPS)
