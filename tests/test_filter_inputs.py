"""What comes before and after a filter: missing samples, uneven time, derivatives, fewer points for a picture."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from luztar import signal
from luztar.errors import ParameterError

EPS = np.finfo(np.float64).eps
SIX_HERTZ = {"sample_rate_hz": 1000, "cutoff_hz": 6}


def noise(n: int, seed: int = 0) -> np.ndarray:
    return np.random.default_rng(seed).standard_normal(n).cumsum()


# --- missing samples ---


def test_split_filters_each_stretch_as_its_own_record() -> None:
    x = noise(900)
    x[[0, 300, 301, 899]] = np.nan
    y = signal.zero_phase(x, **SIX_HERTZ, missing="split")
    np.testing.assert_array_equal(np.isnan(y), np.isnan(x))
    for part in (slice(1, 300), slice(302, 899)):
        np.testing.assert_array_equal(y[part], signal.zero_phase(x[part], **SIX_HERTZ))
    assert signal.stretches(x) == [slice(1, 300), slice(302, 899)]


def test_hold_filters_the_last_sample_seen() -> None:
    x = noise(500)
    filled = x.copy()
    x[[0, 1]], filled[[0, 1]] = np.nan, x[2]
    x[100:150], filled[100:150] = np.inf, x[99]
    np.testing.assert_array_equal(
        signal.zero_phase(x, **SIX_HERTZ, missing="hold"), signal.zero_phase(filled, **SIX_HERTZ)
    )


def test_missing_samples_along_an_axis() -> None:
    x = np.stack([noise(200, s) for s in range(3)], axis=1)
    x[50, 1] = np.nan
    y = signal.zero_phase(x, **SIX_HERTZ, missing="split", axis=0)
    np.testing.assert_array_equal(y[:, 0], signal.zero_phase(x[:, 0], **SIX_HERTZ))
    np.testing.assert_array_equal(y[:50, 1], signal.zero_phase(x[:50, 1], **SIX_HERTZ))
    with pytest.raises(ParameterError, match=r"at index \(50, 1\)"):
        signal.zero_phase(x, **SIX_HERTZ, axis=0)


def test_nothing_but_missing_samples() -> None:
    assert np.isnan(signal.zero_phase([np.nan] * 5, **SIX_HERTZ, missing="split")).all()
    with pytest.raises(ParameterError, match="no finite sample in record 0"):
        signal.zero_phase([np.nan] * 5, **SIX_HERTZ, missing="hold")
    assert signal.stretches([]) == []


# --- derivative ---


@given(slope=st.floats(-1e3, 1e3), n=st.integers(2, 3000), poles=st.integers(2, 12))
def test_derivative_of_a_ramp_is_its_slope(slope: float, n: int, poles: int) -> None:
    y = signal.derivative(5 + slope * np.arange(n) / 1000, **SIX_HERTZ, poles=poles)
    # rounding of the samples over the filter's memory, times the rate
    np.testing.assert_allclose(y, slope, rtol=1e-9, atol=1e-8 * (1 + abs(slope) * n / 1000))


def test_derivative_of_a_sine_is_its_velocity() -> None:
    rate, f = 1000.0, 2.0
    t = np.arange(20_000) / rate
    y = signal.derivative(np.sin(2 * np.pi * f * t), **SIX_HERTZ)
    gain = signal.LowPass(poles=4, **SIX_HERTZ).magnitude(f)
    warped = np.tan(np.pi * f / rate) * 2 * rate  # the trapezoidal rule's 2 pi f
    expected = gain * warped * np.cos(2 * np.pi * f * t)
    inside = slice(3000, -3000)
    np.testing.assert_allclose(y[inside], expected[inside], rtol=0, atol=1e-9 * warped)
    assert abs(warped / (2 * np.pi * f) - 1) < 1.4e-5


def test_derivative_on_a_stream_is_the_filtered_streams() -> None:
    made = signal.LowPass(poles=4, cutoff_hz=6, sample_rate_hz=1000, zero_phase=False)
    x = noise(5000)
    y, v = signal.Filter.of(made).push(x), signal.Filter.of(made, derivative=True).push(x)
    # trapezoids of the derivative are the increments of the filtered signal
    np.testing.assert_allclose((v[1:] + v[:-1]) / 2000, np.diff(y), rtol=0, atol=1e-12 * np.abs(x).max())


def test_what_has_no_derivative_is_refused() -> None:
    for made in (
        signal.LowPass(poles=1, **SIX_HERTZ),
        signal.HighPass(poles=4, **SIX_HERTZ),
        signal.BandStop(poles=2, low_hz=5, high_hz=9, sample_rate_hz=1000),
    ):
        with pytest.raises(ParameterError, match="poles"):
            signal.derivative(np.ones(9), design=made)
    band = signal.BandPass(poles=2, low_hz=5, high_hz=9, sample_rate_hz=1000)
    assert signal.derivative(np.ones(9), design=band).tolist() == [0.0] * 9


# --- uneven time ---


@given(seed=st.integers(0, 99), n=st.integers(1, 60), rate=st.floats(0.5, 40))
def test_a_line_stays_a_line_at_even_times(seed: int, n: int, rate: float) -> None:
    t = np.cumsum(np.random.default_rng(seed).uniform(0.01, 1.0, n))
    for between in ("linear", "cubic"):
        made = signal.resample(t, 3 - 2 * t, sample_rate_hz=rate, between=between)
        np.testing.assert_allclose(made.x, 3 - 2 * np.minimum(made.time_s, t[-1]), rtol=0, atol=1e-12 * (3 + t[-1]))
        assert made.x.size == int((t[-1] - t[0]) * rate * (1 + EPS)) + 1


def test_a_parabola_stays_a_parabola_between_cubics() -> None:
    t = np.cumsum(np.random.default_rng(0).uniform(0.05, 1.0, 50))
    made = signal.resample(t, t**2, sample_rate_hz=7.0, between="cubic")
    np.testing.assert_allclose(made.x, made.time_s**2, rtol=0, atol=1e-11 * t[-1] ** 2)


def test_gaps_are_reported_and_empty() -> None:
    t = np.array([0.0, 0.1, 0.2, 1.2, 1.3])
    made = signal.resample(t, np.arange(5.0), sample_rate_hz=10.0, max_gap_s=0.5)
    assert made.gaps_s == ((0.2, 1.2),)
    np.testing.assert_array_equal(np.isnan(made.x), (made.time_s > 0.2 + 1e-9) & (made.time_s < 1.2 - 1e-9))
    assert made.to_dict()["x"][5] is None
    y = signal.zero_phase(made.x, sample_rate_hz=10, cutoff_hz=1, missing="split")
    np.testing.assert_array_equal(np.isnan(y), np.isnan(made.x))


@pytest.mark.parametrize(
    ("wrong", "culprit"),
    [
        ({"time_s": [0.0, 2.0, 1.0]}, "index 2"),
        ({"time_s": [0.0, 1.0, 1.0]}, "index 2"),
        ({"time_s": [0.0, 1.0]}, "time"),
        ({"time_s": [0.0, 1.0, np.nan]}, "time_s"),
        ({"x": [1.0, np.inf, 2.0]}, "x"),
        ({"sample_rate_hz": 0.0}, "sample_rate_hz"),
        ({"sample_rate_hz": 1e300}, "sample_rate_hz"),
        ({"max_gap_s": 0.0}, "max_gap_s"),
        ({"max_gap_s": float("nan")}, "max_gap_s"),
        ({"between": "steps"}, "between"),
    ],
)
def test_an_unusable_time_is_named(wrong: dict, culprit: str) -> None:
    given_ = {"time_s": [0.0, 1.0, 2.0], "x": [1.0, 2.0, 3.0], "sample_rate_hz": 1.0} | wrong
    with pytest.raises(ParameterError, match=culprit):
        signal.resample(given_.pop("time_s"), given_.pop("x"), **given_)


# --- fewer points ---


@given(x=st.lists(st.floats(allow_infinity=False), min_size=1, max_size=200), stretches=st.integers(1, 50))
def test_extremes_of_every_stretch_stay(x: list[float], stretches: int) -> None:
    values = np.array(x)
    places = signal.extremes(values, stretches)
    assert (np.diff(places) > 0).all() and places.size <= 3 * stretches
    count = min(stretches, values.size)
    for i in range(count):
        a, b = i * values.size // count, (i + 1) * values.size // count
        part, kept = values[a:b], values[places[(places >= a) & (places < b)]]
        if np.isnan(part).any():
            assert np.isnan(kept).any()
        if not np.isnan(part).all():
            assert np.nanmin(kept) == np.nanmin(part) and np.nanmax(kept) == np.nanmax(part)
