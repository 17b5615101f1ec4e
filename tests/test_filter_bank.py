"""Many channels and stored samples: banks, counts, single precision, state as JSON."""

from __future__ import annotations

import copy
import json
import pickle

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from luztar import signal
from luztar.errors import ParameterError
from test_filter_designs import design, kinds

LOW = signal.LowPass(poles=4, cutoff_hz=6, sample_rate_hz=1000, zero_phase=False)
# Single sections and blocks of sixteen round differently, as instruction sets do.
AGREEMENT = 1e-13


def frames(n: int, channels: int) -> np.ndarray:
    return np.random.default_rng(channels).standard_normal((n, channels)).cumsum(axis=0) + np.arange(channels)


@given(kind=kinds, poles=st.integers(1, 12), channels=st.integers(1, 40), cut=st.integers(0, 300))
def test_bank_is_as_many_filters(kind: str, poles: int, channels: int, cut: int) -> None:
    made = design(kind, poles, 0.01, 0.04, zero_phase=False)
    x = frames(300, channels)
    bank = signal.FilterBank(made, channels)
    y = np.concatenate([bank.push(x[:cut]), bank.push(x[cut:])])
    np.testing.assert_array_equal(y, signal.FilterBank(made, channels).push(x))
    for channel in {0, channels // 2, channels - 1}:
        one = signal.Filter.of(made).push(x[:, channel])
        np.testing.assert_allclose(y[:, channel], one, rtol=0, atol=10 * AGREEMENT * np.abs(x[:, channel]).max())
        alone = signal.FilterBank(made, 1).push(x[:, channel : channel + 1])
        np.testing.assert_array_equal(y[:, channel], alone[:, 0])


@pytest.mark.parametrize("twin", [copy.copy, copy.deepcopy, lambda b: pickle.loads(pickle.dumps(b))])
def test_twin_of_a_bank_continues_with_the_same_bits(twin) -> None:
    x = frames(200, 19)
    bank = signal.FilterBank(LOW, 19)
    bank.push(x)
    other = twin(bank)
    np.testing.assert_array_equal(other.push(x), bank.push(x))


def test_bank_resets_to_levels_and_filters_in_place() -> None:
    bank = signal.FilterBank(LOW, 3)
    bank.push(frames(20, 3))
    bank.reset([1.0, 2.0, 3.0])
    held = np.tile([1.0, 2.0, 3.0], (5, 1))
    bank.push_in_place(held)
    assert held.tolist() == [[1.0, 2.0, 3.0]] * 5
    bank.reset()
    assert bank.push([[7.0, 8.0, 9.0]]).tolist() == [[7.0, 8.0, 9.0]]


def test_frames_that_cannot_be_used_are_refused() -> None:
    bank, other = signal.FilterBank(LOW, 3), signal.FilterBank(LOW, 3)
    x = frames(50, 3)
    bank.push(x)
    other.push(x)
    for wrong in (np.ones((5, 2)), np.ones(6), [[1.0, np.nan, 1.0]], [[1e200, 0.0, 0.0]]):
        with pytest.raises(ParameterError, match="frames"):
            bank.push(wrong)
    with pytest.raises(ParameterError, match="frames"):
        bank.push_in_place(np.ones((4, 3), dtype=np.float32))
    with pytest.raises(ParameterError, match="level"):
        bank.reset([1.0])
    with pytest.raises(ParameterError, match="channels"):
        signal.FilterBank(LOW, 0)
    with pytest.raises(ParameterError, match="design"):
        signal.FilterBank(signal.tb038(1000), 2)
    np.testing.assert_array_equal(bank.push(x), other.push(x))


@pytest.mark.parametrize("dtype", [np.int16, np.int32, ">i2"])
def test_counts_give_the_bits_of_the_converted_samples(dtype) -> None:
    counts = np.random.default_rng(1).integers(-30_000, 30_000, 1000).astype(dtype)
    scale, offset = 10 / 32768, -0.3
    expected = signal.Filter.of(LOW).push(counts * scale + offset)
    f = signal.Filter.of(LOW)
    parts = [f.push_counts(part, scale=scale, offset=offset) for part in np.split(counts, [1, 300, 777])]
    np.testing.assert_array_equal(np.concatenate(parts), expected)


@pytest.mark.parametrize("dtype", [np.int16, np.int32, np.float32])
def test_a_record_of_counts_gives_the_bits_of_the_converted_record(dtype) -> None:
    counts = np.random.default_rng(1).integers(-30_000, 30_000, 5000).astype(dtype)
    expected = signal.zero_phase(counts.astype(float) * 0.001 + 2.0, sample_rate_hz=1000, cutoff_hz=6)
    y = signal.zero_phase(counts, sample_rate_hz=1000, cutoff_hz=6, scale=(0.001, 2.0))
    np.testing.assert_array_equal(y, expected)
    with pytest.raises(ParameterError, match="int16"):
        signal.zero_phase(counts.astype(np.int64), sample_rate_hz=1000, cutoff_hz=6, scale=(1.0, 0.0))


def test_single_precision_is_stored_and_nothing_more() -> None:
    x = frames(3000, 1)[:, 0].astype(np.float32)
    out = np.empty_like(x)
    signal.Filter.of(LOW).push_into(x, out)
    exact = signal.Filter.of(LOW).push(x.astype(float))
    np.testing.assert_array_equal(out, exact.astype(np.float32))
    for wrong in (np.empty(2999, np.float32), np.empty(6000, np.float32)[::2]):
        with pytest.raises(ParameterError, match="out"):
            signal.Filter.of(LOW).push_into(x, wrong)


@given(cut=st.integers(0, 100), kind=kinds, derivative=st.booleans())
def test_state_as_json_continues_with_the_same_bits(cut: int, kind: str, derivative: bool) -> None:
    made = design(kind, 4, 0.01, 0.04, zero_phase=False)
    derivative = derivative and kind in ("low", "pass")
    x = frames(100, 1)[:, 0]
    f = signal.Filter.of(made, derivative=derivative)
    f.push(x[:cut])
    g = signal.Filter.from_state(json.loads(json.dumps(f.state())))
    np.testing.assert_array_equal(g.push(x[cut:]), f.push(x[cut:]))
    assert g.design == made and g.describe() == f.describe()


@pytest.mark.parametrize(
    "spoil",
    [
        lambda s: s.pop("memory"),
        lambda s: s["memory"].pop(),
        lambda s: s["memory"].__setitem__(14, 16.0),
        lambda s: s["memory"].__setitem__(3, float("nan")),
        lambda s: s["design"].__setitem__("kind", "Comb"),
        lambda s: s["design"].__setitem__("poles", 99),
        lambda s: s.__setitem__("memory", "all"),
    ],
)
def test_a_spoilt_state_is_refused(spoil) -> None:
    state = signal.Filter.of(LOW).state()
    spoil(state)
    with pytest.raises(ParameterError):
        signal.Filter.from_state(state)
