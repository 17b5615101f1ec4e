"""Effects of the catalogue that a study finds in free runs of solvers that share no code with luztar."""

import math

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import luztar
from generators.steering import Mechanism, drawn_hand, steering_run
from luztar.errors import ModelError
from luztar.freerun import FreeFit
from luztar.freerun.run_model import run_model

NOISE_RAD = 5e-4
NEAR_NOISE = 1.1
UNITS = {"time": "s", "handwheel": "rad", "roadwheel": "rad"}


def fitted(m: Mechanism, runs: list[dict[str, np.ndarray]], base: tuple[str, ...]) -> FreeFit:
    model = luztar.Model.steering(ratio=m.ratio, stiffness=m.stiffness)
    for effect in base:
        model = model + effect
    return luztar.fit(model, [luztar.Run(name=f"run{i}", units=UNITS, **run) for i, run in enumerate(runs)])


@pytest.mark.parametrize(
    ("m", "size", "seconds", "base", "effect", "truth"),
    [
        (
            Mechanism(waves=((0.5, 0.7, 1),)),
            4.0,
            8.0,
            (),
            "once_per_rev",
            {"amplitude_nm": (0.5, 0.02), "phase_rad": (0.7, 0.05)},
        ),
        (
            Mechanism(end_stop=(4000.0, 0.035)),
            1.0,
            8.0,
            (),
            "end_stop",
            {"stiffness_nm_per_rad": (4000.0, 100.0), "limit_rad": (0.035, 5e-4)},
        ),
        (
            Mechanism(kinetic=8.0, static=8.0, dwell=(25.0, 0.5)),
            1.0,
            15.0,
            ("coulomb",),
            "dwell",
            {"extra_nm": (25.0, 6.0), "time_s": (0.5, 0.2)},
        ),
    ],
    ids=["once_per_rev", "end_stop", "dwell"],
)
def test_an_effect_is_found_and_measured(m, size, seconds, base, effect, truth):
    chance = np.random.default_rng(4)
    runs = [steering_run(m, chance, seconds=seconds, rate_hz=200.0, size=size) for _ in range(3)]
    look = luztar.diagnose(fitted(m, runs, base)).to_dict()
    assert effect in look["named"] and len(look["named"]) <= 3
    best = look["candidates"][0]
    assert best["effect"] == effect and best["held_out_rms"] <= NEAR_NOISE * NOISE_RAD
    for key, (value, margin) in truth.items():
        assert best["parameters"][key] == pytest.approx(value, abs=margin)


def dahl_run(m: Mechanism, travel: float, chance: np.random.Generator, seconds: float) -> dict[str, np.ndarray]:
    """A run on Dahl's contact, by a general solver on his equation."""
    hand, times = drawn_hand(chance), np.arange(round(seconds * 200.0)) / 200.0

    def rate(t, y):
        phi, v, s = y
        pull = m.spring(float(hand(t)), phi) - m.viscous * v - m.kinetic * s
        return [v, pull / m.inertia, v / travel * (1.0 - s * np.sign(v))]

    made = solve_ivp(rate, (0.0, times[-1]), [0.0] * 3, t_eval=times, rtol=1e-5, atol=1e-8, max_step=0.01)
    angle = made.y[0] + chance.normal(0.0, NOISE_RAD, times.size)
    return {"time": times, "handwheel": np.asarray(hand(times)), "roadwheel": angle}


def test_presliding_is_found_with_its_shape_and_travel():
    m, chance = Mechanism(kinetic=9.0), np.random.default_rng(4)
    look = luztar.diagnose(fitted(m, [dahl_run(m, 0.006, chance, 8.0) for _ in range(3)], ("coulomb",))).to_dict()
    assert "presliding" in look["named"]
    best = look["candidates"][0]
    assert best["effect"] == "presliding" and best["held_out_rms"] <= NEAR_NOISE * NOISE_RAD
    assert best["parameters"]["breakaway_rad"] == pytest.approx(0.006, abs=6e-4)
    assert best["parameters"]["shape"] > 0.5


def test_presliding_does_not_stand_beside_what_is_felt_at_rest_only():
    t = np.arange(900) / 100.0
    run = luztar.Run(sample_rate_hz=100.0, handwheel=np.sin(3.0 * t), roadwheel=np.sin(3.0 * t) / 16.0)
    model = luztar.Model.steering(ratio=16.0, stiffness=12.0) + "coulomb" + "presliding" + "stiction"
    with pytest.raises(ModelError, match="presliding leaves nothing at rest, where stiction"):
        luztar.fit(model, run)


def test_a_wave_per_turn_is_not_searched_where_the_pinion_makes_no_turn():
    m, chance = Mechanism(waves=((0.5, 0.7, 1),)), np.random.default_rng(4)
    look = luztar.diagnose(fitted(m, [steering_run(m, chance, seconds=6.0, rate_hz=200.0)], ()))
    assert "once_per_rev" not in [c["effect"] for c in look.to_dict()["candidates"]]


def test_a_model_file_with_effects_is_simulated(tmp_path):
    path = tmp_path / "model.toml"
    path.write_text(
        'schema = 1\nstructure = "steering"\neffects = ["viscous", "coulomb", "dwell", "end_stop", "once_per_rev"]\n'
        "[known]\nratio = 16.0\nstiffness = 60.0\ninertia = 3.0\naligning = 300.0\n"
        '"viscous.coefficient_nm_s_per_rad" = 40.0\n"coulomb.level_nm" = 8.0\n"dwell.extra_nm" = 4.0\n'
        '"dwell.time_s" = 0.2\n"end_stop.stiffness_nm_per_rad" = 4000.0\n"end_stop.limit_rad" = 0.03\n'
        '"once_per_rev.amplitude_nm" = 0.2\n"once_per_rev.phase_rad" = 1.0\n'
    )
    t = np.arange(2000) / 500.0
    psi = 1.2 * np.sin(2.0 * math.pi * 0.5 * t)
    run = run_model(luztar.Model.load(path), psi, sample_rate_hz=500.0)
    assert run.balanced and {"stick", "slip"} <= {e.kind for e in run.events}
    assert run.energy_j["dry"] > 0.0
