import gzip
import zlib

import numpy as np
import pytest

import luztar
from luztar.errors import MeasurementError
from measurement_files import ROWS, abd_text, rows_text

TEXT = "time_s,angle_deg,torque_Nm\n" + rows_text()
SI = {"angle": "rad", "torque": "Nm"}
WHOLE = np.array([(t, np.deg2rad(a), m) for t, a, m in ROWS])


def read_or_none(path):
    try:
        return luztar.read(path)[0]
    except MeasurementError as error:
        assert error.where
        assert error.remedy
        return None


def rows_of(run):
    return np.column_stack([run.time_s, run["angle"], run["torque"]])


def must_be_honest(run, whole=WHOLE):
    """Rows are right and in order, and a last row that is not right comes with a finding."""
    rows = rows_of(run)
    np.testing.assert_allclose(rows[:-1], whole[: len(rows) - 1], rtol=1e-12)
    right = bool(np.allclose(rows[-1], whole[len(rows) - 1], rtol=1e-12))
    if not right:
        assert run.integrity.findings, "a wrong last row without a finding"
    if not run.integrity.complete:
        assert right
        assert {f.kind for f in run.integrity.doubtful} == {"cut"}
    return right


VARIANTS = {
    "plain": TEXT,
    "CRLF": TEXT.replace("\n", "\r\n"),
    "variable digits": "time_s,angle_deg,torque_Nm\n" + "".join(f"{t},{a},{m}\n" for t, a, m in ROWS),
    "integers": "time_s,angle_deg,torque_mNm\n" + "".join(f"{t:.2f},{a},{1000 * m:.0f}\n" for t, a, m in ROWS),
    "exponents": "time_s,angle_deg,torque_Nm\n" + rows_text(fmt="{:.3e}"),
    "decimal commas": "time_s;angle_deg;torque_Nm\n" + rows_text(";", ","),
    "degree signs": "time [s];angle [°];torque [Nm]\n" + rows_text(";"),
    "trailing text": TEXT + "\nEnd of recörd\n",
    "a column of text": "time_s,state,angle_deg,torque_Nm\n" + "".join(f"{t},OK,{a},{m:.3f}\n" for t, a, m in ROWS),
    "a clock first": "clock,time_s,angle_deg,torque_Nm\n" + "".join(f"12:00:00,{t},{a},{m:.3f}\n" for t, a, m in ROWS),
    "text last": "time_s,angle_deg,torque_Nm,state\n" + "".join(f"{t},{a},{m},OK\n" for t, a, m in ROWS),
    "two header rows": "time\tangle\ttorque\ns\tdeg\tNm\n" + rows_text("\t"),
}


@pytest.mark.parametrize("variant", VARIANTS)
def test_a_file_cut_at_any_byte_never_passes_off_a_short_row(tmp_path, variant):
    data = VARIANTS[variant].encode()
    path = tmp_path / "run.csv"
    n_read = 0
    for size in range(len(data) + 1):
        path.write_bytes(data[:size])
        run = read_or_none(path)
        if run is None:
            continue
        n_read += 1
        must_be_honest(run)
        ends_a_line = data[:size].endswith((b"\n", b"\r"))
        if not ends_a_line and len(run) < len(ROWS):
            assert run.integrity.findings
            rest = data[:size].replace(b"\r", b"\n").rpartition(b"\n")[2]
            n_whole = data[:size].replace(b"\r\n", b"\n").count(b"\n") - (2 if variant == "two header rows" else 1)
            left_out = len(run) == n_whole
            # A lone piece of clock text may be a footer: reported, and not called a cut.
            lone_text = variant == "a clock first" and b"," not in rest
            assert left_out != run.integrity.complete or lone_text
    assert n_read > 10
    assert len(run) == len(ROWS)
    assert run.integrity.complete


def test_fixed_decimals_make_every_cut_inside_a_row_a_doubtful_one(tmp_path):
    path = tmp_path / "run.csv"
    body = TEXT.encode()
    for size in range(body.rindex(b"\n", 0, -1) + 2, len(body) - 1):
        path.write_bytes(body[:size])
        run = luztar.read(path)[0]
        assert (len(run), run.integrity.complete) == (4, False)
        assert [f.kind for f in run.integrity.doubtful] == ["cut"]


def test_zeros_at_the_end_of_a_file_are_a_cut(tmp_path):
    path = tmp_path / "run.csv"
    path.write_bytes(TEXT.encode()[:-10] + bytes(500))
    run = luztar.read(path)[0]
    assert (len(run), run.integrity.complete) == (4, False)
    path.write_bytes(TEXT.encode()[:70] + bytes(3) + TEXT.encode()[70:])
    with pytest.raises(MeasurementError, match="not text"):
        luztar.read(path)


def test_a_last_line_without_its_end_is_a_finding_and_not_doubtful(tmp_path):
    path = tmp_path / "run.csv"
    path.write_text(TEXT[:-1])
    run = luztar.read(path)[0]
    assert len(run) == 5
    assert run.integrity.complete
    assert not run.integrity.doubtful
    assert "no line end" in run.integrity.findings[0].text


def test_an_archive_cut_at_any_byte_never_passes_as_complete(tmp_path):
    data = gzip.compress(TEXT.encode(), 9, mtime=0)
    path = tmp_path / "run.csv.gz"
    n_read = 0
    for size in range(len(data)):
        path.write_bytes(data[:size])
        run = read_or_none(path)
        if run is not None:
            n_read += 1
            assert not run.integrity.complete
            assert must_be_honest(run)
    assert n_read >= 8  # the trailer alone is eight bytes
    path.write_bytes(data)
    assert luztar.read(path)[0].integrity.complete


def test_a_flipped_bit_in_an_archive_is_an_error_or_changes_nothing(tmp_path):
    data = bytearray(gzip.compress(TEXT.encode(), 9, mtime=0))
    path = tmp_path / "run.csv.gz"
    for at in range(len(data)):
        data[at] ^= 0x10
        path.write_bytes(bytes(data))
        run = read_or_none(path)
        if run is not None and run.integrity.complete:
            np.testing.assert_allclose(rows_of(run), WHOLE, rtol=1e-12)
        data[at] ^= 0x10


def test_an_archive_of_several_members_is_read_whole(tmp_path):
    path = tmp_path / "run.csv.gz"
    path.write_bytes(gzip.compress(TEXT[:60].encode()) + gzip.compress(TEXT[60:].encode()) + b"\0\0\0")
    assert len(luztar.read(path)[0]) == 5


def test_an_archive_that_unpacks_without_end_is_refused(tmp_path, monkeypatch):
    import sys

    from luztar.measurement import read as module  # noqa: F401

    monkeypatch.setattr(sys.modules["luztar.measurement.read"], "MOST_BYTES", 1 << 20)
    path = tmp_path / "run.csv.gz"
    packer = zlib.compressobj(9, wbits=31)
    path.write_bytes(packer.compress(b"0,0\n" * (1 << 20)) + packer.flush())
    with pytest.raises(MeasurementError, match="unpacks to more than"):
        luztar.read(path)


def test_an_export_cut_at_any_byte_never_passes_as_complete(tmp_path):
    data = abd_text(units="s\tdeg\tNm", names="Time\tSR Angle\tTorque", tail="Notes\r\n").encode("cp1252")
    path = tmp_path / "run.txt"
    end_of_rows = data.rindex(b"\r\nNotes")
    n_read = 0
    for size in range(len(data) + 1):
        path.write_bytes(data[:size])
        run = read_or_none(path)
        if run is None:
            continue
        n_read += 1
        assert must_be_honest(run)
        assert run.integrity.complete == (size >= end_of_rows)
    assert n_read > 50


def test_a_missing_value_keeps_its_place_and_is_listed(tmp_path):
    path = tmp_path / "run.csv"
    path.write_text("time_s,angle_deg,torque_Nm\n0,1,2\n1,,2\n2,NaN,2\n3,1,n/a\n4,1,inf\n5,3,1\n")
    run = luztar.read(path)[0]
    assert len(run) == 6
    assert np.flatnonzero(np.isnan(run["angle"])).tolist() == [1, 2]
    found = [(f.kind, f.channel, f.from_s, f.to_s, f.doubtful) for f in run.integrity.findings]
    assert found == [
        ("not_finite", "angle", 1.0, 2.0, True),
        ("not_finite", "torque", 3.0, 4.0, True),
    ]
    assert "line 3 to line 4 (2 rows)" in run.integrity.findings[0].text


def test_a_missing_stamp_is_filled_and_doubtful(tmp_path):
    path = tmp_path / "run.csv"
    path.write_text("time_s,angle_deg\n0,1\n1,2\n,3\n3,4\n4,5\n")
    run = luztar.read(path)[0]
    assert run.time_s.tolist() == [0.0, 1.0, 2.0, 3.0, 4.0]
    (finding,) = run.integrity.findings
    assert (finding.channel, finding.doubtful, finding.from_s, finding.to_s) == ("time", True, 1.0, 3.0)
    assert "line 4" in finding.text


def kinds(time_s):
    time_s = np.asarray(time_s, float)
    return [f.kind for f in luztar.Run(time=time_s, angle=np.sin(time_s), units=SI).integrity.findings]


@pytest.mark.parametrize("rate", [100, 200, 256, 500, 512, 1000, 1024, 2000])
def test_stamps_rounded_to_a_tenth_of_a_millisecond_are_even(rate):
    time_s = np.round(np.arange(20_000) / rate, 4)
    run = luztar.Run(time=time_s, angle=np.sin(time_s), units=SI)
    assert run.integrity.findings == ()
    assert run.sample_rate_hz == pytest.approx(rate, rel=1e-5)


def test_stamps_since_1970_are_even():
    assert kinds(1.7e9 + np.arange(5000) / 1000) == []


def test_one_lost_sample_is_a_gap_with_its_place():
    time_s = np.delete(np.arange(1000) / 500, 300)
    run = luztar.Run(time=time_s, angle=np.sin(time_s), units=SI)
    (finding,) = run.integrity.findings
    assert (finding.kind, finding.doubtful) == ("gap", True)
    assert (finding.from_s, finding.to_s) == (0.598, 0.602)
    assert not run.integrity.evenly_sampled
    with pytest.raises(MeasurementError, match="split_at_gaps"):
        run.require_even()


@pytest.mark.parametrize(("ratio", "expected"), [(1.24, []), (1.26, ["uneven"]), (1.49, ["uneven"]), (1.51, ["gap"])])
def test_the_edges_of_even_and_gap_are_where_they_are_stated(ratio, expected):
    steps = np.full(500, 0.01)
    steps[250] *= ratio
    assert kinds(np.concatenate(([0.0], np.cumsum(steps)))) == expected


def test_time_that_stands_or_runs_back_is_doubtful():
    assert kinds([0, 1, 2, 2, 3, 4, 5, 6]) == ["duplicate_time"]
    assert kinds([0, 1, 2, 3, 2.5, 3, 4, 5, 6])[0] == "reversed_time"
    assert "uneven" in kinds([5, 4, 3, 2, 1, 0])


def test_a_rate_that_wanders_is_uneven():
    steps = 1e-3 * (1.0 + 0.1 * np.linspace(0, 1, 5000))
    assert kinds(np.cumsum(steps)) == ["uneven"]


def test_events_at_random_times_are_uneven_and_not_a_thousand_gaps():
    rng = np.random.default_rng(7)
    found = kinds(np.cumsum(rng.uniform(0.5e-3, 1.6e-3, 3000)))
    assert found == ["uneven"]


def test_findings_of_one_kind_are_counted_beyond_twenty():
    rng = np.random.default_rng(1)
    keep = np.sort(rng.choice(20_000, 19_400, replace=False))
    run = luztar.Run(time=keep / 1000, angle=np.sin(keep / 1000), units=SI)
    gaps = [f for f in run.integrity.findings if f.kind == "gap"]
    assert len(gaps) == 21
    assert "more of the same kind" in gaps[-1].text
    assert gaps[-1].to_s > 19.0


def noisy(n=20_000, seed=3):
    rng = np.random.default_rng(seed)
    time_s = np.arange(n) / 1000
    angle = 1.5 * np.sin(0.5 * time_s)
    return time_s, angle, 0.8 * np.sign(np.cos(0.5 * time_s)) + rng.normal(0.0, 0.05, n)


def test_a_sound_noisy_torque_has_no_finding():
    time_s, angle, torque = noisy()
    assert luztar.Run(time=time_s, angle=angle, torque=torque, units=SI).integrity.findings == ()
    coarse = np.round(torque / 0.01) * 0.01
    assert luztar.Run(time=time_s, angle=angle, torque=coarse, units=SI).integrity.findings == ()


def test_a_torque_that_stands_still_in_noise_is_stuck():
    time_s, angle, torque = noisy()
    torque[5000:5400] = torque[5000]
    (finding,) = luztar.Run(time=time_s, angle=angle, torque=torque, units=SI).integrity.findings
    assert (finding.kind, finding.channel, finding.doubtful) == ("stuck", "torque", True)
    assert (finding.from_s, finding.to_s) == (5.0, 5.399)


def test_a_torque_cut_off_at_its_range_is_clipped():
    time_s, angle, torque = noisy()
    torque += 4.0 * np.exp(-(((time_s - 8.0) / 0.1) ** 2))
    torque = np.minimum(torque, 1.5)
    found = luztar.Run(time=time_s, angle=angle, torque=torque, units=SI).integrity.findings
    assert [f.kind for f in found] == ["clipped"]
    assert all(f.doubtful and 7.7 < f.from_s < 8.3 for f in found)


def test_a_channel_that_clips_again_and_again_has_one_finding_with_its_places():
    time_s, angle, torque = noisy()
    torque = np.clip(1.2 * np.cos(5.0 * time_s) + torque - torque.mean(), -1.4, 1.4)
    (finding,) = luztar.Run(time=time_s, angle=angle, torque=torque, units=SI).integrity.findings
    assert (finding.kind, finding.channel, finding.doubtful) == ("clipped", "torque", True)
    assert "its extremes -1.4 and 1.4" in finding.text and "% of the record" in finding.text
    assert finding.text.count(" s") < 12  # the first places, not all of them
    at = np.abs(torque) == 1.4
    spoken = sum(((time_s >= a) & (time_s <= b)).sum() for a, b in finding.places)
    assert len(finding.places) == finding.to_dict()["count"] > 20
    # Stretches of ten samples and more; what is shorter at the extreme may be noise.
    assert 0.5 * at.sum() < spoken <= at.sum()
    first, last = finding.places[0], finding.places[1]
    assert finding.concerns(*first) and not finding.concerns(first[1] + 1e-6, last[0] - 1e-6)


def test_a_computed_torque_without_noise_is_not_called_stuck():
    time_s, angle, _ = noisy()
    torque = 0.8 * np.sign(np.cos(0.5 * time_s))
    assert luztar.Run(time=time_s, angle=angle, torque=torque, units=SI).integrity.findings == ()


def test_a_constant_channel_is_reported():
    time_s, angle, _ = noisy()
    (finding,) = luztar.Run(time=time_s, angle=angle, torque=np.full(time_s.size, 0.8), units=SI).integrity.findings
    assert (finding.kind, finding.channel, finding.doubtful) == ("stuck", "torque", False)


def test_the_report_is_plain_json(tmp_path):
    import json

    path = tmp_path / "run.csv"
    path.write_text("time_s,angle_deg,torque_Nm\n0,1,2\n1,,2\n2,NaN,2\n3,1,n/a\n")
    text = json.dumps(luztar.read(path).to_dict(), allow_nan=False)
    assert json.loads(text)[0]["integrity"]["units"]["angle"] == {"read": "deg", "used": "rad"}
