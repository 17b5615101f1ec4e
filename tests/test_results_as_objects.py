"""Results as Python objects: what fit, compare, diagnose and study take, print, and survive being sent elsewhere."""

from __future__ import annotations

import copy
import pickle

import numpy as np
import pytest

import luztar
from generators.rig import simulate_rig_set
from luztar.errors import ParameterError

RIG = luztar.Model.rig()


@pytest.fixture(scope="module")
def runs() -> list[luztar.Run]:
    made = simulate_rig_set({}, runs=2, seed=5, motion={"strokes": 8}, sample_rate_hz=100.0)
    units = {"angle": "rad", "torque": "Nm"}
    return [
        luztar.Run(time=r.time_s, angle=r.angle_rad, torque=r.torque_nm, name=f"run{i}", units=units)
        for i, r in enumerate(made, start=1)
    ]


@pytest.fixture(scope="module")
def results(runs: list[luztar.Run]) -> list[object]:
    fitted = luztar.fit(RIG + luztar.effects.Stribeck(speed_rad_s=0.1), runs)
    study = luztar.study(RIG, runs, max_effects=0)
    return [fitted, luztar.compare(fitted), study.last, study, study.steps[0], luztar.tb038.evaluate(runs)]


def test_results_survive_pickle_and_copy(results: list[object]) -> None:
    for result in results:
        for again in (pickle.loads(pickle.dumps(result)), copy.deepcopy(result)):
            assert again.to_dict() == result.to_dict(), type(result)
            assert str(again) == str(result)


def test_a_fit_from_pickle_can_be_looked_at(results: list[object]) -> None:
    fitted = pickle.loads(pickle.dumps(results[0]))
    assert luztar.compare(fitted).to_dict() == results[1].to_dict()


def test_results_print_themselves_as_text(results: list[object]) -> None:
    for result in results[:4]:
        assert repr(result) == str(result) and "array(" not in repr(result)


def test_one_run_alone_is_a_list_of_one(runs: list[luztar.Run]) -> None:
    assert luztar.fit(RIG, runs[0]).to_dict() == luztar.fit(RIG, [runs[0]]).to_dict()
    alone, listed = (luztar.fit(RIG, runs[0], held_out=h).to_dict() for h in (runs[1], [runs[1]]))
    assert alone == listed
    assert luztar.study(RIG, runs[0], max_effects=0).runs == [runs[0]]


def test_arguments_of_another_kind_are_told_what_is_wanted(runs: list[luztar.Run]) -> None:
    for call in (
        lambda: luztar.fit(runs, RIG),
        lambda: luztar.fit(RIG, "run1.csv"),
        lambda: luztar.fit(RIG, None),
        lambda: luztar.study(RIG, [np.ones(3)]),
        lambda: luztar.study(RIG, runs, max_effects=-1),
        lambda: luztar.compare(runs),
        lambda: luztar.diagnose(RIG),
    ):
        with pytest.raises(ParameterError) as caught:
            call()
        assert caught.value.where and caught.value.remedy
