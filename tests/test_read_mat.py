import struct
import zlib

import numpy as np
import pytest
import scipy.io

import luztar
from luztar.errors import MeasurementError
from measurement_files import shared

N = 200
TIME = np.arange(N) / 100
POSITION = np.sin(TIME)
VOLT = np.cos(TIME)
EMPS = {"time": "t", "position": "qm", "force": "vir*35.1507"}


def save(tmp_path, content, name="run.mat", **options):
    path = tmp_path / name
    scipy.io.savemat(path, content, **options)
    return path


@pytest.mark.parametrize("options", [{}, {"do_compression": True}, {"format": "4"}])
@pytest.mark.parametrize("shape", [(N, 1), (1, N)])
def test_variables_are_named_by_map_and_kept_to_the_last_bit(tmp_path, options, shape):
    path = save(
        tmp_path, {"t": TIME.reshape(shape), "qm": POSITION.reshape(shape), "vir": VOLT.reshape(shape)}, **options
    )
    run = luztar.read(path, map=EMPS, units={"position": "m"})[0]
    assert (run.time_s == TIME).all()
    assert (run["position"] == POSITION).all()
    assert (run["force"] == VOLT * 35.1507).all()
    assert (run.integrity.rows_declared, run.integrity.complete) == (N, True)
    assert {f.kind for f in run.integrity.findings} == {"unit_assumed"}


def test_names_with_units_need_no_map(tmp_path):
    path = save(tmp_path, {"time_ms": 1000 * TIME, "angle_deg": POSITION, "torque_Nm": VOLT})
    run = luztar.read(path)[0]
    np.testing.assert_allclose(run["angle"], np.deg2rad(POSITION), rtol=1e-15)
    assert run.integrity.findings == ()


def test_fields_of_structures_are_addressed_with_a_point(tmp_path):
    path = save(tmp_path, {"log": {"t": TIME, "rig": {"phi": POSITION, "torque_Nm": VOLT}}})
    run = luztar.read(path, map={"time": "log.t", "angle": "log.rig.phi"}, units={"angle": "deg"})[0]
    assert run.integrity.columns == {"time": "log.t", "angle": "log.rig.phi", "torque": "log.rig.torque_Nm"}


def test_a_named_variable_without_unit_is_refused_unless_mapped(tmp_path):
    path = save(tmp_path, {"t": TIME, "angle": POSITION})
    with pytest.raises(MeasurementError, match="angle has no unit"):
        luztar.read(path)
    assert luztar.read(path, map={"angle": "angle"})[0].integrity.units["angle"] == ("", "rad")


@pytest.mark.parametrize(
    ("content", "unit"),
    [({"t": 1000 * TIME, "x": POSITION}, "time=ms"), ({"t": TIME, "x": 500 * POSITION}, "angle=deg")],
)
def test_an_assumed_unit_must_be_plausible(tmp_path, content, unit):
    with pytest.raises(MeasurementError) as caught:
        luztar.read(save(tmp_path, content), map={"angle": "x"})
    assert unit in caught.value.remedy


def test_a_declared_rate_in_the_file_stands_in_for_time(tmp_path):
    path = save(tmp_path, {"fs": 250.0, "angle_deg": POSITION})
    assert luztar.read(path)[0].sample_rate_hz == 250.0


def test_lengths_must_agree(tmp_path):
    path = save(tmp_path, {"t": TIME, "angle_deg": POSITION[:-1]})
    with pytest.raises(MeasurementError, match="t 200, angle_deg 199"):
        luztar.read(path)


@pytest.mark.parametrize(
    "content",
    [
        {"text": "abc"},
        {"z": np.array([1j, 2j, 3j])},
        {"m": np.zeros((5, 5))},
        {"s": 1.0},
        {"c": np.array([{}, 1], object)},
    ],
)
def test_a_file_without_vectors_of_numbers_is_refused(tmp_path, content):
    with pytest.raises(MeasurementError, match="no vector of numbers"):
        luztar.read(save(tmp_path, content))


@pytest.mark.parametrize("head", [b"MATLAB 7.3 MAT-file, Platform: GLNXA64", b"\x89HDF\r\n\x1a\n"])
def test_version_7_3_is_refused_with_the_way_out(tmp_path, head):
    path = tmp_path / "run.mat"
    path.write_bytes(head.ljust(600, b" "))
    with pytest.raises(MeasurementError, match="-v7"):
        luztar.read(path)


@pytest.mark.parametrize("packed", [True, False])
def test_a_file_cut_at_any_place_is_refused_or_says_so(tmp_path, packed):
    data = save(tmp_path, {"t": TIME, "angle_deg": POSITION, "zz": VOLT}, do_compression=packed).read_bytes()
    path = tmp_path / "cut.mat"
    read = 0
    for size in range(0, len(data), 7):
        path.write_bytes(data[:size])
        try:
            run = luztar.read(path)[0]
        except MeasurementError:
            continue
        read += 1
        assert (run["angle"] == np.deg2rad(1.0) * POSITION).all()
        whole_variables = size in _element_ends(data)
        assert run.integrity.complete == whole_variables
        assert whole_variables or [f.kind for f in run.integrity.doubtful] == ["cut"]
    assert read


def _element_ends(data):
    at, ends = 128, {128}
    while at < len(data):
        at += 8 + struct.unpack_from("<I", data, at + 4)[0]
        ends.add(at)
    return ends


def test_a_flipped_byte_never_leaks_a_foreign_exception(tmp_path):
    rng = np.random.default_rng(5)
    for packed in (True, False):
        data = save(tmp_path, {"t": TIME, "angle_deg": POSITION, "s": {"a": VOLT}}, do_compression=packed).read_bytes()
        path = tmp_path / "flip.mat"
        for at in rng.choice(len(data), 300, replace=False):
            broken = bytearray(data)
            broken[at] ^= 1 << int(rng.integers(8))
            path.write_bytes(bytes(broken))
            try:
                luztar.read(path)
            except MeasurementError as error:
                assert error.where


def test_a_small_file_that_unpacks_to_gigabytes_is_refused(tmp_path):
    packer = zlib.compressobj(9)
    zeros = bytes(1 << 22)
    body = b"".join(packer.compress(zeros) for _ in range(300)) + packer.flush()
    head = b"MATLAB 5.0 MAT-file".ljust(124, b" ") + struct.pack("<H", 0x0100) + b"IM"
    path = tmp_path / "bomb.mat"
    path.write_bytes(head + struct.pack("<II", 15, len(body)) + body)
    with pytest.raises(MeasurementError, match="unpack to more than 1024 MiB"):
        luztar.read(path)


def test_the_shared_axis_is_read_with_the_documented_map():
    for name in ("DATA_EMPS.mat", "DATA_EMPS_PULSES.mat"):
        run = luztar.read(shared("data", "emps", name), map=EMPS, units={"position": "m"})[0]
        assert (len(run), run.sample_rate_hz) == (24_841, 1000.0)
        assert run.integrity.complete
        assert not run.integrity.doubtful
