"""The calibration benchmark runs, goes on where it was stopped, and writes its page."""

from __future__ import annotations

import json
import math
import os
import re
import subprocess
import sys
from pathlib import Path

import pytest

TOP = Path(__file__).resolve().parents[1]


def bench(out: Path, *options: str) -> subprocess.CompletedProcess[str]:
    command = [sys.executable, "-m", "benches.hidden_effects", "--fast", "--workers", "2"]
    command += ["--out", str(out), "--docs", str(out), *options]
    environment = {**os.environ, "OPENBLAS_NUM_THREADS": "1"}
    done = subprocess.run(command, cwd=TOP, env=environment, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    return done


@pytest.fixture(scope="module")
def finished(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("calibration")
    bench(folder)
    return folder


def records(folder: Path) -> list[dict[str, object]]:
    return [json.loads(line) for line in (folder / "results.jsonl").read_text(encoding="utf-8").splitlines()]


def test_two_cases_are_judged(finished: Path) -> None:
    null, spring = sorted(records(finished), key=lambda r: str(r["kind"]), reverse=True)
    assert "failed" not in null and "failed" not in spring, (null, spring)
    assert null["kind"] == "null" and null["named"] == [] and null["kinds"]
    assert spring["effect"] == "stiffness" and spring["in_set"] is True
    assert 0.9 < spring["cosine"] <= 1.0  # a spring and a slow wave are alike within 60 degrees
    assert spring["after"] < 0.5 * spring["before"]
    assert {"coulomb.level_nm", "stiffness.stiffness_nm_per_rad"} <= set(spring["intervals"])
    for row in spring["intervals"].values():
        if "inside" in row:
            assert row["low"] < row["high"] and row["inside"] == (row["low"] <= row["truth"] <= row["high"])


def test_finished_cases_are_not_run_again_and_the_page_stands(finished: Path) -> None:
    before = records(finished)
    said = bench(finished).stderr
    assert "2 cases were finished before" in said
    assert records(finished) == before
    page = (finished / "validation.md").read_text(encoding="utf-8")
    for word in (
        "## Targets",
        "## Names",
        "## Nothing hidden",
        "## Intervals",
        "## Typical sizes",
        "| stiffness | 1 |",
    ):
        assert word in page
    assert not re.search(r"\bnan\b", page)


def test_rates_carry_wilsons_interval(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.syspath_prepend(str(TOP))
    from benches.hidden_effects.tally import Rate

    # 15 of 148, Wilson score without continuity correction: 0.0624 to 0.1605 (Newcombe 1998, table I: 0.0624, 0.1605)
    low, high = Rate(15, 148).interval
    assert math.isclose(low, 0.0624, abs_tol=5e-5) and math.isclose(high, 0.1605, abs_tol=5e-5)
    assert Rate(0, 20).interval[0] == 0.0
