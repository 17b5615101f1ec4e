"""Polynomials: certified and exact digits, numpy's answer, streams that are the whole, defined answers at the edges."""

from __future__ import annotations

import warnings

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import exact_least_squares
from luztar import regression
from luztar.errors import ParameterError
from nist_data import EPS, digits, worst
from nist_data import regression as regression_set

SETS = {
    "Norris": 1,
    "Pontius": 2,
    "Wampler1": 5,
    "Wampler2": 5,
    "Wampler3": 5,
    "Wampler4": 5,
    "Wampler5": 5,
    "Filip": 10,
}
# The certified values are of the decimals, which are not all doubles: what the exact answer for the doubles has.
CEILING = {"Norris": 14.0, "Pontius": 13.4, "Wampler2": 13.1, "Filip": 13.9}


def by_numpy(x: np.ndarray, y: np.ndarray, degree: int) -> list[np.ndarray]:
    """numpy's two ways, lowest power first."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        fitted = np.polynomial.Polynomial.fit(x, y, degree).convert().coef
        return [np.polyfit(x, y, degree)[::-1], np.pad(fitted, (0, degree + 1 - fitted.size))]


@pytest.mark.parametrize(("name", "degree"), SETS.items())
def test_polynomials_have_their_certified_digits(nist, name: str, degree: int) -> None:
    data = regression_set(nist, name)
    fit = regression.polynomial(data.x[:, 0], data.y, degree)
    found = worst(fit.coefficients, data.coefficients)
    assert found >= CEILING.get(name, 15.5) - 0.1
    theirs = max(worst(c, data.coefficients) for c in by_numpy(data.x[:, 0], data.y, degree))
    assert found >= min(theirs, CEILING.get(name, 15.5) - 0.1)
    assert worst(fit.standard_errors, data.standard_errors) >= 13.5
    assert digits(fit.residual_std, data.residual_std) >= 13.5
    assert digits(fit.r_squared, data.r_squared) >= 14


@pytest.mark.parametrize(("name", "degree"), SETS.items())
def test_coefficients_are_the_exact_ones_of_the_stored_doubles(nist, name: str, degree: int) -> None:
    data = regression_set(nist, name)
    x = data.x[:, 0]
    exact, spread = exact_least_squares.polynomial(x, data.y, degree)
    fit = regression.polynomial(x, data.y, degree)
    # corrected in twice the precision and rounded once: the last place
    assert worst(fit.coefficients, exact) >= 15.6
    assert digits(fit.residual_std, spread) >= 15
    stream = regression.PolynomialSums(degree, (x.min(), x.max()))
    for start in range(0, x.size, 7):
        stream.push(x[start : start + 7], data.y[start : start + 7])
    # without the correction: still not less than numpy, which has all data at once; one digit for the other order
    theirs = max(worst(c, exact) for c in by_numpy(x, data.y, degree))
    assert worst(stream.fit().coefficients, exact) >= min(theirs, 15.0) - 1.0


def test_filip_has_twelve_digits_also_in_a_stream(nist) -> None:
    data = regression_set(nist, "Filip")
    stream = regression.PolynomialSums(10, (-9.0, -3.0))
    for x, y in zip(data.x, data.y, strict=True):
        stream.push(x, [y])
    assert worst(stream.fit().coefficients, data.coefficients) >= 12


def points(n: int, seed: int) -> tuple[np.ndarray, np.ndarray]:
    rng = np.random.default_rng(seed)
    x = rng.uniform(2.0, 5.0, n)
    return x, np.sin(2 * x) + 0.1 * rng.standard_normal(n)


@given(n=st.integers(12, 800), seed=st.integers(0, 99), degree=st.integers(0, 8))
def test_polynomial_is_that_of_numpy(n: int, seed: int, degree: int) -> None:
    x, y = points(n, seed)
    found = regression.polynomial(x, y, degree)
    theirs = np.polynomial.Chebyshev.fit(x, y, degree)
    # numpy's least squares rounds by the condition of its columns: 1e4 at degree 8 on uneven points
    assert np.abs(found.predict(x) - theirs(x)).max() <= 1e4 * EPS * np.abs(y).max() * n**0.5
    assert np.abs(np.polynomial.polynomial.polyval(x, found.coefficients) - theirs(x)).max() <= 1e-7
    residuals = y - found.predict(x)
    assert found.residual_squares == pytest.approx(residuals @ residuals, rel=1e-10)


@given(
    seed=st.integers(0, 99),
    cuts=st.lists(st.integers(0, 700), max_size=4),
    degree=st.integers(0, 6),
    weighted=st.booleans(),
)
def test_chunks_and_merging_are_the_whole(seed: int, cuts: list[int], degree: int, weighted: bool) -> None:
    x, y = points(700, seed)
    w = np.random.default_rng(seed).uniform(0.0, 2.0, 700) if weighted else None
    whole = regression.polynomial(x, y, degree, w)
    edges = sorted({0, *cuts, 700})
    chunked, merged = regression.PolynomialSums(degree, (2.0, 5.0)), regression.PolynomialSums(degree, (2.0, 5.0))
    for a, b in zip(edges[:-1], edges[1:], strict=True):
        part = regression.PolynomialSums(degree, (2.0, 5.0))
        for sums in (chunked, part):
            sums.push(x[a:b], y[a:b], None if w is None else w[a:b])
        merged.merge(part)
    for sums in (chunked, merged):
        found = sums.fit()
        # the other order of reflections rounds by the condition of Chebyshev columns, below 100 here
        assert np.abs(found.predict(x) - whole.predict(x)).max() <= 1e3 * EPS
        assert found.residual_squares == pytest.approx(whole.residual_squares, rel=1e-12)
        assert found.r_squared == pytest.approx(whole.r_squared, abs=1e-12)


def test_forgetting_is_a_weight_that_falls_with_age() -> None:
    x, y = points(500, 1)
    for factor in (0.3, 0.9, 0.999):
        sums = regression.PolynomialSums(2, (2.0, 5.0), forgetting=factor)
        sums.push(x[:130], y[:130])
        sums.push(x[130:], y[130:])
        weights = factor ** np.arange(499.0, -1.0, -1.0)
        direct = regression.polynomial(x, y, 2, weights)
        assert sums.fit().coefficients == pytest.approx(direct.coefficients, rel=1e-9)


@given(seed=st.integers(0, 99), window=st.integers(5, 200), extra=st.integers(0, 400), chunk=st.integers(1, 90))
def test_rolling_polynomial_is_the_one_of_the_last_points(seed: int, window: int, extra: int, chunk: int) -> None:
    x, y = points(window + extra, seed)
    rolling = regression.RollingPolynomial(3, window)
    for start in range(0, x.size, chunk):
        rolling.push(x[start : start + chunk], y[start : start + chunk])
    found, direct = rolling.fit(), regression.polynomial(x[-window:], y[-window:], 3)
    assert found.n == window
    # the same points in another order, both corrected: the last places, times the cancellation of the powers
    assert found.coefficients == pytest.approx(direct.coefficients, rel=1e-12)


def test_too_few_distinct_points_are_refused_in_words() -> None:
    with pytest.raises(ParameterError, match="at least 3 distinct x"):
        regression.polynomial([1.0, 2.0, 1.0, 2.0], [1.0, 2.0, 3.0, 4.0], 2)
    with pytest.raises(ParameterError, match="x does not vary"):
        regression.polynomial([1.0, 1.0], [1.0, 2.0], 1)
    with pytest.raises(ParameterError, match="y has 2"):
        regression.polynomial([1.0, 2.0], [1.0, 2.0], 2)
    with pytest.raises(ParameterError, match="degree"):
        regression.polynomial([1.0, 2.0], [1.0, 2.0], 31)
    with pytest.raises(ParameterError, match="domain"):
        regression.PolynomialSums(2, (1.0, 1.0))
    with pytest.raises(ParameterError, match="near the domain"):
        regression.PolynomialSums(5, (0.0, 1.0)).push([1e60], [1.0])


def test_degree_zero_is_the_mean() -> None:
    fit = regression.polynomial([3.0, 3.0, 3.0], [1.0, 2.0, 6.0], 0)
    assert fit.coefficients.tolist() == [3.0] and fit.r_squared == 0.0
    assert fit.standard_errors[0] == pytest.approx(np.std([1, 2, 6], ddof=1) / 3**0.5, rel=1e-14)


def test_exact_fit_has_no_standard_errors() -> None:
    fit = regression.polynomial([0.0, 1.0, 2.0], [1.0, 2.0, 5.0], 2)
    assert fit.standard_errors is None and fit.residual_std is None and fit.intervals() is None
    assert fit.to_dict()["standard_errors"] is None
