"""What stands in a report, as plain values for the template: no HTML here, no decisions there."""

from __future__ import annotations

import math
import platform
from datetime import datetime
from typing import TYPE_CHECKING, Any

import numpy as np

from .. import __version__
from ..diagnosis.chance import p_value_floor
from ..diagnosis.verdict import MANY_STROKES
from ..diagnosis.words import number
from ..model import card
from ..model.negative import in_sense
from . import checked, sentences
from .style import rounded

if TYPE_CHECKING:
    from ..diagnosis.diagnose import Diagnosis, Tried
    from ..diagnosis.study import Step, Study
    from ..tb038.check import Check

# A verdict is told by a word and a class of colour, never by the colour alone.
CLASS_OF_VERDICT = {
    "nothing_missing": "good",
    "named": "found",
    "one_of": "found",
    "below_practical_size": "good",
    "unexplained": "open",
    "too_few_strokes": "open",
}
WORST_SHOWN = 4


def provenance(study: Study | None, check: Check | None, when: datetime) -> dict[str, Any]:
    """Return where a report comes from: versions, date, inputs with their hashes."""
    made: dict[str, Any] = {
        "schema": 1,
        "date": when.isoformat(timespec="seconds"),
        "versions": {"luztar": __version__, "python": platform.python_version(), "numpy": np.__version__},
        "inputs": [],
    }
    if study is not None:
        for run, held_out in [*((r, False) for r in study.runs), *((r, True) for r in study.held_out)]:
            made["inputs"].append({**run.to_dict(), "source": None, "held_out": held_out})
        made["model"] = study.model.to_dict()
    elif check is not None:
        for report in check.integrity:
            integrity = {k: v for k, v in report.items() if k != "run"}
            made["inputs"].append({"name": report["run"], "sha256": None, "held_out": False, "integrity": integrity})
    return made


def sections(study: Study | None, check: Check | None, not_checked: str | None, made: dict[str, Any]) -> dict[str, Any]:
    """Return everything the template shows except figures and scripts."""
    return {
        "title": "Friction report",
        "date": made["date"].replace("T", " "),
        "versions": made["versions"],
        "inputs": [_input(i) for i in made["inputs"]],
        "study": None if study is None else _study(study),
        "check": None if check is None else checked.section(check),
        "not_checked": not_checked,
        "actions": sentences.actions(study, check),
        "settings": _settings(study, check),
    }


def _study(study: Study) -> dict[str, Any]:
    fit = study.steps[-1].fit
    return {
        "verdict": study.verdict,
        "class": CLASS_OF_VERDICT[study.verdict]
        if len(study.steps) == 1 or study.verdict == "unexplained"
        else "found",
        "sentence": sentences.verdict(study),
        "meaning": sentences.VERDICT_MEANING[study.verdict],
        "why": study.last.judgement.why,
        "error": sentences.error_sentence(study),
        "motion": fit.model.structure.motion,
        "effort": fit.model.structure.effort,
        "unit": fit.noise_floor.unit,
        "floor": {
            "rms": rounded(study.noise_floor.rms),
            "low": rounded(study.noise_floor.low),
            "high": rounded(study.noise_floor.high),
            "method": study.noise_floor.method,
        },
        "improved": len(study.steps) > 1,
        "steps": _steps(study),
        "where_before": [r.text for r in study.first.where[:WORST_SHOWN]],
        "where_after": [r.text for r in study.last.where[:WORST_SHOWN]],
        "first": _look(study.first),
        "last": _look(study.last) if len(study.looks) > 1 else None,
        "parameters": _parameters(study),
        "flags": [f.text for f in fit.flags],
        "provisional": any(s.provisional for s in study.steps),
        "held_out": len(study.held_out) > 0,
        "runs": len(study.runs),
    }


def _steps(study: Study) -> list[dict[str, Any]]:
    structure = study.model.structure_name
    rows = []
    for place, step in enumerate(study.steps):
        e = step.fit.error
        rows.append(
            {
                "place": place,
                "name": "model as given" if step.added is None else card(step.added, structure).title,
                "effect": step.added,
                "look": None if step.added is None else _look_of(step),
                "others": [card(n, structure).title for n in step.set if n != step.added],
                "effects": ", ".join(step.fit.model.effects) or "no effects",
                "unseen": rounded(e.held_out_rms),
                "unseen_percent": f"{100 * e.held_out_relative:.1f}",
                "seen": rounded(e.rms),
                "floor_ratio": f"{e.floor_ratio:.1f}",
                "provisional": step.provisional,
                "experiment": step.next_experiment.text if step.next_experiment else None,
            }
        )
    return rows


def _look_of(step: Step) -> str:
    name = step.added or ""
    values = {k.partition(".")[2]: e.value for k, e in step.fit.parameters.items() if k.startswith(f"{name}.")}
    return in_sense(card(name, step.fit.model.structure_name), values).look


def _look(look: Diagnosis) -> dict[str, Any]:
    structure = look.fit.model.structure_name
    return {
        "effects": ", ".join(look.fit.model.effects) or "no effects",
        "verdict": look.verdict,
        "why": look.judgement.why,
        "strokes": look.detection.strokes,
        "p_value": probability(look.detection.p_value),
        "p_floor": probability(p_value_floor(look.detection.strokes))
        if look.detection.strokes < MANY_STROKES
        else None,
        "outcome": sentences.outcome(look),
        "candidates": [
            {
                "title": card(c.effect, structure).title,
                "effect": c.effect,
                "unseen": rounded(c.held_out_rms),
                "gain": _tenths(100 * c.gain),
                "errors": _tenths(c.gain_errors),
                "remark": _remark(c, look),
                "offered": c.effect in look.named,
                "decoy": c.decoy,
                "parameters": [f"{k} = {number(v)}" for k, v in c.parameters.items()],
            }
            for c in look.candidates
        ],
    }


def _remark(c: Tried, look: Diagnosis) -> str:
    words = ["decoy"] if c.decoy else []
    words += [sentences.came_out(c, look)] if c.same_as else []
    if look.named and c.in_set:
        words += ["best" if c.effect == look.named[0] else "cannot be told from the best"]
    return ", ".join(words)


def _parameters(study: Study) -> list[dict[str, Any]]:
    structure = study.model.structure_name
    rows = []
    for key, e in study.steps[-1].fit.parameters.items():
        effect, _, parameter = key.partition(".")
        meaning = next((p.meaning for p in card(effect, structure).parameters if p.key == parameter), "")
        given = e.note == "given"
        rows.append(
            {
                "effect": effect,
                "key": parameter,
                "meaning": meaning,
                "value": number(e.value),
                "interval": "" if e.low is None or given else f"{number(e.low)} to {number(e.high)}",
                "unit": e.unit,
                "degrees": _in_degrees(e.value, e.unit),
                "note": e.note,
                "sound": e.identifiable,
            }
        )
    return rows


def _in_degrees(value: float, unit: str) -> str:
    return f"{number(math.degrees(value))} {unit.replace('rad', 'deg')}" if unit in ("rad", "rad/s") else ""


def _input(given: dict[str, Any]) -> dict[str, Any]:
    integrity = given["integrity"]
    rate = given.get("sample_rate_hz")
    if rate is None and integrity["dt_median_s"]:
        pace = f"about {1.0 / integrity['dt_median_s']:.4g} Hz"
    else:
        pace = "not evenly sampled" if rate is None else f"{rate:g} Hz"
    declared = integrity["rows_declared"]
    rows = f"{integrity['rows_read']} rows" + (f" of {declared} declared" if declared is not None else "")
    units = integrity["units"]
    return {
        "name": given["name"],
        "held_out": given["held_out"],
        "sha256": given["sha256"],
        "rows": rows,
        "pace": pace,
        "complete": integrity["complete"],
        "columns": [
            {"channel": k, "column": column, "read": units[k]["read"] if k in units else ""}
            for k, column in integrity["columns"].items()
        ],
        "findings": [{"text": f["text"], "doubtful": f["doubtful"]} for f in integrity["findings"]],
    }


def _settings(study: Study | None, check: Check | None) -> list[tuple[str, str]]:
    rows: list[tuple[str, str]] = []
    if study is not None:
        model = study.model
        rows += [
            ("Structure", f"{model.structure_name}: {model.structure.driven_by} in, {model.structure.effort} out"),
            ("Model as given", ", ".join(study.steps[0].fit.model.effects) or "no effects"),
            ("Model after the last step", ", ".join(model.effects)),
            ("Given, not estimated", ", ".join(f"{k} = {number(v)}" for k, v in model.known.items()) or "nothing"),
            ("Band of the comparison", "all of it" if model.band_hz is None else f"0 to {model.band_hz:g} Hz"),
            ("Filter of the comparison", _comparison_filter(study)),
            ("Unseen", _unseen(study)),
            ("Noise floor", study.noise_floor.method),
        ]
    if check is not None:
        rows += [("Rule set", check.rules.title), ("Filter of the check", checked.filter_words(check))]
        rows += [("Hysteresis centre", "removed before the verdict" if check.centred else "left as recorded")]
    return rows


def _comparison_filter(study: Study) -> str:
    if study.model.structure.is_free:
        return "none: the channels are compared as recorded"
    text = "low pass of 4 poles, forward and backward, the same on measurement and model"
    if study.model.comparison.filter_already_applied:
        text += "; the measurement was filtered before and is not filtered again"
    return text


def _unseen(study: Study) -> str:
    if len(study.held_out):
        return f"held-out runs, used for nothing but prediction: {', '.join(r.name for r in study.held_out)}"
    if len(study.runs) > 1:
        return "each run predicted from the others"
    return "strokes of the one run predicted in folds from the others"


def _tenths(value: float) -> str:
    # Adding zero turns -0.0 into 0.0.
    return f"{round(value, 1) + 0.0:.1f}"


def probability(value: float) -> str:
    """Return a p-value as it is read."""
    return "< 0.001" if value < 0.001 else f"{value:.2g}"
