"""Zero phase: scipy's answer where scipy is right, the cut-off where it is stated, edges that can be trusted."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy import signal as scipy_signal

from luztar import signal
from luztar.errors import ParameterError

EPS = np.finfo(np.float64).eps

# scipy's direct-form sections lose eps / (fc/fs)^2 of the largest sample; at 1 % of the sample rate that is 2e-12.
SCIPY_CONDITIONING = EPS / 0.01**2
# 1e-9 dB, the accuracy asked of the cut-off, as a relative magnitude.
NANO_DECIBEL = 1e-9 * np.log(10) / 20
# The memory the edges leave (EDGE_TOLERANCE = 1e-9), times 100 for the residues of up to twelve poles in two passes.
EDGE_MEMORY = 100 * signal.EDGE_TOLERANCE


def noise(n: int, seed: int, level: float = 0.0) -> np.ndarray:
    return level + np.random.default_rng(seed).standard_normal(n)


@given(
    poles=st.integers(1, 12),
    ratio=st.floats(0.01, 0.45),
    n=st.integers(40, 400),
    seed=st.integers(0, 2**32 - 1),
    level=st.floats(-100, 100),
)
def test_scipy_edges_give_scipys_answer(poles: int, ratio: float, n: int, seed: int, level: float) -> None:
    x = noise(n, seed, level)
    sos = scipy_signal.butter(poles, ratio, fs=1.0, output="sos")
    expected = scipy_signal.sosfiltfilt(sos, x)
    y = signal.zero_phase(x, sample_rate_hz=1.0, cutoff_hz=ratio, poles=poles, edges="scipy")
    # twice per pole: each section's conditioning, in each of the two passes
    largest = max(np.abs(x).max(), np.abs(expected).max())
    np.testing.assert_allclose(y, expected, rtol=0, atol=2 * poles * SCIPY_CONDITIONING * largest)


@given(
    poles=st.integers(1, 12),
    ratio=st.floats(1e-3, 0.45),
    sample_rate_hz=st.floats(0.1, 1e6),
    cutoff_at=st.sampled_from(["per_pass", "overall"]),
)
def test_magnitude_is_minus_three_decibel_at_the_stated_frequency(poles, ratio, sample_rate_hz, cutoff_at) -> None:
    design = {"poles": poles, "sample_rate_hz": sample_rate_hz, "cutoff_hz": ratio * sample_rate_hz}
    low_pass = signal.LowPass(**design, cutoff_at=cutoff_at)
    memory = low_pass.settle_samples(1e-15)
    impulse = np.zeros(2 * memory + 1)
    impulse[memory] = 1.0
    response = signal.zero_phase(impulse, **design, cutoff_at=cutoff_at)
    k = np.arange(-memory, memory + 1)
    found = np.sum(response * np.cos(2 * np.pi * ratio * k))
    expected = 0.5 if cutoff_at == "per_pass" else np.sqrt(0.5)
    assert abs(found / expected - 1) < NANO_DECIBEL
    assert abs(low_pass.magnitude(ratio * sample_rate_hz) / expected - 1) < NANO_DECIBEL


@given(poles=st.integers(1, 12), ratio=st.floats(1e-4, 0.49), n=st.integers(1, 300), value=st.floats(-1e9, 1e9))
def test_constant_stays_the_same_bit_for_bit(poles: int, ratio: float, n: int, value: float) -> None:
    x = np.full(n, value)
    np.testing.assert_array_equal(signal.zero_phase(x, sample_rate_hz=1.0, cutoff_hz=ratio, poles=poles), x)


@given(poles=st.integers(1, 12), ratio=st.floats(1e-3, 0.45), n=st.integers(1, 3000), slope=st.floats(-1e3, 1e3))
def test_ramp_stays_the_same_ramp(poles: int, ratio: float, n: int, slope: float) -> None:
    x = 5.0 + slope * np.arange(n)
    y = signal.zero_phase(x, sample_rate_hz=1.0, cutoff_hz=ratio, poles=poles)
    memory = signal.LowPass(poles=poles, cutoff_hz=ratio, sample_rate_hz=1.0).settle_samples(signal.EDGE_TOLERANCE)
    # rounding of the largest number that goes through, the far end of the extension, in every pole of both passes,
    # accumulated as a random walk over the filter's memory
    largest = 5.0 + abs(slope) * (n + memory)
    np.testing.assert_allclose(y, x, rtol=0, atol=2 * poles * EPS * (1 + np.sqrt(1 / ratio)) * largest)


def two_hertz(n: int, phase: float, margin: int = 0) -> np.ndarray:
    return 20.0 * np.sin(2 * np.pi * 2.0 * np.arange(-margin, n + margin) / 1000.0 + phase)


def filtered_with_the_true_surroundings(n: int, phase: float) -> np.ndarray:
    margin = 20_000  # 20 s: the six-hertz filter has forgotten 1e-120 of it
    return signal.zero_phase(two_hertz(n, phase, margin), sample_rate_hz=1000, cutoff_hz=6)[margin:-margin]


def test_edges_of_a_sine_are_right_where_scipys_are_off_by_twelve_units() -> None:
    x, truth = two_hertz(1000, 0.0), filtered_with_the_true_surroundings(1000, 0.0)
    error = np.abs(signal.zero_phase(x, sample_rate_hz=1000, cutoff_hz=6) - truth)
    scipys = np.abs(signal.zero_phase(x, sample_rate_hz=1000, cutoff_hz=6, edges="scipy") - truth)
    # what a point reflection of 500 samples reaches: first sample, last sample, anywhere
    assert error[0] <= 2.7e-3 and error[-1] <= 1.8e-3 and error.max() <= 0.41
    assert scipys[0] > 0.5 and scipys[-1] > 12


@pytest.mark.parametrize("phase", [0.0, 0.4, 1.0, np.pi / 2, 2.5])
def test_ends_of_a_sine_are_right_at_every_phase(phase: float) -> None:
    y = signal.zero_phase(two_hertz(3137, phase), sample_rate_hz=1000, cutoff_hz=6)
    error = np.abs(y - filtered_with_the_true_surroundings(3137, phase))
    # By point symmetry the end sample keeps its own value, and the true filter takes 1/(1 + (2/6)^8) of it.
    loss_at_two_hertz = 20 * (1 - signal.LowPass(poles=4, cutoff_hz=6, sample_rate_hz=1000).magnitude(2.0))
    assert max(error[0], error[-1]) <= loss_at_two_hertz * (1 + 1e-3)  # 1e-3: the sampled sine's own ends


@given(poles=st.integers(1, 12), ratio=st.floats(2e-3, 0.4), n=st.integers(1, 2000), seed=st.integers(0, 999))
def test_reversing_the_record_reverses_the_answer(poles: int, ratio: float, n: int, seed: int) -> None:
    x = np.cumsum(noise(n, seed))
    there = signal.zero_phase(x, sample_rate_hz=1.0, cutoff_hz=ratio, poles=poles)
    back = signal.zero_phase(x[::-1], sample_rate_hz=1.0, cutoff_hz=ratio, poles=poles)[::-1]
    memory = signal.LowPass(poles=poles, cutoff_hz=ratio, sample_rate_hz=1.0).settle_samples(signal.EDGE_TOLERANCE)
    # the extension of a short record climbs by its mean slope, so it holds more than the record does
    reach = np.ptp(x) * (2 + memory / max(n - 1, 1))
    np.testing.assert_allclose(there, back, rtol=0, atol=EDGE_MEMORY * reach + EPS)


@given(n=st.integers(2, 40), seed=st.integers(0, 999), poles=st.integers(1, 6))
def test_short_record_is_filtered_as_if_reflected_by_hand(n: int, seed: int, poles: int) -> None:
    x = noise(n, seed, 3.0)
    longer = x
    while longer.size < 20_000:  # many times the memory of the filter below
        longer = np.concatenate(
            [2 * longer[0] - longer[:0:-1], longer, 2 * longer[-1] - longer[-2::-1]],
        )
    before = (longer.size - n) // 2
    design = {"sample_rate_hz": 100.0, "cutoff_hz": 0.5, "poles": poles}
    expected = signal.zero_phase(longer, **design)[before : before + n]
    reach = np.ptp(x) * (2 + 2000 / (n - 1))  # the extension's height where its memory begins
    np.testing.assert_allclose(signal.zero_phase(x, **design), expected, rtol=0, atol=EDGE_MEMORY * reach)


def test_one_and_two_samples_come_back_as_they_are() -> None:
    assert signal.zero_phase([4.2], sample_rate_hz=1000, cutoff_hz=6).tolist() == [4.2]
    y = signal.zero_phase([1.0, 3.0], sample_rate_hz=1000, cutoff_hz=6)
    np.testing.assert_allclose(y, [1.0, 3.0], rtol=0, atol=EDGE_MEMORY)


@pytest.mark.parametrize(
    "form",
    [
        lambda x: np.repeat(x, 2)[::2],
        lambda x: x[::-1].copy()[::-1],
        lambda x: x.astype(">f8"),
        lambda x: x.astype(np.float32),
        lambda x: x.astype(np.int16),
        lambda x: x.tolist(),
        lambda x: np.frombuffer(x.tobytes()),
        lambda x: np.frombuffer(b"." + x.tobytes(), dtype=np.uint8)[1:].view(np.float64),
    ],
    ids=["strided", "reversed", "big_endian", "float32", "int16", "list", "read_only", "misaligned"],
)
def test_every_real_layout_gives_the_same_answer(form) -> None:
    x = np.round(noise(200, 1) * 50)  # whole numbers, exact in every type above
    expected = signal.zero_phase(x, sample_rate_hz=1000, cutoff_hz=60)
    np.testing.assert_array_equal(signal.zero_phase(form(x), sample_rate_hz=1000, cutoff_hz=60), expected)


@pytest.mark.parametrize("axis", [0, 1, 2, -1])
def test_every_axis_is_filtered_as_its_own_record(axis: int) -> None:
    x = noise(4 * 5 * 6, 2).reshape(4, 5, 6)
    y = signal.zero_phase(x, sample_rate_hz=100, cutoff_hz=10, axis=axis)
    one_by_one = np.apply_along_axis(lambda r: signal.zero_phase(r, sample_rate_hz=100, cutoff_hz=10), axis, x)
    np.testing.assert_array_equal(y, one_by_one)


@pytest.mark.parametrize("channels", [1, 3, 16, 19, 35])
@pytest.mark.parametrize("poles", [1, 2, 5, 12])
@pytest.mark.parametrize("n", [40, 3000])
def test_columns_side_by_side_are_their_own_records(channels: int, poles: int, n: int) -> None:
    x = np.cumsum(noise(n * channels, channels).reshape(n, channels), axis=0)
    given_ = {"sample_rate_hz": 1000, "cutoff_hz": 20, "poles": poles}
    y = signal.zero_phase(x, **given_, axis=0)
    one_by_one = np.stack([signal.zero_phase(x[:, c].copy(), **given_) for c in range(channels)], axis=1)
    # sections and blocks of sixteen round differently: the agreement of instruction sets
    np.testing.assert_allclose(y, one_by_one, rtol=0, atol=1e-13 * np.abs(x).max())
    speed = signal.derivative(x, **given_, axis=0) if poles > 1 else None
    if speed is not None:
        one = signal.derivative(x[:, -1].copy(), **given_)
        np.testing.assert_allclose(speed[:, -1], one, rtol=0, atol=1e-13 * 1000 * np.abs(x).max())
    out = np.asfortranarray(np.empty_like(x))
    assert signal.zero_phase(x, **given_, axis=0, out=out) is out
    np.testing.assert_array_equal(out, y)
    assert signal.zero_phase(x, **given_, axis=0, out=x) is x
    np.testing.assert_array_equal(x, y)


def test_result_goes_into_the_callers_array() -> None:
    x = noise(500, 3)
    expected = signal.zero_phase(x, sample_rate_hz=1000, cutoff_hz=6)
    out = np.empty_like(x)
    assert signal.zero_phase(x, sample_rate_hz=1000, cutoff_hz=6, out=out) is out
    np.testing.assert_array_equal(out, expected)
    assert signal.zero_phase(x, sample_rate_hz=1000, cutoff_hz=6, out=x) is x
    np.testing.assert_array_equal(x, expected)


def test_columns_go_into_the_callers_columns() -> None:
    x = noise(600, 4).reshape(200, 3)
    out = np.empty((200, 3), order="F")
    signal.zero_phase(x, sample_rate_hz=1000, cutoff_hz=6, axis=0, out=out)
    np.testing.assert_array_equal(out, signal.zero_phase(x, sample_rate_hz=1000, cutoff_hz=6, axis=0))


def test_argument_is_never_modified() -> None:
    x = noise(100, 5)
    before = x.copy()
    signal.zero_phase(x, sample_rate_hz=1000, cutoff_hz=6)
    np.testing.assert_array_equal(x, before)


def test_nan_and_infinity_are_refused_with_their_positions() -> None:
    x = noise(100, 6)
    x[[7, 31]] = np.nan, np.inf
    with pytest.raises(ParameterError, match="at index 7, 31"):
        signal.zero_phase(x, sample_rate_hz=1000, cutoff_hz=6)
    with pytest.raises(ParameterError, match=r"at index \(0, 7\), \(0, 31\)"):
        signal.zero_phase(x[np.newaxis, :], sample_rate_hz=1000, cutoff_hz=6)


@pytest.mark.parametrize(
    "x",
    [
        [],
        3.0,
        np.zeros((0, 5)),
        np.array([1j]),
        np.array([object()]),
        ["a"],
        [[1.0], [1.0, 2.0]],
        np.ma.array([1.0, 2.0], mask=[0, 1]),
        np.array(["2026-01-01"], dtype="datetime64[D]"),
        [1e200, 0.0],
    ],
    ids=["empty", "scalar", "no_rows", "complex", "object", "text", "ragged", "masked", "dates", "huge"],
)
def test_what_cannot_be_filtered_is_refused(x) -> None:
    with pytest.raises(ParameterError):
        signal.zero_phase(x, sample_rate_hz=1000, cutoff_hz=6)


@pytest.mark.parametrize(
    ("wrong", "culprit"),
    [
        ({"poles": 0}, "poles"),
        ({"poles": 13}, "poles"),
        ({"poles": 2.5}, "poles"),
        ({"poles": float("nan")}, "poles"),
        ({"poles": "four"}, "poles"),
        ({"cutoff_hz": 0}, "cutoff_hz"),
        ({"cutoff_hz": 500}, "cutoff_hz"),
        ({"cutoff_hz": float("nan")}, "cutoff_hz"),
        ({"cutoff_hz": None}, "cutoff_hz"),
        ({"cutoff_hz": 1e-7}, "cutoff_hz"),
        ({"sample_rate_hz": -1}, "sample_rate_hz"),
        ({"sample_rate_hz": float("inf")}, "sample_rate_hz"),
        ({"sample_rate_hz": "fast"}, "sample_rate_hz"),
        ({"cutoff_at": "both"}, "cutoff_at"),
        ({"edges": "mirror"}, "edges"),
        ({"edges": ["scipy"]}, "edges"),
        ({"poles": [4]}, "poles"),
        ({"threads": 0, "missing": "hold"}, "threads"),
        ({"missing": "drop"}, "missing"),
        ({"axis": 1}, "axis"),
        ({"axis": 0.5}, "axis"),
        ({"out": np.zeros(3)}, "out"),
        ({"out": np.zeros(50, dtype=np.float32)}, "out"),
        ({"out": [0.0] * 50}, "out"),
        ({"out": np.frombuffer(bytes(400))}, "out"),
    ],
)
def test_a_wrong_parameter_is_named(wrong: dict, culprit: str) -> None:
    with pytest.raises(ParameterError, match=culprit):
        signal.zero_phase(np.ones(50), **({"sample_rate_hz": 1000, "cutoff_hz": 6} | wrong))


def test_scipy_edges_refuse_the_records_scipy_refuses() -> None:
    with pytest.raises(ParameterError, match="at least 16"):
        signal.zero_phase(np.ones(15), sample_rate_hz=1000, cutoff_hz=6, edges="scipy")
    signal.zero_phase(np.ones(16), sample_rate_hz=1000, cutoff_hz=6, edges="scipy")


@given(
    x=st.lists(st.floats(allow_nan=True, allow_infinity=True), max_size=20),
    poles=st.integers(-1, 14),
    cutoff_hz=st.floats(1e-2, 1e3),
)
def test_any_numbers_give_finite_numbers_or_a_parameter_error(x, poles: int, cutoff_hz: float) -> None:
    try:
        y = signal.zero_phase(x, sample_rate_hz=1000.0, cutoff_hz=cutoff_hz, poles=poles)
    except ParameterError:
        return
    assert y.shape == (len(x),) and np.isfinite(y).all()


def test_words_say_which_point_the_cutoff_means() -> None:
    tb038 = {"poles": 2, "cutoff_hz": 6, "sample_rate_hz": 1000}
    overall = signal.describe_filter(**tb038, cutoff_at="overall")
    assert "4-pole slope, -3.01 dB at 6.000 Hz overall (designed at 7.479 Hz), zero phase" in overall
    assert "-3.01 dB at 6.000 Hz per pass (-6.02 dB there overall)" in signal.describe_filter(**tb038)
    assert "causal" in signal.describe_filter(**tb038, zero_phase=False)
