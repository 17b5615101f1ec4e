"""Small measurement files that tests write for themselves, and where shared measurements lie."""

from __future__ import annotations

from pathlib import Path

import pytest

SHARED = Path(__file__).resolve().parents[2] / "shared"

ROWS = [(0.0, 0.0, 0.50), (0.01, 1.25, 0.625), (0.02, 2.5, -0.75), (0.03, 3.75, 0.875), (0.04, 5.0, 1.125)]


def shared(*parts: str) -> Path:
    """Return a path among the shared measurements, or skip the test."""
    path = SHARED.joinpath(*parts)
    if not path.exists():
        pytest.skip(f"the shared measurements ({'/'.join(parts)}) are not here")
    return path


def rows_text(separator: str = ",", decimal: str = ".", end: str = "\n", fmt: str = "{:.4f}") -> str:
    """Return ROWS as text."""
    return "".join(separator.join(fmt.format(v).replace(".", decimal) for v in row) + end for row in ROWS)


def abd_text(
    points: int | str = 5, tail: str = "", names: str = "Time\tSR Angle\tADC6", units: str = "s\tdeg\tN"
) -> str:
    """Return an AB Dynamics export of ROWS."""
    head = f"Friction check, car 7\r\nPoints={points}\r\n{names}\r\n{units}\r\n"
    return head + rows_text("\t", end="\r\n") + tail
