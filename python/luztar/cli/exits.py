"""The exit codes, part of the public interface."""

from __future__ import annotations

DONE = 0
FAIL = 1
INCONCLUSIVE = 2
INPUT = 3
INTERNAL = 4
# What a shell shows for a process that an interrupt has ended: 128 + SIGINT.
INTERRUPTED = 130

TB038 = {"pass": DONE, "fail": FAIL, "inconclusive": INCONCLUSIVE}


def of_verdict(verdict: str) -> int:
    """Return the exit code of a diagnosis or study: anything that was decided is done."""
    return INCONCLUSIVE if verdict == "too_few_strokes" else DONE
