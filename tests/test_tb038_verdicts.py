"""The table of edge cases of TB 038: what is done to three sound records, and the verdict that must come out.

docs/tb038.md shows the same table with the reasons.
"""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import luztar
import tb038_records as records
from luztar import tb038
from luztar.errors import MeasurementError, ParameterError


def with_one_changed(change, **kinds) -> list[luztar.Run]:
    """Return three records of which the second has been changed by ``change(t, angle, torque)``."""
    first, _, third = records.three(**kinds)
    t, angle, sign = records.turning()
    torque = records.torque(angle, sign, seed=2, **kinds)
    return [first, records.as_run(*change(t, angle, torque), name="run2.csv"), third]


def nan_while_increasing(t, angle, torque):
    # The first motion runs upwards and passes 0 deg once.
    torque = torque.copy()
    torque[np.flatnonzero(angle > 0.0)[0]] = np.nan
    return t, angle, torque


def nan_beyond_the_window(t, angle, torque):
    torque = torque.copy()
    torque[np.flatnonzero(angle > 57.0)[0]] = np.nan
    return t, angle, torque


def nan_at_the_edge(t, angle, torque):
    # 46 deg is 0.05 s before the window at 20 deg/s: less than one period of 6 Hz.
    angle = angle.copy()
    turned = np.flatnonzero(angle >= 60.0)[-1]
    decreasing = np.flatnonzero((np.arange(angle.size) > np.flatnonzero(angle >= 60.0)[0]) & (angle < 46.0))[0]
    assert decreasing < turned
    angle[decreasing] = np.nan
    return t, angle, torque


def gap_in_the_window(t, angle, torque):
    keep = (t < 3.0) | (t > 3.4)
    return t[keep], angle[keep], torque[keep]


def gap_over_a_whole_crossing(t, angle, torque):
    # The second motion, downwards, is lost from before the window to behind it.
    keep = (t < 7.05) | (t > 12.9)
    return t[keep], angle[keep], torque[keep]


def ends_in_the_first_motion(t, angle, torque):
    keep = angle <= 20.0
    n = np.flatnonzero(~keep)[0]
    return t[:n], angle[:n], torque[:n]


def jittered_clock(t, angle, torque):
    rng = np.random.default_rng(5)
    return t + rng.uniform(-0.45, 0.45, t.size) / records.RATE_HZ, angle, torque


def clock_runs_back(t, angle, torque):
    t = t.copy()
    i = np.flatnonzero(angle > 0.0)[0]
    t[i] = t[i - 2]
    return t, angle, torque


def turns_back_inside(t, angle, torque):
    # Three degrees back and forth again at 0 deg, at the speed of the motion.
    i = np.flatnonzero(angle > 0.0)[0]
    n = round(3.0 / 20.0 * records.RATE_HZ)
    back = angle[i] - 3.0 * np.concatenate((np.arange(1, n + 1), np.arange(n - 1, -1, -1))) / n
    angle = np.concatenate((angle[: i + 1], back, angle[i + 1 :]))
    torque = np.concatenate((torque[: i + 1], np.full(back.size, torque[i]), torque[i + 1 :]))
    return np.arange(angle.size) / records.RATE_HZ, angle, torque


def rests_with_little_torque(t, angle, torque):
    # A fifth of the window's samples at rest, where the hand holds the wheel with a third of the friction level.
    i = np.flatnonzero(angle > 0.0)[0]
    n = round(1.5 * records.RATE_HZ)
    angle = np.concatenate((angle[: i + 1], np.full(n, angle[i]), angle[i + 1 :]))
    torque = np.concatenate((torque[: i + 1], np.full(n, torque[i] / 3.0), torque[i + 1 :]))
    return np.arange(angle.size) / records.RATE_HZ, angle, torque


def clipped_torque(t, angle, torque):
    inside = np.abs(angle) < 20.0
    out = torque.copy()
    out[inside] = np.clip(torque[inside] * 1.3, -0.85, 0.85)
    top = torque.copy()
    top[inside & (torque > 0.0)] = torque.max() + 0.05
    return t, angle, top


SOUND = dict(level_nm=0.8)

#  what is done, the runs, the verdict, verdicts per verification (p, f, i), words that must stand in a reason
CASES = [
    ("sound", lambda: records.three(**SOUND), "pass", "pp pp pp", ""),
    ("level just below the upper limit", lambda: records.three(level_nm=1.49), "pass", "pp pp pp", ""),
    ("level just above the upper limit", lambda: records.three(level_nm=1.51), "fail", "ff ff ff", "exceeds 1.5"),
    ("level just above the lower limit", lambda: records.three(level_nm=0.21), "pass", "pp pp pp", ""),
    ("level just below the lower limit", lambda: records.three(level_nm=0.19), "fail", "ff ff ff", "not exceed 0.2"),
    ("standard deviation just below its limit", lambda: records.three(ripple_nm=0.55), "pass", "pp pp pp", ""),
    ("standard deviation just above its limit", lambda: records.three(ripple_nm=0.60), "fail", "ff ff ff", "0.4"),
    ("offset that pushes one direction out", lambda: records.three(offset_nm=0.65), "fail", "pf pf pf", "0.2"),
    ("offset that pushes the other out", lambda: records.three(level_nm=1.2, offset_nm=0.4), "fail", "fp fp fp", "1.5"),
    (
        "start inside the window",
        lambda: [*records.three()[:2], records.run(3, motion={"start_deg": -30.0})],
        "inconclusive",
        "pp pp ip",
        "starts at -30.0 deg",
    ),
    (
        "start at exactly -45 deg",
        lambda: [*records.three()[:2], records.run(3, motion={"start_deg": -45.0})],
        "inconclusive",
        "pp pp ip",
        "2.2.8",
    ),
    (
        "start just beyond -45 deg",
        lambda: [*records.three()[:2], records.run(3, motion={"start_deg": -45.5})],
        "pass",
        "pp pp pp",
        "",
    ),
    ("turned to 40 deg only", lambda: records.three(motion={"reach_deg": 40.0}), "inconclusive", "ii ii ii", "no full"),
    ("one file", lambda: records.three()[:1], "inconclusive", "pp", ""),
    ("two files", lambda: records.three()[:2], "inconclusive", "pp pp", ""),
    ("two files, one fails", lambda: [records.run(1), records.run(2, level_nm=2.0)], "fail", "pp ff", "exceeds"),
    ("four files", lambda: [*records.three(), records.run(4)], "pass", "pp pp pp pp", ""),
    ("one run too high", lambda: [*records.three()[:2], records.run(3, level_nm=1.8)], "fail", "pp pp ff", "exceeds"),
    (
        "one sample missing, increasing",
        lambda: with_one_changed(nan_while_increasing),
        "inconclusive",
        "pp ip pp",
        "unr",
    ),
    ("one sample missing beyond the window", lambda: with_one_changed(nan_beyond_the_window), "pass", "pp pp pp", ""),
    ("one sample missing at the edge", lambda: with_one_changed(nan_at_the_edge), "inconclusive", "pp pi pp", "broken"),
    ("a gap in the window", lambda: with_one_changed(gap_in_the_window), "inconclusive", "pp ip pp", "break"),
    (
        "a gap over one crossing",
        lambda: with_one_changed(gap_over_a_whole_crossing),
        "inconclusive",
        "pp pi pp",
        "break",
    ),
    (
        "record ends in the window",
        lambda: with_one_changed(ends_in_the_first_motion),
        "inconclusive",
        "pp ii pp",
        "no f",
    ),
    ("unsteady sampling", lambda: with_one_changed(jittered_clock), "inconclusive", "pp ii pp", "resample"),
    ("the clock runs back", lambda: with_one_changed(clock_runs_back), "inconclusive", "pp ip pp", "break"),
    ("turned back inside", lambda: with_one_changed(turns_back_inside), "inconclusive", "pp ip pp", "turned back"),
    (
        "rest decides the verdict",
        lambda: with_one_changed(rests_with_little_torque, level_nm=1.55),
        "fail",
        "ff if ff",
        "rested",
    ),
    ("clipped torque", lambda: with_one_changed(clipped_torque), "inconclusive", "pp ip pp", "clipped"),
    ("too fast", lambda: records.three(motion={"speed_deg_s": 45.0}), "inconclusive", "ii ii ii", "45.0 deg/s"),
    ("at exactly 40 deg/s", lambda: records.three(motion={"speed_deg_s": 40.0}), "pass", "pp pp pp", ""),
    ("once per turn", lambda: records.three(once_per_turn_nm=0.3), "pass", "pp pp pp", ""),
    (
        "radians taken for degrees",
        lambda: [
            luztar.Run(time=r.time_s, angle=r["angle"], torque=r["torque"], units={"angle": "deg"}, name=r.name)
            for r in records.three()
        ],
        "inconclusive",
        "ii ii ii",
        "no full",
    ),
    (
        "fails where readable, doubtful elsewhere",
        lambda: with_one_changed(nan_while_increasing, level_nm=2.0),
        "fail",
        "ff if ff",
        "unreadable",
    ),
]


@pytest.mark.parametrize(("runs", "verdict", "each", "words"), [c[1:] for c in CASES], ids=[c[0] for c in CASES])
def test_every_edge_case_gets_its_verdict(runs, verdict, each, words):
    check = tb038.evaluate(runs())
    found = "".join(v.verdict[0] for v in check.verifications)
    assert found == each.replace(" ", ""), str(check)
    assert check.verdict == verdict
    reasons = [v.why for v in check.verifications if v.why]
    if words:
        assert any(words in why for why in reasons), reasons
    for v in check.verifications:
        assert (v.why is None) == (v.verdict == "pass")
    # The JSON interface holds no NaN, and what is printed is not empty.
    json.dumps(check.to_dict(), allow_nan=False)
    assert check.verdict.upper() in str(check)


def test_a_reversed_torque_is_an_error_with_the_remedy():
    runs = records.three()
    turned = records.as_run(runs[1].time_s, np.rad2deg(runs[1]["angle"]), -runs[1]["torque"], "run2.csv")
    with pytest.raises(MeasurementError, match="torque sign reversed") as caught:
        tb038.evaluate([runs[0], turned, runs[2]])
    assert caught.value.where == "run2.csv"
    assert "--map" in caught.value.remedy


def test_a_torque_in_newton_millimetres_is_not_passed_and_the_unit_is_doubted():
    runs = [records.as_run(r.time_s, np.rad2deg(r["angle"]), 1000.0 * r["torque"], r.name) for r in records.three()]
    check = tb038.evaluate(runs)
    assert check.verdict == "fail"
    assert any("unit" in sentence for sentence in check.advice)


def test_a_file_cut_in_the_middle_of_a_line_is_inconclusive(tmp_path):
    paths = []
    for seed in (1, 2, 3):
        t, angle, sign = records.turning()
        path = tmp_path / f"run{seed}.csv"
        records.write_csv(path, t, angle, records.torque(angle, sign, seed=seed))
        paths.append(path)
    assert tb038.evaluate(luztar.read(*paths)).verdict == "pass"
    text = paths[2].read_bytes()
    paths[2].write_bytes(text[: round(0.9 * len(text)) // 10 * 10 - 3])
    runs = luztar.read(*paths)
    check = tb038.evaluate(runs)
    assert check.verdict == "inconclusive"
    assert [v.verdict for v in check.verifications[4:]] == ["inconclusive", "inconclusive"]
    assert "not complete" in check.verifications[4].why


def test_one_file_given_three_times_is_one_test(tmp_path):
    t, angle, sign = records.turning()
    path = tmp_path / "run1.csv"
    records.write_csv(path, t, angle, records.torque(angle, sign))
    check = tb038.evaluate(luztar.read(path, path, path))
    assert check.verdict == "inconclusive"
    assert any("there is 1" in sentence for sentence in check.advice)


def test_an_unknown_unit_is_refused_before_any_verdict(tmp_path):
    t, angle, sign = records.turning(crossings=2)
    path = tmp_path / "run1.csv"
    records.write_csv(path, t, angle, records.torque(angle, sign), head="time_s,angle_deg,torque_furlong")
    with pytest.raises(MeasurementError):
        tb038.evaluate(luztar.read(path))


def test_no_runs_and_a_negative_link_distance_are_refused():
    with pytest.raises(ParameterError):
        tb038.evaluate([])
    for bad in (0.0, -0.52, float("nan"), float("inf"), "long"):
        with pytest.raises(ParameterError):
            tb038.evaluate(records.three(), link_distance_m=bad)


def test_a_run_without_torque_and_force_is_refused():
    t, angle, _ = records.turning()
    with pytest.raises(MeasurementError, match="neither torque nor force"):
        tb038.evaluate([luztar.Run(time=t, angle=angle, units={"angle": "deg"})])


def test_the_page_in_docs_shows_this_table():
    page = (Path(__file__).parents[1] / "docs" / "tb038.md").read_text(encoding="utf-8")
    table = page[page.index("| case | verdict |") :].split("\n\n")[0].splitlines()[2:]
    shown = [tuple(cell.strip() for cell in row.strip("|").split("|"))[:3] for row in table]
    assert shown == [(name, verdict, each) for name, _, verdict, each, _ in CASES]


@settings(max_examples=60, deadline=None, derandomize=True)
@given(
    kind=st.sampled_from(["torque", "angle", "time", "cut out", "cut off", "shift", "scramble", "thin"]),
    where=st.floats(0.0, 0.99),
    width=st.integers(1, 400),
    level=st.sampled_from([0.1, 1.7]),
)
def test_no_damage_turns_a_failing_run_into_a_pass(kind, where, width, level):
    t, angle, sign = records.turning(rate_hz=100.0)
    torque = records.torque(angle, sign, level_nm=level)
    start = round(where * t.size)
    part = slice(start, start + width)
    keep = np.ones(t.size, bool)
    if kind == "torque":
        torque[part] = np.nan
    elif kind == "angle":
        angle[part] = np.nan
    elif kind == "time":
        t[part] = np.nan
    elif kind == "cut out":
        keep[part] = False
    elif kind == "cut off":
        keep[max(start, 10) :] = False
    elif kind == "shift":
        t[part] += 0.01 * width
    elif kind == "scramble":
        t[part] = t[part][::-1]
    else:
        keep[:] = np.random.default_rng(width).random(t.size) < 0.7
    try:
        damaged = records.as_run(t[keep], angle[keep], torque[keep])
    except MeasurementError:
        return
    for v in tb038.evaluate([damaged]).verifications:
        assert v.verdict in ("fail", "inconclusive")


def test_a_torque_of_pure_noise_is_not_called_reversed():
    for seed in range(20):
        runs = [records.run(3 * seed + k, level_nm=0.0, noise_nm=0.0003) for k in range(3)]
        assert tb038.evaluate(runs).verdict == "fail"


def test_friction_that_is_clearly_negative_is_reversed_whatever_its_ripple():
    for ripple_nm in (0.0, 0.5):
        with pytest.raises(MeasurementError, match="torque sign reversed"):
            tb038.evaluate(records.three(level_nm=-0.5, ripple_nm=ripple_nm))


def test_many_crossings_that_are_too_fast_are_one_finding_with_the_worst():
    fast = records.run(1, motion={"crossings": 8, "speed_deg_s": 46.0})
    found = tb038.evaluate([fast]).verifications[0]
    assert found.why.count("deg/s inside the window") == 1
    assert "(the worst of 4 such crossings)" in found.why
