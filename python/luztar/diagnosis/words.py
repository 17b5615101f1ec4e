"""Results in plain text, as they print themselves."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

from ..model import card
from ..model.negative import in_sense
from .flags import flag_lines

if TYPE_CHECKING:
    from .compare import Comparison
    from .diagnose import Diagnosis
    from .fit import Fit
    from .intervals import Estimate
    from .study import Study


def number(value: float | None) -> str:
    """Return a number with four significant digits, or a dash."""
    return "-" if value is None else f"{value:.4g}"


def parameter_lines(parameters: dict[str, Estimate]) -> list[str]:
    """Return one line per parameter: value, 95 % interval, unit, remark."""
    width = max((len(k) for k in parameters), default=0)
    lines = []
    for key, e in parameters.items():
        interval = f"[{number(e.low)}, {number(e.high)}]" if e.low is not None else ""
        lines.append(f"  {key:<{width}}  {number(e.value):>10}  {interval:<22} {e.unit:<10} {e.note}".rstrip())
    return lines


def error_line(fit: Fit) -> str:
    """Return the error against the noise floor in one line."""
    e = fit.error
    return (
        f"error {number(e.rms)} {e.unit} ({100 * e.relative:.2f} %), unseen {number(e.held_out_rms)} {e.unit} "
        f"({100 * e.held_out_relative:.2f} %), {e.floor_ratio:.2f} times the noise floor of "
        f"{number(fit.noise_floor.rms)} {e.unit}"
    )


def fit_text(fit: Fit) -> str:
    """Return a fit as text."""
    head = f"{fit.model.structure_name}: {', '.join(fit.model.effects) or 'no effects'}"
    return "\n".join([head, error_line(fit), *parameter_lines(fit.parameters), *flag_lines(fit.flags)])


def comparison_text(comparison: Comparison) -> str:
    """Return a comparison as text."""
    return "\n".join([fit_text(comparison.fit), *_where(comparison.where)])


def _where(where: Sequence[object]) -> list[str]:
    lines = [f"  {w.text}" for w in list(where)[:4]]  # type: ignore[attr-defined]
    return ["where:", *lines] if lines else ["where: nowhere in particular"]


VERDICT_TEXT = {
    "nothing_missing": "Nothing is missing that this test can see.",
    "named": "Missing: {named}.",
    "one_of": "Missing: one of {named}; this test cannot tell which.",
    "unexplained": "Something is missing that no effect of the catalogue explains.",
    "too_few_strokes": "Too few strokes to say anything.",
    "below_practical_size": "Something may be missing, but this test can neither name it nor show a gain worth having.",
}


def verdict_sentence(verdict: str, named: Sequence[str], structure: str = "rig", why: str = "") -> str:
    """Return the verdict as a sentence; ``why`` is the judgement's reason."""
    if verdict == "unexplained" and "equally well" in why:
        return "Something is missing, and more effects explain it than this test can tell apart: none is named."
    titles = " or ".join(f"{card(n, structure).title} ({n})" for n in named)
    return VERDICT_TEXT[verdict].format(named=titles)


def diagnosis_text(look: Diagnosis) -> str:
    """Return a diagnosis as text."""
    lines = [verdict_sentence(look.verdict, look.named, look.fit.model.structure_name, look.judgement.why)]
    if look.judgement.why:
        lines.append(f"({look.judgement.why})")
    lines += [error_line(look.fit), *flag_lines(look.fit.flags), *_where(look.where), "candidates by unseen error:"]
    for c in look.candidates[:8]:
        marks = [m for m, on in (("in the set", c.in_set), ("decoy", c.decoy)) if on]
        if c.same_as:
            inside = c.same_as in look.fit.model.effects
            marks.append(f"adds nothing to {c.same_as}" if inside else f"same as {c.same_as}")
        lines.append(f"  {c.effect:<20} {number(c.held_out_rms):>10}  gain {100 * c.gain:6.1f} %  {', '.join(marks)}")
    if look.next_experiment:
        lines.append(f"next: {look.next_experiment.text}")
    return "\n".join(line.rstrip() for line in lines)


def ladder_lines(study: Study) -> list[str]:
    """Return one line per step with a bar of the unseen error."""
    top = max(s.fit.error.held_out_rms for s in study.steps)
    lines = []
    for s in study.steps:
        e = s.fit.error
        name = s.added or "as given"
        if s.added and len(s.set) > 1:
            name += f" (or {', '.join(n for n in s.set if n != s.added)})"
        ratio = e.held_out_rms / max(study.noise_floor.rms, 1e-300)
        bar = "#" * max(1, round(30 * e.held_out_rms / top)) if top > 0 else ""
        mark = "  provisional" if s.provisional else ""
        lines.append(f"  {name:<38} {number(e.held_out_rms):>9} {e.unit}  x{ratio:4.1f} floor  {bar}{mark}")
    floor = study.noise_floor
    bar = "." * min(30, max(1, round(30 * floor.rms / top))) if top > floor.rms / 30 else "." * 30
    lines.append(f"  {'noise floor':<38} {number(floor.rms):>9} {floor.unit}               {bar}")
    return lines


def _turned(study: Study) -> list[str]:
    """Return a line for every effect that was added and does the opposite of what its name says."""
    last = study.steps[-1].fit
    lines = []
    for name in (s.added for s in study.steps if s.added):
        described = card(name, last.model.structure_name)
        values = {k.partition(".")[2]: e.value for k, e in last.parameters.items() if k.startswith(f"{name}.")}
        found = in_sense(described, values)
        if found != described:
            lines.append(f"note: {name} is negative. {found.look}")
    return lines


def next_texts(study: Study) -> list[str]:
    """Return the tests to do after a study, each once: those of its steps, then that of the last look."""
    asked = [*(s.next_experiment for s in study.steps if not s.provisional), study.last.next_experiment]
    return list(dict.fromkeys(e.text for e in asked if e is not None))


def study_text(study: Study) -> str:
    """Return a study as text."""
    lines = ["unseen error, step by step:", *ladder_lines(study)]
    why = study.last.judgement.why
    sentence = verdict_sentence(study.verdict, study.last.named, study.model.structure_name, why)
    if study.named and study.verdict == "below_practical_size":
        beside = " and ".join(card(n, study.model.structure_name).title for n in study.named)
        sentence = (
            f"Beside {beside} something may be left, but this test can neither name it nor show a gain worth having."
        )
    lines.append(sentence)
    lines += [f"next: {text}" for text in next_texts(study)]
    lines += _turned(study)
    lines += [
        "parameters of the last model (95 % intervals by stroke):",
        *parameter_lines(study.steps[-1].fit.parameters),
        *flag_lines(study.steps[-1].fit.flags),
    ]
    return "\n".join(lines)
