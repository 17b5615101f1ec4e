"""Which kind of test rejects: candidates outside and inside the reversal zones, cells, gain on unseen strokes."""

from __future__ import annotations

import numpy as np

from luztar.diagnosis.candidates import baseline, try_all
from luztar.diagnosis.chance import one_sided, p_values, signs, studentised
from luztar.diagnosis.fit import Fit
from luztar.diagnosis.jacobian import continuous, jacobian
from luztar.diagnosis.score import _scores, cells

CELLS = ("state", "time", "reversal")
FAMILIES = ("candidates outside zones", "candidates inside zones", *CELLS, "gain on unseen strokes")


def families(fitted: Fit) -> dict[str, tuple[float, str]]:
    """Return a p-value per family, adjusted inside it and not across families, and what is strongest in it."""
    problem, state = fitted.problem, fitted.state
    found, features = try_all(fitted)
    features = [*features, *cells(problem.runs)]
    made = jacobian(problem, state, continuous(problem, state, sharpness=True))
    shift, bound = float(state.coefficients[-1]), state.blocks.bound
    scores = _scores(problem.runs, made.matrix, features, problem.weights, shift, bound)
    flips = signs(sum(len(r.strokes) for r in problem.runs))
    joined: dict[tuple[str, str], list[np.ndarray]] = {}
    for feature, score in zip(features, scores, strict=True):
        if np.count_nonzero(np.any(score != 0.0, axis=1)) < 2:
            continue
        inside = FAMILIES[1] if feature.inside_zones else FAMILIES[0]
        family = feature.name if feature.name in CELLS else inside
        joined.setdefault((family, feature.name), []).append(studentised(score, flips))
    out = {}
    for family in FAMILIES:
        names = [name for f, name in joined if f == family]
        if not names:
            continue
        drawn = []
        for name in names:
            parts = np.hstack(joined[(family, name)])
            drawn.append(parts.sum(axis=1) if family in CELLS else parts.max(axis=1))
        single = p_values(np.column_stack(drawn))
        adjusted = float(p_values(-single.min(axis=1)[:, None])[0, 0])
        out[family] = (adjusted, names[int(np.argmin(single[0]))])
    before = baseline(fitted).losses
    gains = np.column_stack([before - c.search.losses for c in found])
    drawn_gain = one_sided(gains, flips)
    best = found[int(np.argmax(drawn_gain[0]))].name
    out[FAMILIES[-1]] = (float(p_values(drawn_gain.max(axis=1)[:, None])[0, 0]), best)
    return out
