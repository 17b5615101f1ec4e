"""Writes simulated runs as run1.csv.gz, run2.csv.gz ... with truth.json beside them."""

from __future__ import annotations

import gzip
import io
import json
from collections.abc import Mapping, Sequence
from pathlib import Path

import numpy as np

from generators.axis import AxisRun
from generators.rig import RigRun


def _columns(run: RigRun | AxisRun, angle_decimals: int) -> tuple[list[str], list[np.ndarray], list[str]]:
    if isinstance(run, RigRun):
        names = ["time_s", "angle_deg", "torque_Nm"]
        columns = [run.time_s, np.rad2deg(run.angle_rad), run.torque_nm]
        formats = ["%.4f", f"%.{angle_decimals}f", "%.4f"]
    else:
        names = ["time_s", "position_m", "force_N"]
        columns = [run.time_s, run.position_m, run.force_n]
        formats = ["%.4f", "%.8f", "%.4f"]
    if run.load_n is not None:
        names.append("load_N")
        columns.append(run.load_n)
        formats.append("%.3f")
    return names, columns, formats


def run_text(run: RigRun | AxisRun, *, angle_decimals: int = 4) -> str:
    """The run as CSV text."""
    names, columns, formats = _columns(run, angle_decimals)
    table = np.column_stack(columns) + 0.0  # adding zero turns -0 into 0
    text = io.StringIO()
    np.savetxt(text, table, fmt=formats, delimiter=",", header=",".join(names), comments="")
    return text.getvalue().replace(",-0.0000,", ",0.0000,")


def write_runs(
    folder: str | Path,
    runs: Sequence[RigRun | AxisRun],
    *,
    hidden: Mapping[str, object],
    base: Mapping[str, object],
    angle_decimals: int = 4,
    more: Mapping[str, object] | None = None,
) -> list[Path]:
    """Write the runs and the truth; the same runs give the same bytes (no time stamp in the gzip header)."""
    folder = Path(folder)
    folder.mkdir(parents=True, exist_ok=True)
    paths = []
    for number, run in enumerate(runs, start=1):
        path = folder / f"run{number}.csv.gz"
        text = run_text(run, angle_decimals=angle_decimals).encode()
        path.write_bytes(gzip.compress(text, compresslevel=9, mtime=0))
        paths.append(path)
    truth = {
        "structure": "rig" if isinstance(runs[0], RigRun) else "axis",
        "hidden": list(hidden),
        "base": base,
        "parameters": hidden,
        **(more or {}),
    }
    (folder / "truth.json").write_text(json.dumps(truth, indent=1) + "\n")
    return paths
