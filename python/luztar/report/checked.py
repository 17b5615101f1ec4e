"""What a report shows of a TB 038 check, as plain values for the template."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from . import sentences

if TYPE_CHECKING:
    from ..tb038.check import Check

# A verdict is told by a word and a class of colour, never by the colour alone.
SETTLED = {"pass": "good", "fail": "bad", "inconclusive": "open"}


def section(check: Check) -> dict[str, Any]:
    """Return what a report shows of a check."""
    rules = check.rules
    return {
        "rule_set": check.rule_set,
        "title": rules.title,
        "verdict": check.verdict,
        "class": SETTLED[check.verdict],
        "meaning": sentences.CHECK_MEANING[check.verdict],
        "centred": check.centred,
        "recorded": check.as_recorded.verdict if check.centred else None,
        "offset": None if check.offset_nm is None else f"{check.offset_nm:+.3f}",
        "limits": {
            "max": f"{rules.mean_max_nm:g}",
            "min": f"{rules.mean_above_nm:g}",
            "std": f"{rules.std_below_nm:g}",
            "half": f"{rules.half_width_deg:g}",
            "max_at": rules.section("mean_max"),
            "min_at": rules.section("mean_above"),
            "std_at": rules.section("std"),
        },
        "rows": [
            {
                "run": v.run,
                "direction": v.direction,
                "mean": _fixed(v.mean_nm),
                "std": _fixed(v.std_nm),
                "largest": _fixed(v.max_abs_nm),
                "slope": "-" if v.slope_nm_per_deg is None else f"{v.slope_nm_per_deg:+.5f}",
                "speed": _fixed(v.max_speed_deg_s, 1),
                "samples": v.samples,
                "mean_wrong": v.below_max is False or v.above_min is False,
                "std_wrong": v.steady is False,
                "verdict": v.verdict,
                "class": SETTLED[v.verdict],
                "why": v.why,
            }
            for v in check.verifications
        ],
        "filter": filter_words(check),
        "per_turn": _per_turn(check),
        "checklist": [{"step": item.step, "text": item.text} for item in check.checklist],
    }


def filter_words(check: Check) -> str:
    """Return how the check's filter was read, in words."""
    used = check.filter
    return f"{used.poles} poles, {used.cutoff_hz:g} Hz: {used.passes}; {used.text}"


def _per_turn(check: Check) -> str:
    pattern = check.once_per_rev
    if pattern.amplitude_nm is None:
        return "not known"
    words = "prominent" if pattern.prominent else "not prominent"
    doubt = "" if pattern.identifiable else "; the range turned cannot tell it from a spring"
    return f"{pattern.amplitude_nm:.3f} Nm, {words}{doubt}"


def _fixed(value: float | None, digits: int = 3) -> str:
    return "-" if value is None else f"{value:.{digits}f}"
