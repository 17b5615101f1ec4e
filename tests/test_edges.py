"""The ends of a record: scipy's, MATLAB's and Gustafsson's answers, what may be trusted, records of a few samples."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy import signal as scipy_signal

from luztar import signal
from luztar.errors import ParameterError
from test_filter_designs import design

EPS = np.finfo(np.float64).eps
KINDS = ["low", "high", "pass", "stop"]
# The memory the edges leave (EDGE_TOLERANCE), times 100 for the residues of up to twelve poles in two passes.
EDGE_MEMORY = 100 * signal.EDGE_TOLERANCE


def walk(n: int, seed: int) -> np.ndarray:
    return np.cumsum(np.random.default_rng(seed).standard_normal(n)) + 20


def scipys(kind: str, poles: int, low: float, high: float, output: str = "sos"):
    words = {"low": "lowpass", "high": "highpass", "pass": "bandpass", "stop": "bandstop"}[kind]
    if kind in ("low", "high"):
        return scipy_signal.butter(poles, low, words, fs=1.0, output=output)
    return scipy_signal.butter((poles + 1) // 2, [low, high], words, fs=1.0, output=output)


@given(kind=st.sampled_from(KINDS), poles=st.integers(1, 8), low=st.floats(0.03, 0.2), seed=st.integers(0, 99))
def test_scipy_edges_of_every_band_give_scipys_answer(kind: str, poles: int, low: float, seed: int) -> None:
    x = walk(150, seed)
    expected = scipy_signal.sosfiltfilt(scipys(kind, poles, low, 2 * low), x)
    y = signal.zero_phase(x, design=design(kind, poles, low, 2 * low), edges="scipy")
    # each section's conditioning at z = 1, in each of the two passes
    np.testing.assert_allclose(y, expected, rtol=0, atol=40 * poles * EPS / low**2 * np.abs(x).max())


@given(
    kind=st.sampled_from(KINDS),
    poles=st.integers(1, 12),
    low=st.floats(1e-3, 0.2),
    n=st.integers(1, 1500),
    factor=st.floats(-3, 3),
)
def test_a_sum_is_filtered_as_the_sum_of_the_filtered(kind: str, poles: int, low: float, n: int, factor: float) -> None:
    made = design(kind, poles, low, 2 * low)
    a, b = walk(n, 1), walk(n, 2)
    together = signal.zero_phase(a + factor * b, design=made)
    apart = signal.zero_phase(a, design=made) + factor * signal.zero_phase(b, design=made)
    # rounding in every pole of both passes over the filter's memory, on an extension that climbs by the mean slope
    reach = (np.abs(a).max() + 3 * np.abs(b).max()) * (2 + made.settle_samples(1e-9) / n)
    assert np.abs(together - apart).max() <= 8 * poles * EPS * (1 + np.sqrt(1 / low)) * reach


@pytest.mark.parametrize("kind", KINDS)
def test_scipy_edges_agree_to_1e_12_where_scipy_can(kind: str) -> None:
    x = walk(400, 3)
    expected = scipy_signal.sosfiltfilt(scipys(kind, 4, 0.1, 0.2), x)
    y = signal.zero_phase(x, design=design(kind, 4, 0.1, 0.2), edges="scipy")
    np.testing.assert_allclose(y, expected, rtol=0, atol=1e-12 * np.abs(x).max())


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("poles", [1, 2, 4])
def test_matlab_edges_give_the_answer_of_a_padding_of_three_orders(kind: str, poles: int) -> None:
    x = walk(300, 4)
    b, a = scipys(kind, poles, 0.1, 0.2, output="ba")
    expected = scipy_signal.filtfilt(b, a, x, padlen=3 * (len(b) - 1))
    y = signal.zero_phase(x, design=design(kind, poles, 0.1, 0.2), edges="matlab")
    # 1e-12 and the transfer function's conditioning, (1/0.1)^poles roundings
    np.testing.assert_allclose(y, expected, rtol=0, atol=(1e-12 + EPS * 10.0 ** (poles + 1)) * np.abs(x).max())


@pytest.mark.parametrize("kind", ["low", "high", "pass"])
@pytest.mark.parametrize("poles", [1, 2, 3, 4])
def test_gust_edges_give_scipys_answer(kind: str, poles: int) -> None:
    x = walk(220, 5)
    b, a = scipys(kind, poles, 0.08, 0.2, output="ba")
    expected = scipy_signal.filtfilt(b, a, x, method="gust")
    y = signal.zero_phase(x, design=design(kind, poles, 0.08, 0.2), edges="gust")
    # the tolerance of scipy's own test of the method
    np.testing.assert_allclose(y, expected, rtol=1e-8, atol=1e-8 * np.abs(x).max())


@pytest.mark.parametrize("n", [1, 2, 3, 7, 15, 16, 17, 31, 32, 33])
@pytest.mark.parametrize("edges", ["settled", "gust"])
@pytest.mark.parametrize("kind", KINDS)
def test_short_records_have_an_answer(n: int, edges: str, kind: str) -> None:
    x = walk(n, n)
    made = design(kind, 4, 0.004, 0.008)
    y = signal.zero_phase(x, design=made, edges=edges)
    assert y.shape == (n,) and np.isfinite(y).all()
    if edges == "settled":  # gust keeps what is left between the two orders of its passes
        back = signal.zero_phase(x[::-1], design=made)[::-1]
        np.testing.assert_allclose(y, back, rtol=0, atol=signal.EDGE_TOLERANCE * np.abs(x).max())
    if n == 1 and edges == "settled":
        assert y.tolist() == (x.tolist() if kind in ("low", "stop") else [0.0])


@pytest.mark.parametrize("n", [3, 40, 500, 1999, 2000, 2001, 4000])
@pytest.mark.parametrize("poles", [1, 4, 8])
def test_closed_form_is_the_record_reflected_for_very_long(n: int, poles: int) -> None:
    made = signal.LowPass(poles=poles, cutoff_hz=6, sample_rate_hz=1000)
    memory = made.settle_samples(1e-14)
    x = walk(n, poles)
    longer = x
    while (longer.size - n) // 2 < memory:
        longer = np.concatenate([2 * longer[0] - longer[:0:-1], longer, 2 * longer[-1] - longer[-2::-1]])
    before = (longer.size - n) // 2
    expected = signal.zero_phase(longer, design=made)[before : before + n]
    reach = np.ptp(x) * (2 + 2 * memory / (n - 1))
    np.testing.assert_allclose(signal.zero_phase(x, design=made), expected, rtol=0, atol=EDGE_MEMORY * reach)


def test_a_cutoff_far_below_the_record_is_the_chord_and_takes_no_time() -> None:
    x = walk(1000, 6)
    y = signal.zero_phase(x, sample_rate_hz=1e9, cutoff_hz=1.0)
    chord = x[0] + (x[-1] - x[0]) * np.arange(1000) / 999
    # a filter of 1 Hz does not see what repeats within a microsecond: rounding of the extension remains
    np.testing.assert_allclose(y, chord, rtol=0, atol=1e-9 * np.ptp(x))


@pytest.mark.parametrize("poles", [1, 2, 4, 12])
@pytest.mark.parametrize("tolerance", [1e-2, 1e-6])
def test_trusted_samples_do_not_know_what_lies_beyond(poles: int, tolerance: float) -> None:
    made = signal.LowPass(poles=poles, cutoff_hz=6, sample_rate_hz=1000)
    n = 8000
    trusted = made.trusted(n, tolerance)
    x = walk(n, poles)
    y = signal.zero_phase(x, design=made)
    assumed = np.concatenate([2 * x[0] - x[:0:-1], x, 2 * x[-1] - x[-2::-1]])
    # what lies beyond differs from what was assumed by one unit, with the sign that hurts the first trusted sample most
    response = made.impulse_response(4 * n + 1)[2 * n :]
    error = np.zeros(n - 1)
    error[::-1] = np.sign(response[trusted.start + 1 : trusted.start + n])
    truth = assumed.copy()
    truth[: n - 1] += error
    difference = np.abs(signal.zero_phase(truth, design=made)[n - 1 : 2 * n - 1] - y)
    assert difference[trusted.start : trusted.stop].max() <= tolerance
    assert difference[trusted.start] > 0.5 * tolerance  # no sample is given away


def test_a_record_shorter_than_its_edges_has_no_trusted_sample() -> None:
    made = signal.LowPass(poles=4, cutoff_hz=6, sample_rate_hz=1000)
    assert len(made.trusted(100)) == 0
    y, trusted = signal.zero_phase(walk(4000, 1), design=made, return_trusted=True)
    assert y.shape == (4000,) and trusted == made.trusted(4000) and 0 < trusted.start < 500


@pytest.mark.parametrize(("edges", "least"), [("scipy", 16), ("matlab", 13)])
def test_parity_modes_refuse_what_their_models_refuse(edges: str, least: int) -> None:
    with pytest.raises(ParameterError, match=f"at least {least}"):
        signal.zero_phase(np.ones(least - 1), sample_rate_hz=1000, cutoff_hz=6, edges=edges)
    signal.zero_phase(np.ones(least), sample_rate_hz=1000, cutoff_hz=6, edges=edges)
