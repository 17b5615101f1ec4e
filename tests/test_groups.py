"""Parts of a record: the figures of each part are those of the part alone, with the places of the record."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from luztar import stats
from luztar.errors import ParameterError


@given(seed=st.integers(0, 99), n=st.integers(1, 3000), most=st.integers(1, 400))
def test_every_label_has_the_figures_of_its_samples(seed: int, n: int, most: int) -> None:
    rng = np.random.default_rng(seed)
    x = rng.standard_normal(n)
    labels = np.repeat(rng.integers(-2, 3, n), rng.integers(1, most + 1, n))[:n]
    found = stats.by_label(x, labels)
    assert list(found) == sorted(set(labels.tolist()))
    for label, part in found.items():
        places = np.flatnonzero(labels == label)
        alone = stats.describe(x[places])
        moved = replace(alone, min_index=int(places[alone.min_index]), max_index=int(places[alone.max_index]))
        assert part == moved


def test_direction_is_the_sign_of_motion_beyond_rest() -> None:
    speed = np.array([-2.0, -0.1, 0.0, 0.1, 3.0, 3.0])
    x = np.arange(6.0)
    by = stats.by_direction(x, speed, rest=0.1)
    assert {k: (d.count, d.min_index) for k, d in by.items()} == {-1: (1, 0), 0: (3, 1), 1: (2, 4)}
    assert {k: d.count for k, d in stats.by_direction(x, speed).items()} == {-1: 2, 0: 1, 1: 3}


def test_windows_have_the_places_of_the_record() -> None:
    x = np.random.default_rng(0).standard_normal(5000)
    first, second = stats.by_window(x, [(10, 4000), (3999, 5000)])
    assert first.mean == stats.describe(x[10:4000]).mean
    assert second.max_index == 3999 + int(x[3999:].argmax())


def test_nan_in_a_part_is_told_or_counted() -> None:
    x, labels = np.array([1.0, np.nan, 3.0, np.nan]), np.array([0, 0, 1, 2])
    with pytest.raises(ParameterError, match="index 1, 3"):
        stats.by_label(x, labels)
    found = stats.by_label(x, labels, nan="skip")
    assert list(found) == [0, 1] and found[0].nan_count == 1


@pytest.mark.parametrize("labels", [[0, 1], [0.5, 1.0, 2.0], [[0, 1, 2]], ["a", "b", "c"]])
def test_unusable_labels_are_refused(labels) -> None:
    with pytest.raises(ParameterError, match="labels"):
        stats.by_label([1.0, 2.0, 3.0], labels)


@pytest.mark.parametrize("window", [(0, 4), (2, 2), (2, 1), (-1, 2)])
def test_windows_outside_the_record_are_refused(window) -> None:
    with pytest.raises(ParameterError, match="windows"):
        stats.by_window([1.0, 2.0, 3.0], [window])


def test_rest_below_nothing_is_refused() -> None:
    with pytest.raises(ParameterError, match="rest"):
        stats.by_direction([1.0], [1.0], rest=-1.0)
