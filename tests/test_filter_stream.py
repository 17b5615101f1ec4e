"""The causal filter: exact to rounding at low cut-offs, and blind to how the stream is cut."""

from __future__ import annotations

import copy
import pickle
import threading

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from exact_filter import forward
from luztar import signal
from luztar.errors import ParameterError

EPS = np.finfo(np.float64).eps


def torque(n: int, seed: int = 0) -> np.ndarray:
    """100 units of level, 20 of a 2 Hz swing, 1 of noise, at 1 kHz."""
    t = np.arange(n) / 1000.0
    return 100 + 20 * np.sin(2 * np.pi * 2 * t) + np.random.default_rng(seed).standard_normal(n)


@pytest.mark.parametrize("poles", [1, 2, 3, 4, 8, 12])
@pytest.mark.parametrize("ratio", [0.2, 6e-3, 6e-4, 6e-5, 6e-6, 6e-7])
@pytest.mark.parametrize("start", ["at rest", "settled"])
def test_forward_filter_is_exact_to_rounding_at_low_cutoffs(poles: int, ratio: float, start: str) -> None:
    x = torque(20_000)
    f = signal.Filter(poles=poles, cutoff_hz=ratio * 1000, sample_rate_hz=1000)
    f.reset(0.0 if start == "at rest" else None)
    level = 0.0 if start == "at rest" else x[0]
    exact = forward(x, level, poles, ratio * 1000, 1000.0)
    # One rounding per pole and sample, remembered for fs/fc samples and adding up as a random walk.
    memory_of_rounding = poles * EPS * (1 + np.sqrt(1 / ratio))
    np.testing.assert_allclose(f.push(x), exact, rtol=0, atol=memory_of_rounding * np.abs(x).max())


@given(
    cuts=st.lists(st.integers(0, 500), max_size=12),
    poles=st.integers(1, 12),
    ratio=st.floats(1e-6, 0.49),
    seed=st.integers(0, 999),
)
def test_chunks_of_any_size_give_the_same_bits(cuts: list[int], poles: int, ratio: float, seed: int) -> None:
    x = torque(500, seed)
    whole = signal.causal(x, poles=poles, cutoff_hz=ratio, sample_rate_hz=1.0)
    f = signal.Filter(poles=poles, cutoff_hz=ratio, sample_rate_hz=1.0)
    parts = [f.push(chunk) for chunk in np.split(x, sorted(cuts))]
    np.testing.assert_array_equal(np.concatenate(parts), whole)


def test_pushing_into_an_array_or_in_place_gives_the_same_bits_as_push() -> None:
    x = torque(100)
    expected = signal.causal(x, cutoff_hz=6, sample_rate_hz=1000)
    f = signal.Filter(cutoff_hz=6, sample_rate_hz=1000)
    g = f.copy()
    out = np.empty_like(x)
    f.push_into(x, out)
    np.testing.assert_array_equal(out, expected)
    g.push_into(x, x)
    np.testing.assert_array_equal(x, expected)


def test_overlapping_memory_is_refused_and_nothing_is_remembered() -> None:
    buffer = torque(101)
    f = signal.Filter(cutoff_hz=6, sample_rate_hz=1000)
    with pytest.raises(ParameterError, match="overlaps"):
        f.push_into(buffer[:-1], buffer[1:])
    assert f.push([7.0]).tolist() == [7.0]


def test_new_filter_is_settled_at_its_first_sample() -> None:
    assert signal.causal(np.full(50, 3.7), cutoff_hz=6, sample_rate_hz=1000).tolist() == [3.7] * 50


def test_reset_chooses_where_the_filter_has_settled() -> None:
    f = signal.Filter(cutoff_hz=6, sample_rate_hz=1000)
    f.push(torque(10))
    f.reset(2.0)
    assert f.push([2.0, 2.0]).tolist() == [2.0, 2.0]
    f.reset()
    assert f.push([9.0]).tolist() == [9.0]


def test_slow_ramp_comes_out_late_by_the_stated_delay() -> None:
    design = {"poles": 4, "cutoff_hz": 6, "sample_rate_hz": 1000}
    t = np.arange(5000) / 1000
    y = signal.causal(10 * t, **design)
    late_s = t[-1] - y[-1] / 10
    # after five seconds the start has decayed to 1e-30; the rest is rounding of 50 units in t of 5 s
    assert abs(late_s - signal.LowPass(**design, zero_phase=False).delay_s) < 64 * EPS * 50


@pytest.mark.parametrize(
    "twin", [copy.copy, copy.deepcopy, lambda f: pickle.loads(pickle.dumps(f)), lambda f: f.copy()]
)
def test_twin_continues_with_the_same_bits_and_its_own_memory(twin) -> None:
    x = torque(300)
    f = signal.Filter(poles=5, cutoff_hz=6, sample_rate_hz=1000)
    f.push(x[:100])
    g = twin(f)
    expected = f.push(x[100:])
    np.testing.assert_array_equal(g.push(x[100:]), expected)
    assert g.design == f.design


def test_fresh_filter_survives_a_pickle() -> None:
    f = pickle.loads(pickle.dumps(signal.Filter(cutoff_hz=6, sample_rate_hz=1000)))
    assert f.push([5.0]).tolist() == [5.0]


@pytest.mark.parametrize("bad", [np.nan, np.inf, 1e200])
def test_refused_chunk_leaves_the_memory_untouched(bad: float) -> None:
    x = torque(100)
    f = signal.Filter(cutoff_hz=6, sample_rate_hz=1000)
    g = f.copy()
    f.push(x[:50])
    g.push(x[:50])
    with pytest.raises(ParameterError):
        f.push([1.0, bad])
    with pytest.raises(ParameterError):
        f.reset(bad)
    np.testing.assert_array_equal(f.push(x[50:]), g.push(x[50:]))


def test_empty_chunk_gives_an_empty_answer() -> None:
    f = signal.Filter(cutoff_hz=6, sample_rate_hz=1000)
    assert f.push([]).shape == (0,)
    assert f.push([8.0]).tolist() == [8.0]


def test_unusable_output_arrays_are_refused() -> None:
    f = signal.Filter(cutoff_hz=6, sample_rate_hz=1000)
    for out in (np.empty(2), np.empty(3, dtype=np.float32), np.empty(6)[::2], np.frombuffer(bytes(24)), [0.0] * 3):
        with pytest.raises(ParameterError, match="out"):
            f.push_into(np.ones(3), out)


def test_filter_describes_itself() -> None:
    assert "4 poles forward" in repr(signal.Filter(poles=4, cutoff_hz=6, sample_rate_hz=1000))


@pytest.mark.parametrize(
    "form",
    [
        lambda x: np.repeat(x, 2)[::2],
        lambda x: x[::-1].copy()[::-1],
        lambda x: x.astype(">f8"),
        lambda x: x.astype(np.float32),
        lambda x: x.astype(np.int64),
        lambda x: x.tolist(),
        lambda x: np.frombuffer(x.tobytes()),
        lambda x: np.frombuffer(b"." + x.tobytes(), dtype=np.uint8)[1:].view(np.float64),
    ],
    ids=["strided", "reversed", "big_endian", "float32", "int64", "list", "read_only", "misaligned"],
)
def test_every_real_layout_gives_the_same_bits(form) -> None:
    x = np.round(torque(200) * 50)  # whole numbers, exact in every type above
    f, g, h = (signal.Filter(cutoff_hz=60, sample_rate_hz=1000) for _ in range(3))
    expected = f.push(x)
    np.testing.assert_array_equal(g.push(form(x)), expected)
    out = np.empty(200)
    h.push_into(form(x), out)
    np.testing.assert_array_equal(out, expected)


@pytest.mark.parametrize(
    "chunk",
    [3.0, [[1.0]], [1j], [object()], ["a"], [[1.0], [1.0, 2.0]], np.ma.array([1.0], mask=[1]), None, [np.nan], [1e200]],
    ids=["scalar", "table", "complex", "object", "text", "ragged", "masked", "none", "nan", "huge"],
)
def test_what_cannot_be_pushed_is_refused(chunk) -> None:
    f = signal.Filter(cutoff_hz=6, sample_rate_hz=1000)
    with pytest.raises(ParameterError):
        f.push(chunk)
    with pytest.raises(ParameterError):
        f.push_into(chunk, np.empty(1))
    assert f.push([4.0]).tolist() == [4.0]


def test_two_threads_on_two_filters_give_what_one_gives() -> None:
    x = torque(200_000)
    expected = signal.causal(x, cutoff_hz=6, sample_rate_hz=1000)
    outs = [np.empty_like(x) for _ in range(2)]
    filters = [signal.Filter(cutoff_hz=6, sample_rate_hz=1000) for _ in range(2)]
    threads = [threading.Thread(target=f.push_into, args=(x, out)) for f, out in zip(filters, outs, strict=True)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    for out in outs:
        np.testing.assert_array_equal(out, expected)
