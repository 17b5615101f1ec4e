"""The simulated runs as files: written and read back, and the bundled demo data among them."""

import gzip
import json
import subprocess
import sys
from pathlib import Path

import numpy as np

from generators import demo, typical
from generators.physics import pieces_of_one_direction
from generators.rig import simulate_rig_set
from generators.write import run_text, write_runs

DEG = np.pi / 180.0


def test_written_runs_read_back(tmp_path):
    hidden, base = typical.draw("stribeck", 1.0, np.random.default_rng(1))
    runs = simulate_rig_set(hidden, base=base, runs=2, seed=3)
    paths = write_runs(tmp_path, runs, hidden=hidden, base=base, angle_decimals=2)
    assert [path.name for path in paths] == ["run1.csv.gz", "run2.csv.gz"]
    text = gzip.decompress(paths[0].read_bytes()).decode()
    assert text.splitlines()[0] == "time_s,angle_deg,torque_Nm"
    table = np.loadtxt(text.splitlines()[1:], delimiter=",")
    np.testing.assert_allclose(table[:, 0], runs[0].time_s, atol=1e-9)
    np.testing.assert_allclose(table[:, 1] * DEG, runs[0].angle_rad, atol=1e-9)
    np.testing.assert_allclose(table[:, 2], runs[0].torque_nm, atol=1e-9)
    truth = json.loads((tmp_path / "truth.json").read_text())
    assert truth["hidden"] == ["stribeck"] and truth["parameters"] == hidden
    first = [path.read_bytes() for path in paths]
    assert first == [p.read_bytes() for p in write_runs(tmp_path, runs, hidden=hidden, base=base, angle_decimals=2)]


def bundled_demo():
    return [
        np.loadtxt(
            gzip.decompress((demo.FOLDER / f"run{n}.csv.gz").read_bytes()).decode().splitlines()[1:], delimiter=","
        )
        for n in (1, 2, 3)
    ]


def test_the_bundled_demo_is_what_the_script_writes():
    for table, run in zip(bundled_demo(), demo.demo_runs(), strict=True):
        again = np.loadtxt(run_text(run, angle_decimals=2).splitlines()[1:], delimiter=",")
        # A last digit may differ between versions of the sine; on one machine the bytes are equal.
        np.testing.assert_allclose(again[:, 0], table[:, 0], atol=1e-9)
        np.testing.assert_allclose(again[:, 1], table[:, 1], atol=0.0201)
        np.testing.assert_allclose(again[:, 2], table[:, 2], atol=1.01e-4)


def test_the_bundled_demo_can_pass_tb038():
    """Six strokes from beyond 50 degrees, below 40 deg/s inside 45, mean 0.2 to 1.5 Nm, spread below 0.4 Nm."""
    assert sum((demo.FOLDER / f"run{n}.csv.gz").stat().st_size for n in (1, 2, 3)) < 400_000
    for table, run in zip(bundled_demo(), demo.demo_runs(), strict=True):
        strokes = [p for p in pieces_of_one_direction(run.motion.position) if p[2]]
        assert len(strokes) == 6
        assert all(abs(run.motion.position[first]) > 50.0 * DEG for first, _, _ in strokes)
        inside = np.abs(table[:, 1]) < 45.0
        assert np.max(np.abs(run.true_speed_rad_s[inside])) < 40.0 * DEG
        for direction in (-1.0, 1.0):
            torque_nm = table[inside & (np.sign(run.true_speed_rad_s) == direction), 2] * direction
            assert 0.2 < np.mean(torque_nm) < 1.5
            assert np.std(torque_nm) < 0.4


def test_the_generator_does_not_import_luztar():
    folder = Path(__file__).resolve().parent
    code = (
        f"import sys; sys.path.insert(0, {str(folder)!r}); import generators.demo, generators.typical; "
        "print(sorted(m for m in ('luztar', 'numba', 'pandas') if m in sys.modules))"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.strip() == "[]"
