"""The search finds what is known, beats chance, and gives the same bits."""

import hashlib
import subprocess
import sys

import numpy as np
import pytest

from luztar.errors import ParameterError
from luztar.manoeuvre import manoeuvre, optimise
from luztar.manoeuvre.search import Effort, search

# Small, but whole: every stage runs.
SMALL = Effort(first=512, population=48, generations=40, refinement=16, refinements=60, flat=64)

SCRIPT = """
from test_manoeuvre_search import digest
print(digest())
"""


def digest() -> str:
    task = manoeuvre("avoiding", length_m=55.0, speed_m_s=15.0, tyre="linear", model="single_track")
    box = task.box
    found = search(lambda u: task.scores(box.values(u)).companion, 6, seed=5, effort=SMALL)
    steps = np.array([s.best for s in found.history])
    return hashlib.sha256(found.point.tobytes() + steps.tobytes() + found.flat.tobytes()).hexdigest()


@pytest.fixture(scope="module")
def optimum():
    task = manoeuvre("avoiding", length_m=55.0, speed_m_s=15.0)
    return optimise(task, seed=0, effort="quick")


@pytest.mark.parametrize("seed", [0, 1, 2])
def test_a_known_smooth_optimum_is_found(seed):
    at = np.array([0.31, 0.72, 0.55, 0.13, 0.9, 0.48])
    scale = np.array([1.0, 30.0, 3.0, 100.0, 10.0, 1.0])
    found = search(lambda u: (scale * (u - at) ** 2).sum(axis=1) + 1.0, 6, seed=seed, effort=SMALL)
    assert np.abs(found.point - at).max() < 1e-3
    assert found.value == pytest.approx(1.0, abs=1e-6)


@pytest.mark.parametrize("seed", [0, 1, 2])
def test_a_known_optimum_among_many_valleys_is_found(seed):
    at = np.array([0.31, 0.72, 0.55, 0.2])

    def rastrigin(u):
        x = 4.0 * (u - at)
        return (x**2 + 1.0 - np.cos(2 * np.pi * x)).sum(axis=1)

    found = search(rastrigin, 4, seed=seed, effort=SMALL)
    assert np.abs(found.point - at).max() < 1e-3
    # The next valley lies a quarter of the box away and costs a little less than 1.
    assert found.other_value == pytest.approx(1.0, abs=0.05)


def test_a_kinked_optimum_at_a_wall_is_found():
    at = np.array([0.0, 0.5, 1.0])
    found = search(lambda u: np.abs(u - at).max(axis=1) + 0.1 * np.abs(u - at).sum(axis=1), 3, seed=1, effort=SMALL)
    assert found.value < 1e-3


def test_the_flat_set_of_a_parabola_has_its_known_width():
    at, curve = np.array([0.4, 0.6]), np.array([1.0, 25.0])
    found = search(lambda u: 1.0 + (curve * (u - at) ** 2).sum(axis=1), 2, seed=1, effort=SMALL)
    half = np.sqrt(0.01 / curve)
    low, high = found.flat.min(axis=0), found.flat.max(axis=0)
    # An inner bound: it cannot go beyond, and some 400 points of a disc come within a tenth of its rim.
    assert (low >= at - half - 1e-6).all() and (high <= at + half + 1e-6).all()
    assert (low <= at - 0.9 * half).all() and (high >= at + 0.9 * half).all()


def test_the_optimum_beats_as_many_drives_by_chance(optimum):
    box = optimum.task.box
    tried = optimum.task.scores(box.values(np.random.default_rng(0).random((optimum.evaluations, 6))))
    assert optimum.best.scores["companion"] < 0.5 * tried.companion.min()
    assert optimum.feasible


def test_no_step_around_the_optimum_costs_less(optimum):
    box, best = optimum.task.box, optimum.best
    point = box.points(best.values[np.newaxis])[0]
    chance = np.random.default_rng(1)
    around = np.clip(point + 0.01 * chance.standard_normal((2000, 6)), 0.0, 1.0)
    assert optimum.task.scores(box.values(around)).companion.min() > 0.999 * best.scores["companion"]


def test_the_ranges_within_one_per_cent_hold_the_optimum(optimum):
    for name, (low, high) in optimum.flat.items():
        assert low <= optimum.best.parameters[name] <= high
    assert optimum.history[-1].evaluations == optimum.evaluations
    bests = [s.best for s in optimum.history]
    assert bests == sorted(bests, reverse=True)


def test_every_number_of_threads_gives_the_same_bits(monkeypatch, request):
    found = set()
    for threads in ("1", "2"):
        monkeypatch.setenv("RAYON_NUM_THREADS", threads)
        monkeypatch.setenv("PYTHONPATH", str(request.path.parent))
        done = subprocess.run([sys.executable, "-c", SCRIPT], capture_output=True, text=True, check=True)
        found.add(done.stdout.strip())
    assert len(found) == 1


def test_what_cannot_be_done_is_said_and_not_made_up():
    # ISO 3888-1 at 80 km/h asks for more than 4 m/s2: that is what the test is for.
    task = manoeuvre("iso_3888_1", speed_m_s=22.2)
    found = optimise(task, effort="quick")
    assert not found.feasible and found.best.scores["criterion"] is None
    assert found.broken() and "m" in found.broken()[0]
    assert found.to_dict()["best"]["criterion"] is None and "infinite" in str(found)


def test_an_unknown_effort_or_seed_is_named():
    task = manoeuvre("avoiding", length_m=55.0, speed_m_s=15.0)
    with pytest.raises(ParameterError, match="no effort"):
        optimise(task, effort="heroic")
    with pytest.raises(ParameterError, match="seed"):
        optimise(task, seed=-1)
