"""Every width of register: the same answer to 1e-13, the same bits whatever the chunking."""

from __future__ import annotations

import dataclasses

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from luztar import signal
from test_filter_designs import design, kinds

# The agreement asked between instruction sets, of the largest sample.
AGREEMENT = 1e-13
SETS = signal.instruction_sets()


def record(n: int, seed: int) -> np.ndarray:
    t = np.arange(n) / 1000
    return 100 + 20 * np.sin(2 * np.pi * 2 * t) + np.random.default_rng(seed).standard_normal(n)


def test_the_plain_set_is_everywhere_and_the_best_is_chosen() -> None:
    assert SETS[0] == "scalar"
    made = signal.LowPass(poles=4, cutoff_hz=6, sample_rate_hz=1000)
    assert made._both_ways("settled").instruction_set == SETS[-1]


@pytest.mark.parametrize("name", SETS)
@pytest.mark.parametrize("poles", [1, 2, 3, 4, 5, 8, 9, 12])
@pytest.mark.parametrize("kind", ["low", "high", "pass", "stop"])
def test_instruction_sets_agree(name: str, poles: int, kind: str) -> None:
    x = record(3001, poles)
    best = design(kind, poles, 0.006, 0.02)
    forced = dataclasses.replace(best, instruction_set=name)
    assert forced._both_ways("settled").instruction_set == name
    largest = np.abs(x).max()
    both = signal.zero_phase(x, design=forced) - signal.zero_phase(x, design=best)
    once = [signal.Filter.of(dataclasses.replace(d, zero_phase=False)).push(x) for d in (forced, best)]
    assert np.abs(both).max() <= AGREEMENT * largest
    assert np.abs(once[0] - once[1]).max() <= AGREEMENT * largest


@pytest.mark.parametrize("name", SETS)
@given(kind=kinds, poles=st.integers(1, 12), cuts=st.lists(st.integers(0, 700), max_size=9), low=st.floats(1e-6, 0.2))
def test_chunks_of_any_size_give_the_same_bits(name: str, kind: str, poles: int, cuts: list[int], low: float) -> None:
    made = design(kind, poles, low, 2 * low, zero_phase=False, instruction_set=name)
    x = record(700, poles)
    whole = signal.Filter.of(made).push(x)
    f = signal.Filter.of(made)
    parts = [f.push(part) for part in np.split(x, sorted(cuts))]
    np.testing.assert_array_equal(np.concatenate(parts), whole)


@pytest.mark.parametrize("name", SETS)
def test_threads_give_the_same_bits(name: str) -> None:
    x = np.stack([record(2000, seed) for seed in range(7)])
    made = signal.LowPass(poles=4, cutoff_hz=6, sample_rate_hz=1000, instruction_set=name)
    one = signal.zero_phase(x, design=made)
    np.testing.assert_array_equal(signal.zero_phase(x, design=made, threads=3), one)
