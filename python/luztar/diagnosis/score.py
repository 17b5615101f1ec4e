"""Is something missing? Score tests of the candidates and of what repeats, each stroke one observation.

The residual of the fitted model is correlated, stroke by stroke, with what each candidate would add (score) and with
cells of state, time and travel since the reversal (lack of fit, which needs no candidate). Columns are freed of what
the model explains already. Reversal zones are left out, except for a test of their own of what only shows there.

The tests detect; they do not name. Score statistics saturate at the number of strokes and rank wrong candidates above
right ones: naming is by held-out error after refitting (see ``candidates``).
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from .chance import one_sided, p_values, signs, studentised, studentised_pairs
from .equations import Weights
from .floor import hats, travel_since_reversal
from .lines import line_frequencies_hz, line_scores
from .prepare import Prepared, stroke_of_samples, stroke_offsets

# Cells of the tests for lack of fit. A step or bump in the angle is a tenth of a usual range wide.
POSITION_CELLS = 12
SPEED_CELLS = 5
TIME_CELLS = 8
TRAVEL_CELLS = (0.0, 0.015, 0.03, 0.06, 0.12, 0.25, 0.5)
PRODUCT_CELLS = 8
# What gives the uncertain start of each stroke the weight it has in the fit.
Whitener = Callable[[np.ndarray], np.ndarray]
# Kinds of what repeats.
CELLS = ("state", "time", "reversal")
LACK = (*CELLS, "spectrum")
# Kinds of candidates' tests: outside the reversal zones, and inside for what only shows there.
CANDIDATES = ("candidates", "candidates in zones")


@dataclass(frozen=True)
class Feature:
    """One direction in which the residual may be wrong.

    Attributes
    ----------
    name : str
        The candidate, or a kind of :data:`LACK`.
    columns : tuple of ndarray, shape (n, q)
        Per run.
    inside_zones : bool
        Whether it is tested in the reversal zones rather than outside.
    """

    name: str
    columns: tuple[np.ndarray, ...]
    inside_zones: bool = False


@dataclass(frozen=True)
class Detection:
    """The outcome of the tests.

    Attributes
    ----------
    p_value : float
        That nothing is missing: one level over all tests.
    candidates : dict of str to float
        Adjusted p-value per candidate.
    lack_of_fit : float
        Adjusted p-value that nothing repeats which the model lacks, without reference to any candidate.
    along : str
        Where it repeats most: a kind of :data:`LACK`.
    strokes : int
    kinds : dict of str to (float, str)
        P-value of each kind of test by itself, and what is strongest in it.
    line_share : float
        Share of the residual's square that the strongest spectral line takes.
    """

    p_value: float
    candidates: dict[str, float]
    lack_of_fit: float
    along: str
    strokes: int
    kinds: dict[str, tuple[float, str]]
    line_share: float = 0.0


def cells(runs: Sequence[Prepared]) -> list[Feature]:
    """Return the directions of the tests for lack of fit."""
    low = min(float(r.motion.min()) for r in runs)
    high = max(float(r.motion.max()) for r in runs)
    longest = max(r.duration_s for r in runs)
    moving = np.concatenate([np.abs(r.speed)[r.usable & ~r.zone] for r in runs])
    speeds = np.quantile(moving, np.linspace(0.02, 0.98, SPEED_CELLS)) if moving.size else np.array([0.0, 1.0])
    speeds = np.unique(speeds)
    state, time, travel = [], [], []
    for r in runs:
        up = np.zeros(r.motion.size)
        for s in r.strokes:
            up[s.onset : s.last] = s.direction
        ways = [(up > 0)[:, None], (up < 0)[:, None]]
        place = hats(r.motion, np.linspace(low, high, POSITION_CELLS))
        speed = hats(np.abs(r.speed), speeds) if speeds.size > 1 else np.zeros((r.motion.size, 0))
        # What depends on place and speed together (a product) leaves nothing in either alone.
        product = hats(r.motion, np.linspace(low, high, PRODUCT_CELLS)) * r.speed[:, None]
        state.append(np.hstack([*(block * way for block in (place, speed) for way in ways), product]))
        clock = hats(r.time_s, np.linspace(0.0, longest, TIME_CELLS))
        time.append(np.hstack([clock, clock * up[:, None]]))
        since = hats(travel_since_reversal(r), (high - low) * np.array(TRAVEL_CELLS))[:, :-1]
        travel.append(np.hstack([since * way for way in ways]))
    return [Feature("state", tuple(state)), Feature("time", tuple(time)), Feature("reversal", tuple(travel))]


def detect(
    runs: Sequence[Prepared],
    model_columns: Sequence[np.ndarray],
    candidates: Sequence[Feature],
    weights: Weights,
    start_shift: float,
    start_bound: float,
    gains: np.ndarray | None = None,
) -> Detection:
    """Test whether something is missing from a model.

    Parameters
    ----------
    runs : sequence of Prepared
    model_columns : sequence of ndarray, shape (n, p + 1)
        The fitted model's columns and derivatives by its inner parameters, the shift of the starts, the measurement.
    candidates : sequence of Feature
        What each candidate would add; several features may carry the same name.
    weights : Weights
        What each stroke's own shift of its start is weighed against.
    start_shift, start_bound : float
        The fitted coefficient of the common shift of the starts (the last column) and the most it may be.
    gains : ndarray, shape (strokes, candidates), optional
        By how much each candidate lowers the held-out loss of every stroke. If nothing is missing a gain is as likely
        as a loss, or less: this sees what the score, which looks near zero only, does not.
    """
    count = sum(len(r.strokes) for r in runs)
    flips = signs(count)
    features = [*candidates, *cells(runs)]
    scores, line_share = _scores(runs, model_columns, features, weights, start_shift, start_bound)
    drawn: dict[tuple[str, str], list[np.ndarray]] = {}
    for feature, score in zip([*features, Feature("spectrum", ())], scores, strict=True):
        if np.count_nonzero(np.any(score != 0.0, axis=1)) > 1:
            of = studentised_pairs if feature.name == "spectrum" else studentised
            drawn.setdefault((_kind(feature), feature.name), []).append(of(score, flips))
    # A candidate is as strong as its best column, so is a line; cells add up, for a pattern is spread over them.
    joined = {
        key: np.hstack(parts).sum(axis=1) if key[0] in CELLS else np.hstack(parts).max(axis=1)
        for key, parts in drawn.items()
    }
    if gains is not None and gains.size:
        joined[("gain", "gain")] = one_sided(gains, flips).max(axis=1)
    if not joined:
        return Detection(1.0, {}, 1.0, "state", count, {})
    keys = list(joined)
    single = p_values(np.column_stack([joined[k] for k in keys]))
    kinds = list(dict.fromkeys(kind for kind, _ in keys))
    least = {kind: single[:, [i for i, k in enumerate(keys) if k[0] == kind]].min(axis=1) for kind in kinds}
    # Candidates are many and overlap: they share one place in the family, beside one for each kind of cell.
    grouped = p_values(-np.column_stack([least[kind] for kind in kinds]))
    overall = float(_smallest(grouped)[0])
    of_candidates = [i for i, (kind, _) in enumerate(keys) if kind in CANDIDATES]
    adjusted: dict[str, float] = {}
    for i in of_candidates:
        p = float(np.mean(single[:, of_candidates].min(axis=1) <= single[0, i] + 1e-12))
        adjusted[keys[i][1]] = min(p, adjusted.get(keys[i][1], 1.0))
    lack = [kinds.index(kind) for kind in LACK if kind in kinds]
    by_kind = {kind: (float(p), _strongest(keys, single, kind)) for kind, p in zip(kinds, grouped[0], strict=True)}
    if not lack:
        return Detection(overall, adjusted, 1.0, "state", count, by_kind)
    along = kinds[lack[int(np.argmin(grouped[0, lack]))]]
    return Detection(overall, adjusted, float(_smallest(grouped[:, lack])[0]), along, count, by_kind, line_share)


def _kind(feature: Feature) -> str:
    if feature.name in LACK:
        return feature.name
    return "candidates in zones" if feature.inside_zones else "candidates"


def _smallest(p: np.ndarray) -> np.ndarray:
    """Return the p-value of the smallest of several, per draw."""
    return p_values(-p.min(axis=1)[:, None])[:, 0]


def _strongest(keys: Sequence[tuple[str, str]], single: np.ndarray, kind: str) -> str:
    places = [i for i, k in enumerate(keys) if k[0] == kind]
    return keys[places[int(np.argmin(single[0, places]))]][1]


def _scores(
    runs: Sequence[Prepared],
    model_columns: Sequence[np.ndarray],
    features: Sequence[Feature],
    weights: Weights,
    start_shift: float,
    start_bound: float,
) -> tuple[list[np.ndarray], float]:
    """Return the scores of every feature, each of shape (strokes, q), then those of the spectral lines.

    The second value is the share of the residual's square that the strongest line takes.
    """
    out: list[np.ndarray] = [np.empty(0)] * len(features)
    line_share = 0.0
    for inside in (False, True):
        chosen = [i for i, f in enumerate(features) if f.inside_zones == inside]
        if not chosen:
            continue
        keep = [r.usable & (r.zone if inside else ~r.zone) for r in runs]
        offsets = stroke_offsets(runs)
        every = [stroke_of_samples(r, offset) for r, offset in offsets]
        colour = weights.colour
        tables = [
            colour.whitened(np.column_stack([_own_starts(r, m, o, n), m]), r.step_s)[k]
            for (r, n), m, o, k in zip(offsets, model_columns, every, keep, strict=True)
        ]
        owners = [o[k] for o, k in zip(every, keep, strict=True)]
        whiten = [_whitener(r, t[:, -2], o, n, weights) for (r, n), t, o in zip(offsets, tables, owners, strict=True)]
        table = np.concatenate([w(t) for w, t in zip(whiten, tables, strict=True)])
        basis, response = table[:, :-1], table[:, -1]
        # A common shift of the starts is the sensor's, not a missing effect, as long as it stays inside what the sensor
        # leaves open; beyond, it is taken off only as far as that.
        if abs(start_shift) >= 0.999 * start_bound:
            # The first column, what starts wrong by a share of their uncertainty add, is spent then as well.
            basis, response = basis[:, 1:-1], response - np.copysign(start_bound, start_shift) * basis[:, -1]
        q, _ = np.linalg.qr(_scaled(basis))
        residual = response - q @ (q.T @ response)
        owner = np.concatenate(owners)
        count = sum(len(r.strokes) for r in runs)
        belongs = (owner == np.arange(count)[:, None]).astype(float)
        for i in chosen:
            added = [colour.whitened(c, r.step_s)[k] for r, c, k in zip(runs, features[i].columns, keep, strict=True)]
            z = np.concatenate([w(c) for w, c in zip(whiten, added, strict=True)])
            z = z - q @ (q.T @ z)
            scores = belongs @ (z * residual[:, None])
            # A column that the model explains already has nothing left but rounding.
            scores[:, np.linalg.norm(z, axis=0) < 1e-9 * np.sqrt(len(z))] = 0.0
            out[i] = scores
        if not inside:
            frequencies = line_frequencies_hz(max(r.duration_s for r in runs), weights.band_hz)
            lines = _line_scores(runs, keep, whiten, owners, belongs, q, residual, frequencies)
            out.append(lines)
            # A sine and a cosine over n samples have the square n / 2 each.
            taken = np.sum(lines.sum(axis=0).reshape(-1, 2) ** 2, axis=1) / max(residual.size / 2.0, 1.0)
            line_share = float(taken.max(initial=0.0) / max(float(residual @ residual), np.finfo(float).tiny))
    return out, line_share


def _line_scores(
    runs: Sequence[Prepared],
    keep: Sequence[np.ndarray],
    whiten: Sequence[Whitener],
    owners: Sequence[np.ndarray],
    belongs: np.ndarray,
    q: np.ndarray,
    residual: np.ndarray,
    frequencies_hz: np.ndarray,
) -> np.ndarray:
    """Return the scores of the spectral lines, shape (strokes, 2 lines).

    The whitener is symmetric and stays inside a stroke: what it does to a line it may as well do to what the line is
    multiplied with.
    """
    parts, start = [], 0
    for r, k, w, owner in zip(runs, keep, whiten, owners, strict=True):
        rows = slice(start, start + int(k.sum()))
        start = rows.stop
        at_all = np.full(k.size, -1)
        at_all[k] = owner
        table = np.zeros((k.size, q.shape[1] + 1))
        table[k] = w(np.column_stack([q[rows], residual[rows]]))
        parts.append((at_all, table[:, -1], table[:, :-1], r.step_s))
    return line_scores(parts, belongs @ (q * residual[:, None]), frequencies_hz)


def _whitener(r: Prepared, shift: np.ndarray, owner: np.ndarray, offset: int, weights: Weights) -> Whitener:
    """Return the map that gives the uncertain start of each stroke the weight it has in the fit.

    The square root of ``I - z z' / (z'z + ridge)`` for each stroke's column ``z``.
    """
    parts = []
    for i, stroke in enumerate(r.strokes):
        inside = np.flatnonzero(owner == offset + i)
        z = shift[inside]
        length = float(z @ z)
        if length > 0.0:
            ridge = weights.ridge(r.step_s, stroke.onset_uncertainty_s)
            parts.append((inside, z, (1.0 - np.sqrt(ridge / (length + ridge))) / length))

    def apply(values: np.ndarray) -> np.ndarray:
        out = values.copy()
        for inside, z, share in parts:
            out[inside] -= share * np.outer(z, z @ values[inside])
        return out

    return apply


def _own_starts(r: Prepared, columns: np.ndarray, owner: np.ndarray, offset: int) -> np.ndarray:
    """Return what starts that are all late by the same share of their own uncertainty would add.

    How a motion begins before the sensor shows it is extrapolated; a wrong extrapolation is one that is wrong by a
    share of what it extrapolates over.
    """
    uncertainty = np.array([0.0, *(s.onset_uncertainty_s for s in r.strokes)])
    return columns[:, -2] * uncertainty[np.where(owner >= 0, owner - offset + 1, 0)]


def _scaled(basis: np.ndarray) -> np.ndarray:
    length = np.linalg.norm(basis, axis=0)
    return basis[:, length > 0] / length[length > 0]
