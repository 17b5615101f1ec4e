"""Every design: its cut-off where it is stated, scipy's response, the standards' numbers, words that say what it is."""

from __future__ import annotations

import copy
import pickle

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy import signal as scipy_signal

from exact_filter import band_sections, run
from luztar import signal
from luztar.errors import ParameterError

EPS = np.finfo(np.float64).eps
# 1e-9 dB, the accuracy asked of the cut-off, as a relative magnitude.
NANO_DECIBEL = 1e-9 * np.log(10) / 20
HALF_POWER = np.sqrt(0.5)


def design(kind: str, poles: int, low: float, high: float, rate: float = 1.0, **more):
    if kind in ("low", "high"):
        one = {"low": signal.LowPass, "high": signal.HighPass}[kind]
        return one(poles=poles, cutoff_hz=low * rate, sample_rate_hz=rate, **more)
    two = {"pass": signal.BandPass, "stop": signal.BandStop}[kind]
    return two(poles=poles + poles % 2, low_hz=low * rate, high_hz=high * rate, sample_rate_hz=rate, **more)


def edges_of(made) -> list[float]:
    return [made.cutoff_hz] if isinstance(made, signal.LowPass) else [made.low_hz, made.high_hz]


kinds = st.sampled_from(["low", "high", "pass", "stop"])


@given(
    kind=kinds,
    poles=st.integers(1, 12),
    low=st.floats(1e-3, 0.2),
    octaves=st.floats(0.1, 1.2),
    cutoff_at=st.sampled_from(["per_pass", "overall"]),
    rate=st.floats(0.1, 1e6),
)
def test_every_design_is_at_minus_three_decibel_where_it_says(kind, poles, low, octaves, cutoff_at, rate) -> None:
    made = design(kind, poles, low, low * 2**octaves, rate, cutoff_at=cutoff_at)
    expected = 0.5 if cutoff_at == "per_pass" else HALF_POWER
    for edge in edges_of(made):
        assert abs(made.magnitude(edge) / expected - 1) < NANO_DECIBEL


@pytest.mark.parametrize("kind", ["low", "high", "pass", "stop"])
@pytest.mark.parametrize("poles", [1, 2, 3, 4, 7, 12])
@pytest.mark.parametrize("cutoff_at", ["per_pass", "overall"])
def test_the_running_filter_is_at_minus_three_decibel_where_it_says(kind: str, poles: int, cutoff_at: str) -> None:
    made = design(kind, poles, 0.03, 0.05, cutoff_at=cutoff_at)
    memory = made.settle_samples(1e-15)
    response = made.impulse_response(2 * memory + 1)
    k = np.arange(-memory, memory + 1)
    expected = 0.5 if cutoff_at == "per_pass" else HALF_POWER
    for edge in edges_of(made):
        found = np.sum(response * np.cos(2 * np.pi * edge * k))
        # the sum of an impulse response rounds once per sample of its memory
        assert abs(found / expected - 1) < NANO_DECIBEL


@given(kind=kinds, poles=st.integers(1, 8), low=st.floats(0.02, 0.15), octaves=st.floats(0.3, 1.2))
def test_response_is_that_of_scipys_design(kind: str, poles: int, low: float, octaves: float) -> None:
    made = design(kind, poles, low, low * 2**octaves, zero_phase=False)
    words = {"low": "lowpass", "high": "highpass", "pass": "bandpass", "stop": "bandstop"}[kind]
    order = made.poles if kind in ("low", "high") else made.poles // 2
    ends = edges_of(made)
    sos = scipy_signal.butter(order, ends[0] if len(ends) == 1 else ends, words, fs=1.0, output="sos")
    f = np.linspace(0.001, 0.499, 60)
    _, expected = scipy_signal.freqz_sos(sos, f, fs=1.0)
    # scipy's sections near z = 1 lose eps / (fc/fs)^2, once per section and again in the narrow band
    lost = 200 * poles * EPS / low**2 / (2**octaves - 1)
    np.testing.assert_allclose(made.response(f), expected, rtol=0, atol=lost)
    np.testing.assert_allclose(np.abs(made.response(f)), [made.magnitude(v) for v in f], rtol=0, atol=1e-11)


@pytest.mark.parametrize("kind", ["high", "pass", "stop"])
@pytest.mark.parametrize("poles", [2, 3, 4, 6, 8, 12])
@pytest.mark.parametrize("ratio", [0.1, 6e-3, 6e-4, 6e-5])
def test_forward_pass_of_every_band_is_exact_to_rounding(kind: str, poles: int, ratio: float) -> None:
    poles += poles % 2 if kind != "high" else 0
    rng = np.random.default_rng(poles)
    x = 100 + 20 * np.sin(np.arange(6000) / 80) + rng.standard_normal(6000)
    made = design(kind, poles, ratio, 2 * ratio, 1.0, zero_phase=False)
    f = signal.Filter.of(made)
    level = x[0] if kind == "stop" else 0.0
    exact = run(band_sections(kind, poles, ratio, 2 * ratio, 1.0), x, x[0], level)
    # One rounding per pole and sample, remembered for fs/fc samples and adding up as a random walk; an octave's pole
    # pairs ring, which holds it longer by the quality of the sharpest pair, below four.
    memory_of_rounding = 4 * poles * EPS * (1 + np.sqrt(1 / ratio))
    np.testing.assert_allclose(f.push(x), exact, rtol=0, atol=memory_of_rounding * np.abs(x).max())


@pytest.mark.parametrize("kind", ["high", "pass"])
def test_a_constant_is_taken_out_exactly(kind: str) -> None:
    made = design(kind, 4, 0.01, 0.02)
    assert signal.zero_phase(np.full(700, 3.7), design=made).tolist() == [0.0] * 700


def test_band_stop_leaves_a_constant_alone() -> None:
    made = design("stop", 4, 0.01, 0.02)
    assert signal.zero_phase(np.full(700, 3.7), design=made).tolist() == [3.7] * 700


def test_stated_delay_is_the_group_delay_in_the_middle_of_the_pass_band() -> None:
    for kind, middle in (("low", 1e-4), ("stop", 1e-4), ("high", 0.4999)):
        made = design(kind, 4, 0.05, 0.1, zero_phase=False)
        assert made.delay_s == pytest.approx(group_delay(made, middle), rel=1e-5)
    band = design("pass", 4, 0.05, 0.1, zero_phase=False)
    tangents = np.tan(np.pi * np.array([0.05, 0.1]))
    assert band.delay_s == pytest.approx(group_delay(band, np.arctan(np.sqrt(tangents.prod())) / np.pi), rel=1e-5)


def group_delay(made, frequency: float) -> float:
    step = 1e-5
    before, after = np.angle(made.response([frequency - step, frequency + step]))
    return -np.angle(np.exp(1j * (after - before))) / (4 * np.pi * step)


def test_impulse_and_step_response_are_those_of_the_running_filter() -> None:
    made = signal.LowPass(poles=3, cutoff_hz=20, sample_rate_hz=1000, zero_phase=False)
    sos = scipy_signal.butter(3, 20, fs=1000, output="sos")
    np.testing.assert_allclose(made.impulse_response(200), scipy_signal.sosfilt(sos, np.eye(1, 200)[0]), atol=1e-12)
    np.testing.assert_allclose(made.step_response(200), np.cumsum(made.impulse_response(200)), atol=1e-12)
    both = signal.LowPass(poles=3, cutoff_hz=20, sample_rate_hz=1000)
    response = both.impulse_response(201)
    np.testing.assert_allclose(response, response[::-1], atol=1e-15)
    assert abs(both.step_response(2001)[-1] - 1) < 1e-12 and abs(both.step_response(2001)[0]) < 1e-12


# --- presets ---


def printed_recursion(design_hz: float, sample_rate_hz: float) -> tuple[list[float], list[float]]:
    """SAE J211-1, appendix C: the recursion of one pass."""
    wa = np.tan(np.pi * design_hz / sample_rate_hz)
    below = 1 + np.sqrt(2) * wa + wa**2
    a0 = wa**2 / below
    return [a0, 2 * a0, a0], [1.0, 2 * (wa**2 - 1) / below, (1 - np.sqrt(2) * wa + wa**2) / below]


@pytest.mark.parametrize("channel_class", [60, 180, 600, 1000])
@pytest.mark.parametrize(("standard", "factor"), [("SAE J211", 2.0775), ("ISO 6487", 1.25 * 5 / 3)])
def test_cfc_is_the_printed_recursion(channel_class: int, standard: str, factor: float) -> None:
    rate = 20_000.0
    made = signal.cfc(channel_class, rate, standard=standard)
    b, a = printed_recursion(factor * channel_class, rate)
    x = np.random.default_rng(1).standard_normal(3000)
    x[:1000] = x[-1000:] = 0.0  # the standards say nothing about the edges
    there = scipy_signal.lfilter(b, a, x)
    expected = scipy_signal.lfilter(b, a, there[::-1])[::-1]
    # the direct form of the printed recursion loses eps / (fc/fs)^2
    lost = 20 * EPS / (factor * channel_class / rate) ** 2
    np.testing.assert_allclose(signal.zero_phase(x, design=made), expected, rtol=0, atol=lost)


def test_cfc_is_not_corrected_in_the_tangent() -> None:
    decibel = 20 * np.log10(signal.cfc(600, 10_000).magnitude(1000))
    assert round(decibel, 2) == -2.82


@pytest.mark.parametrize("channel_class", [60, 180, 600])
@pytest.mark.parametrize("standard", ["SAE J211", "ISO 6487"])
def test_cfc_is_minus_three_decibel_at_five_thirds_of_the_class(channel_class: int, standard: str) -> None:
    made = signal.cfc(channel_class, 1000 * channel_class, standard=standard)
    # 1.25 instead of 1/0.80224 is 0.03 dB
    assert abs(20 * np.log10(made.magnitude(5 / 3 * channel_class)) + 3.0103) < 0.03


@pytest.mark.parametrize(
    ("wrong", "culprit"),
    [
        ((61, 10_000.0), "channel_class"),
        ((1000, 9_999.0), "sample_rate_hz"),
        ((60, float("nan")), "sample_rate_hz"),
        ((60, "fast"), "sample_rate_hz"),
    ],
)
def test_cfc_refuses_what_the_standards_do_not_allow(wrong, culprit: str) -> None:
    with pytest.raises(ParameterError, match=culprit):
        signal.cfc(*wrong)
    with pytest.raises(ParameterError, match="standard"):
        signal.cfc(60, 10_000.0, standard="DIN")


def test_tb038_says_six_hertz_overall() -> None:
    assert signal.tb038(500).magnitude(6.0) == pytest.approx(HALF_POWER, rel=1e-12)
    assert "4-pole slope, -3.01 dB at 6.000 Hz overall" in signal.tb038(500).describe()


# --- words and wrong values ---


def test_words_of_every_band() -> None:
    band = signal.BandPass(poles=4, low_hz=5, high_hz=20, sample_rate_hz=1000, zero_phase=False)
    assert band.describe().startswith(
        "band pass, 4 poles forward, 2-pole slope on each side, -3.01 dB at 5.000 and 20.00 Hz, causal, "
    )
    high = signal.HighPass(poles=3, cutoff_hz=5, sample_rate_hz=1000)
    assert high.describe().startswith(
        "high pass, 3 poles forward and 3 backward, 6-pole slope, -3.01 dB at 5.000 Hz per"
    )
    assert band.to_dict()["low_hz"] == 5 and high.to_dict()["band"] == "high"


@pytest.mark.parametrize(
    ("kind", "wrong", "culprit"),
    [
        (signal.BandPass, {"poles": 3}, "poles"),
        (signal.BandPass, {"low_hz": 30}, "high_hz"),
        (signal.BandStop, {"high_hz": 500}, "high_hz"),
        (signal.BandStop, {"low_hz": 0}, "low_hz"),
        (signal.BandStop, {"instruction_set": "neon"}, "instruction_set"),
    ],
)
def test_a_wrong_band_is_named(kind, wrong: dict, culprit: str) -> None:
    with pytest.raises(ParameterError, match=culprit):
        kind(**({"poles": 4, "low_hz": 5, "high_hz": 20, "sample_rate_hz": 1000} | wrong))


def test_a_record_is_filtered_by_one_design_only() -> None:
    made = signal.LowPass(poles=2, cutoff_hz=6, sample_rate_hz=1000)
    with pytest.raises(ParameterError, match="cutoff_hz"):
        signal.zero_phase(np.ones(9), design=made, cutoff_hz=6)
    with pytest.raises(ParameterError, match="design"):
        signal.zero_phase(np.ones(9), design="low")
    with pytest.raises(ParameterError, match="passes"):
        signal.zero_phase(
            np.ones(9), design=signal.LowPass(poles=2, cutoff_hz=6, sample_rate_hz=1000, zero_phase=False)
        )


def test_designs_travel_by_pickle_and_compare_by_value() -> None:
    made = signal.BandPass(poles=4, low_hz=5, high_hz=20, sample_rate_hz=1000)
    signal.zero_phase(np.ones(50), design=made)
    twin = pickle.loads(pickle.dumps(made))
    assert twin == made and hash(twin) == hash(made) and copy.deepcopy(made) == made
    np.testing.assert_array_equal(
        signal.zero_phase(np.arange(50.0), design=twin), signal.zero_phase(np.arange(50.0), design=made)
    )
