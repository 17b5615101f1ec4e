"""What the sensor of one run alone has, an offset or a delay, is taken off and said."""

from __future__ import annotations

import numpy as np
import pytest

import luztar
from generators.rig import simulate_rig_set

HIDDEN = {"stribeck": {"extra_nm": 0.3, "speed_rad_s": 0.08}}
# Twice the standard error that six strokes leave of an offset, with a wander of 0.02 Nm.
OFFSET_NM = 0.01
# Half of what the sensor leaves open about the starts.
DELAY_S = 0.015


def runs(offset_nm: float = 0.0, delay_s: float = 0.0, seed: int = 5) -> list[luztar.Run]:
    """Three runs, the second with an offset and a delay of its own."""
    made = []
    for number, r in enumerate(simulate_rig_set(HIDDEN, runs=3, seed=seed, noise="50 ms", wander_nm=0.02)):
        own = number == 1
        torque = np.interp(r.time_s - delay_s * own, r.time_s, r.torque_nm) + offset_nm * own
        made.append(luztar.Run(time=r.time_s, angle=r.angle_rad, torque=torque, name=f"run{number + 1}"))
    return made


def own(fit: luztar.diagnosis.fit.Fit) -> dict[str, str]:
    return {f.kind: f.text for f in fit.flags if f.kind.startswith("own_")}


def test_runs_that_agree_are_left_alone() -> None:
    assert own(luztar.fit(luztar.Model.rig(), runs())) == {}


@pytest.mark.parametrize("offset_nm", [-0.12, 0.08])
def test_a_load_cell_zeroed_anew(offset_nm: float) -> None:
    study = luztar.study(luztar.Model.rig(), runs(offset_nm))
    assert study.named == ("stribeck",)
    fit = study.steps[-1].fit
    assert fit.runs[1].own_offset == pytest.approx(offset_nm, abs=OFFSET_NM)
    assert "run2" in own(fit)["own_offset"]
    # as good as without the offset: what was taken off is the sensor's
    plain = luztar.study(luztar.Model.rig(), runs()).steps[-1].fit
    assert fit.error.held_out_rms == pytest.approx(plain.error.held_out_rms, rel=0.03)


def test_a_torque_that_comes_late_in_one_run() -> None:
    study = luztar.study(luztar.Model.rig(), runs(delay_s=0.04))
    assert study.named == ("stribeck",)
    fit = study.steps[-1].fit
    assert fit.runs[1].own_delay_s == pytest.approx(0.04, abs=DELAY_S)
    assert fit.runs[0].own_delay_s == fit.runs[2].own_delay_s == 0.0
    assert "later than in the other runs" in own(fit)["own_delay"]


def test_one_run_has_nothing_to_differ_from() -> None:
    assert own(luztar.fit(luztar.Model.rig(), runs()[:1])) == {}
