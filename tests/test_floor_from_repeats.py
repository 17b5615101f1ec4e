"""Where runs repeat a motion, the noise floor is what they differ by."""

from __future__ import annotations

import numpy as np
import pytest

import luztar
from generators.rig import simulate_rig_set

# Of the noise of three runs of 30 s in a band of 6 Hz, some thousand independent values.
CHANCE = 0.08


def repeated(rms_nm: float, hidden: dict[str, dict[str, object]] | None = None) -> list[luztar.Run]:
    """One motion three times, each with a noise of its own."""
    once = simulate_rig_set(hidden or {}, runs=1, seed=11)[0]
    rng = np.random.default_rng(2)
    made = []
    for k in range(3):
        noise = rng.normal(0.0, rms_nm, once.time_s.size)
        made.append(
            luztar.Run(time=once.time_s, angle=once.angle_rad, torque=once.clean_torque_nm + noise, name=f"r{k}")
        )
    return made


@pytest.mark.parametrize("hidden", [None, {"cogging": {"amplitude_nm": 0.2, "phase_rad": 0.5, "per_turn": 5}}])
def test_the_floor_is_the_noise_whatever_the_mechanism_is(hidden: dict[str, dict[str, object]] | None) -> None:
    runs = repeated(0.1, hidden)
    fit = luztar.fit(luztar.Model.rig(), runs)
    assert fit.noise_floor.method.startswith("repeats")
    # what the comparison's low pass leaves of white noise, measured on noise alone
    white = np.random.default_rng(3).normal(0.0, 0.1, 200_000)
    left = luztar.signal.zero_phase(white, sample_rate_hz=500, cutoff_hz=6, poles=4).std()
    assert fit.noise_floor.moving_rms == pytest.approx(left, rel=CHANCE)
    assert fit.noise_floor.low < fit.noise_floor.rms < fit.noise_floor.high


def test_a_hand_repeats_nothing() -> None:
    made = simulate_rig_set({}, runs=3, seed=4)
    runs = [luztar.Run(time=r.time_s, angle=r.angle_rad, torque=r.torque_nm) for r in made]
    assert luztar.fit(luztar.Model.rig(), runs).noise_floor.method.startswith("saturated")
