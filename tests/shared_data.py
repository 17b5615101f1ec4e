"""Data beside the project, which the project never contains: found where it is, or the test says that it is not."""

import json
from pathlib import Path

import pytest

FOLDER = Path(__file__).resolve().parents[1].parent / "shared"


def shared(*parts: str) -> Path:
    """Return a path in the shared folder, or skip the test."""
    path = FOLDER.joinpath(*parts)
    if not path.exists():
        pytest.skip(f"the shared data '{'/'.join(parts)}' are not here")
    return path


def case(name: str):
    """Return the run files and the truth of a measured case."""
    folder = shared("measurements", name)
    return sorted(folder.glob("run*.csv.gz")), json.loads((folder / "truth.json").read_text())
