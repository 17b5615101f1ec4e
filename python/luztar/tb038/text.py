"""A check in words: a plain-text page for the terminal, a table for a notebook."""

from __future__ import annotations

from collections.abc import Sequence
from html import escape
from typing import TYPE_CHECKING

from .checklist import as_html as checklist_html
from .checklist import as_text as checklist_text
from .verification import Verification

if TYPE_CHECKING:
    from .check import Check

_HEAD = ("run", "direction", "mean Nm", "std Nm", "min..max |T| Nm", "slope Nm/deg", "samples", "deg/s", "verdict")


def as_text(check: Check) -> str:
    """Return the check as plain text."""
    filter_ = check.filter
    lines = [f"{check.rule_set}: {check.verdict.upper()}{' (hysteresis centre removed)' if check.centred else ''}", ""]
    lines += _table(check.verifications)
    if check.other is not None:
        lines += ["", f"As recorded: {check.other.verdict.upper()}", *_table(check.other.verifications)]
    rules = check.rules
    lines += [
        "",
        f"Limits     mean <= {rules.mean_max_nm:g} Nm ({rules.section('mean_max')}), mean > {rules.mean_above_nm:g} Nm "
        f"({rules.section('mean_above')}), std < {rules.std_below_nm:g} Nm ({rules.section('std')})",
        f"Filter     {filter_.poles} poles, {filter_.cutoff_hz:g} Hz: {filter_.passes}; {filter_.text}",
        f"Offset     {_number(check.offset_nm, '+.3f')} Nm (hysteresis centre)",
        f"Per turn   {_pattern(check)}",
    ]
    if check.advice:
        lines += ["", "Advice", *(f"  - {sentence}" for sentence in check.advice)]
    findings = [
        f"  {'!' if f['doubtful'] else '-'} {report['run']}: {f['text']}"
        for report in check.integrity
        for f in report["findings"]
    ]
    if findings:
        lines += ["", "Data", *findings]
    if check.checklist:
        lines += ["", "To tick before the readings", checklist_text(check.checklist)]
    return "\n".join(lines)


def as_html(check: Check) -> str:
    """Return the check as an HTML fragment; every name from a file is escaped."""
    body = "".join(
        "<tr>" + "".join(f"<td>{escape(cell)}</td>" for cell in (*_cells(v), v.why or "")) + "</tr>"
        for v in check.verifications
    )
    head = "".join(f"<th>{escape(cell)}</th>" for cell in (*_HEAD, "why"))
    advice = "".join(f"<li>{escape(sentence)}</li>" for sentence in check.advice)
    recorded = f" (hysteresis centre removed; as recorded: {escape(check.other.verdict)})" if check.other else ""
    return (
        f"<p><b>{escape(check.rule_set)}: {escape(check.verdict)}</b>{recorded}</p>"
        f"<table><thead><tr>{head}</tr></thead><tbody>{body}</tbody></table>"
        f"<p>{escape(check.filter.passes)}; {escape(check.filter.text)}. "
        f"Hysteresis centre {_number(check.offset_nm, '+.3f')} Nm. {escape(_pattern(check))}</p>"
        f"<ul>{advice}</ul>{checklist_html(check.checklist)}"
    )


def _table(verifications: Sequence[Verification]) -> list[str]:
    rows = [_HEAD, *(_cells(v) for v in verifications)]
    width = [max(len(row[i]) for row in rows) for i in range(len(_HEAD))]
    lines = []
    for row, verification in zip(rows, [None, *verifications], strict=True):
        # Words to the left, numbers to the right.
        cells = [c.ljust(w) if i in (0, 1, 8) else c.rjust(w) for i, (c, w) in enumerate(zip(row, width, strict=True))]
        lines.append("  ".join(cells).rstrip())
        if verification is not None and verification.why:
            lines.append(f"    {verification.why}")
    return lines


def _cells(v: Verification) -> tuple[str, ...]:
    span = f"{_number(v.min_abs_nm, '.3f')}..{_number(v.max_abs_nm, '.3f')}"
    return (
        v.run,
        v.direction,
        _number(v.mean_nm, ".3f"),
        _number(v.std_nm, ".3f"),
        span,
        _number(v.slope_nm_per_deg, "+.5f"),
        str(v.samples),
        _number(v.max_speed_deg_s, ".1f"),
        v.verdict,
    )


def _pattern(check: Check) -> str:
    pattern = check.once_per_rev
    if pattern.amplitude_nm is None or pattern.range_deg is None:
        return "once-per-turn amplitude not known"
    sure = f" +- {pattern.standard_error_nm:.3f}" if pattern.standard_error_nm is not None else ""
    told = "can" if pattern.identifiable else "cannot"
    return (
        f"amplitude {pattern.amplitude_nm:.3f}{sure} Nm, {'' if pattern.prominent else 'not '}prominent; "
        f"{pattern.range_deg:.0f} deg of angle {told} tell it from a spring"
    )


def _number(value: float | None, form: str) -> str:
    return "-" if value is None else format(value, form)
