import codecs
import gzip

import numpy as np
import pandas as pd
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

import luztar
from luztar.errors import MeasurementError
from measurement_files import ROWS, rows_text, shared

T, A, M = (np.array(column) for column in zip(*ROWS, strict=True))
ANGLE = np.deg2rad(A)

DIALECTS = {
    "name_unit": "time_s,angle_deg,torque_Nm\n" + rows_text(),
    "name [unit]": "Time [s],Angle [deg],Torque [Nm]\n" + rows_text(),
    "name (unit)": "time (s),angle (deg),torque (N*m)\n" + rows_text(),
    "name / unit": "Zeit / s;Lenkwinkel / °;Moment / Nm\n" + rows_text(";", ","),
    "units in a second row": "time;angle;torque\ns;deg;Nm\n" + rows_text(";"),
    "units in brackets in a second row": "time\tangle\ttorque\n[s]\t[°]\t[N·m]\n" + rows_text("\t"),
    "semicolons and decimal commas": "time_s;angle_deg;torque_Nm\n" + rows_text(";", ","),
    "tabs and decimal commas": "time_s\tangle_deg\ttorque_Nm\n" + rows_text("\t", ","),
    "quoted decimal commas": "time_s,angle_deg,torque_Nm\n"
    + "".join(",".join(f'"{v:.4f}"'.replace(".", ",") for v in row) + "\n" for row in ROWS),
    "quoted names": '"time_s","angle_deg","torque_Nm"\n' + rows_text(),
    "German names": "Zeit [s];Lenkwinkel [Grad];Lenkmoment [Nm]\n" + rows_text(";", ","),
    "robot names": "Time (s),SR Angle (deg),Steering Torque (Nm)\n" + rows_text(),
    "milliseconds": "time_ms,angle_deg,torque_Nm\n" + "".join(f"{1000 * t:.1f},{a:.4f},{m:.4f}\n" for t, a, m in ROWS),
    "preamble and comments": "Car 7, rig 2\nDate;21.11.2026\n\n# hand turned\ntime_s,angle_deg,torque_Nm\n"
    + rows_text(),
    "commented header": "# time_s,angle_deg,torque_Nm\n" + rows_text(),
    "trailing text": "time_s,angle_deg,torque_Nm\n" + rows_text() + "\nEnd of record\nOperator: N. N.\n",
    "trailing separators": "time_s,angle_deg,torque_Nm,\n" + rows_text(end=",\n"),
    "blanks after separators": "time_s, angle_deg, torque_Nm\n" + rows_text(", "),
    "other columns": "n,time_s,angle_deg,temperature,torque_Nm\n"
    + "".join(f"{i},{t},{a},warm,{m}\n" for i, (t, a, m) in enumerate(ROWS)),
    "a column of clock text": "clock,time_s,angle_deg,torque_Nm,state\n"
    + "".join(f"12:00:0{i},{t},{a},{m},OK\n" for i, (t, a, m) in enumerate(ROWS)),
    "blank lines between": "time_s,angle_deg,torque_Nm\n" + rows_text().replace("\n", "\n\n"),
    "exponents": "time_s,angle_deg,torque_Nm\n" + rows_text(fmt="{:.6e}"),
    "newton millimetres": "time_s,angle_deg,torque_Nmm\n" + "".join(f"{t},{a},{1000 * m}\n" for t, a, m in ROWS),
}
ENCODINGS = {
    "utf-8": lambda text: text.encode(),
    "utf-8 with mark": lambda text: codecs.BOM_UTF8 + text.encode(),
    "cp1252": lambda text: text.encode("cp1252"),
    "utf-16": lambda text: text.encode("utf-16"),
    "CRLF": lambda text: text.replace("\n", "\r\n").encode(),
    "CR": lambda text: text.replace("\n", "\r").encode(),
    "gzip": lambda text: gzip.compress(text.encode()),
}


@pytest.mark.parametrize("encoding", ENCODINGS)
@pytest.mark.parametrize("dialect", DIALECTS)
def test_every_dialect_gives_the_same_run(tmp_path, dialect, encoding):
    path = tmp_path / "run.csv"
    path.write_bytes(ENCODINGS[encoding](DIALECTS[dialect]))
    run = luztar.read(path)[0]
    np.testing.assert_allclose(run.time_s, T, rtol=1e-15)
    np.testing.assert_allclose(run["angle"], ANGLE, rtol=1e-15)
    np.testing.assert_allclose(run["torque"], M, rtol=1e-15)
    assert run.integrity.complete
    assert not run.integrity.doubtful
    assert run.sample_rate_hz == 100.0


def test_the_report_says_which_column_and_unit_a_channel_came_from(tmp_path):
    path = tmp_path / "run.csv"
    path.write_text(DIALECTS["German names"], encoding="utf-8")
    integrity = luztar.read(path)[0].integrity
    assert integrity.units == {"time": ("s", "s"), "angle": ("Grad", "rad"), "torque": ("Nm", "Nm")}
    assert integrity.columns["angle"] == "Lenkwinkel [Grad]"
    assert integrity.rows_declared is None
    assert integrity.rows_read == 5


BAD = {
    # name: (text, where, kind, remedy), each a part of what the error must say
    "empty": ("", "run.csv", "empty", "export"),
    "only a header": ("time_s,angle_deg,torque_Nm\n", "run.csv", "no row of numbers", "header"),
    "no header": (rows_text(), "line 1", "no header", "time_s,angle_deg,torque_Nm"),
    "one row": ("time_s,angle_deg\n0.0,1.0\n", "run.csv", "1 whole row", "Export"),
    "no time": ("angle_deg,torque_Nm\n1,2\n2,3\n", "run.csv", "no time column", "--map time=COLUMN"),
    "no channel": ("time_s,foo,bar\n1,2,3\n2,3,4\n", "run.csv", "'foo', 'bar'", "--map angle"),
    "two torques": (
        "time_s,Torque [Nm],Steering Torque [Nm]\n0,1,2\n1,2,3\n",
        "run.csv",
        "'Torque [Nm]', 'Steering Torque [Nm]'",
        '--map torque="Torque [Nm]"',
    ),
    "two columns of one name": ("time_s,angle_deg,angle_deg\n0,1,2\n1,2,3\n", "run.csv", "2 columns", "--map angle"),
    "no unit": ("time_s,angle,torque_Nm\n0,1,2\n1,2,3\n", "column 'angle'", "angle has no unit", "--unit angle=rad"),
    "unknown unit": ("time_s,angle [degg]\n0,1\n1,2\n", "column 'angle [degg]'", "unknown unit 'degg'", "deg"),
    "misspelt unit": ("time_s,angle_dg\n0,1\n1,2\n", "column 'angle_dg'", "unknown unit 'dg'", "deg"),
    "torque in newtons": (
        "time_s,torque_N\n0,1\n1,2\n",
        "column 'torque_N'",
        "torque is in N",
        'torque="torque_N*0.52"',
    ),
    "angle in metres": (
        "time_s,angle_m\n0,1\n1,2\n",
        "column 'angle_m'",
        "angle is in m",
        '--map angle="angle_m*FACTOR"',
    ),
    "text in a column": (
        "time_s,angle_deg\n0,1\n1,2\n2,over\n3,4\n",
        "line 4, column 'angle_deg'",
        "'over' is not a number",
        "Repair",
    ),
    "text in the first row": ("time_s,angle_deg\n0,over\n1,2\n2,3\n", "line 2, column 'angle_deg'", "'over'", "Repair"),
    "a short row": ("time_s,angle_deg\n0,1\n1\n2,3\n", "line 3", "1 fields where the header has 2", "Repair"),
    "a long row": ("time_s,angle_deg\n0,1\n1,2,3\n2,3\n", "line 3", "3 fields where the header has 2", "Repair"),
    "text between rows": ("time_s,angle_deg\n0,1\n1,2\npause\n2,3\n", "line 4", "1 fields", "Repair"),
    "decimal commas between commas": (
        "time_s,angle_deg\n0,00,1,5\n0,01,2,5\n",
        "line 2",
        "4 fields where the header (line 1) has 2",
        "semicolons",
    ),
    "both decimal marks": ("time_s;angle_deg\n0,00;1.5\n0,01;2.5\n", "lines 2 and 2", "decimal", "one decimal mark"),
    "thousands dots": (
        "time_s;angle_deg\n0,00;1,5\n0,01;1.002,5\n",
        "line 3, column 'angle_deg'",
        "'1.002,5'",
        "thousands",
    ),
    "thousands commas": (
        'time_s,angle_deg\n0.00,"1.5"\n0.01,"1,002.5"\n',
        "line 3, column 'angle_deg'",
        "'1,002.5'",
        "thousands",
    ),
    "hexadecimal": ("time_s,angle_deg\n0,1\n1,0x10\n2,3\n", "line 3", "'0x10'", "Repair"),
    "truth words": ("time_s,angle_deg\n0,1\n1,True\n2,3\n", "line 3", "'True'", "Repair"),
    "no stamps": ("time_s,angle_deg\nnan,1\nnan,2\nnan,3\n", "line 2", "fewer than two time stamps", "time column"),
}


@pytest.mark.parametrize("case", BAD)
def test_a_bad_file_is_refused_with_place_and_remedy(tmp_path, monkeypatch, case):
    text, where, kind, remedy = BAD[case]
    monkeypatch.chdir(tmp_path)
    (tmp_path / "run.csv").write_text(text)
    with pytest.raises(MeasurementError) as caught:
        luztar.read("run.csv")
    error = caught.value
    assert error.where.startswith("run.csv")
    assert where in error.where
    assert kind in error.kind
    assert remedy in error.remedy


@pytest.mark.parametrize(
    ("content", "kind"),
    [
        (b"PK\x03\x04rest", "Excel"),
        (b"MDF     4.10", "MDF"),
        (b"TDSm....", "TDMS"),
        (b"PAR1....", "Parquet"),
        (b"\x00\x01\x02\x03" * 30, "not text"),
        (b"\x1f\x8b", "truncated"),
        (gzip.compress(b"")[:12], "truncated"),
    ],
)
def test_what_is_no_text_is_called_by_its_name(tmp_path, content, kind):
    path = tmp_path / "run.csv"
    path.write_bytes(content)
    with pytest.raises(MeasurementError, match=kind):
        luztar.read(path)


def test_a_missing_file_and_a_folder_are_errors(tmp_path):
    with pytest.raises(MeasurementError, match="no such file"):
        luztar.read(tmp_path / "none.csv")
    with pytest.raises(MeasurementError, match="folder"):
        luztar.read(tmp_path)
    with pytest.raises(MeasurementError, match="no file was named"):
        luztar.read()
    with pytest.raises(MeasurementError, match="cannot be opened"):
        luztar.read("a\0b.csv")


def write(tmp_path, text, name="run.csv"):
    path = tmp_path / name
    path.write_text(text, encoding="utf-8")
    return path


def test_map_names_and_scales_a_column(tmp_path):
    path = write(tmp_path, "t_s,SR Angle (deg),ADC6 (kN)\n0,90,1\n1,180,2\n")
    run = luztar.read(path, map={"torque": "ADC6*0.52", "angle": "SR Angle*-1", "time": "t_s"})[0]
    np.testing.assert_allclose(run["torque"], [520.0, 1040.0], rtol=1e-15)
    np.testing.assert_allclose(run["angle"], [-np.pi / 2, -np.pi], rtol=1e-15)
    assert run.integrity.units["torque"] == ("kN*0.52", "Nm")
    assert run.integrity.columns["torque"] == "ADC6 (kN)*0.52"


def test_a_scaled_column_takes_the_unit_that_was_said(tmp_path):
    path = write(tmp_path, "time_s,raw\n0,10\n1,20\n")
    run = luztar.read(path, map={"angle": "raw*2"}, units={"angle": "deg"})[0]
    np.testing.assert_allclose(run["angle"], np.deg2rad([20.0, 40.0]), rtol=1e-15)
    run = luztar.read(path, map={"angle": "raw*2"})[0]
    np.testing.assert_allclose(run["angle"], [20.0, 40.0], rtol=1e-15)
    assert [f.kind for f in run.integrity.findings] == ["unit_assumed"]


def test_a_mapped_name_may_hold_a_star(tmp_path):
    path = write(tmp_path, "time_s,moment_N*m\n0,10\n1,20\n")
    assert list(luztar.read(path, map={"torque": "moment_N*m"})[0]["torque"]) == [10.0, 20.0]
    assert list(luztar.read(path, map={"torque": "moment_N*m*2"})[0]["torque"]) == [20.0, 40.0]


@pytest.mark.parametrize("factor", ["0,52", "2*3", "__import__('os')", "nan", "inf", "1e999", "0", ""])
def test_a_factor_is_one_number_and_nothing_else(tmp_path, factor):
    path = write(tmp_path, "time_s,ADC6\n0,10\n1,20\n")
    with pytest.raises(MeasurementError) as caught:
        luztar.read(path, map={"torque": f"ADC6*{factor}"})
    assert "factor" in caught.value.kind or "no column" in caught.value.kind


def test_map_and_unit_refuse_unknown_keys(tmp_path):
    path = write(tmp_path, "time_s,ADC6\n0,10\n1,20\n")
    with pytest.raises(MeasurementError, match="Did you mean torque"):
        luztar.read(path, map={"torqe": "ADC6"})
    with pytest.raises(MeasurementError, match="unknown key"):
        luztar.read(path, units={"pace": "m/s"})
    with pytest.raises(MeasurementError, match="Did you mean 'ADC6'"):
        luztar.read(path, map={"torque": "ADC66"})
    with pytest.raises(MeasurementError, match="measures force"):
        luztar.read(path, map={"torque": "ADC6"}, units={"torque": "N"})


def test_unit_fills_in_where_the_file_has_none_and_is_reported(tmp_path):
    path = write(tmp_path, "time_s,force\n0,10\n1,20\n")
    run = luztar.read(path, units={"force": "kN"})[0]
    assert list(run["force"]) == [10000.0, 20000.0]
    assert [(f.kind, f.channel) for f in run.integrity.findings] == [("unit_assumed", "force")]


def test_a_unit_that_contradicts_the_file_is_refused(tmp_path):
    path = write(tmp_path, "time_s,angle_deg\n0,10\n1,20\n")
    assert luztar.read(path, units={"angle": "°"})[0]["angle"][1] == np.deg2rad(20)
    with pytest.raises(MeasurementError, match="the file says deg, --unit says rad"):
        luztar.read(path, units={"angle": "rad"})


def test_a_declared_sample_rate_stands_in_for_time(tmp_path):
    path = write(tmp_path, "angle_deg,torque_Nm\n1,2\n2,3\n3,4\n")
    run = luztar.read(path, sample_rate_hz=250)[0]
    assert list(run.time_s) == [0.0, 0.004, 0.008]
    path = write(tmp_path, "Sample rate [Hz]: 500\nangle_deg,torque_Nm\n1,2\n2,3\n3,4\n")
    assert luztar.read(path)[0].sample_rate_hz == 500.0


def test_an_everyday_word_in_a_foreign_unit_is_left_alone_in_a_rig_file(tmp_path):
    path = write(tmp_path, "time_s,angle_deg,torque_Nm,Load [%]\n0,1,2,3\n1,2,3,4\n")
    run = luztar.read(path)[0]
    assert tuple(run.channels) == ("angle", "torque")
    assert "Load [%]" in run.integrity.findings[0].text
    with pytest.raises(MeasurementError, match=r"Load \[%\]"):
        run["load"]


def test_files_of_one_name_are_told_apart(tmp_path):
    paths = []
    for folder in ("a", "b"):
        (tmp_path / folder).mkdir()
        paths.append(write(tmp_path / folder, f"time_s,angle_deg\n0,1\n1,{len(paths)}\n"))
    runs = luztar.read(*paths)
    assert runs.names == ("a/run.csv", "b/run.csv")
    twice = luztar.read(paths[0], paths[0])
    assert twice.names == ("run.csv", "run.csv (2)")
    assert "the same bytes as run.csv" in twice[1].integrity.findings[0].text


def test_the_checksum_is_that_of_the_file(tmp_path):
    import hashlib

    path = tmp_path / "run.csv.gz"
    path.write_bytes(gzip.compress(DIALECTS["name_unit"].encode()))
    assert luztar.read(path)[0].sha256 == hashlib.sha256(path.read_bytes()).hexdigest()


def test_the_shared_rig_runs_are_whole_even_and_without_findings():
    for path in sorted(shared("measurements").glob("*/run1.csv.gz")):
        run = luztar.read(path)[0]
        assert run.sample_rate_hz == 500.0
        assert run.integrity.complete
        assert run.integrity.findings == ()
        frame = pd.read_csv(path)
        column = next(c for c in frame.columns if c != "time_s")
        key, _, unit = column.partition("_")
        expected = frame[column] * (np.pi / 180 if unit == "deg" else 1.0)
        np.testing.assert_allclose(run[key], expected, rtol=4e-16)


finite = st.floats(allow_nan=False, allow_infinity=False, width=64)


@settings(max_examples=150, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(
    rows=st.lists(st.tuples(finite, finite), min_size=2, max_size=30),
    separator=st.sampled_from([",", ";", "\t"]),
    comma=st.booleans(),
    end=st.sampled_from(["\n", "\r\n"]),
    encoding=st.sampled_from(["utf-8", "utf-8-sig", "cp1252", "utf-16"]),
    style=st.sampled_from(
        ["time_s{0}position_m{0}force_N", "t [s]{0}Weg [m]{0}Kraft [N]", "time{0}pos{0}force\ns{0}m{0}N"]
    ),
    packed=st.booleans(),
)
def test_what_is_written_is_read_back_to_the_last_bit(tmp_path, rows, separator, comma, end, encoding, style, packed):
    decimal = "," if comma and separator != "," else "."
    lines = [style.format(separator).replace("\n", end)]
    for i, row in enumerate(rows):
        lines.append(separator.join(repr(v).replace(".", decimal) for v in (i * 0.5, *row)))
    data = (end.join(lines) + end).encode(encoding)
    path = tmp_path / "run.csv"
    path.write_bytes(gzip.compress(data) if packed else data)
    run = luztar.read(path)[0]
    assert run.integrity.complete
    assert [tuple(r) for r in zip(run["position"], run["force"], strict=True)] == rows


alphabet = st.sampled_from(
    [*"0123456789.,;\t\n\r\"'#%-+eE ()[]_°*/", "time_s", "angle_deg", "torque [Nm]", "nan", "inf", "\0", "ß"]
)


@settings(max_examples=400, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(
    head=st.sampled_from(["", "time_s,angle_deg\n0,1\n1,2\n", "x\nPoints=3\ntime\tangle\ns\tdeg\n0\t1\n"]),
    tail=st.lists(alphabet, max_size=60),
)
def test_any_text_is_read_or_refused_with_a_remedy(tmp_path, head, tail):
    path = tmp_path / "run.csv"
    path.write_bytes((head + "".join(tail)).encode())
    try:
        run = luztar.read(path)[0]
    except MeasurementError as error:
        assert error.where
        assert error.remedy
    else:
        run.to_dict()
        assert len(run) >= 2


@settings(max_examples=200, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(flips=st.lists(st.tuples(st.integers(0, 10_000), st.integers(0, 255)), min_size=1, max_size=5))
def test_damaged_bytes_are_read_or_refused_with_a_remedy(tmp_path, flips):
    data = bytearray(DIALECTS["units in brackets in a second row"].encode())
    for at, byte in flips:
        data[at % len(data)] = byte
    path = tmp_path / "run.csv"
    path.write_bytes(bytes(data))
    try:
        luztar.read(path)[0].to_dict()
    except MeasurementError as error:
        assert error.where
        assert error.remedy


@pytest.mark.parametrize(
    "raw",
    [
        b'<!DOCTYPE html>\n<html><body class="a, b">"hello\n</body></html>\n',
        b'time_s,angle_deg,torque_Nm\n0,0,0\n"' + b"a" * 200_000,
        b"\x89PNG\r\n\x1a\n" + np.random.default_rng(1).integers(1, 256, 5000, np.uint8).tobytes(),
        np.random.default_rng(2).integers(0, 256, 5000, np.uint8).tobytes(),
    ],
    ids=["a web page", "a quote that never ends", "a picture", "noise"],
)
def test_what_is_no_table_is_refused_with_a_remedy(tmp_path, raw: bytes):
    path = tmp_path / "run.csv"
    path.write_bytes(raw)
    with pytest.raises(MeasurementError) as caught:
        luztar.read(path)
    assert "run.csv" in caught.value.where and caught.value.remedy
