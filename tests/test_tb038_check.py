"""The check as a whole: JSON, centring, offset, torque source, once-per-turn pattern, advice, words and figure."""

from __future__ import annotations

import dataclasses
import json
import pickle
import subprocess
import sys

import numpy as np
import pytest

import luztar
import tb038_records as records
from luztar import tb038

KEYS = "schema rule_set verdict filter verifications offset_nm once_per_rev integrity advice".split()
VERIFICATION_KEYS = (
    "run direction mean_nm std_nm max_abs_nm min_abs_nm slope_nm_per_deg intercept_nm samples angle_from_deg "
    "angle_to_deg max_speed_deg_s below_max above_min steady verdict why"
).split()


def test_the_json_is_the_interfaces_json():
    found = tb038.evaluate(records.three()).to_dict()
    assert list(found) == KEYS
    assert list(found["verifications"][0]) == VERIFICATION_KEYS
    assert list(found["filter"]) == ["poles", "cutoff_hz", "passes", "text", "verdict_depends_on_it"]
    assert list(found["once_per_rev"]) == ["amplitude_nm", "prominent", "identifiable"]
    assert found["schema"] == 1
    assert json.loads(json.dumps(found, allow_nan=False)) == found
    order = [(v["run"], v["direction"]) for v in found["verifications"]]
    assert order == [(f"run{k}.csv", way) for k in (1, 2, 3) for way in ("increasing", "decreasing")]


def test_a_verification_without_samples_holds_null_and_no_number():
    found = tb038.evaluate(records.three(motion={"reach_deg": 2.0})).to_dict()["verifications"][0]
    assert found["samples"] == 0
    for key in set(VERIFICATION_KEYS) - {"run", "direction", "samples", "verdict", "why"}:
        assert found[key] is None


def test_the_figures_of_a_plain_record_are_the_ones_put_in():
    check = tb038.evaluate([records.run(level_nm=0.8, offset_nm=0.1, slope_nm_per_deg=0.002, noise_nm=0.0)])
    up, down = check.verifications
    # The filter rounds the reversal 0.75 s before the window: exp(-26.6 * 0.75) * 1.6 Nm is 3e-9 Nm.
    tolerance = 1e-7
    assert up.mean_nm == pytest.approx(0.9, abs=tolerance)
    assert down.mean_nm == pytest.approx(0.7, abs=tolerance)
    for v, way in ((up, 1.0), (down, -1.0)):
        assert v.slope_nm_per_deg == pytest.approx(0.002, abs=tolerance)
        assert v.intercept_nm == pytest.approx(0.1 + way * 0.8, abs=tolerance)
        # A line of slope s over a window of width 90 has the deviation s * 90 / sqrt(12); samples end 0.04 deg early.
        assert v.std_nm == pytest.approx(0.002 * 90.0 / np.sqrt(12.0), rel=1e-3)
        assert v.angle_from_deg == pytest.approx(-way * 45.0, abs=0.04)
        assert v.angle_to_deg == pytest.approx(way * 45.0, abs=0.04)
        assert v.max_speed_deg_s == pytest.approx(20.0, abs=0.01)
    assert check.offset_nm == pytest.approx(0.1, abs=tolerance)


def test_force_times_link_distance_is_the_torque():
    by_torque = tb038.evaluate(records.three())
    by_force = tb038.evaluate(
        [luztar.Run(time=r.time_s, angle=r["angle"], force=r["torque"] / 0.4, name=r.name) for r in records.three()],
        link_distance_m=0.4,
    )
    for a, b in zip(by_torque.verifications, by_force.verifications, strict=True):
        assert b.mean_nm == pytest.approx(a.mean_nm, rel=1e-12)  # one rounding of the product per sample


def test_torque_wins_over_force_and_the_choice_is_said():
    runs = [
        luztar.Run(time=r.time_s, angle=r["angle"], torque=r["torque"], force=9.0 * r["torque"], name=r.name)
        for r in records.three()
    ]
    check = tb038.evaluate(runs)
    assert check.verifications[0].mean_nm == tb038.evaluate(records.three()).verifications[0].mean_nm
    assert any("torque is used" in f["text"] for f in check.integrity[0]["findings"])


def test_centring_takes_the_hysteresis_centre_off_and_shows_both():
    runs = records.three(offset_nm=0.65)
    recorded = tb038.evaluate(runs)
    centred = tb038.evaluate(runs, centre=True)
    assert recorded.verdict == "fail"
    assert any("Annex I 13" in sentence for sentence in recorded.advice)
    assert not any("Annex I 18" in sentence for sentence in recorded.advice)
    assert centred.verdict == "pass"
    assert centred.as_recorded.verdict == "fail"
    assert centred.to_dict()["as_recorded"]["verdict"] == "fail"
    assert "as_recorded" not in recorded.to_dict()
    assert centred.offset_nm == recorded.offset_nm == pytest.approx(0.65, abs=0.01)
    assert "As recorded: FAIL" in str(centred)
    json.dumps(centred.to_dict(), allow_nan=False)


def test_too_much_friction_points_to_the_thumb_screws():
    check = tb038.evaluate(records.three(level_nm=2.0))
    assert any("thumb screws" in s and "Annex I 18" in s for s in check.advice)


@pytest.mark.parametrize(
    ("reach", "kinds", "prominent", "identifiable"),
    [
        (60.0, {}, False, False),
        (60.0, {"once_per_turn_nm": 0.3}, True, False),
        (60.0, {"slope_nm_per_deg": 0.005}, True, False),
        (60.0, {"once_per_turn_nm": 0.05}, False, False),
        (185.0, {"once_per_turn_nm": 0.3}, True, True),
        (185.0, {"slope_nm_per_deg": 0.002}, False, True),
        (185.0, {"slope_nm_per_deg": 0.002, "once_per_turn_nm": 0.15}, True, True),
    ],
)
def test_a_once_per_turn_pattern_is_seen_and_told_from_a_spring_only_over_a_wide_range(
    reach, kinds, prominent, identifiable
):
    check = tb038.evaluate(records.three(motion={"reach_deg": reach, "speed_deg_s": 30.0}, **kinds))
    found = check.once_per_rev
    assert (found.prominent, found.identifiable) == (prominent, identifiable), found
    if "once_per_turn_nm" in kinds:
        # White noise of 0.02 Nm at 500 Hz leaves about 0.002 Nm on an amplitude from +-60 deg.
        assert found.amplitude_nm == pytest.approx(kinds["once_per_turn_nm"], abs=0.01)
    assert any("Annex I 12" in sentence for sentence in check.advice) is prominent
    if prominent and not identifiable:
        assert any("-180 to 180" in sentence for sentence in check.advice)


def test_a_check_is_frozen_and_survives_pickle():
    check = tb038.evaluate(records.three())
    with pytest.raises(dataclasses.FrozenInstanceError):
        check.verdict = "fail"
    assert pickle.loads(pickle.dumps(check)).to_dict() == check.to_dict()
    with pytest.raises(ValueError):
        check.traces[0].torque_nm[0] = 1.0


def test_a_check_prints_its_table_its_limits_and_the_list_to_tick():
    text = str(tb038.evaluate(records.three()))
    for words in ("PASS", "run3.csv", "decreasing", "2.2.4", "6 Hz", "[ ]", "Annex I 9", "free mode"):
        assert words in text


def test_names_from_files_are_escaped_in_html():
    runs = [records.run(k, name=f"<script>{k}") for k in (1, 2, 3)]
    html = tb038.evaluate(runs)._repr_html_()
    assert "<script>" not in html
    assert "&lt;script&gt;1" in html


def test_the_figure_shows_traces_trends_and_limits():
    figure = tb038.evaluate(records.three()).figure()
    names = [trace.name for trace in figure.data]
    assert "run1.csv increasing" in names and "run3.csv decreasing trend" in names
    assert sorted({shape.y0 for shape in figure.layout.shapes}) == [-1.5, -0.2, 0.2, 1.5]


def test_a_figure_of_many_crossings_stays_small_and_keeps_its_extremes():
    check = tb038.evaluate([records.run(motion={"crossings": 24})])
    figure = check.figure()
    rising = [trace for trace in figure.data if trace.name == "run1.csv increasing"]
    assert sum(len(trace.x) for trace in rising) <= 2100
    assert max(max(trace.y) for trace in rising) == check.verifications[0].max_abs_nm


def test_the_same_torque_under_several_names_is_said():
    runs = [records.run(1, name=name) for name in ("a.csv", "b.csv", "c.csv")]
    check = tb038.evaluate(runs)
    assert any("a.csv and b.csv hold the same torque" in sentence for sentence in check.advice)


def test_importing_tb038_loads_neither_scipy_nor_plotly_nor_pandas():
    code = (
        "import sys, luztar; luztar.tb038.evaluate; "
        "print([m for m in ('scipy', 'plotly', 'pandas', 'jinja2') if m in sys.modules])"
    )
    assert (
        subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True).stdout.strip() == "[]"
    )


def test_a_loop_that_runs_the_wrong_way_behind_a_large_offset_is_doubted():
    # Negative friction of 0.3 Nm under an offset of 0.9 Nm: only one direction shows it.
    check = tb038.evaluate(records.three(level_nm=-0.3, offset_nm=0.9))
    assert check.verdict == "fail"
    assert any("wrong way" in sentence for sentence in check.advice)
    with pytest.raises(luztar.errors.MeasurementError, match="torque sign reversed"):
        tb038.evaluate(records.three(level_nm=-0.3, offset_nm=0.9), centre=True)


def test_a_load_cell_on_an_adc_channel_is_mapped_and_scaled(tmp_path):
    paths = []
    for seed in (1, 2, 3):
        t, angle, sign = records.turning()
        force = records.torque(angle, sign, seed=seed) / 0.52
        path = tmp_path / f"run{seed}.csv"
        records.write_csv(path, t, angle, force, head="time_s,SR Angle (deg),ADC6 (N)")
        paths.append(path)
    by_torque = tb038.evaluate(luztar.read(*paths, map={"angle": "SR Angle", "torque": "ADC6*0.52"}))
    by_force = tb038.evaluate(luztar.read(*paths, map={"angle": "SR Angle", "force": "ADC6"}))
    assert by_torque.verdict == by_force.verdict == "pass"
    for a, b in zip(by_torque.verifications, by_force.verifications, strict=True):
        assert a.mean_nm == pytest.approx(b.mean_nm, rel=1e-12)  # one rounding of the product per sample


def test_advice_on_the_centre_does_not_take_a_direction_for_an_offset():
    (sentence,) = [s for s in tb038.evaluate(records.three(offset_nm=0.3)).advice if "centred" in s]
    assert "nothing attached (Annex I 9)" in sentence and "Annex I 13" in sentence
    assert "differs between the directions" in sentence


def test_the_figure_shows_both_limits_and_takes_no_name_for_a_tag():
    runs = [records.run(seed, name=f"<b>{seed}</b> & co.csv") for seed in (1, 2, 3)]
    picture = tb038.evaluate(runs).figure()
    low, high = picture.layout.yaxis.range
    assert low < -1.5 and high > 1.5
    assert all("<" not in trace.name and "&amp; co" in trace.name for trace in picture.data)
    tall = tb038.evaluate(records.three(level_nm=2.5)).figure()
    assert tall.layout.yaxis.range[1] > 2.5 and tall.layout.yaxis.range[0] < -2.5
