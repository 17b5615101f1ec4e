"""What all tests share: one reproducible Hypothesis profile and the place of the certified data."""

from __future__ import annotations

import signal
from pathlib import Path

import pytest
from hypothesis import settings

settings.register_profile("ci", derandomize=True, deadline=None, max_examples=100)
settings.load_profile("ci")

# A shell that starts a job in the background has it ignore interrupts; the tests of interrupts send themselves some.
if signal.getsignal(signal.SIGINT) is signal.SIG_IGN:
    signal.signal(signal.SIGINT, signal.default_int_handler)

SHARED = Path(__file__).resolve().parents[2] / "shared"


@pytest.fixture(scope="session")
def nist() -> Path:
    """The folder of the NIST StRD files; tests that need them are skipped where they are not at hand."""
    folder = SHARED / "data" / "nist"
    if not folder.is_dir():
        pytest.skip("the NIST StRD files are not beside the repository (shared/data/nist)")
    return folder
