import numpy as np
import pytest

import luztar
from luztar.errors import MeasurementError
from measurement_files import ROWS, abd_text

LOAD_CELL = {"torque": "ADC6*0.52"}


def write(tmp_path, text, name="run.txt"):
    path = tmp_path / name
    path.write_bytes(text.encode("cp1252"))
    return path


def test_an_export_is_read_and_its_load_cell_becomes_torque(tmp_path):
    run = luztar.read(write(tmp_path, abd_text(tail="Notes\tjunk\r\n1\t2\r\n")), map=LOAD_CELL)[0]
    np.testing.assert_allclose(run["torque"], [0.52 * m for _, _, m in ROWS], rtol=1e-15)
    np.testing.assert_allclose(run["angle"], np.deg2rad([a for _, a, _ in ROWS]), rtol=1e-15)
    assert (run.integrity.rows_declared, run.integrity.rows_read, run.integrity.complete) == (5, 5, True)
    assert run.integrity.findings == ()


def test_the_name_of_the_file_does_not_matter(tmp_path):
    run = luztar.read(write(tmp_path, abd_text(), "run.csv"), map=LOAD_CELL)[0]
    assert run.integrity.rows_declared == 5


def test_degree_signs_in_cp1252_are_units(tmp_path):
    run = luztar.read(write(tmp_path, abd_text(units="s\t°\tN")), map=LOAD_CELL)[0]
    assert run["angle"][-1] == np.deg2rad(5.0)


def test_nothing_is_read_past_the_declared_points(tmp_path):
    run = luztar.read(write(tmp_path, abd_text(points=3)), map=LOAD_CELL)[0]
    assert len(run) == 3
    assert run.integrity.complete
    assert "declares 3 rows and goes on" in run.integrity.findings[0].text


@pytest.mark.parametrize("tail", ["", "Notes\r\n", "Notes\r\nmore\r\nand\r\nmore\r\nof it\r\n"])
def test_fewer_rows_than_declared_is_a_cut(tmp_path, tail):
    run = luztar.read(write(tmp_path, abd_text(points=8, tail=tail)), map=LOAD_CELL)[0]
    assert len(run) == 5
    assert not run.integrity.complete
    (finding,) = run.integrity.doubtful
    assert finding.kind == "cut"
    assert "declares 8 rows and holds 5" in finding.text
    assert "line 9" in finding.text


@pytest.mark.parametrize("points", ["", "many", "-5", "0", "5.0", "9" * 30, "٣"])
def test_points_that_are_no_count_are_refused(tmp_path, points):
    path = tmp_path / "run.txt"
    path.write_bytes(abd_text(points=points).encode())
    with pytest.raises(MeasurementError) as caught:
        luztar.read(path, map=LOAD_CELL)
    assert caught.value.where.endswith("line 2")


def test_a_damaged_row_among_the_declared_is_an_error_with_its_line(tmp_path):
    text = abd_text().replace("2.5000", "2.5x00")
    with pytest.raises(MeasurementError) as caught:
        luztar.read(write(tmp_path, text), map=LOAD_CELL)
    assert "line 7, column 'SR Angle'" in caught.value.where


def test_an_estimated_torque_serves_only_with_a_warning(tmp_path):
    names = "Time\tSR Angle\tSR Column Torque (Estimated)"
    run = luztar.read(write(tmp_path, abd_text(names=names, units="s\tdeg\tNm")))[0]
    assert [f.kind for f in run.integrity.findings] == ["estimated_torque"]
    assert "ADC6*0.52" in run.integrity.findings[0].text


def test_a_measured_torque_goes_before_an_estimated_one(tmp_path):
    names = "SR Angle\tTorque\tSR Column Torque (Estimated)"
    path = write(tmp_path, abd_text(names=names, units="deg\tNm\tNm"))
    run = luztar.read(path, sample_rate_hz=100)[0]
    assert run.integrity.columns["torque"] == "Torque"
    assert all(f.kind != "estimated_torque" for f in run.integrity.findings)


def test_a_load_cell_nobody_named_is_not_guessed(tmp_path):
    run = luztar.read(write(tmp_path, abd_text()))[0]
    with pytest.raises(MeasurementError) as caught:
        run["torque"]
    assert "'ADC6'" in caught.value.kind
    assert "--map torque" in caught.value.remedy


def test_a_blank_line_among_the_declared_rows_is_not_counted_as_one(tmp_path):
    text = abd_text().replace("0.0200\t", "\r\n0.0200\t")
    run = luztar.read(write(tmp_path, text), map=LOAD_CELL)[0]
    assert (len(run), run.integrity.complete) == (4, False)
    assert "1 of those lines hold none" in run.integrity.doubtful[0].text
