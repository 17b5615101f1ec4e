"""Spectral lines: the chirp transform against the plain sum, and a disturbance of its own frequency is not noise."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import luztar
from generators.rig import simulate_rig_set
from luztar.diagnosis.lines import line_frequencies_hz, transform


@given(
    samples=st.integers(1, 200),
    step_s=st.floats(0.001, 0.1),
    longest_s=st.floats(2.0, 60.0),
    seed=st.integers(0, 2**16),
)
def test_the_transform_is_the_plain_sum(samples, step_s, longest_s, seed):
    values = np.random.default_rng(seed).normal(size=(2, samples))
    frequencies_hz = line_frequencies_hz(longest_s, 6.0)
    plain = values @ np.exp(2j * np.pi * step_s * np.outer(np.arange(samples), frequencies_hz))
    # Sums of n values of order one, through transforms whose phases reach pi n^2 f: 1e-9 covers their rounding.
    assert transform(values, step_s, frequencies_hz) == pytest.approx(plain, abs=1e-9 * max(samples, 10))


def test_a_disturbance_of_its_own_frequency_ends_unexplained():
    hidden = {"time_sine": {"amplitude_nm": 0.1, "frequency_hz": 1.1, "phase_rad": 0.4}}
    made = simulate_rig_set(hidden, runs=3, seed=3, duration_s=30.0)
    runs = [luztar.Run(time=r.time_s, angle=r.angle_rad, torque=r.torque_nm, name=f"r{i}") for i, r in enumerate(made)]
    found = luztar.study(luztar.Model.rig(), runs)
    assert found.verdict == "unexplained" and found.named == ()
    assert found.last.detection.along == "spectrum"
