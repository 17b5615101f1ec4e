"""What leaves the program: results on standard output, everything else on standard error."""

from __future__ import annotations

import json
import math
import os
import sys
from collections import Counter
from collections.abc import Iterable, Mapping
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from ..measurement import Run

# More findings of one kind than this are shown by their first ones.
MOST_ALIKE, SHOWN_ALIKE = 3, 2


def say(result: object) -> None:
    """Print a result: text as it is, a mapping as one JSON object."""
    text = as_json(result) if isinstance(result, Mapping) else str(result)
    _write(sys.stdout, text)


def tell(text: str) -> None:
    """Print a message on standard error."""
    _write(sys.stderr, text)


def say_error(kind: str, where: str, remedy: str) -> None:
    """Print an error for a reader: the place and what is wrong, then what to do."""
    named = not where or kind.startswith(f"{where} ")
    tell(f"error: {'' if named else f'{where}: '}{kind.rstrip('.')}.")
    if remedy:
        tell(f"  {remedy}")


def _write(stream: Any, text: str) -> None:
    try:
        stream.write(f"{text}\n")
        stream.flush()
    except BrokenPipeError:
        # The reader has seen enough (head, a closed pager): the exit code still tells the verdict. The descriptor is
        # replaced so that the interpreter's own flush at its end finds nobody missing.
        os.dup2(os.open(os.devnull, os.O_WRONLY), stream.fileno())


def as_json(result: Mapping[str, Any]) -> str:
    """Return one JSON object in ASCII; what is not finite becomes null."""
    return json.dumps(plain(result), allow_nan=False, indent=1)


def plain(value: Any) -> Any:
    """Return a value of JSON's own kinds."""
    if isinstance(value, Mapping):
        return {str(k): plain(v) for k, v in value.items()}
    if value is None or isinstance(value, str | bool):
        return value
    if hasattr(value, "tolist"):
        # NumPy scalars and arrays.
        return plain(value.tolist())
    if isinstance(value, int):
        return int(value)
    if isinstance(value, float):
        return float(value) if math.isfinite(value) else None
    if isinstance(value, Iterable):
        return [plain(v) for v in value]
    raise TypeError(f"{type(value).__name__} has no form in JSON")


def finding_lines(runs: Iterable[Run]) -> list[str]:
    """Return the integrity findings of runs in lines; an exclamation mark stands before those that cast doubt.

    Of one kind and channel of a run the first few are shown and the others counted.
    """
    lines = []
    for run in runs:
        alike = Counter((f.kind, f.channel, f.doubtful) for f in run.integrity.findings if f.kind != "note")
        shown: Counter[tuple[str, str | None, bool]] = Counter()
        for finding in run.integrity.findings:
            key = (finding.kind, finding.channel, finding.doubtful)
            shown[key] += 1
            if alike[key] > MOST_ALIKE and shown[key] > SHOWN_ALIKE:
                continue
            more = alike[key] - SHOWN_ALIKE if alike[key] > MOST_ALIKE and shown[key] == SHOWN_ALIKE else 0
            rest = f" (and {more} more of this kind)" if more else ""
            lines.append(f"  {'!' if finding.doubtful else '-'} {run.name}: {finding.text}{rest}")
    return lines


def show(result: Any, runs: Iterable[Run], json_wanted: bool) -> None:
    """Print a result with the integrity findings of its runs: JSON alone on standard output where that is wanted."""
    findings = finding_lines(runs)
    if json_wanted:
        for line in findings:
            tell(line.strip())
        say(result.to_dict())
    else:
        say("\n".join([str(result), *(["", "Data", *findings] if findings else [])]))
