"""From candidates and tests to a verdict: what may be named, what may only be offered, what must be left open."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from .candidates import (
    PRACTICAL_GAIN,
    SET_ERRORS,
    Candidate,
    as_good_as_a_law,
    baseline,
    beyond_the_law,
    equivalent,
    gain,
)
from .chance import p_value_floor
from .equations import start_uncertainty_s
from .fit import Fit, predict, predict_folds
from .grids import points, word
from .misfit import rms, usable
from .profile import plain, plain_coefficients
from .score import Detection
from .search import Search
from .values import effect_values

# One level over all tests of a look.
ALPHA = 0.05
# Fewer strokes than this say nothing about chance; up to MANY_STROKES a name needs a gain in every fold.
FEWEST_STROKES = 6
MANY_STROKES = 10
# With few strokes the best of the catalogue takes up to 4 % off the unseen error by chance alone, in every fold.
GAIN_WITH_FEW = 0.05
# A rest that repeats but is this close to the noise floor is no failure of the model.
ABOVE_FLOOR = 1.1
# More than this many candidates that cannot be told apart are no answer.
LARGEST_SET = 3

VERDICTS = (
    "nothing_missing",
    "named",
    "one_of",
    "unexplained",
    "too_few_strokes",
    "below_practical_size",
)


@dataclass(frozen=True)
class Judgement:
    """The verdict of one look.

    Attributes
    ----------
    verdict : str
        One of :data:`VERDICTS`.
    named : tuple of str
        The best candidate, or the whole set under ``one_of``.
    equivalent : tuple of str
        Candidates the data cannot tell from the best, the best first.
    folded : dict of str to str
        Candidates that came out as a simpler one.
    why : str
    """

    verdict: str
    named: tuple[str, ...]
    equivalent: tuple[str, ...]
    folded: dict[str, str]
    why: str


def folded(fitted: Fit, found: Sequence[Candidate]) -> dict[str, str]:
    """Return the candidates whose best values make them a simpler effect, with that effect's name."""
    out = {}
    for c in found:
        state = c.search.best
        simpler = c.card.becomes
        if state is None or not simpler:
            continue
        inside = c.card.inner
        if not inside:
            # The same while moving, whatever its value.
            if simpler in fitted.model.effects or any(o.name == simpler for o in found):
                out[c.name] = simpler
            continue
        value = state.terms.inner[c.name][0]
        if word(inside[0]) == "delay":
            # Less than the starts are uncertain by is what the sensor does to them, unless it shows elsewhere as well.
            least = 0.0 if _shows_away_from_reversals(fitted, c) else start_uncertainty_s(fitted.runs)
        else:
            # Half above the smallest value: the search stops there, its least lies at or below it.
            least = 1.5 * float(points(inside[0], fitted.runs)[0])
        if value < least:
            out[c.name] = simpler
    return out


def _shows_away_from_reversals(fitted: Fit, c: Candidate) -> bool:
    """Whether a candidate takes the practical size off the error where the motion is under way."""
    state = c.search.best
    assert state is not None

    moving = [r.usable & ~r.zone for r in fitted.runs]
    coefficients = plain_coefficients(fitted.problem, state)
    modelled = [predict(r, m, coefficients) for r, m in zip(fitted.runs, state.made.matrix, strict=True)]
    with_it = [r.effort - p for r, p in zip(fitted.runs, modelled, strict=True)]
    return rms(_chosen(with_it, moving)) <= (1.0 - PRACTICAL_GAIN) * rms(_chosen(fitted.residual, moving))


def admissible(fitted: Fit, c: Candidate) -> bool:
    """Whether a candidate's best values are inside its card's bounds: a negative inertia explains nothing."""
    if c.search.best is None:
        return False
    values = effect_values(fitted.problem, c.search.best, c.name)
    return all(p.low <= values[p.key] <= p.high for p in c.card.parameters if p.role == "linear")


def judge(
    fitted: Fit, found: Sequence[Candidate], detection: Detection, simpler: dict[str, str], explained: float = 0.0
) -> Judgement:
    """Decide what a look at the candidates allows to say.

    Parameters
    ----------
    fitted : Fit
    found : sequence of Candidate
        The best first.
    detection : Detection
    simpler : dict of str to str
        The :func:`folded` ones.
    explained : float
        The held-out sum of squares that effects added before have taken off.
    """
    rivals = [c for c in found if c.name not in simpler and admissible(fitted, c)]
    strokes = detection.strokes
    if strokes < FEWEST_STROKES:
        return Judgement("too_few_strokes", (), (), simpler, f"{strokes} strokes; at least {FEWEST_STROKES} are needed")
    same = equivalent(rivals)
    names = tuple(c.name for c in same)
    best = rivals[0] if rivals else None
    share, errors = gain(baseline(fitted), best.search) if best else (0.0, 0.0)
    few = strokes < MANY_STROKES
    # The p-value of few strokes cannot fall far enough: the gain has to do, in every fold and by more than chance.
    detected = few or detection.p_value <= ALPHA
    worth = best is not None and share >= (GAIN_WITH_FEW if few else PRACTICAL_GAIN) and errors >= SET_ERRORS
    if few and best is not None:
        worth = worth and worth_with_few(fitted, best, rivals)
    worth = worth and best is not None and beyond_the_law(baseline(fitted), best.search, explained)
    worth = worth and best is not None and shows(fitted, baseline(fitted), best.search)
    if not detected:
        return Judgement("nothing_missing", (), names, simpler, f"no test rejects at {100 * ALPHA:g} %")
    if worth and best is not None:
        if best.card.is_decoy:
            return Judgement("unexplained", (), names, simpler, "a decoy without physics explains it best")
        # With few strokes a standard error says little: a rival counts if it, too, gains in every fold.
        rest = [c for c in same if not few or worth_with_few(fitted, c, rivals)]
        real = tuple(c.name for c in rest if not c.card.is_decoy)
        # Where the numbers tell them apart by less than a law is good for, the set takes them in as far as it may.
        close = [c.name for c in as_good_as_a_law(rivals, baseline(fitted)) if not c.card.is_decoy]
        wider = (*real, *(n for n in close if n not in real))
        if len(wider) <= LARGEST_SET:
            real = wider
            names = (*names, *(n for n in real if n not in names))
        if len(real) == 1:
            return Judgement("named", real, names, simpler, "")
        if len(real) <= LARGEST_SET:
            return Judgement("one_of", real, names, simpler, "the data do not tell these apart")
        many = f"{len(real)} effects explain it equally well: this test cannot tell"
        unexplained = detection.lack_of_fit <= ALPHA and not few
        return Judgement("unexplained" if unexplained else "below_practical_size", (), names, simpler, many)
    # The floor takes a line of the spectrum for noise; without it the error would be so much nearer to the noise.
    line = detection.along == "spectrum" and detection.line_share > 1.0 - 1.0 / ABOVE_FLOOR**2
    above = fitted.error.floor_ratio > ABOVE_FLOOR or line
    if detection.lack_of_fit <= ALPHA and above and not few:
        return Judgement("unexplained", (), names, simpler, "something repeats that no effect of the catalogue removes")
    if few and not worth:
        why = f"{strokes} strokes can give no p-value below {p_value_floor(strokes):.2g}"
        return Judgement("nothing_missing", (), names, simpler, f"no effect gains in every fold; {why}")
    return Judgement(
        "below_practical_size", (), names, simpler, f"no effect takes {100 * PRACTICAL_GAIN:g} % off the unseen error"
    )


def shown_rms(fitted: Fit, search: Search) -> float:
    """Return the unseen error of a search's states as it is shown: that of plain least squares."""
    return rms(usable(fitted.runs, _unseen_residual(fitted, search)))


def shows(fitted: Fit, before: Search, after: Search) -> bool:
    """Whether the unseen error as it is shown falls from one search to another: a step that nobody sees is none.

    It falls over all samples; or it falls where the motion is under way and hardly rises in all: what is shown knows
    nothing of the uncertain instants of the starts, and a model with sharper corners, though nearer to the truth, pays
    more for them.
    """
    was, now = (_unseen_residual(fitted, s) for s in (before, after))
    rise = rms(usable(fitted.runs, now)) / max(rms(usable(fitted.runs, was)), np.finfo(float).tiny)
    if rise < 1.0 or rise > ABOVE_FLOOR:
        return rise < 1.0
    moving = [r.usable & ~r.zone for r in fitted.runs]
    return rms(_chosen(now, moving)) < rms(_chosen(was, moving))


def _unseen_residual(fitted: Fit, search: Search) -> list[np.ndarray]:
    unseen = predict_folds(plain(fitted.problem), search)
    return [r.effort - p for r, p in zip(fitted.runs, unseen, strict=True)]


def _chosen(values: Sequence[np.ndarray], chosen: Sequence[np.ndarray]) -> np.ndarray:
    return np.concatenate([v[c] for v, c in zip(values, chosen, strict=True)])


def worth_with_few(fitted: Fit, best: Candidate, rivals: Sequence[Candidate]) -> bool:
    """Whether a candidate gains in every fold above the practical size and above the best decoy."""
    folds, before_all = fitted.search.folds, baseline(fitted).losses
    decoys = [c for c in rivals if c.card.is_decoy]
    for k in range(folds.count):
        inside = folds.of_stroke == k
        before = float(before_all[inside].sum())
        after = float(best.search.losses[inside].sum())
        # Losses are squares: 1 % of the error is 2 % of them.
        if after > (1.0 - PRACTICAL_GAIN) ** 2 * before:
            return False
        if any(float(d.search.losses[inside].sum()) < after for d in decoys):
            return False
    return folds.count > 1
