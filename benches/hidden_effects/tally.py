"""Counts with the uncertainty they have."""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from typing import Any

Record = dict[str, Any]
# Above this cosine two effects are nearly the same curve in those movements, and a set is the right answer.
ALIKE = 0.9


@dataclass(frozen=True)
class Rate:
    """Hits of tries."""

    hits: int
    tries: int

    @property
    def share(self) -> float:
        """The plain share."""
        return self.hits / self.tries if self.tries else math.nan

    @property
    def interval(self) -> tuple[float, float]:
        """Wilson's 95 % interval of the share."""
        if not self.tries:
            return 0.0, 1.0
        z, n, p = 1.959963984540054, self.tries, self.share
        centre = (p + z * z / (2 * n)) / (1 + z * z / n)
        half = z * math.sqrt(p * (1 - p) / n + z * z / (4 * n * n)) / (1 + z * z / n)
        return max(0.0, centre - half), min(1.0, centre + half)

    def __str__(self) -> str:
        if not self.tries:
            return "—"
        low, high = self.interval
        return f"{self.hits}/{self.tries} = {100 * self.share:.1f} % ({100 * low:.1f}–{100 * high:.1f})"

    @property
    def short(self) -> str:
        """Hits of tries alone."""
        return f"{self.hits}/{self.tries}" if self.tries else "—"


def rate(records: Iterable[Record], hit: Callable[[Record], object]) -> Rate:
    """Count the records for which something holds."""
    found = [bool(hit(r)) for r in records]
    return Rate(sum(found), len(found))


def of_kind(records: Iterable[Record], kind: str) -> list[Record]:
    """Return the records of luztar (not of the peers) of one kind."""
    return [r for r in records if r["kind"] == kind and not r["peers"] and "failed" not in r]


def distinct(record: Record) -> bool:
    """Whether every rival looks different enough in these movements for one name."""
    return record.get("cosine") is not None and record["cosine"] < ALIKE


def misnamed(records: Iterable[Record]) -> Counter[str]:
    """Count what was said where the truth was not."""
    said: Counter[str] = Counter()
    for r in records:
        if not r["exact"]:
            said["+".join(r["named"]) or r["verdict"].replace("_", " ")] += 1
    return said


def coverage(records: Iterable[Record]) -> dict[str, tuple[Rate, int]]:
    """Return per parameter how many intervals hold the truth, and how often there was none or it was flagged."""
    inside: dict[str, list[bool]] = {}
    without: Counter[str] = Counter()
    for r in records:
        for key, row in r.get("intervals", {}).items():
            inside.setdefault(key, [])
            if "inside" in row and row["identifiable"]:
                inside[key].append(row["inside"])
            else:
                without[key] += 1
    return {k: (Rate(sum(v), len(v)), without[k]) for k, v in inside.items()}


def median(values: Sequence[float]) -> float:
    """Return the median; NaN of nothing."""
    ordered = sorted(v for v in values if v is not None and math.isfinite(v))
    n = len(ordered)
    return math.nan if not n else 0.5 * (ordered[(n - 1) // 2] + ordered[n // 2])
