"""Runs that cannot be what they are said to be are refused at the door of a fit, with the remedy that works."""

from __future__ import annotations

import re

import numpy as np
import pytest

import luztar
import tb038_records
from generators.rig import simulate_rig_set
from luztar.errors import DoubtfulError, LuztarError, MeasurementError
from luztar.model.model import Comparison

RIG = luztar.Model.rig()
CALLS = {"fit": luztar.fit, "study": luztar.study}


def run_with(change=lambda t, x, y: (x, y), **kinds) -> luztar.Run:
    t, angle, sign = tb038_records.turning(rate_hz=100.0, speed_deg_s=30.0)
    angle, torque = change(t, angle, tb038_records.torque(angle, sign, **kinds))
    return tb038_records.as_run(t, angle, torque, "mine.csv")


def refused(model: luztar.Model, run: luztar.Run, call=luztar.fit) -> MeasurementError:
    with pytest.raises(MeasurementError) as caught:
        call(model, [run])
    assert caught.value.where == "mine.csv" and caught.value.remedy
    return caught.value


@pytest.mark.parametrize("call", CALLS.values(), ids=CALLS)
@pytest.mark.parametrize("channel", ["torque", "angle"])
def test_a_channel_that_never_changes_is_refused(channel: str, call) -> None:
    def still(t, x, y):
        return (x, np.full_like(y, 0.7)) if channel == "torque" else (np.zeros_like(x), y)

    error = refused(RIG, run_with(still), call)
    assert f"the {channel} is 0" in error.kind and f"--map {channel}=" in error.remedy


def test_a_torque_that_stops_half_way_is_refused() -> None:
    def stuck(t, x, y):
        return x, np.where(np.arange(y.size) < y.size // 2, y, y[y.size // 2])

    assert "stands still for" in refused(RIG, run_with(stuck)).kind


@pytest.mark.parametrize("call", CALLS.values(), ids=CALLS)
def test_friction_that_drives_the_motion_is_a_reversed_sign(call) -> None:
    error = refused(RIG, run_with(lambda t, x, y: (x, -y), offset_nm=0.3), call)
    assert "torque sign reversed" in error.kind and "*-1" in error.remedy


def test_an_axis_is_checked_by_its_own_channels() -> None:
    t, angle, sign = tb038_records.turning(rate_hz=500.0, speed_deg_s=30.0)
    force = -20.0 * tb038_records.torque(angle, sign)
    run = luztar.Run(time=t, position=angle / 300.0, force=force, units={}, name="mine.csv")
    error = refused(luztar.Model.axis(), run)
    assert "force sign reversed" in error.kind and "N with increasing" in error.kind and "position" in error.kind


def test_a_mechanism_without_friction_is_not_called_reversed() -> None:
    found = luztar.fit(RIG + "stiffness", [run_with(level_nm=-0.0002, slope_nm_per_deg=0.02)])
    assert abs(found.parameters["coulomb.level_nm"].value) < 0.01


def test_without_coulomb_friction_no_sign_is_asked_for() -> None:
    model = luztar.Model("rig", ("offset",))
    assert luztar.fit(model, [run_with(level_nm=-0.8)]).error.rms == pytest.approx(0.8, rel=0.05)


@pytest.mark.parametrize(
    "comparison",
    [Comparison(band_hz=0.01), Comparison(decimate=5000), Comparison(decimate=900), Comparison(6.0, decimate=50)],
)
def test_a_band_or_decimation_that_leaves_nothing_names_one_that_does(comparison: Comparison, capfd) -> None:
    (run,) = (luztar.Run(time=r.time_s, angle=r.angle_rad, torque=r.torque_nm, name="mine.csv") for r in _made())
    model = luztar.Model("rig", RIG.effects, comparison=comparison)
    error = refused(model, run)
    assert not capfd.readouterr().out
    for _ in range(2):
        value = float(re.search(r"at (?:least|most) ([\d.]+)", error.remedy)[1])
        band = (
            Comparison(band_hz=value) if "--band" in error.remedy else Comparison(comparison.band_hz, False, int(value))
        )
        try:
            assert np.isfinite(luztar.fit(luztar.Model("rig", RIG.effects, comparison=band), [run]).error.rms)
            break
        except MeasurementError as again:
            error = again
    else:
        raise AssertionError(f"the remedy does not work: {error}")


def _made():
    return simulate_rig_set({}, runs=1, seed=3, motion={"strokes": 8}, sample_rate_hz=250.0)


def test_an_effect_names_the_channel_it_needs() -> None:
    error = refused(RIG + "load", run_with())
    assert "'load'" in error.kind and "--map load=" in error.remedy


@pytest.mark.parametrize("effects", [(), ("delay",)])
def test_a_model_without_a_coefficient_predicts_nothing(effects: tuple[str, ...]) -> None:
    found = luztar.fit(luztar.Model("rig", effects), [run_with()])
    assert found.error.relative == pytest.approx(1.0, abs=1e-6)
    assert "no effects" in str(found) or effects


def test_an_effect_that_another_stands_on_is_kept() -> None:
    # The study finds Coulomb friction first and may not try the Stribeck friction that stands on it without it.
    runs = [
        luztar.Run(time=r.time_s, angle=r.angle_rad, torque=r.torque_nm, name=f"{i}")
        for i, r in enumerate(
            simulate_rig_set(
                {"stribeck": {"extra_nm": 0.4, "speed_rad_s": 0.08}},
                runs=2,
                seed=3,
                motion={"strokes": 8},
                sample_rate_hz=100.0,
            )
        )
    ]
    found = luztar.study(luztar.Model("rig", ("offset", "viscous")), runs)
    assert "coulomb" in found.model.effects


def test_errors_of_the_core_have_a_place_and_a_remedy() -> None:
    for call in (
        lambda: luztar.signal.Filter(poles=4, cutoff_hz=600.0, sample_rate_hz=1000.0),
        lambda: luztar.signal.Filter(poles=99, cutoff_hz=6.0, sample_rate_hz=1000.0),
        lambda: luztar.regression.line([1.0, 1.0], [1.0, 2.0]),
        lambda: luztar.stats.Moments().push([1.0, np.nan]),
    ):
        with pytest.raises(LuztarError) as caught:
            call()
        assert caught.value.kind and caught.value.where and caught.value.remedy, repr(caught.value)


def clipped_set(level_nm: float | None, name: str = "mine.csv") -> list[luztar.Run]:
    """Runs of the independent generator whose torque amplifier saturates in the first of them."""
    runs = []
    for number, r in enumerate(simulate_rig_set({"stribeck": {"extra_nm": 0.5, "speed_rad_s": 0.1}}, runs=3, seed=4)):
        torque = r.torque_nm if level_nm is None or number else np.clip(r.torque_nm, -level_nm, level_nm)
        runs.append(luztar.Run(time=r.time_s, angle=r.angle_rad, torque=torque, units=UNITS, name=f"{number}{name}"))
    return runs


UNITS = {"angle": "rad", "torque": "Nm", "time": "s"}


LOOKS = {"study": lambda runs: luztar.study(RIG, runs), "diagnose": lambda runs: luztar.diagnose(luztar.fit(RIG, runs))}


@pytest.mark.parametrize("look", LOOKS.values(), ids=LOOKS)
def test_nothing_is_named_from_a_clipped_torque(look) -> None:
    with pytest.raises(DoubtfulError) as caught:
        look(clipped_set(0.9))
    assert caught.value.where == "0mine.csv"
    assert "-0.9 and 0.9 Nm" in caught.value.kind and "% of the samples compared" in caught.value.kind


def test_a_fit_of_a_clipped_torque_says_so_and_stands() -> None:
    comparison = luztar.compare(luztar.fit(RIG, clipped_set(0.9)))
    (flag,) = [f for f in comparison.fit.flags if f.kind == "clipped"]
    assert flag.text.startswith("0mine.csv") and flag.text in str(comparison)
    assert flag.to_dict() in comparison.to_dict()["flags"]


def test_one_clipped_peak_is_a_trifle() -> None:
    runs = clipped_set(None)
    torque = np.array(runs[0]["torque"])
    at = int(torque.argmax())
    torque[at - 7 : at + 8] = torque.max() + 0.01
    time = runs[0].time_s
    one = luztar.Run(time=time, angle=runs[0]["angle"], torque=torque, units=UNITS, name="0mine.csv")
    assert [f.kind for f in one.integrity.findings] == ["clipped"]
    assert not any(f.kind == "clipped" for f in luztar.fit(RIG, [one, *runs[1:]]).flags)
