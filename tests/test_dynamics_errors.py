"""A mechanism or a drive that makes no sense is refused by name."""

import math

import numpy as np
import pytest

from luztar.dynamics import simulate, trace
from luztar.errors import ParameterError

SOUND = {
    "steering.inertia_kg_m2": 3.0,
    "steering.ratio": 16.0,
    "steering.stiffness_nm_per_rad": 60.0,
    "coulomb.level_nm": 8.0,
    "viscous.coefficient_nm_s_per_rad": 40.0,
}
PSI = np.sin(np.arange(200) / 50)


@pytest.mark.parametrize(
    ("change", "word"),
    [
        ({"steering.inertia_kg_m2": -1.0}, "inertia_kg_m2"),
        ({"steering.inertia_kg_m2": 0.0}, "inertia_kg_m2"),
        ({"steering.ratio": 0.0}, "ratio"),
        ({"coulomb.level_nm": -1.0}, "coulomb_nm"),
        ({"freeplay.gap_rad": -0.1}, "gap_rad"),
        ({"stiction.extra_nm": -0.1}, "static friction is at least kinetic"),
        ({"stribeck.extra_nm": -9.0, "stribeck.speed_rad_s": 1.0}, "stribeck_nm"),
        ({"stribeck.extra_nm": 1.0}, "stribeck_speed_rad_s"),
        ({"asymmetric_coulomb.difference_nm": 9.0}, "asymmetric_coulomb_nm"),
        ({"asymmetric_viscous.difference_nm_s_per_rad": 50.0}, "asymmetric_viscous"),
        ({"viscous.coefficient_nm_s_per_rad": math.nan}, "viscous_nm_s_per_rad"),
        ({"coulomb.levl_nm": 1.0}, "no parameter 'coulomb.levl_nm'"),
        ({"coulomb.level_nm": [[1.0]]}, "shape"),
        ({"coulomb.level_nm": "much"}, "coulomb.level_nm"),
        ({"coulomb.level_nm": [1.0, 2.0], "freeplay.gap_rad": [0.1, 0.2, 0.3]}, "one value per lane"),
    ],
)
def test_a_wrong_parameter_is_named(change, word):
    with pytest.raises(ParameterError, match=word):
        simulate({**SOUND, **change}, PSI, sample_rate_hz=500)


@pytest.mark.parametrize(
    ("options", "word"),
    [
        ({"sample_rate_hz": 0.0}, "sample_rate_hz"),
        ({"sample_rate_hz": math.nan}, "sample_rate_hz"),
        ({"sample_rate_hz": 500.0, "substeps": 0}, "substeps"),
        ({"sample_rate_hz": 500.0, "method": "euler"}, "split, moreau_jean"),
        ({"sample_rate_hz": 500.0, "width": "mmx"}, "baseline, avx2"),
        ({"sample_rate_hz": 500.0, "start_rad": math.inf}, "start angle"),
        ({"sample_rate_hz": 500.0, "load_nm": [0.0]}, "load_nm"),
    ],
)
def test_a_wrong_option_is_named(options, word):
    with pytest.raises(ParameterError, match=word):
        simulate(SOUND, PSI, **options)


def test_a_drive_that_is_not_finite_is_refused_with_its_place():
    with pytest.raises(ParameterError, match="index 3"):
        simulate(SOUND, [0.0, 0.1, 0.2, math.nan], sample_rate_hz=500)


def test_a_step_too_large_for_the_spring_names_step_and_spring():
    # The limit is h = 2 / w with w = p sqrt(K / I) = 71.55 rad/s: 27.95 ms.
    with pytest.raises(ParameterError, match=r"step.*0\.03.*2\.795e-2.*stiffness_nm_per_rad.*substeps"):
        simulate(SOUND, PSI, sample_rate_hz=1.0 / 0.03)
    simulate(SOUND, PSI, sample_rate_hz=1.0 / 0.03, substeps=4)


def test_more_steps_than_memory_holds_are_refused_by_name():
    with pytest.raises(ParameterError, match=r"substeps.*\[1, 671088\] for a record of 200 samples"):
        trace(SOUND, PSI, sample_rate_hz=500, substeps=1_000_000)


def test_a_trace_is_of_one_lane():
    with pytest.raises(ParameterError, match="several lanes"):
        trace({**SOUND, "coulomb.level_nm": [1.0, 2.0]}, PSI, sample_rate_hz=500)
