"""Runs of unequal rates and lengths, single strokes, and strokes one way only, in one study."""

from __future__ import annotations

import csv

import numpy as np
import pytest

import luztar
from advised_trials import BASE, WINDOW
from generators.rig import RigRun, simulate_rig_full

STRIBECK = {"stribeck": {"extra_nm": 0.3, "speed_rad_s": 0.1}}
UNITS = {"time": "s", "angle": "rad", "torque": "Nm"}


def simulated(seed: int, rate_hz: float, strokes: int) -> RigRun:
    return simulate_rig_full(
        STRIBECK,
        base=BASE,
        motion={**WINDOW, "speeds_deg_s": (5.0, 38.0), "strokes": strokes},
        sample_rate_hz=rate_hz,
        noise="50 ms",
        wander_nm=0.02,
        encoder_deg=0.02,
        seed=[9, seed],
    )


def as_run(r: RigRun, name: str) -> luztar.Run:
    return luztar.Run(time=r.time_s, angle=r.angle_rad, torque=r.torque_nm, units=UNITS, name=name)


def holds(study: luztar.Study) -> None:
    assert study.named == ("stribeck",) and study.verdict == "nothing_missing", study
    for key, true in (
        ("coulomb.level_nm", 0.75),
        ("viscous.coefficient_nm_s_per_rad", 0.3),
        ("stribeck.extra_nm", 0.3),
    ):
        found = study.last.parameters[key]
        # One miss in twenty is what 95 % means; five times the half width never is.
        assert abs(found.value - true) < 5.0 * 0.5 * (found.high - found.low), key


# Four times the samples a second and five times the length from run to run, in one order and the other.
RATES = [(500.0, 6), (1000.0, 10), (100.0, 8), (250.0, 2)]


@pytest.mark.parametrize("order", [1, -1])
def test_unequal_rates_and_lengths_make_one_study(order: int) -> None:
    runs = [as_run(simulated(k, rate, strokes), f"{rate:g}") for k, (rate, strokes) in enumerate(RATES)][::order]
    study = luztar.study(luztar.Model.rig(), runs)
    holds(study)
    fitted = study.steps[-1].fit
    assert [r.name for r in fitted.runs] == [r.name for r in runs]
    assert sum(len(r.strokes) for r in fitted.runs) == sum(strokes for _, strokes in RATES)


def test_a_held_out_run_may_have_another_rate() -> None:
    runs = [as_run(simulated(k, 500.0, 6), f"run{k}") for k in (1, 2)]
    study = luztar.study(luztar.Model.rig(), runs, as_run(simulated(3, 100.0, 8), "slow"))
    holds(study)
    first, last = study.steps[0].fit.error, study.steps[-1].fit.error
    assert last.held_out_rms < 0.6 * first.held_out_rms


def test_runs_of_one_stroke_each_make_one_study() -> None:
    holds(luztar.study(luztar.Model.rig(), [as_run(simulated(30 + k, 500.0, 1), f"stroke{k}") for k in range(10)]))


def test_strokes_one_way_only_say_that_friction_and_offset_are_one() -> None:
    made = (simulated(k, 500.0, 1) for k in range(30, 60))
    upward = [r for r in made if r.angle_rad[-1] > r.angle_rad[0]][:7]
    fitted = luztar.fit(luztar.Model.rig(), [as_run(r, f"up{k}") for k, r in enumerate(upward)])
    assert fitted.flags[0].kind == "one_direction" and "increasing angle" in fitted.flags[0].text
    assert not fitted.parameters["coulomb.level_nm"].identifiable
    assert not [f for f in fitted.flags if f.kind == "not_passive"]
    alone = luztar.fit(luztar.Model("rig", ("coulomb", "viscous")), [as_run(r, f"up{k}") for k, r in enumerate(upward)])
    assert not [f for f in alone.flags if f.kind == "one_direction"]


def test_a_german_export_reads_as_the_run_it_is(tmp_path) -> None:
    r = simulated(1, 500.0, 2)
    path = tmp_path / "lauf.csv"
    with path.open("w", encoding="cp1252", newline="") as file:
        rows = csv.writer(file, delimiter=";")
        rows.writerow(["Zeit [s]", "Lenkwinkel [°]", "Lenkmoment [Nm]"])
        for row in zip(r.time_s, np.degrees(r.angle_rad), r.torque_nm, strict=True):
            rows.writerow([f"{v:.6f}".replace(".", ",") for v in row])
    run = luztar.read(path)[0]
    assert run.sample_rate_hz == 500.0 and not run.integrity.doubtful
    # Six decimals were written.
    assert np.abs(run["angle"] - r.angle_rad).max() < np.radians(1e-6)
    assert np.abs(run["torque"] - r.torque_nm).max() < 1e-6
