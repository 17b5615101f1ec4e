"""The EMPS axis, measured, with a documented missing effect; skipped where the data are not present.

Janot, Gautier, Brunot 2019, Data Set and Reference Models of EMPS: relative force errors 4.08 % (training) and 5.98 %
(pulses) for the symmetric model, 3.11 % for the asymmetric one. Figures depend on the preparation: here position
through four poles at 100 Hz forward and backward, force and regressors decimated by ten.
"""

import pytest

import luztar
from shared_data import shared

MAP = {"time": "t", "position": "qm", "force": "vir*35.1507"}
UNITS = {"position": "m", "force": "N"}


def emps(name):
    return luztar.read(shared("data", "emps", name), map=MAP, units=UNITS)


@pytest.fixture(scope="module")
def train():
    return emps("DATA_EMPS.mat")


@pytest.fixture(scope="module")
def pulses():
    return emps("DATA_EMPS_PULSES.mat")


def test_the_published_errors_of_the_symmetric_model_come_out(train, pulses):
    fit = luztar.fit(luztar.Model.axis(decimate=10), train, held_out=pulses)
    assert 100 * fit.error.relative == pytest.approx(4.06, abs=0.05)
    assert 100 * fit.error.held_out_relative == pytest.approx(5.97, abs=0.08)
    # The published parameters, to 1 %: other sensible filters move them by a few tenths of a per cent.
    for key, value in (
        ("inertia.inertia_kg", 95.1089),
        ("viscous.coefficient_n_s_per_m", 203.5034),
        ("coulomb.level_n", 20.3935),
    ):
        assert fit.parameters[key].value == pytest.approx(value, rel=0.01)


def test_the_asymmetric_model_reaches_the_published_error(train, pulses):
    fit = luztar.fit(luztar.Model.axis(decimate=10) + "asymmetric_viscous", train, held_out=pulses)
    assert 100 * fit.error.relative == pytest.approx(3.09, abs=0.05)
    assert 100 * fit.error.held_out_relative <= 5.40
    # (Fv+ - Fv-) / 2 of the publication: (166.7061 - 240.4236) / 2
    assert fit.parameters["asymmetric_viscous.difference_n_s_per_m"].value == pytest.approx(-36.86, rel=0.03)


def test_the_study_tells_the_authors_story_and_goes_on(train, pulses):
    study = luztar.study(luztar.Model.axis(), train, pulses)
    # Janot and others: viscous friction that differs by direction, "mechanical fatigue of the screw". What follows
    # halves the unseen error once more: the recorded command is ahead of the position by less than a sample, and the
    # friction near standstill is not that of the quick strokes.
    assert study.named[0] == "asymmetric_viscous"
    assert set(study.named) == {"asymmetric_viscous", "lead", "stribeck"}
    assert not any(name.startswith("decoy") for s in study.steps for name in s.set)
    errors = [100 * s.fit.error.held_out_relative for s in study.steps]
    assert errors == sorted(errors, reverse=True)
    # The reference reaches 2.79 % by the same three steps.
    assert errors[-1] <= 2.8
