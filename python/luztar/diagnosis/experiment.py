"""What to measure next where the data do not decide.

Candidate tests are simulated with the fitted effects and ranked by how well they tell them apart per minute: see
``luztar.planning``, which is loaded when it is needed.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from ..errors import MeasurementError
from ..model import card
from .fit import Fit
from .profile import State
from .verdict import Judgement

if TYPE_CHECKING:
    from ..planning.advise import Advice
    from .candidates import Candidate


@dataclass(frozen=True)
class Experiment:
    """A test that would separate effects.

    Attributes
    ----------
    text : str
        What to do, in the words of the workshop.
    separates : tuple of str
    advice : Advice or None
        The tests that were simulated, with what each would tell.
    """

    text: str
    separates: tuple[str, ...]
    advice: Advice | None = None

    def to_dict(self) -> dict[str, Any]:
        """Return the experiment as the JSON interface prints it."""
        return {"text": self.text, "separates": list(self.separates)}


def next_experiment(fitted: Fit, judged: Judgement, found: Sequence[Candidate] = ()) -> Experiment | None:
    """Return the test to do after a look; None where there is nothing to tell apart.

    Parameters
    ----------
    fitted : Fit
        The model looked at.
    judged : Judgement
    found : sequence of Candidate
        What was tried on top of it.
    """
    if judged.verdict == "too_few_strokes":
        reach = "from beyond one end to beyond the other" if _is_rig(fitted) else "over the whole range"
        return Experiment(f"Record three runs of at least six strokes each, {reach}.", ())
    if not judged.named:
        return None
    name = judged.named[0]
    best = next((c.search.best for c in found if c.name == name), None)
    if best is None:
        return experiment_for(fitted, judged.named)
    rivals = judged.named[1:]
    return _experiment(fitted, best, name, rivals or _alike(fitted, name, judged, found), alone=not rivals)


def experiment_for(fitted: Fit, named: tuple[str, ...]) -> Experiment | None:
    """Return the test that would tell the effects of a set apart, or confirm one that looks like another.

    Parameters
    ----------
    fitted : Fit
        Of a model that holds the first of them.
    named : tuple of str
        The set, the effect in the model first.
    """
    if not named or named[0] not in fitted.model.effects:
        return None
    name = named[0]
    if len(named) > 1:
        return _experiment(fitted, fitted.state, name, named[1:], alone=False)
    from ..planning.advise import lookalikes

    return _experiment(fitted, fitted.state, name, lookalikes(fitted, fitted.state, name), alone=True)


def _alike(fitted: Fit, name: str, judged: Judgement, found: Sequence[Candidate]) -> tuple[str, ...]:
    """Return the candidates that take nearly the same off the error as the best.

    The share they take of what it takes is the square of the cosine between them.
    """
    from ..planning.advise import ALIKE

    losses = {c.name: c.search.loss for c in found if not c.card.is_decoy and c.name not in judged.folded}
    taken = fitted.state.loss - losses[name]
    if taken <= 0.0:
        return ()
    shares = {n: (fitted.state.loss - loss) / taken for n, loss in losses.items() if n != name}
    near = [n for n, share in shares.items() if share > ALIKE**2]
    return tuple(sorted(near, key=lambda n: -shares[n]))


def _experiment(fitted: Fit, state: State, name: str, rivals: Sequence[str], *, alone: bool) -> Experiment | None:
    if not rivals:
        return None
    from ..planning.advise import SETTLED, TOLD_APART, advice

    structure = fitted.model.structure_name
    try:
        found = advice(fitted, state, name, rivals)
    except MeasurementError:
        # A test that cannot be simulated at this rate and band is no advice; the look itself stands.
        return None
    if found is None:
        titles = " from ".join(card(n, structure).title for n in (name, rivals[0]))
        return Experiment(f"Repeat the strokes under two clearly different loads, to tell {titles}.", (name, *rivals))
    if alone and (found.now > SETTLED or (not found.better and found.now >= TOLD_APART)):
        # Nothing is open that another test would tell better than the strokes recorded.
        return None
    return Experiment(found.text(structure), (name, *found.rivals), found)


def _is_rig(fitted: Fit) -> bool:
    return fitted.model.structure_name == "rig"
