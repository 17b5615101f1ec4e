"""One case: study it as a user would, fit the true model, and write down what happened."""

from __future__ import annotations

import math
import time
import traceback
from typing import Any

import luztar
from luztar.diagnosis import Diagnosis, Study

from .cases import Case, Measured, measure
from .rivals import cosines

TABLE_LENGTH = 6


def run(case: Case) -> dict[str, Any]:
    """Return the record of a case; a failure is a record too."""
    head = {"key": case.key, "effect": case.effect, "size": case.size, "noise": case.noise, "number": case.number}
    head |= {"kind": case.kind, "peers": case.peers, "seed": case.seed()}
    started = time.perf_counter()
    try:
        body = _peers(case) if case.peers else _luztar(case)
    except Exception as problem:  # a calibration goes on; the page counts the failures
        last = traceback.extract_tb(problem.__traceback__)[-1]
        body = {"failed": f"{type(problem).__name__}: {problem} ({last.name}, line {last.lineno})"}
    return {**head, **body, "seconds_all": round(time.perf_counter() - started, 3)}


def _peers(case: Case) -> dict[str, Any]:
    from .peers import look

    return {"found": look(measure(case))}


def _luztar(case: Case) -> dict[str, Any]:
    measured = measure(case)
    started = time.perf_counter()
    study = luztar.study(case.start(), measured.runs)
    seconds = time.perf_counter() - started
    first = study.first
    record = {
        "seconds": round(seconds, 3),
        **outcome(case, study),
        "p_value": first.detection.p_value,
        "lack_of_fit": first.detection.lack_of_fit,
        "along": first.detection.along,
        "strokes": first.detection.strokes,
        "said_missing": first.verdict != "nothing_missing",
        "first_verdict": first.verdict,
        "first_named": list(first.named),
        "first_set": list(first.judgement.equivalent),
        "why": study.last.judgement.why,
        "last_p_value": study.last.detection.p_value,
        "last_lack_of_fit": study.last.detection.lack_of_fit,
        "last_along": study.last.detection.along,
        "table": table(case, first),
        "draws": {"base": measured.base, "hidden": measured.hidden},
    }
    if case.kind != "outside":
        record |= intervals(case, measured)
    if case.kind == "null":
        record["kinds"] = first.detection.kinds
    if case.kind == "effect":
        near = cosines(case, measured, study.noise_floor)
        record["rivals"] = {n: round(c, 4) for n, c in sorted(near.items(), key=lambda x: -x[1])[:4]}
        record["cosine"] = max(near.values(), default=None)
    return record


def outcome(case: Case, study: Study) -> dict[str, Any]:
    """Return what the study ended with, judged against the truth."""
    added = [s for s in study.steps if s.added]
    sets = [list(s.set) for s in added]
    sure = [s for s in added if not s.provisional]
    right = set(case.right)
    before, after = study.steps[0].fit.error, study.steps[-1].fit.error
    return {
        "verdict": study.verdict,
        "named": list(study.named),
        "added": [s.added for s in added],
        "sets": sets,
        "exact": len(study.named) == 1 and study.named[0] in right,
        "in_set": any(len(s.set) <= 3 and right & set(s.set) for s in sure),
        "one_step_in_set": len(sure) == 1 and len(sure[0].set) <= 3 and bool(right & set(sure[0].set)),
        "wrong": [n for n in study.named if n not in right],
        "floor": study.noise_floor.rms,
        "before": before.floor_ratio,
        "after": after.floor_ratio,
        "held_out_before": before.held_out_rms,
        "held_out_after": after.held_out_rms,
    }


def table(case: Case, look: Diagnosis) -> list[dict[str, Any]]:
    """Return the head of the list of candidates, the truth with it."""
    rows = []
    for place, c in enumerate(look.candidates):
        if place < TABLE_LENGTH or c.effect in case.right:
            row = {"effect": c.effect, "place": place + 1, "gain": c.gain, "gain_errors": c.gain_errors}
            row |= {"p_value": c.p_value, "in_set": c.in_set, "same_as": c.same_as, "held_out_rms": c.held_out_rms}
            rows.append(row | {"parameters": c.parameters})
    return rows


def intervals(case: Case, measured: Measured) -> dict[str, Any]:
    """Fit the true model and ask of every parameter whether its interval holds the truth."""
    fitted = luztar.fit(case.true_model(), measured.runs)
    truth = measured.truth()
    out = {}
    for key, estimate in fitted.parameters.items():
        if key not in truth or estimate.note == "given":
            continue
        true = truth[key]
        row: dict[str, Any] = {"value": estimate.value, "truth": true, "identifiable": estimate.identifiable}
        if estimate.low is not None and estimate.high is not None:
            if key.endswith(".phase_rad"):  # the same angle a turn further on is the same angle
                true += 2.0 * math.pi * round((estimate.value - true) / (2.0 * math.pi))
            row |= {"low": estimate.low, "high": estimate.high, "inside": estimate.low <= true <= estimate.high}
            row["truth"] = true
        out[key] = row
    return {"intervals": out, "true_after": fitted.error.floor_ratio, "true_held_out": fitted.error.held_out_rms}
