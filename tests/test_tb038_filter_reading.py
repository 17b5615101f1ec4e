"""The three readings of "4-pole Butterworth, 6 Hz": what each does, and that a dependence is said."""

from __future__ import annotations

import numpy as np
import pytest
from scipy import signal as scipy_signal

import tb038_records as records
from luztar import tb038
from luztar.tb038 import filters

RULES = tb038.rule_set("TB 038 v1.0")
RATE_HZ = 500.0
MINUS_3_DB = 1.0 / np.sqrt(2.0)


def gain_at_cutoff(reading: str) -> float:
    """Return the amplitude left of a long 6 Hz sine, read in the middle of the record."""
    t = np.arange(round(20.0 * RATE_HZ)) / RATE_HZ
    y = filters.low_pass(np.sin(2.0 * np.pi * 6.0 * t), RATE_HZ, RULES, reading)
    middle = slice(round(8.0 * RATE_HZ), round(12.0 * RATE_HZ))  # 24 whole periods
    basis = np.column_stack([np.sin(2.0 * np.pi * 6.0 * t[middle]), np.cos(2.0 * np.pi * 6.0 * t[middle])])
    return float(np.hypot(*np.linalg.lstsq(basis, y[middle], rcond=None)[0]))


@pytest.mark.parametrize(
    ("reading", "gain"),
    [
        ("two_forward_two_backward", MINUS_3_DB),
        ("four_forward_four_backward", MINUS_3_DB**2),
        ("four_forward", MINUS_3_DB),
    ],
)
def test_the_gain_at_6_hz_is_what_the_reading_says(reading, gain):
    # The settled filter's memory after 8 s is below 1e-60; what remains is the fit's rounding.
    assert gain_at_cutoff(reading) == pytest.approx(gain, rel=1e-9)


def oracle(x: np.ndarray, reading: str) -> np.ndarray:
    if reading == "two_forward_two_backward":
        # -3 dB overall for two passes of two poles: 2**0.25 squared is the root of two; the shift is exact in tan.
        narrow = (2.0**0.5 - 1.0) ** 0.25
        corner = np.arctan(np.tan(np.pi * 6.0 / RATE_HZ) / narrow) * RATE_HZ / np.pi
        return scipy_signal.sosfiltfilt(scipy_signal.butter(2, corner, fs=RATE_HZ, output="sos"), x, padlen=2000)
    sos = scipy_signal.butter(4, 6.0, fs=RATE_HZ, output="sos")
    if reading == "four_forward_four_backward":
        return scipy_signal.sosfiltfilt(sos, x, padlen=2000)
    state = scipy_signal.sosfilt_zi(sos) * x[0]
    return scipy_signal.sosfilt(sos, x, zi=state)[0]


@pytest.mark.parametrize("reading", ["two_forward_two_backward", "four_forward_four_backward", "four_forward"])
def test_figures_agree_with_scipy(reading):
    t, angle, sign = records.turning()
    torque = records.torque(angle, sign, seed=4, ripple_nm=0.1, offset_nm=0.05)
    check = tb038.evaluate([records.as_run(t, angle, torque)])
    # The oracle knows nothing of crossings: it takes the samples in motion with the filtered angle in the window.
    filtered = oracle(angle, "two_forward_two_backward")
    smooth = oracle(torque, RULES.reading)
    for v, way in zip(check.verifications, (1.0, -1.0), strict=True):
        inside = (np.abs(filtered) <= 45.0) & (sign == way)
        moved = way * smooth[inside]
        assert v.samples == inside.sum()
        # scipy's direct form rounds at about 1e-13 here (fc/fs = 0.012); 1e-9 Nm is far below any load cell.
        assert v.mean_nm == pytest.approx(np.mean(moved), abs=1e-9)
        assert v.std_nm == pytest.approx(np.std(moved), abs=1e-9)
        assert v.max_abs_nm == pytest.approx(np.max(np.abs(moved)), abs=1e-9)
        slope, intercept = np.polyfit(filtered[inside], smooth[inside], 1)
        assert v.slope_nm_per_deg == pytest.approx(slope, abs=1e-9)
        assert v.intercept_nm == pytest.approx(intercept, abs=1e-9)
    x = records.torque(angle, sign, seed=9)
    assert filters.low_pass(x, RATE_HZ, RULES, reading) == pytest.approx(oracle(x, reading), abs=1e-9)


def test_a_verdict_that_depends_on_the_reading_says_so():
    # A ripple near the cut-off is damped to 0.71 by one reading and to 0.5 by the other: the deviation crosses 0.4.
    t, angle, sign = records.turning()
    ripple = 0.9 * np.sin(2.0 * np.pi * 6.0 * t)
    runs = [records.as_run(t, angle, records.torque(angle, sign, seed=k) + ripple, f"run{k}.csv") for k in (1, 2, 3)]
    check = tb038.evaluate(runs)
    # 0.9 * 0.7071 / sqrt(2) = 0.450 against 0.9 * 0.5 / sqrt(2) = 0.318
    assert check.verifications[0].std_nm == pytest.approx(0.45, abs=0.005)
    assert check.verdict == "fail"
    assert check.filter.verdict_depends_on_it is True
    assert "4 poles forward, 4 poles backward: pass" in check.filter.text
    assert any("2.1.3" in sentence for sentence in check.advice)


def test_a_sound_record_does_not_depend_on_the_reading():
    check = tb038.evaluate(records.three())
    assert check.filter.verdict_depends_on_it is False
    assert check.to_dict()["filter"] == {
        "poles": 4,
        "cutoff_hz": 6.0,
        "passes": "2 poles forward, 2 poles backward",
        "text": "4 poles in total, zero phase, -3 dB at 6 Hz overall",
        "verdict_depends_on_it": False,
    }


def test_the_whole_record_is_filtered_before_it_is_cropped():
    # A spike beyond the window leaks into it through the filter; cropping first would hide it.
    t, angle, sign = records.turning()
    torque = records.torque(angle, sign, noise_nm=0.0)
    spiked = torque.copy()
    spiked[np.flatnonzero(angle > 45.5)[0]] += 100.0
    plain = tb038.evaluate([records.as_run(t, angle, torque)]).verifications[0]
    leaked = tb038.evaluate([records.as_run(t, angle, spiked)]).verifications[0]
    assert leaked.max_abs_nm > plain.max_abs_nm + 1.0


def test_a_rate_too_low_for_the_filter_is_inconclusive():
    # 4 deg steps at 10 Hz and 40 deg/s: the window is crossed, but 6 Hz is above half the rate.
    check = tb038.evaluate(records.three(motion={"rate_hz": 10.0}))
    assert check.verdict == "inconclusive"
    assert "10 Hz" in check.verifications[0].why
