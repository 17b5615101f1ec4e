"""Zero phase at a fixed lag: the zero-phase answer, late by the delay, within the stated bound."""

from __future__ import annotations

import copy

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from luztar import signal
from luztar.errors import ParameterError
from test_filter_designs import design

SIX_HERTZ = signal.LowPass(poles=4, cutoff_hz=6, sample_rate_hz=1000)


def random_walk(n: int, seed: int = 0) -> np.ndarray:
    """The torque of the reference: steps of 0.2."""
    return 0.2 * np.cumsum(np.random.default_rng(seed).standard_normal(n))


def error_of(design_, delay_s: float, x: np.ndarray) -> np.ndarray:
    live = signal.FixedLag(design_, delay_s)
    lag = live.delay_samples
    truth = signal.zero_phase(x, design=design_)
    margin = design_.settle_samples(1e-12)  # neither end of the record is in the comparison
    return np.abs(live.push(x)[lag + margin : -margin] - truth[margin : -margin - lag])


@pytest.mark.parametrize(("delay_s", "about"), [(0.5, 1.5e-3), (1.0, 5e-7), (2.0, 5e-12)])
def test_error_on_the_random_walk_is_what_the_reference_found(delay_s: float, about: float) -> None:
    worst = error_of(SIX_HERTZ, delay_s, random_walk(60_000)).max()
    # the reference's single record; another draw and 63/64 of the delay stay within a factor of two
    assert worst < 2 * about


@given(
    kind=st.sampled_from(["low", "high", "pass", "stop"]),
    poles=st.integers(1, 8),
    delay=st.integers(1, 400),
    seed=st.integers(0, 99),
)
def test_error_stays_below_the_bound(kind: str, poles: int, delay: int, seed: int) -> None:
    made = design(kind, poles, 0.02, 0.05)
    x = random_walk(4000, seed)
    live = signal.FixedLag(made, delay)
    memory = made.settle_samples(1e-12)
    excursion = max(np.ptp(x[t : t + memory + delay]) for t in range(0, x.size, 50)) * 2
    # the rest is rounding and the memory the compared record's own edges leave
    assert error_of(made, delay, x).max() <= live.error_bound * excursion + 1e-9


@pytest.mark.parametrize("delay", [63, 250, 640])
def test_fixed_lag_keeps_and_reaches_its_bound(delay: int) -> None:
    live = signal.FixedLag(SIX_HERTZ, delay / 1000)
    hop = max(delay // 64, 1)
    memory = SIX_HERTZ.settle_samples(1e-16)
    response = SIX_HERTZ.impulse_response(2 * (memory + delay) + 1)[memory + delay :]
    # constant until the newest sample of the first run backward, then one unit away with the worst sign at each
    # sample; the last output of the hop sees the least of what comes
    newest = hop * ((memory + delay) // hop)
    last = newest - delay + hop - 1
    x = np.zeros(newest + 2 * memory)
    ahead = np.arange(newest + 1, x.size)
    lag = np.minimum(ahead - last, response.size - 1)
    x[newest + 1 :] = np.sign(response[lag])
    truth = np.dot(response[lag], x[newest + 1 :])
    found = live.push(x)[last + delay]
    assert abs(found) < 1e-12  # it could not know
    assert abs(truth) <= live.error_bound * (1 + 1e-9)
    assert abs(truth) >= 0.97 * live.error_bound


@given(cuts=st.lists(st.integers(0, 900), max_size=8), delay=st.integers(1, 300))
def test_chunks_of_any_size_give_the_same_bits(cuts: list[int], delay: int) -> None:
    x = random_walk(900) + 50
    whole = signal.FixedLag(SIX_HERTZ, delay / 1000).push(x)
    live = signal.FixedLag(SIX_HERTZ, delay / 1000)
    np.testing.assert_array_equal(np.concatenate([live.push(c) for c in np.split(x, sorted(cuts))]), whole)


def test_a_constant_comes_out_from_the_first_sample() -> None:
    assert signal.FixedLag(SIX_HERTZ, 0.2).push(np.full(900, 3.7)).tolist() == [3.7] * 900


def test_copies_and_resets() -> None:
    live = signal.FixedLag(SIX_HERTZ, 0.05)
    x = random_walk(500)
    live.push(x)
    twin = copy.deepcopy(live)
    np.testing.assert_array_equal(twin.push(x), live.push(x))
    live.reset(2.0)
    assert live.push([2.0]).tolist() == [2.0]
    live.reset()
    assert live.push([5.0, 5.0]).tolist() == [5.0, 5.0]


def test_refused_chunk_leaves_the_memory_untouched() -> None:
    live, other = signal.FixedLag(SIX_HERTZ, 0.05), signal.FixedLag(SIX_HERTZ, 0.05)
    x = random_walk(300)
    live.push(x)
    other.push(x)
    with pytest.raises(ParameterError, match="at index 1"):
        live.push([1.0, np.nan])
    np.testing.assert_array_equal(live.push(x), other.push(x))


@pytest.mark.parametrize("delay_s", [0.0, -1.0, float("nan"), 1e9, "long"])
def test_a_wrong_delay_is_named(delay_s) -> None:
    with pytest.raises(ParameterError, match="delay_s"):
        signal.FixedLag(SIX_HERTZ, delay_s)
    with pytest.raises(ParameterError, match="design"):
        signal.FixedLag(signal.LowPass(poles=4, cutoff_hz=6, sample_rate_hz=1000, zero_phase=False), 1.0)


def test_it_says_how_late_and_how_wrong() -> None:
    assert "0.5 s late, within" in repr(signal.FixedLag(SIX_HERTZ, 0.5))
