"""Flags of a fit: parameters at a bound or without influence, friction that drives the motion."""

from __future__ import annotations

import numpy as np
import pytest

import luztar
import tb038_records
from generators.rig import simulate_rig_set

UNITS = {"angle": "deg", "torque": "Nm"}


def fitted(torque_of, effects: tuple[str, ...], known=None) -> luztar.diagnosis.fit.Fit:
    """Fit a wheel turned at two speeds; the torque is a formula of sign, speed and angle."""
    angle, sign, speed = [], [], []
    for pace in (10.0, 35.0):
        _, x, s = tb038_records.turning(speed_deg_s=pace, rate_hz=100.0, start_deg=-60.0)
        angle, sign = [*angle, x], [*sign, s]
        speed = [*speed, np.gradient(x, 0.01)]
    x, s, w = np.concatenate(angle), np.concatenate(sign), np.radians(np.concatenate(speed))
    torque = torque_of(s, w, np.radians(x)) + np.random.default_rng(4).normal(0.0, 0.01, x.size)
    run = luztar.Run(sample_rate_hz=100.0, angle=x, torque=torque, units=UNITS)
    return luztar.fit(luztar.Model("rig", effects, known or {}), run)


def kinds(found) -> list[tuple[str, str]]:
    return [(f.kind, f.parameter) for f in found.flags]


def test_friction_as_it_should_be_has_no_flag() -> None:
    found = fitted(lambda s, w, x: 0.7 * s + 0.3 * w, ("offset", "coulomb", "viscous"), {"offset.level_nm": 0.05})
    assert [k for k in kinds(found) if k[1] != "offset.level_nm"] == []
    assert "!" not in str(found)


def test_a_negative_coefficient_lies_outside_its_card() -> None:
    found = fitted(lambda s, w, x: 0.8 * s - 0.3 * w, ("coulomb", "viscous"))
    assert kinds(found) == [("at_bound", "viscous.coefficient_nm_s_per_rad")]
    (flag,) = found.to_dict()["flags"]
    assert set(flag) == {"kind", "parameter", "text"} and flag["text"] in str(found)
    assert luztar.compare(found).to_dict()["flags"] == [flag]


def test_one_sided_viscous_friction_that_drives_the_motion_is_not_passive() -> None:
    # At 35 deg/s in the decreasing direction: 0.3 + (0.6 - 1.2) * 0.61 = -0.07 Nm.
    found = fitted(lambda s, w, x: 0.3 * s + 0.6 * w + 1.2 * abs(w), ("coulomb", "viscous", "asymmetric_viscous"))
    (flag,) = found.flags
    assert (flag.kind, flag.parameter) == ("not_passive", "asymmetric_viscous.difference_nm_s_per_rad")
    assert "decreasing angle" in flag.text and "deg/s" in flag.text
    sound = fitted(lambda s, w, x: 0.6 * s + 0.6 * w + 1.2 * abs(w), ("coulomb", "viscous", "asymmetric_viscous"))
    assert sound.flags == ()


def test_a_negative_friction_level_is_not_passive_even_where_it_is_given() -> None:
    with pytest.raises(luztar.errors.ModelError, match="between"):
        luztar.Model("rig", ("coulomb",), {"coulomb.level_nm": -0.5})
    found = fitted(lambda s, w, x: -0.5 * s + 1.0, ("offset", "coulomb"))
    assert ("not_passive", "coulomb.level_nm") in kinds(found) and ("at_bound", "coulomb.level_nm") in kinds(found)


def test_what_adds_nothing_to_the_prediction_has_no_influence() -> None:
    found = fitted(lambda s, w, x: 0.7 * s, ("coulomb", "drift"), {"drift.rate_nm_per_s": 1e-9})
    assert ("no_influence", "drift.rate_nm_per_s") in kinds(found)


def test_a_gap_that_is_not_there_ends_at_the_bound_of_its_search() -> None:
    (made,) = simulate_rig_set({}, runs=1, seed=5, motion={"strokes": 8}, sample_rate_hz=100.0)
    run = luztar.Run(time=made.time_s, angle=made.angle_rad, torque=made.torque_nm)
    found = luztar.fit(luztar.Model.rig() + "freeplay", run)
    assert ("at_bound", "freeplay.gap_rad") in kinds(found)


def test_an_axis_speaks_of_its_own_units() -> None:
    _, x, s = tb038_records.turning(speed_deg_s=30.0, rate_hz=500.0)
    run = luztar.Run(sample_rate_hz=500.0, position=x / 300.0, force=-20.0 * s + 50.0, units={})
    (flag,) = [f for f in luztar.fit(luztar.Model("axis", ("offset", "coulomb")), run).flags if f.kind == "not_passive"]
    assert "mm/s" in flag.text and " N)" in flag.text and "position" in flag.text
