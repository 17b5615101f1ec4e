import copy
import pickle

import numpy as np
import pandas as pd
import pytest

import luztar
from luztar.errors import MeasurementError, ParameterError

TIME = np.arange(101) / 100
ANGLE = np.linspace(-50.0, 50.0, 101)
SI = {"angle": "rad", "torque": "Nm"}
TORQUE = np.full(101, 0.8) + 0.01 * TIME


def make(**changes):
    given = {"time": TIME, "angle": ANGLE, "torque": TORQUE, "units": {"angle": "deg", "torque": "Nm"}, "name": "run 1"}
    return luztar.Run(**{**given, **changes})


def test_a_run_from_arrays_is_in_si():
    run = make()
    np.testing.assert_allclose(run["angle"], np.deg2rad(ANGLE), rtol=1e-15)
    assert (run.name, run.source, run.sha256, len(run)) == ("run 1", "arrays", None, 101)
    assert (run.sample_rate_hz, run.duration_s) == (100.0, 1.0)
    assert "angle" in run
    assert "force" not in run
    assert run.integrity.units["angle"] == ("deg", "rad")


def test_a_run_may_be_given_by_its_sample_rate():
    run = luztar.Run(sample_rate_hz=500, angle=[0.0, 1.0, 2.0])
    assert run.time_s.tolist() == [0.0, 0.002, 0.004]


def test_arrays_are_copies_that_nobody_can_write():
    angle = ANGLE.copy()
    run = luztar.Run(time=TIME, angle=angle)
    angle[0] = 7.0
    assert run["angle"][0] == -50.0
    with pytest.raises(ValueError, match="read-only"):
        run["angle"][0] = 1.0
    with pytest.raises(TypeError):
        run.channels["angle"] = angle
    with pytest.raises(AttributeError):
        run.name = "other"


@pytest.mark.parametrize(
    ("arguments", "where"),
    [
        ({"time": TIME}, "channels"),
        ({"angle": ANGLE}, "time"),
        ({"time": TIME, "sample_rate_hz": 100, "angle": ANGLE}, "time"),
        ({"time": TIME, "angle": ANGLE[1:]}, "angle"),
        ({"time": TIME, "pace": ANGLE}, "pace"),
        ({"time": TIME, "angle": ANGLE.astype(complex)}, "angle"),
        ({"time": TIME, "angle": ANGLE.reshape(1, -1)}, "angle"),
        ({"time": [0.0], "angle": [1.0]}, "time"),
        ({"sample_rate_hz": 0, "angle": ANGLE}, "sample_rate_hz"),
        ({"sample_rate_hz": float("nan"), "angle": ANGLE}, "sample_rate_hz"),
        ({"time": TIME, "angle": ANGLE, "units": {"pace": "m"}}, "units"),
    ],
)
def test_arguments_that_make_no_run_are_named(arguments, where):
    with pytest.raises(ParameterError) as caught:
        luztar.Run(**arguments)
    assert caught.value.where == where


def test_a_unit_of_the_wrong_quantity_is_refused():
    with pytest.raises(MeasurementError, match="measures angle"):
        make(units={"torque": "deg"})


def test_a_missing_channel_names_those_found_and_the_way_out():
    with pytest.raises(MeasurementError) as caught:
        make()["force"]
    assert "angle, torque" in caught.value.kind
    assert "--map force" in caught.value.remedy


def test_a_run_can_be_pickled_and_copied():
    for twin in (pickle.loads(pickle.dumps(make())), copy.deepcopy(make())):
        assert (twin["angle"] == make()["angle"]).all()
        assert not twin["angle"].flags.writeable


def test_values_that_are_not_finite_keep_their_place():
    torque = TORQUE.copy()
    torque[[3, 50]] = np.nan, np.inf
    found = make(torque=torque).integrity.doubtful
    assert [(f.kind, f.from_s) for f in found] == [("not_finite", 0.03), ("not_finite", 0.5)]


def test_a_slice_keeps_its_ends_and_the_findings_that_touch_it():
    torque = TORQUE.copy()
    torque[50] = np.nan
    run = make(torque=torque)
    part = run.slice(0.2, 0.4)
    assert (part.time_s[0], part.time_s[-1], len(part)) == (0.2, 0.4, 21)
    assert part.integrity.findings == ()
    assert len(run.slice(0.4).integrity.doubtful) == 1
    with pytest.raises(MeasurementError, match="0 samples"):
        run.slice(3.0, 4.0)


def test_a_run_is_split_where_its_time_breaks():
    time = np.concatenate((TIME[:40], TIME[45:70], TIME[70:] - 0.5))
    keep = np.concatenate((np.arange(40), np.arange(45, 101)))
    run = luztar.Run(time=time, angle=ANGLE[keep], name="a.csv")
    parts = run.split_at_gaps()
    assert parts.names == ("a.csv#1", "a.csv#2", "a.csv#3")
    assert [len(p) for p in parts] == [40, 25, 31]
    assert all(p.sample_rate_hz == pytest.approx(100.0) for p in parts)
    assert make().split_at_gaps().names == ("run 1",)


def uneven(rng=None):
    rng = rng or np.random.default_rng(2)
    time = np.cumsum(rng.uniform(0.006, 0.014, 500))
    return luztar.Run(time=time, angle=3.0 * time + 1.0, torque=np.sin(time), name="bus.csv", units=SI)


def test_an_uneven_run_asks_to_be_resampled():
    with pytest.raises(MeasurementError) as caught:
        uneven().require_even()
    assert "resample" in caught.value.remedy
    with pytest.raises(MeasurementError):
        _ = uneven().sample_rate_hz


@pytest.mark.parametrize(("method", "tolerance"), [("linear", 3e-5), ("pchip", 1e-5)])
def test_resampling_keeps_a_line_and_follows_a_curve(method, tolerance):
    run = uneven().resample(200, method=method)
    assert run.sample_rate_hz == pytest.approx(200.0)
    np.testing.assert_allclose(run["angle"], 3.0 * run.time_s + 1.0, rtol=1e-13)
    # Straight lines are off by h^2/8 at most, h = 14 ms; the cubic by less except at the sine's turning points.
    assert np.abs(run["torque"] - np.sin(run.time_s)).max() < tolerance
    assert "resampled from about" in run.integrity.findings[0].text


def test_resampling_to_its_own_rate_changes_nothing():
    run = make()
    again = run.resample(100)
    assert len(again) == len(run)
    np.testing.assert_allclose(again["angle"], run["angle"], atol=1e-14)


def test_resampling_refuses_gaps_and_unknown_methods():
    gap = luztar.Run(time=np.delete(TIME, slice(40, 50)), angle=np.delete(ANGLE, slice(40, 50)))
    with pytest.raises(MeasurementError, match="split_at_gaps"):
        gap.resample(100)
    with pytest.raises(ParameterError, match="linear or pchip"):
        make().resample(100, method="cubic")
    with pytest.raises(ParameterError):
        make().resample(-1)
    torque = TORQUE.copy()
    torque[50] = np.nan
    with pytest.raises(MeasurementError, match="not finite"):
        make(torque=torque).resample(200, method="pchip")
    assert np.isnan(make(torque=torque).resample(200)["torque"]).any()


def test_runs_are_an_immutable_sequence_with_names_that_differ():
    runs = luztar.Runs([make(), make(), make(name="b")])
    assert runs.names == ("run 1", "run 1 (2)", "b")
    assert runs["b"] is runs[2]
    assert isinstance(runs[:2], luztar.Runs)
    assert len(runs + [make(name="c")]) == 4
    assert runs.complete
    with pytest.raises(AttributeError):
        runs.other = 1
    with pytest.raises(MeasurementError, match="no run 'z'"):
        runs["z"]
    with pytest.raises(ParameterError):
        luztar.Runs([1])
    assert pickle.loads(pickle.dumps(runs)).names == runs.names


def test_printing_escapes_what_came_from_a_file():
    hostile = "<script>alert(1)</script>"
    run = make(name=hostile)
    for shown in (run._repr_html_(), luztar.Runs([run])._repr_html_()):
        assert "<script>" not in shown
        assert "&lt;script&gt;" in shown
    assert "100 Hz" in repr(run)
    assert "complete" in repr(luztar.Runs([run]))


def test_a_frame_is_read_like_a_file():
    frame = pd.DataFrame({"Zeit [ms]": 1000 * TIME, "SR Angle (deg)": ANGLE, "ADC6": TORQUE})
    run = luztar.read_frame(frame, map={"torque": "ADC6"}, units={"torque": "Nm"}, name="bench")
    assert run.name == "bench"
    np.testing.assert_allclose(run["angle"], np.deg2rad(ANGLE), rtol=1e-15)
    assert run.sample_rate_hz == 100.0
    indexed = frame.set_index("Zeit [ms]")
    assert luztar.read_frame(indexed, map={"torque": "ADC6"}, units={"torque": "Nm"}).sample_rate_hz == 100.0
    assert luztar.read_frame({"time_s": TIME, "angle_deg": ANGLE}).sample_rate_hz == 100.0


@pytest.mark.parametrize(
    ("column", "kind"),
    [
        (["a", "b"], "type"),
        (pd.to_datetime(["2026-01-01", "2026-01-02"]), "type"),
        (np.array([1j, 2j]), "type"),
    ],
)
def test_a_frame_column_that_is_no_number_is_named(column, kind):
    with pytest.raises(MeasurementError) as caught:
        luztar.read_frame(pd.DataFrame({"time_s": [0.0, 1.0], "angle_deg": column}))
    assert kind in caught.value.kind
    assert "'angle_deg'" in caught.value.where


def test_a_nullable_column_keeps_its_missing_values():
    frame = pd.DataFrame({"time_s": [0.0, 1.0, 2.0], "angle_deg": pd.array([1, None, 3], dtype="Int64")})
    assert np.isnan(luztar.read_frame(frame)["angle"]).tolist() == [False, True, False]


def test_importing_the_package_loads_neither_pandas_nor_scipy():
    import subprocess
    import sys

    code = "import luztar, sys; luztar.Run; luztar.read; print([m for m in ('pandas', 'scipy') if m in sys.modules])"
    out = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert out.stdout.strip() == "[]"


def test_a_unit_that_nobody_gave_is_a_finding():
    (found,) = luztar.Run(time=TIME, angle=np.deg2rad(ANGLE), torque=TORQUE).integrity.findings
    assert (found.kind, found.doubtful) == ("unit_assumed", False) and "angle in rad, torque in Nm" in found.text
    assert luztar.Run(time=TIME, angle=np.deg2rad(ANGLE), torque=TORQUE, units=SI).integrity.findings == ()
    (_, doubt) = luztar.Run(time=TIME, angle=ANGLE, torque=TORQUE, units={"torque": "Nm"}).integrity.findings
    assert (doubt.channel, doubt.doubtful) == ("angle", True) and "'deg'" in doubt.text
