"""The advised test is the one that decides: followed with the independent generator, it names the truth."""

import math
import time

import pytest

import luztar
from advised_trials import FOLLOWED, USUAL, measured
from generators.axis import simulate_axis_set
from luztar.diagnosis.experiment import experiment_for
from luztar.planning.advise import Advice, advice
from luztar.planning.separate import Ranked
from luztar.planning.trials import axis_trials, rig_trials

# (rival, hidden effect with a size at which the usual strokes leave a doubt or nearly so)
PAIRS = [
    ("once_per_rev", {"stiffness": {"stiffness_nm_per_rad": 0.03}}),
    ("stiffness", {"once_per_rev": {"amplitude_nm": 0.04, "phase_rad": 0.0}}),
    ("stribeck", {"drag": {"coefficient_nm_s2_per_rad2": 0.2}}),
    ("once_per_rev", {"asymmetric_viscous": {"difference_nm_s_per_rad": 0.03}}),
    ("stribeck", {"presliding": {"breakaway_rad": math.radians(0.15), "shape": "exponential"}}),
    ("presliding", {"freeplay": {"gap_rad": math.radians(0.15)}}),
]


@pytest.mark.parametrize(("rival", "hidden"), PAIRS, ids=lambda p: p if isinstance(p, str) else next(iter(p)))
def test_the_advised_test_names_the_truth(rival, hidden):
    truth = next(iter(hidden))
    fitted = luztar.fit(luztar.Model.rig(), measured(hidden, USUAL, seed=5))
    look = luztar.diagnose(fitted)
    state = next(c.search.best for c in look.found if c.name == truth)
    advised = advice(fitted, state, truth, (rival,))
    assert advised.decides
    # More per minute than what was recorded: otherwise it would be no advice.
    assert advised.best.apart > advised.now / math.sqrt(3.0)
    study = luztar.study(luztar.Model.rig(), measured(hidden, FOLLOWED[advised.best.trial.name], seed=6))
    assert study.named == (truth,), study


@pytest.mark.parametrize(("hidden", "pair"), [(PAIRS[0][1], "stiffness"), (PAIRS[1][1], "once_per_rev")])
def test_a_spring_and_a_once_per_turn_torque_are_told_apart_by_a_wider_turn(hidden, pair):
    look = luztar.diagnose(luztar.fit(luztar.Model.rig(), measured(hidden, USUAL, seed=5)))
    assert look.verdict == "one_of" and set(look.named) == {"stiffness", "once_per_rev"}
    found = look.next_experiment
    assert set(found.separates) == {"stiffness", "once_per_rev"}
    assert "180" in found.text and found.to_dict() == {"text": found.text, "separates": list(found.separates)}


def test_nothing_is_advised_where_nothing_is_named_or_alike():
    look = luztar.diagnose(luztar.fit(luztar.Model.rig(), measured({}, USUAL, seed=5)))
    assert look.next_experiment is None
    fitted = luztar.fit(luztar.Model.rig(), measured({}, USUAL, seed=5))
    assert experiment_for(fitted, ()) is None
    assert experiment_for(fitted, ("stribeck", "drag")) is None  # not in the model


def test_a_named_effect_with_a_twin_gets_the_test_that_confirms_it():
    hidden = {"stiffness": {"stiffness_nm_per_rad": 0.1}}
    fitted = luztar.fit(luztar.Model.rig() + "stiffness", measured(hidden, USUAL, seed=5))
    found = experiment_for(fitted, ("stiffness",))
    assert found.separates == ("stiffness", "once_per_rev") and found.advice.best.trial.name == "wide"


def test_too_few_strokes_ask_for_more():
    short = [{**USUAL[0], "strokes": 3}]
    look = luztar.diagnose(luztar.fit(luztar.Model.rig(), measured({}, short, seed=5)))
    assert look.verdict == "too_few_strokes"
    assert "six strokes" in look.next_experiment.text


def test_an_axis_is_not_spoken_to_like_a_steering_wheel():
    runs = [
        luztar.Run(time=r.time_s, position=r.position_m, force=r.force_n)
        for r in simulate_axis_set({"presliding": {"breakaway_m": 5e-4, "shape": "exponential"}}, runs=2, seed=3)
    ]
    fitted = luztar.fit(luztar.Model.axis() + "presliding", runs)
    found = experiment_for(fitted, ("presliding", "freeplay"))
    texts = [found.text, *(t.text for t in axis_trials(0.0, 0.25, 0.1))]
    for text in texts:
        assert not any(word in text.lower() for word in ("wheel", "robot", "degree", "turn ", "hand"))


def test_the_advice_costs_less_than_a_look():
    hidden = {"freeplay": {"gap_rad": 0.06}}
    fitted = luztar.fit(luztar.Model.rig() + "freeplay", measured(hidden, USUAL, seed=5))
    before = time.process_time()
    advice(fitted, fitted.state, "freeplay", ("presliding",))
    # 0.2 s where the processor is free; process time does not count what others do.
    assert time.process_time() - before < 1.0


def test_every_test_of_the_list_can_be_followed():
    assert {t.name for t in rig_trials()} == set(FOLLOWED)
    for trial in (*rig_trials(), *axis_trials(0.0, 0.25, 0.1)):
        position = trial.make(0.01, 1)
        assert 0.3 < position.size / 6000.0 < 5.0, trial.name  # minutes
        assert (position == trial.make(0.01, 1)).all()


def ranked(apart, minutes=1.0):
    return Ranked(rig_trials()[0], minutes, apart)


def test_a_test_weaker_than_the_strokes_recorded_is_never_advised():
    weaker = Advice("stribeck", ("drag",), (ranked(5.7),), 13.0, 3)
    assert not weaker.better and not weaker.decides
    said = weaker.text("rig")
    assert rig_trials()[0].text not in said and "No test of the list" in said
    # Twice the standard errors need four times the runs.
    assert "9 more runs like them make it 26" in said
    stronger = Advice("stribeck", ("drag",), (ranked(8.0),), 13.0, 3)
    assert stronger.decides and "three runs" in stronger.text("rig") and "14 standard errors" in stronger.text("rig")


def test_repeats_are_counted_up_to_what_tells_apart():
    near = Advice("stribeck", ("drag",), (ranked(0.5),), 3.0, 3)
    assert near.repeats == 1 and "one more run like them make it 3.5" in near.text("rig")
    far = Advice("stribeck", ("drag",), (ranked(0.01),), 0.3, 3)
    assert far.repeats is None and "Repeat those" not in far.text("rig")
    assert Advice("stribeck", ("drag",), (ranked(0.0),), 0.0, 3).repeats is None


def test_a_ranking_puts_tests_that_tell_less_than_asked_last():
    hidden = {"stribeck": {"extra_nm": 0.1, "speed_rad_s": 0.1}}
    fitted = luztar.fit(luztar.Model.rig() + "stribeck", measured(hidden, USUAL, seed=5))
    made = advice(fitted, fitted.state, "stribeck", ("drag",))
    above = made.now / math.sqrt(3.0)
    told = [r.apart > above for r in made.ranking]
    assert told == sorted(told, reverse=True)
    assert made.better == told[0]


def test_a_study_prints_the_tests_that_its_looks_advise():
    study = luztar.study(luztar.Model.rig(), measured(PAIRS[0][1], USUAL, seed=5), max_effects=0)
    assert study.last.verdict == "one_of"
    assert f"next: {study.last.next_experiment.text}" in str(study).splitlines()
    short = luztar.study(luztar.Model.rig(), measured({}, [{**USUAL[0], "strokes": 3}], seed=5))
    assert "next: Record three runs of at least six strokes each" in str(short)
