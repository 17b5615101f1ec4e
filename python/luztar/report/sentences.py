"""The study's verdict and what to do next, in sentences."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

from ..model import card
from ..model.negative import in_sense
from .style import rounded

if TYPE_CHECKING:
    from ..diagnosis.diagnose import Diagnosis, Tried
    from ..diagnosis.study import Study
    from ..tb038.check import Check

VERDICT_MEANING = {
    "nothing_missing": "No test finds anything in the error that repeats.",
    "named": "One effect takes more off the unseen error than any other, beyond chance.",
    "one_of": "Several effects take the same off the unseen error; this measurement cannot tell which is at work.",
    "unexplained": "Something in the error repeats, and no effect of the catalogue takes it away.",
    "too_few_strokes": "The record holds too few strokes to tell an effect from chance.",
    "below_practical_size": "Something in the error repeats, but it is too small to matter in practice.",
}
CHECK_MEANING = {
    "pass": "Every verification is within the limits.",
    "fail": "At least one readable verification is outside the limits.",
    "inconclusive": "The readings do not allow a verdict; the reasons stand in the table.",
}


def titles(names: Sequence[str], structure: str, joint: str) -> str:
    """Return effects by their titles: ``a, b and c``."""
    words = [card(n, structure).title for n in names]
    return "".join(words) if len(words) < 2 else f"{', '.join(words[:-1])} {joint} {words[-1]}"


def verdict(study: Study) -> str:
    """Return the study's verdict as one sentence, or two where it stopped half way."""
    structure = study.model.structure_name
    if study.verdict == "unexplained":
        tried = [s.added for s in study.steps if s.added]
        rest = f" Tried and not enough: {titles(tried, structure, 'and')}." if tried else ""
        return f"Something is missing that no effect of the catalogue explains.{rest}"
    found = _found(study)
    if not found:
        names = titles(study.last.named, structure, "or")
        return {
            "nothing_missing": "Nothing is missing from the model that this measurement can show.",
            "named": f"Missing from the model: {names}.",
            "one_of": f"Missing from the model: {names}; this measurement cannot tell which.",
            "too_few_strokes": "There are too few strokes to say whether anything is missing.",
            "below_practical_size": "Something may be missing, but this measurement can neither name it nor show a "
            "gain worth having.",
        }[study.verdict]
    return f"Missing from the model: {found}. {_end(study)}"


def _found(study: Study) -> str:
    structure = study.model.structure_name
    parts = []
    for step in study.steps:
        if step.added is None:
            continue
        text = titles(step.set, structure, "or") if len(step.set) > 1 else card(step.added, structure).title
        parts.append(f"either {text} (this measurement cannot tell which)" if len(step.set) > 1 else text)
    if len(parts) < 2:
        return "".join(parts)
    return f"{', '.join(parts[:-1])} and {parts[-1]}"


def _end(study: Study) -> str:
    structure = study.model.structure_name
    if study.last.named:
        more = titles(study.last.named, structure, "or")
        return f"The study stopped at its limit of effects; {more} would take off more."
    it = "it" if len(study.steps) == 2 else "them"
    return {
        "nothing_missing": f"With {it}, nothing is missing that this measurement can show.",
        "below_practical_size": f"With {it}, what is left can neither be named nor is it worth having.",
        "too_few_strokes": "There are too few strokes to say more.",
    }.get(study.verdict, "")


def outcome(look: Diagnosis) -> str:
    """Return what one look at the candidates came to."""
    names = titles(look.named, look.fit.model.structure_name, "or") if look.named else ""
    why = f": {look.judgement.why}" if look.judgement.why else ""
    if names:
        return f"Best: {names}{why}."
    return f"None of them is named{why}."


def error_sentence(study: Study) -> str:
    """Return the error before and after against the floor as one sentence."""
    first, last = study.steps[0].fit.error, study.steps[-1].fit.error
    floor = study.noise_floor
    limit = f"the noise floor is {rounded(floor.rms)} {floor.unit} ({rounded(floor.low)} to {rounded(floor.high)})"
    if last.held_out_rms < floor.low:
        limit += "; the error lies below it, so this estimate of the floor is too high"
    if len(study.steps) == 1:
        return (
            f"The model misses {study.model.structure.effort} it has not seen by {rounded(first.held_out_rms)} "
            f"{first.unit} rms ({100 * first.held_out_relative:.1f} % of the measurement); {limit}."
        )
    return (
        f"The unseen error falls from {rounded(first.held_out_rms)} to {rounded(last.held_out_rms)} {first.unit} rms "
        f"({100 * first.held_out_relative:.1f} to {100 * last.held_out_relative:.1f} % of the measurement); {limit}."
    )


def values_found(study: Study, name: str) -> dict[str, float]:
    """Return an effect's parameters as the study found them: in the last model, else in the last look that tried it."""
    fitted = {
        k.partition(".")[2]: e.value for k, e in study.steps[-1].fit.parameters.items() if k.startswith(f"{name}.")
    }
    tried = [c.parameters for look in reversed(study.looks) for c in look.candidates if c.effect == name]
    return fitted or (tried[0] if tried else {})


def came_out(c: Tried, look: Diagnosis) -> str:
    """Return what a candidate turned out to be where its best values make it a simpler effect; else nothing."""
    if not c.same_as:
        return ""
    # Beside what is in the model already it does nothing, and its gain is chance.
    return f"adds nothing to {c.same_as}" if c.same_as in look.fit.model.effects else f"came out as {c.same_as}"


def actions(study: Study | None, check: Check | None) -> list[tuple[str, str]]:
    """Return what to do next: (why, what), the most useful first; nothing where nothing is to be done.

    The check's advice first, for it decides whether the readings can be used; then the workshop's check of each effect
    found, then the measurement that would tell apart what this one could not.
    """
    found: list[tuple[str, str]] = []
    if check is not None:
        found += [(check.rule_set, sentence) for sentence in check.advice]
    if study is None:
        return found
    structure = study.model.structure_name
    found += _offset_or_direction(study, check)
    names: list[str] = []
    for step in study.steps:
        if step.added is not None and not step.provisional:
            names += [n for n in step.set or (step.added,) if n not in names]
    names += [n for n in study.last.named if n not in names and study.verdict != "unexplained"]
    for name in names:
        entry = in_sense(card(name, structure), values_found(study, name))
        found.append((entry.title, f"{entry.check} Usual cause: {_lower(entry.cause)}"))
    seen: set[str] = set()
    for experiment in [*(s.next_experiment for s in study.steps if not s.provisional), study.last.next_experiment]:
        if experiment is not None and experiment.text not in seen:
            seen.add(experiment.text)
            found.append((_to_tell(experiment.separates, structure), experiment.text))
    if study.verdict == "unexplained":
        where = study.last.where[0].text if study.last.where else "It lies nowhere in particular."
        found.append(
            (
                "Not explained",
                f"Look at the mechanism where the error lies: {_lower(where)} Record the suspect channel (temperature, "
                "load, supply) beside the torque, and do not use the provisional parameters.",
            )
        )
    return found


def _offset_or_direction(study: Study, check: Check | None) -> list[tuple[str, str]]:
    """Say how much of the hysteresis centre is an offset where the study found friction that has a direction."""
    both = [n for n in study.named if n in ("asymmetric_coulomb", "asymmetric_viscous")]
    offset = study.steps[-1].fit.parameters.get("offset.level_nm")
    if check is None or check.offset_nm is None or offset is None or not offset.identifiable or not both:
        return []
    friction = titles(both, study.model.structure_name, "and")
    size = f"{offset.value:+.3f} Nm"
    if offset.low is not None and offset.high is not None:
        size += f" ({offset.low:+.3f} to {offset.high:+.3f})"
    return [
        (
            "Offset",
            f"Of the hysteresis centre of {check.offset_nm:+.3f} Nm the study takes {size} for the sensor's offset and "
            f"the rest for {friction}: shift the analogue offset by no more than that.",
        )
    ]


def _to_tell(separates: Sequence[str], structure: str) -> str:
    return f"To tell {titles(separates, structure, 'and')} apart" if len(separates) > 1 else "Next measurement"


def _lower(text: str) -> str:
    # An abbreviation stays as it is.
    return text if text[1:2].isupper() else text[:1].lower() + text[1:]
