"""From candidates and tests to a verdict, by the rules of driven fits."""

from __future__ import annotations

from collections.abc import Sequence

from ..diagnosis.candidates import PRACTICAL_GAIN, SET_ERRORS
from ..diagnosis.score import Detection
from ..diagnosis.verdict import ABOVE_FLOOR, ALPHA, FEWEST_STROKES, LARGEST_SET, Judgement
from .candidates import Candidate, gain, paired
from .fit import FreeFit


def judge(fitted: FreeFit, found: Sequence[Candidate], tested: Detection) -> Judgement:
    """Decide what a look at the candidates allows to say."""
    simpler = {c.name: c.same_as for c in found if c.same_as is not None}
    names = {c.name for c in found} | set(fitted.model.effects)
    # What came out as a simpler effect is not counted, if that one competes itself.
    rivals = [c for c in found if simpler.get(c.name) not in names]
    folded = {k: v for k, v in simpler.items() if v in names}
    if tested.strokes < FEWEST_STROKES:
        why = f"{tested.strokes} strokes; at least {FEWEST_STROKES} are needed"
        return Judgement("too_few_strokes", (), (), folded, why)
    same = equivalent(rivals)
    equal = tuple(c.name for c in same)
    share, errors = gain(fitted.solution, rivals[0].solution) if rivals else (0.0, 0.0)
    if tested.p_value > ALPHA:
        return Judgement("nothing_missing", (), equal, folded, f"no test rejects at {100 * ALPHA:g} %")
    if share >= PRACTICAL_GAIN and errors >= SET_ERRORS:
        if len(equal) == 1:
            return Judgement("named", equal, equal, folded, "")
        if len(equal) <= LARGEST_SET:
            return Judgement("one_of", equal, equal, folded, "the data do not tell these apart")
        many = f"{len(equal)} effects explain it equally well: this test cannot tell"
        lacking = tested.lack_of_fit <= ALPHA
        return Judgement("unexplained" if lacking else "below_practical_size", (), equal, folded, many)
    if tested.lack_of_fit <= ALPHA and fitted.error.floor_ratio > ABOVE_FLOOR:
        why = "something repeats that no effect of the catalogue removes"
        return Judgement("unexplained", (), equal, folded, why)
    why = f"no effect takes {100 * PRACTICAL_GAIN:g} % off the unseen error"
    return Judgement("below_practical_size", (), equal, folded, why)


def equivalent(rivals: Sequence[Candidate]) -> list[Candidate]:
    """Return the candidates whose unseen loss is within two paired standard errors of the best, the best first."""
    if not rivals:
        return []
    best = rivals[0]
    out = [best]
    for c in rivals[1:]:
        behind, error = paired(c.solution, best.solution)
        if behind <= SET_ERRORS * error:
            out.append(c)
    return out
