"""Markdown tables."""

from __future__ import annotations

from collections.abc import Iterable, Sequence


def table(head: Sequence[str], rows: Iterable[Sequence[object]], *, text: bool = False) -> str:
    """Return a Markdown table: the first column left, the others right unless they are text."""
    side = " --- |" if text else " ---: |"
    lines = [f"| {' | '.join(head)} |", f"| --- |{side * (len(head) - 1)}"]
    return "\n".join([*lines, *(f"| {' | '.join(str(c) for c in row)} |" for row in rows)])
