"""Noise that wanders: its colour is read off the record and undone, against scipy's filters and known noise."""

import numpy as np
import pytest
from scipy import signal

import luztar
from generators.rig import simulate_rig_set
from luztar import _core
from luztar.diagnosis.colour import WHITE, Colour, colour_of

STEP_S = 0.02
BAND_HZ = 6.0


def lead(zero_hz, pole_hz, step_s=STEP_S):
    return signal.bilinear([1.0, 2 * np.pi * zero_hz], [1.0, 2 * np.pi * pole_hz], 1.0 / step_s)


def low_passed(noise):
    sos = signal.butter(4, BAND_HZ, fs=1.0 / STEP_S, output="sos")
    return signal.sosfiltfilt(sos, noise)


def pieces(rng, zero_hz, pole_hz, count=18, size=150):
    """Strokes of three seconds cut out of coloured noise behind the comparison's low pass."""
    noise = rng.normal(size=count * (size + 50) + 1000)
    if pole_hz > zero_hz:
        ahead, back = lead(zero_hz, pole_hz)
        noise = signal.lfilter(back, ahead, noise)
    smooth = low_passed(noise)[500:-500]
    return [(smooth[k : k + size], STEP_S) for k in range(0, count * (size + 50), size + 50)]


@pytest.mark.parametrize(("zero_hz", "pole_hz"), [(0.3, 3.0), (1.0, 4.0)])
def test_the_colour_of_known_noise_is_found(zero_hz, pole_hz):
    rng = np.random.default_rng(3)
    found = [colour_of(pieces(rng, zero_hz, pole_hz), BAND_HZ, low_passed=True) for _ in range(20)]
    at = np.array([0.7, 1.5, 3.0, 4.5])
    wanted = Colour(zero_hz, pole_hz).shape(at)
    got = np.median([c.shape(at) for c in found], axis=0)
    # 18 strokes have some 40 independent values around each frequency: the median of 20 fits is good to a tenth; the
    # grid's steps are 1.3.
    assert got == pytest.approx(wanted, rel=0.3)


def test_white_noise_is_left_alone():
    rng = np.random.default_rng(4)
    found = [colour_of(pieces(rng, 1.0, 1.0), BAND_HZ, low_passed=True) for _ in range(100)]
    # 1 % by the threshold's reckoning; five or more of a hundred then happen once in 300.
    assert sum(c != WHITE for c in found) < 5
    assert all(c.flat_share(BAND_HZ) == pytest.approx(1.0) for c in found if c == WHITE)


def test_noise_without_a_spectrum_is_white():
    assert colour_of([], BAND_HZ, low_passed=True) == WHITE
    assert colour_of([(np.zeros(200), STEP_S)] * 4, BAND_HZ, low_passed=True) == WHITE
    assert colour_of([(np.arange(10.0), STEP_S)] * 40, BAND_HZ, low_passed=True) == WHITE


def test_the_filter_is_that_of_scipy():
    columns = np.random.default_rng(5).normal(size=(4, 300)) + 2.0
    ahead, back = lead(0.4, 2.5)
    start = signal.lfilter_zi(ahead, back)[np.newaxis] * columns[:, :1]
    wanted, _ = signal.lfilter(ahead, back, columns, zi=start)
    found = _core.whitened(columns, STEP_S, 0.4, 2.5)
    # Recursions of first order: roundings of values of a few units do not add up.
    assert found == pytest.approx(wanted, abs=1e-13)
    assert np.array_equal(Colour(0.4, 2.5).whitened(columns.T, STEP_S), found.T)


def test_the_share_of_the_flat_part_is_that_of_the_integral():
    colour = Colour(0.3, 2.0)
    f = np.linspace(0.0, BAND_HZ, 200_001)
    # The trapezoid over 200 000 intervals: 1e-9 of a smooth function.
    assert colour.flat_share(BAND_HZ) == pytest.approx(BAND_HZ / np.trapezoid(colour.shape(f), f), rel=1e-7)


def rig(noise, hidden):
    made = simulate_rig_set(hidden, seed=6, noise=noise, wander_nm=0.03)
    return [
        luztar.Run(time=r.time_s, angle=r.angle_rad, torque=r.torque_nm, name=f"run{k}") for k, r in enumerate(made)
    ]


def test_what_is_shown_is_plain_least_squares_whatever_the_noise():
    fit = luztar.fit(luztar.Model.rig(), rig("0.5 s", {"presliding": {"breakaway_rad": 0.04, "shape": "exponential"}}))
    assert fit.noise_floor.colour != WHITE
    assert fit.problem.weights.colour == WHITE
    # A wrong model: a whitened fit follows the quick part and misses the level.
    plain = fit.parameters["coulomb.level_nm"].value
    white = fit.whitened.state.coefficients[1]
    assert abs(plain - 0.75) < 0.08 < abs(white - 0.75)
    # The least error there is with these inner parameters, but for the weight of the uncertain starts.
    assert fit.error.rms < 0.99 * np.sqrt(np.mean(np.concatenate(residual(fit)) ** 2))


def residual(fit):
    made = fit.state.made.matrix
    white = fit.whitened.state.coefficients
    return [(m[:, -1] - m[:, :-2] @ white[:-1])[r.usable] for r, m in zip(fit.runs, made, strict=True)]


def test_white_noise_leaves_the_fit_as_it_is():
    fit = luztar.fit(luztar.Model.rig(), rig("white", {}))
    assert fit.noise_floor.colour == WHITE
    assert fit.whitened is fit
