"""Hidden effects from the independent generator: the study names them, and nothing where nothing is hidden.

The generator shares no code with the engine; sizes are those of ``generators.typical``.
"""

import math

import pytest

import luztar
from generators.rig import simulate_rig_set

BASE = {
    "offset": {"level_nm": 0.05},
    "coulomb": {"level_nm": 0.75},
    "viscous": {"coefficient_nm_s_per_rad": 0.3},
}

# What is hidden beside the base, and the rig model's effects where the base itself is what is missing.
HIDDEN = {
    "asymmetric_viscous": {"difference_nm_s_per_rad": 0.35},
    "stribeck": {"extra_nm": 0.35, "speed_rad_s": 0.08},
    "presliding": {"breakaway_rad": math.radians(2.0), "shape": "exponential"},
    "freeplay": {"gap_rad": 0.06},
    "stiffness": {"stiffness_nm_per_rad": 0.19},
    "once_per_rev": {"amplitude_nm": 0.2, "phase_rad": 2.0},
    "inertia": {"inertia_kg_m2": 0.12},
    "delay": {"time_s": 0.04},
    "drift": {"rate_nm_per_s": 0.018},
}

# Parameters of the hidden effects that the last model must give back, with the relative tolerance. A delay is known to
# the uncertainty of the starts (8 ms of 40), everything else to a few per cent of its size at this noise.
GIVEN_BACK = {
    "asymmetric_viscous": ("asymmetric_viscous.difference_nm_s_per_rad", 0.1),
    "stribeck": ("stribeck.extra_nm", 0.15),
    "presliding": ("presliding.breakaway_rad", 0.1),
    "freeplay": ("freeplay.gap_rad", 0.05),
    "stiffness": ("stiffness.stiffness_nm_per_rad", 0.1),
    "once_per_rev": ("once_per_rev.amplitude_nm", 0.15),
    "inertia": ("inertia.inertia_kg_m2", 0.05),
    "delay": ("delay.time_s", 0.2),
    "drift": ("drift.rate_nm_per_s", 0.05),
}


def runs_with(hidden, seed, noise="50 ms", base=BASE, **motion):
    """Three hand-turned runs as luztar reads them."""
    made = simulate_rig_set(hidden, base=base, runs=3, seed=seed, noise=noise, wander_nm=0.02, motion=motion or None)
    return [
        luztar.Run(time=r.time_s, angle=r.angle_rad, torque=r.torque_nm, name=f"run{i + 1}") for i, r in enumerate(made)
    ]


def offered(study):
    """The set of each step."""
    return [set(s.set) for s in study.steps if s.added]


@pytest.mark.parametrize("effect", HIDDEN)
def test_a_hidden_effect_is_added_and_nothing_else(effect):
    study = luztar.study(luztar.Model.rig(), runs_with({effect: HIDDEN[effect]}, seed=11))
    assert len(study.named) == 1, study
    assert effect in offered(study)[0], study
    assert len(offered(study)[0]) <= 3, study
    first, last = study.steps[0].fit.error, study.steps[-1].fit.error
    assert last.held_out_rms < 0.9 * first.held_out_rms
    if study.named == (effect,):
        key, tolerance = GIVEN_BACK[effect]
        truth = HIDDEN[effect][key.partition(".")[2]]
        assert study.steps[-1].fit.parameters[key].value == pytest.approx(truth, rel=tolerance)


@pytest.mark.parametrize(
    ("missing", "left"),
    [("offset", ("coulomb", "viscous")), ("viscous", ("offset", "coulomb")), ("coulomb", ("offset", "viscous"))],
)
def test_a_part_of_the_usual_model_is_found_when_it_is_left_out(missing, left):
    study = luztar.study(luztar.Model("rig", left), runs_with({}, seed=12))
    assert any(missing in names for names in offered(study)), study
    assert study.steps[-1].fit.error.held_out_rms < 0.9 * study.steps[0].fit.error.held_out_rms


@pytest.mark.parametrize("noise", ["white", "50 ms", "0.5 s"])
def test_nothing_is_named_where_nothing_is_hidden(noise):
    study = luztar.study(luztar.Model.rig(), runs_with({}, seed=13, noise=noise))
    assert study.named == ()
    assert study.verdict in ("nothing_missing", "below_practical_size")
    # The floor is what the model leaves: 1.25 is the spread of the floor's own estimate (low to high).
    assert study.steps[0].fit.error.floor_ratio < 1.25


def test_two_hidden_effects_are_both_added_whatever_hides_them_from_a_greedy_search():
    hidden = {
        "stribeck": {"extra_nm": 0.3, "speed_rad_s": 0.1},
        "once_per_rev": {"amplitude_nm": 0.26, "phase_rad": 0.3},
    }
    study = luztar.study(luztar.Model.rig(), runs_with(hidden, seed=14))
    sets = offered(study)
    assert len(sets) == 2, study
    assert any("stribeck" in names for names in sets) and any("once_per_rev" in names for names in sets), study
    assert all(len(names) <= 3 for names in sets)


def test_what_is_outside_the_catalogue_is_not_given_a_name():
    study = luztar.study(
        luztar.Model.rig(),
        runs_with({"torque_step": {"amplitude_nm": 0.2, "angle_rad": -0.2, "width_rad": 0.03}}, seed=15),
    )
    assert study.verdict == "unexplained"
    assert study.named == ()
    assert all(s.provisional for s in study.steps if s.added)


def test_the_order_in_which_runs_are_given_changes_no_name():
    runs = runs_with({"stribeck": HIDDEN["stribeck"]}, seed=16)
    forward, backward = (luztar.study(luztar.Model.rig(), order) for order in (runs, runs[::-1]))
    assert forward.named == backward.named
    assert forward.steps[-1].fit.error.rms == pytest.approx(backward.steps[-1].fit.error.rms, rel=1e-3)


def test_a_held_out_run_changes_nothing_but_its_own_error():
    runs = runs_with({"freeplay": HIDDEN["freeplay"]}, seed=17)
    other = runs_with({"stiffness": {"stiffness_nm_per_rad": 2.0}}, seed=18)[0]
    alone = luztar.fit(luztar.Model.rig() + "freeplay", runs[:2])
    with_held = luztar.fit(luztar.Model.rig() + "freeplay", runs[:2], held_out=[other])
    assert {k: v.value for k, v in alone.parameters.items()} == {k: v.value for k, v in with_held.parameters.items()}
    assert alone.error.rms == with_held.error.rms
    assert with_held.error.held_out_rms > 3.0 * alone.error.held_out_rms


def test_intervals_of_the_base_hold_the_truth_about_as_often_as_they_say():
    inside = total = 0
    for seed in range(12):
        fit = luztar.fit(luztar.Model.rig(), runs_with({}, seed=100 + seed, noise="0.5 s"))
        for key, truth in (("coulomb.level_nm", 0.75), ("viscous.coefficient_nm_s_per_rad", 0.3)):
            estimate = fit.parameters[key]
            inside += estimate.low <= truth <= estimate.high
            total += 1
    # 24 intervals at 95 %: fewer than 19 inside has a probability below 1e-3
    assert inside >= 19, f"{inside} of {total}"
