"""Bad arguments of statistics, filters and regression: an error that names the argument, once, and what to give."""

from __future__ import annotations

import numpy as np
import pytest

import luztar
from luztar import regression, signal, stats
from luztar.errors import ParameterError

X = np.arange(10.0)
LOW_PASS = signal.LowPass(poles=4, cutoff_hz=6, sample_rate_hz=1000)
RUN = luztar.Run(sample_rate_hz=10.0, angle=X, torque=X, units={"angle": "rad", "torque": "Nm"})


def zero_phase(**options):
    return signal.zero_phase(X, sample_rate_hz=1000, cutoff_hz=6, **options)


#  the argument named, the call
REFUSED = [
    ("motion", lambda: stats.by_direction(X, "fast")),
    ("motion", lambda: stats.by_direction(X, X[:3])),
    ("windows", lambda: stats.by_window(X, 3)),
    ("windows", lambda: stats.by_window(X, "ab")),
    ("windows", lambda: stats.by_window(X, [(0, 2.5)])),
    ("windows", lambda: stats.by_window(X, [3, 4])),
    ("windows", lambda: stats.by_window(X, [(5, 2)])),
    ("clipped_at", lambda: stats.describe(X, clipped_at=3)),
    ("clipped_at", lambda: stats.describe(X, clipped_at=(1,))),
    ("x", lambda: stats.describe([1e308])),
    ("q", lambda: stats.QuantileSketch().quantile("a")),
    ("q", lambda: stats.QuantileSketch().quantile([0.5])),
    ("q", lambda: stats.Counts().quantile(None)),
    ("other", lambda: stats.Moments().merge(3)),
    ("other", lambda: stats.QuantileSketch().merge(stats.Counts())),
    ("other", lambda: stats.Counts().merge("a")),
    ("frequency_hz", lambda: LOW_PASS.magnitude(np.array([1.0, 2.0]))),
    ("frequency_hz", lambda: LOW_PASS.magnitude("a")),
    ("frequency_hz", lambda: LOW_PASS.magnitude(1e9)),
    ("frequency_hz", lambda: LOW_PASS.response("a")),
    ("threads", lambda: zero_phase(threads=0)),
    ("threads", lambda: zero_phase(threads="all")),
    ("scale", lambda: signal.zero_phase(X.astype(np.int16), sample_rate_hz=1000, cutoff_hz=6, scale=2.0)),
    ("weights", lambda: regression.line(X, X, np.zeros(10))),
    ("weights", lambda: regression.line(X, X, [1.0] + 9 * [0.0])),
    ("weights", lambda: regression.polynomial(X, X, 2, np.zeros(10))),
    ("weights", lambda: regression.linear(X, X, np.zeros(10))),
    ("sample_rate_hz", lambda: signal.resample(X, X, sample_rate_hz="fast")),
    ("sample_rate_hz", lambda: signal.resample(X, X, sample_rate_hz=-1.0)),
    ("max_gap_s", lambda: signal.resample(X, X, sample_rate_hz=1.0, max_gap_s=None)),
    ("sample_rate_hz", lambda: RUN.resample("fast")),
    ("from_s", lambda: RUN.slice("now")),
]


@pytest.mark.parametrize(("culprit", "call"), REFUSED)
def test_a_bad_argument_is_named_with_what_to_give(culprit: str, call) -> None:
    with pytest.raises(ParameterError) as caught:
        call()
    error = caught.value
    assert error.where == culprit
    assert error.remedy.startswith("Give ")
    # Said once: neither the name twice in a row nor the interval twice.
    assert len(str(error)) < 150 and f"{culprit}: {culprit}" not in str(error)
    interval = error.remedy.partition(" in ")[2].rstrip(".")
    assert not interval or interval not in error.kind


def test_weights_of_some_points_may_be_zero() -> None:
    weights = np.ones(10)
    weights[3:] = 0.0
    assert regression.line(X, 2.0 * X, weights).slope == pytest.approx(2.0, rel=1e-14)
    assert regression.linear(np.column_stack([X, X**2]), X, weights).coefficients == pytest.approx([0, 1, 0], abs=1e-12)


def test_response_keeps_the_shape_it_is_asked_in() -> None:
    assert LOW_PASS.response(3.0).shape == ()
    assert LOW_PASS.response([[1.0, 2.0], [3.0, 6.0]]).shape == (2, 2)
    assert abs(LOW_PASS.response([3.0])[0]) == pytest.approx(LOW_PASS.magnitude(3.0), rel=1e-12)
