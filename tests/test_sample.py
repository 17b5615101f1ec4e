"""Drawn parameters are distributed as they are said to be, and lane 17 is the same whoever draws it."""

import hashlib
import math

import numpy as np
import pytest
from scipy import stats

from luztar.dynamics import Choice, LogNormal, Normal, Uniform, sample, summarise
from luztar.errors import ParameterError

DRAWN = {
    "a": Uniform(4.0, 12.0),
    "b": Normal(8.0, 2.0),
    "c": Normal(0.1, 0.1, low=0.0, high=0.3),
    "d": LogNormal(3.0, 0.5),
    "e": Choice([1.0, 2.0, 5.0], [1.0, 0.0, 3.0]),
}
REFERENCES = {
    "a": stats.uniform(4.0, 8.0),
    "b": stats.norm(8.0, 2.0),
    "c": stats.truncnorm(-1.0, 2.0, 0.1, 0.1),
    "d": stats.lognorm(0.5, scale=3.0),
}
LANES = 20_000
# One in a thousand honest seeds falls below it; the seed is fixed, so that a pass stays a pass.
LEAST_P = 1e-3


@pytest.mark.parametrize("name", REFERENCES)
def test_random_values_follow_their_distribution(name):
    drawn = sample(DRAWN, LANES, seed=11)[name]
    assert stats.kstest(drawn, REFERENCES[name].cdf).pvalue > LEAST_P


@pytest.mark.parametrize("name", REFERENCES)
def test_sobol_values_fill_their_distribution_evenly(name):
    lanes = 1024
    drawn = np.sort(sample(DRAWN, lanes, seed=5, method="sobol")[name])
    # Each of 2^m cells of equal share holds one of the first 2^m points.
    places = np.floor(REFERENCES[name].cdf(drawn) * lanes + 1e-6)
    assert np.array_equal(places, np.arange(lanes))


def test_choices_come_as_often_as_their_weights_say():
    drawn = sample(DRAWN, LANES, seed=11)["e"]
    assert set(drawn) == {1.0, 5.0}
    assert stats.binomtest(int((drawn == 5.0).sum()), LANES, 0.75).pvalue > LEAST_P


def test_parameters_are_drawn_independently():
    drawn = sample({"a": Uniform(0, 1), "b": Uniform(0, 1)}, LANES, seed=3)
    assert stats.pearsonr(drawn["a"], drawn["b"]).pvalue > LEAST_P


@pytest.mark.parametrize("method", ["random", "sobol"])
def test_shards_are_parts_of_the_same_whole(method):
    whole = sample(DRAWN, 100, seed=9, method=method)
    for first, lanes in ((0, 1), (0, 7), (1, 30), (6, 5), (31, 69), (99, 1)):
        part = sample(DRAWN, lanes, seed=9, first=first, method=method)
        for name in DRAWN:
            assert part[name].tobytes() == whole[name][first : first + lanes].tobytes(), (name, first)
    assert not np.array_equal(sample(DRAWN, 100, seed=10, method=method)["a"], whole["a"])


def test_uniform_values_have_known_bits():
    # Philox 4x64-10 with this key and counter 1, as Random123 defines it; held so that a study can be run again.
    drawn = sample({"coulomb.level_nm": Uniform(0.0, 1.0)}, 4, seed=1)["coulomb.level_nm"]
    stream = int.from_bytes(hashlib.blake2b(b"coulomb.level_nm", digest_size=8).digest(), "little")
    assert np.array_equal(drawn, [((word >> 11) + 0.5) / 2**53 for word in philox(1, stream)])


def philox(key0: int, key1: int) -> list[int]:
    """The first block of Philox 4x64-10 (Salmon et al. 2011), written from the paper; NumPy counts from 1."""
    mask = 2**64 - 1
    counter = [1, 0, 0, 0]
    for _ in range(10):
        a, b = 0xD2E7470EE14C6C93 * counter[0], 0xCA5A826395121157 * counter[2]
        counter = [(b >> 64) ^ counter[1] ^ key0, b & mask, (a >> 64) ^ counter[3] ^ key1, a & mask]
        key0, key1 = (key0 + 0x9E3779B97F4A7C15) & mask, (key1 + 0xBB67AE8584CAA73B) & mask
    return counter


def test_a_parameter_keeps_its_values_when_others_come():
    alone = sample({"b": DRAWN["b"]}, 50, seed=2)["b"]
    assert np.array_equal(alone, sample(DRAWN, 50, seed=2)["b"])


def test_distributions_stand_in_files_as_tables():
    written = {
        "a": {"uniform": [4, 12]},
        "b": {"normal": [8, 2]},
        "c": {"normal": {"mean": 0.1, "std": 0.1, "low": 0.0, "high": 0.3}},
        "d": {"lognormal": [3, 0.5]},
        "e": {"choice": [[1, 2, 5], [1, 0, 3]]},
        "f": {"fixed": 2},
        "g": 7,
    }
    drawn = sample(written, 20, seed=4)
    same = sample(DRAWN, 20, seed=4)
    assert all(np.array_equal(drawn[name], same[name]) for name in DRAWN)
    assert drawn["f"] == 2.0 and drawn["g"] == 7.0
    assert set(sample({"a": {"choice": [1, 2]}}, 50)["a"]) == {1.0, 2.0}


@pytest.mark.parametrize(
    ("given", "word"),
    [
        ({"k": {"uniform": [2, 1]}}, "k: uniform from 2 to 1"),
        ({"k": {"uniform": [1]}}, "k is .*uniform is: Evenly"),
        ({"k": {"normal": [1, -1]}}, "k: a standard deviation of -1"),
        ({"k": {"normal": [1, 1, 3, 2]}}, "k: nothing is left"),
        ({"k": {"lognormal": [0, 1]}}, "k: a median of 0"),
        ({"k": {"choice": [[1, 2], [1]]}}, "k: 2 values with weights"),
        ({"k": {"choice": []}}, "k"),
        ({"k": {"gamma": [1, 2]}}, "k is .*uniform, normal, lognormal, choice, fixed"),
        ({"k": "much"}, "k is 'much'"),
        ({"k": math.nan}, "k holds nan"),
    ],
)
def test_a_distribution_that_makes_no_sense_is_named(given, word):
    with pytest.raises(ParameterError, match=word):
        sample(given, 3)


def test_a_study_over_friction_and_freeplay_in_a_few_lines():
    given = {
        "steering.inertia_kg_m2": 3.0,
        "steering.ratio": 16.0,
        "steering.stiffness_nm_per_rad": 60.0,
        "viscous.coefficient_nm_s_per_rad": 40.0,
        "coulomb.level_nm": Uniform(4.0, 12.0),
        "freeplay.gap_rad": Normal(0.1, 0.03, low=0.0),
    }
    psi = np.sin(np.pi * np.arange(1001) / 500)
    drawn = sample(given, 256, seed=1, method="sobol")
    made = summarise(drawn, psi, sample_rate_hz=500, keep=("peak",))["peak_rad"]
    # Quasi-statically the peak is (1 - gap/2 - F/(pK))/p; mu and I add a little (reference: play operator).
    play = (1.0 - 0.5 * drawn["freeplay.gap_rad"] - drawn["coulomb.level_nm"] / (16.0 * 60.0)) / 16.0
    assert np.abs(made - play).max() < 1e-3 and np.corrcoef(made, play)[0, 1] > 0.999
