"""What goes into the oracle: drives that are what they say, and errors that name the culprit."""

import signal
import time

import numpy as np
import pytest
from scipy.interpolate import CubicSpline

from luztar.dynamics import GapSpring, Signal, exact, exact_bodies
from luztar.errors import ParameterError

from .one_mass_cases import body

ROUNDING = 1e-13
PARTS = body(stiffness=30.0, ratio=2.0, gap=0.02, coulomb=0.3, viscous=0.4)


def test_a_signal_is_the_function_that_it_stands_for():
    t = np.linspace(-0.5, 3.0, 301)
    sum_of_two = 2.0 * (Signal.polynomial(1.0, -2.0, 0.5) + Signal.sine(0.3, 4.0, 0.2))
    assert sum_of_two(t) == pytest.approx(
        2.0 * (1.0 - 2.0 * t + 0.5 * t**2 + 0.3 * np.sin(4.0 * t + 0.2)), abs=ROUNDING
    )
    knots = np.array([0.0, 0.4, 1.1, 2.0, 2.5])
    spline = CubicSpline(knots, np.sin(3.0 * knots))
    inside = np.linspace(0.0, 2.5, 251)
    cubics = Signal.cubics(spline.x[:-1], spline.c[::-1].T)
    assert cubics(inside) == pytest.approx(spline(inside), abs=ROUNDING)
    assert (cubics + sum_of_two)(inside) == pytest.approx(spline(inside) + sum_of_two(inside), abs=ROUNDING)


def test_a_drive_may_be_cut_into_pieces_without_a_trace():
    # The same drive with breaks anywhere: stretches end elsewhere, the motion is the same.
    t = np.linspace(0.0, 5.0, 201)
    hand = Signal.polynomial(0.0, 0.3, 0.1, -0.05) + Signal.sine(0.4, 3.0)
    whole = exact(PARTS, hand, t, load_nm=Signal.sine(0.5, 7.0))
    breaks = np.sort(np.random.default_rng(1).uniform(0.0, 5.0, 40))
    nothing = Signal.cubics(breaks, np.zeros((40, 4)))
    cut = exact(PARTS, hand + nothing, t, load_nm=nothing + Signal.sine(0.5, 7.0))
    assert len(whole.events) > 5
    assert [e.kind for e in cut.events] == [e.kind for e in whole.events]
    assert np.abs(cut.roadwheel_rad - whole.roadwheel_rad).max() < ROUNDING
    times = [[e.time_s for e in run.events] for run in (whole, cut)]
    assert times[0] == pytest.approx(times[1], rel=1e-12)


def test_a_run_may_be_interrupted_and_taken_up_again():
    hand = Signal.sine(0.4, 3.0)
    t = np.linspace(0.0, 5.0, 101)
    whole = exact(PARTS, hand, t)
    for at in (20, 47, 80):
        moved = whole.speed_rad_s[at] != 0.0
        later = exact(PARTS, hand, t[at:], start_rad=whole.roadwheel_rad[at], start_speed_rad_s=whole.speed_rad_s[at])
        assert moved or (later.speed_rad_s[0] == 0.0)
        assert np.abs(later.roadwheel_rad - whole.roadwheel_rad[at:]).max() < 1e-12


@pytest.mark.parametrize(
    ("change", "culprit"),
    [
        ({"drag": 1.0}, "drag.coefficient_nm_s2_per_rad2"),
        ({"hardening": -2.0}, "hardening.coefficient_nm_per_rad3"),
        ({"stribeck": 1.0, "stribeck_speed": 0.1}, "stribeck.extra_nm"),
        ({"coulomb": -1.0}, "coulomb_nm"),
        ({"gap": -1.0}, "gap_rad"),
        ({"inertia": 0.0}, "inertia_kg_m2"),
        ({"coulomb": np.array([0.1, 0.2])}, "parameters"),
    ],
)
def test_a_mechanism_that_is_not_piecewise_linear_is_refused_by_name(change, culprit):
    with pytest.raises(ParameterError) as caught:
        exact(body(stiffness=1.0, **change), 0.0, [0.0, 1.0])
    assert caught.value.where == culprit
    assert caught.value.remedy


@pytest.mark.parametrize(
    ("given", "culprit"),
    [
        ({"times_s": [0.0, 2.0, 1.0]}, "times_s"),
        ({"times_s": []}, "times_s"),
        ({"times_s": [0.0, np.nan]}, "times_s"),
        ({"handwheel_rad": "fast"}, "handwheel_rad"),
        ({"handwheel_rad": Signal.samples(np.zeros(5), 10.0), "times_s": [0.0, 0.41]}, "handwheel_rad"),
        ({"load_nm": float("nan")}, "load_nm.coefficients"),
        ({"load_nm": Signal.cubics([1.0, 1.0], np.zeros((2, 4)))}, "breaks_s"),
        ({"load_nm": Signal.cubics([1.0, 2.0], np.zeros((3, 4)))}, "breaks_s"),
        ({"load_nm": Signal.sine(1.0, -3.0)}, "frequency_rad_s"),
        ({"start_rad": np.inf}, "start_rad"),
        ({"start_speed_rad_s": None}, "start_speed_rad_s"),
        ({"ground_speed_rad_s": np.nan}, "ground_speed"),
        ({"most_events": 0}, "most_events"),
    ],
)
def test_impossible_arguments_are_refused_by_name(given, culprit):
    arguments = {"handwheel_rad": 0.0, "times_s": [0.0, 1.0], **given}
    with pytest.raises(ParameterError) as caught:
        exact(PARTS, **arguments)
    assert caught.value.where == culprit


def test_more_events_than_allowed_are_an_error():
    # A start at rest that breaks away, and a reversal every pi / 10: the eleventh event is the tenth of these.
    with pytest.raises(ParameterError, match=r"more than 10 events until 3\.14159"):
        exact(body(stiffness=100.0), 0.0, [0.0, 1e6], start_rad=1.0, most_events=10)


@pytest.mark.parametrize(
    ("change", "culprit"),
    [
        ({"inertia": [1.0, -1.0]}, "inertia"),
        ({"stiffness": np.eye(3)}, "stiffness"),
        ({"damping": [[1.0, np.inf], [0.0, 1.0]]}, "damping"),
        ({"kinetic": [1.0, 1.0], "static": [1.0, 0.5]}, "static"),
        ({"kinetic": [1.0, 1.0, 1.0]}, "kinetic"),
        ({"loads": [0.0]}, "loads"),
        ({"springs": [GapSpring(1.0, -0.1, at=[1.0, 0.0])]}, "springs[0].gap"),
        ({"springs": [GapSpring(1.0, 0.1, at=[1.0])]}, "springs[0].at"),
        ({"springs": [GapSpring(1.0, 0.1, at=[1.0, 0.0], end="up")]}, "springs[0].end"),
    ],
)
def test_bodies_that_cannot_be_are_refused_by_name(change, culprit):
    arguments = {"inertia": [1.0, 2.0], "times_s": [0.0, 1.0], **change}
    with pytest.raises(ParameterError) as caught:
        exact_bodies(**arguments)
    assert caught.value.where == culprit


def test_a_long_run_hears_an_interrupt():
    # A minute of computing, interrupted after a fifth of a second.
    before = time.perf_counter()
    signal.signal(signal.SIGALRM, signal.default_int_handler)
    signal.setitimer(signal.ITIMER_REAL, 0.2)
    try:
        with pytest.raises(KeyboardInterrupt):
            exact(body(stiffness=1.0), 0.0, [0.0, 1e8], start_rad=1.0, most_events=10**9)
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0.0)
        signal.signal(signal.SIGALRM, signal.SIG_DFL)
    assert time.perf_counter() - before < 5.0
