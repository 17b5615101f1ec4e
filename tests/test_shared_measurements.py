"""Runs with a hidden effect from a simulator that shares no code with luztar; skipped where they are not present."""

import numpy as np
import pytest

import luztar
from luztar.diagnosis.misfit import rms, usable
from shared_data import case

NOTHING = ["rig-00", "rig-01"]
CASES = ["rig-02", "rig-03", "rig-04", "rig-06", "rig-07", "rig-08", "rig-10", "rig-11", "rig-13"]


@pytest.mark.parametrize("name", NOTHING)
def test_nothing_is_named_where_nothing_is_hidden(name):
    files, _ = case(name)
    assert luztar.study(luztar.Model.rig(), luztar.read(*files)).named == ()


@pytest.mark.parametrize("name", CASES)
def test_the_hidden_effect_is_added_and_the_error_falls_to_the_floor(name):
    files, truth = case(name)
    hidden = truth["hidden"][0]
    runs = luztar.read(*files)
    study = luztar.study(luztar.Model.rig(), runs)
    step = next(s for s in study.steps if s.added)
    assert hidden in step.set and len(step.set) <= 3, study
    last = study.steps[-1].fit
    assert last.error.held_out_rms < 0.9 * study.steps[0].fit.error.held_out_rms
    moving = usable(last.runs, [~r.zone for r in last.runs]).astype(bool)
    outside = rms(usable(last.runs, last.residual)[moving])
    assert outside <= 1.10 * last.noise_floor.moving_rms
    true_model = luztar.fit(luztar.Model.rig() + hidden, runs)
    assert last.error.rms <= 1.15 * true_model.error.rms


def test_an_effect_outside_the_catalogue_is_left_unexplained():
    files, _ = case("rig-14")
    study = luztar.study(luztar.Model.rig(), luztar.read(*files))
    assert study.verdict == "unexplained"
    assert study.named == ()
    assert all(s.provisional for s in study.steps if s.added)


def test_a_pair_that_defeats_a_greedy_search_is_found():
    files, truth = case("rig-15")
    study = luztar.study(luztar.Model.rig(), luztar.read(*files))
    assert sorted(study.named) == sorted(truth["hidden"])


@pytest.mark.parametrize(
    ("name", "key", "truth_key"),
    [
        ("rig-03", "asymmetric_viscous.difference_nm_s_per_rad", "dmu"),
        ("rig-07", "freeplay.gap_rad", "gap"),
        ("rig-08", "inertia.inertia_kg_m2", "J"),
        ("rig-10", "drift.rate_nm_per_s", "rate"),
        ("rig-11", "stiffness.stiffness_nm_per_rad", "k"),
    ],
)
def test_the_interval_of_the_hidden_parameter_holds_the_truth(name, key, truth_key):
    files, truth = case(name)
    hidden = truth["hidden"][0]
    estimate = luztar.fit(luztar.Model.rig() + hidden, luztar.read(*files)).parameters[key]
    assert estimate.identifiable
    # Each interval misses once in twenty; a margin of its own half width keeps five of them from failing by chance.
    half = (estimate.high - estimate.low) / 2.0
    value = truth["parameters"][hidden][truth_key]
    assert estimate.low - half <= value <= estimate.high + half
    assert np.isfinite([estimate.low, estimate.high]).all()
