"""Laws of luz, tar, play, stop and the resolvents, over arrays."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from luztar import projections as p
from luztar.errors import ParameterError

values = st.lists(st.floats(-1e3, 1e3), min_size=1, max_size=30).map(np.array)
levels = st.floats(0.0, 100.0)
# Sums and differences of numbers below 1.1e3, each rounded once or twice.
ROUNDING = 8.0 * 1.1e3 * np.finfo(float).eps


@given(values, levels)
def test_luz_takes_away_what_tar_adds(x, a):
    low, high = p.tar(x, a)
    assert np.abs(p.luz(low, a) - x).max() <= ROUNDING
    assert np.abs(p.luz(high, a) - x).max() <= ROUNDING
    assert np.array_equal(low[x != 0.0], high[x != 0.0])


@given(values, levels)
def test_luz_is_the_freeplay_characteristic_of_the_paper(x, a):
    # Equation (1): luz(x, a) = x + (|x - a| - |x + a|) / 2.
    assert np.abs(p.luz(x, a) - (x + (np.abs(x - a) - np.abs(x + a)) / 2.0)).max() <= ROUNDING


@given(values, st.floats(-1e3, 1e3), levels, levels, st.floats(0.0, 10.0))
def test_resolvents_bring_two_points_no_further_apart(x, other, up, down, c):
    for f in (lambda v: p.luz(v, up), lambda v: p.asymmetric(v, up, down), lambda v: p.drag(v, c)):
        assert (np.abs(f(x) - f(other)) <= np.abs(x - other) * (1.0 + 1e-12) + ROUNDING).all()


@given(values, levels, levels)
def test_resolvents_of_friction_take_energy_away(x, up, down):
    for y in (p.luz(x, up), p.asymmetric(x, up, down), p.drag(x, up)):
        assert (y**2 <= x**2 * (1.0 + 1e-12)).all()
        assert (y * (x - y) >= -1e-9).all()


@given(values, levels, levels)
def test_the_asymmetric_resolvent_solves_its_inclusion(x, up, down):
    y = p.asymmetric(x, up, down)
    force = x - y
    assert np.abs(force[y > 0] - up).max(initial=0.0) <= ROUNDING
    assert np.abs(force[y < 0] + down).max(initial=0.0) <= ROUNDING
    assert ((force[y == 0] <= up + ROUNDING) & (force[y == 0] >= -down - ROUNDING)).all()
    assert np.array_equal(p.asymmetric(x, up, up), p.luz(x, up)) or np.allclose(p.asymmetric(x, up, up), p.luz(x, up))


@given(values, st.floats(0.0, 10.0))
def test_the_resolvent_of_drag_solves_its_equation(x, c):
    y = p.drag(x, c)
    assert np.allclose(y + c * np.abs(y) * y, x, rtol=1e-12, atol=1e-12)


@given(values, levels)
def test_play_and_stop_share_the_motion(x, radius):
    x = np.concatenate([[0.0], x])
    play, stop = p.play(x, radius), p.stop(x, radius)
    assert np.abs(play + stop - x).max() <= x.size * ROUNDING
    assert (np.abs(stop) <= radius).all()


def test_arguments_are_broadcast_and_a_number_gives_a_number():
    assert p.luz(1.5, 0.5) == 1.0 and isinstance(p.luz(1.5, 0.5), float)
    assert p.luz(np.ones((3, 1)), np.array([0.25, 0.5])).shape == (3, 2)
    assert p.tar(0.0, 0.5) == (-0.5, 0.5)


@pytest.mark.parametrize(
    ("call", "word"),
    [
        (lambda: p.luz(1.0, -0.1), "a is -0.1"),
        (lambda: p.luz([0.0, np.nan], 0.1), "index 1"),
        (lambda: p.luz([1.0, 2.0], [1.0, 2.0, 3.0]), "do not fit"),
        (lambda: p.luz("wide", 1.0), "x is 'wide'"),
        (lambda: p.play([[1.0]], 1.0), "one record"),
        (lambda: p.stop([1.0], 1.0, start=2.0), "beyond the radius"),
    ],
)
def test_what_makes_no_sense_is_named(call, word):
    with pytest.raises(ParameterError, match=word):
        call()
