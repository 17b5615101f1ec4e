"""One look at a fitted model: is something missing, and if so, what."""

from __future__ import annotations

import functools
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from .candidates import Candidate, baseline, gain, try_all
from .chance import p_value_floor
from .clipped import require_trustworthy
from .detect import detection
from .experiment import Experiment, next_experiment
from .fit import Fit, predict
from .given import given_fit
from .intervals import Estimate
from .misfit import rms, usable
from .prepare import Prepared
from .profile import plain_coefficients
from .score import Detection
from .verdict import Judgement, folded, judge, shown_rms
from .where import Map, Regime, regimes, residual_map


@dataclass(frozen=True)
class Tried:
    """One candidate as the result shows it.

    Attributes
    ----------
    effect : str
    rms, held_out_rms : float
        Error of the refitted model over the comparison's samples, comparable with ``error``.
    gain : float
        Share of the held-out error (rms) it takes away, with the instant of each start free within the sensor's step:
        what names rest on.
    gain_errors : float
        How many standard errors (paired by stroke) the fall of the loss is.
    p_value : float or None
        Adjusted over all candidates.
    in_set, decoy : bool
    same_as : str or None
        The simpler effect it came out as.
    parameters : dict of str to float
        Best values of its parameters.
    """

    effect: str
    rms: float
    held_out_rms: float
    gain: float
    gain_errors: float
    p_value: float | None
    in_set: bool
    decoy: bool
    same_as: str | None
    parameters: dict[str, float]

    def to_dict(self) -> dict[str, Any]:
        """Return the candidate as the JSON interface prints it."""
        return {
            "effect": self.effect,
            "rms": self.rms,
            "held_out_rms": self.held_out_rms,
            "p_value": self.p_value,
            "in_set": self.in_set,
            "decoy": self.decoy,
            "same_as": self.same_as,
            "parameters": self.parameters,
            "gain": self.gain,
            "gain_errors": self.gain_errors,
        }


@dataclass(frozen=True)
class Diagnosis:
    """What ``luztar.diagnose`` returns.

    Attributes
    ----------
    fit : Fit
        The model looked at.
    judgement : Judgement
    where : tuple of Regime
    map : Map
    candidates : tuple of Tried
        By held-out error, decoys among them.
    detection : Detection
    found : tuple of Candidate
        The candidates with their states.
    unseen_rms : float
        The held-out error without any of the candidates, as they meet it.
    """

    fit: Fit
    judgement: Judgement
    where: tuple[Regime, ...]
    map: Map = field(repr=False)
    candidates: tuple[Tried, ...]
    detection: Detection
    found: tuple[Candidate, ...] = field(repr=False, default=())
    unseen_rms: float = 0.0

    @property
    def verdict(self) -> str:
        """The verdict's word."""
        return self.judgement.verdict

    @property
    def named(self) -> tuple[str, ...]:
        """The effect named, or the set under ``one_of``."""
        return self.judgement.named

    @functools.cached_property
    def next_experiment(self) -> Experiment | None:
        """The test that would tell apart what this measurement could not; simulated when it is first asked for."""
        return next_experiment(self.fit.whitened, self.judgement, self.found)

    @property
    def parameters(self) -> dict[str, Estimate]:
        """The fitted model's parameters."""
        return self.fit.parameters

    def to_dict(self) -> dict[str, Any]:
        """Return the diagnosis as the JSON interface prints it."""
        fit = self.fit
        return {
            "schema": 1,
            "structure": fit.model.structure_name,
            "effects": list(fit.model.effects),
            "band_hz": fit.model.band_hz,
            "verdict": self.verdict,
            "named": list(self.named),
            "why": self.judgement.why,
            "noise_floor": fit.noise_floor.to_dict(),
            "error": fit.error.to_dict(),
            "parameters": {k: v.to_dict() for k, v in fit.parameters.items()},
            "flags": [f.to_dict() for f in fit.flags],
            "where": [r.to_dict() for r in self.where],
            "candidates": [c.to_dict() for c in self.candidates],
            "lack_of_fit": {"p_value": self.detection.lack_of_fit, "along": self.detection.along},
            "p_value": self.detection.p_value,
            "p_value_floor": p_value_floor(self.detection.strokes),
            "strokes": self.detection.strokes,
            "next_experiment": self.next_experiment.to_dict() if self.next_experiment else None,
        }

    def __str__(self) -> str:
        from .words import diagnosis_text

        return diagnosis_text(self)

    __repr__ = __str__

    def _repr_html_(self) -> str:
        from html import escape

        return f"<pre>{escape(str(self))}</pre>"

    def figure(self) -> Any:
        """Return a plotly figure: the candidates' held-out error, decoys beside them."""
        from ..report.figures import candidates

        return candidates(self)


def diagnose(fitted: Fit, *, explained: float = 0.0, progress: Callable[[int, int], None] | None = None) -> Diagnosis:
    """Look once at a fitted model: test whether something is missing and try every effect of the catalogue.

    Parameters
    ----------
    fitted : Fit
        From ``luztar.fit``. Held-out runs given there are only predicted: they decide nothing here.
    explained : float
        The held-out sum of squares that effects added before have taken off: what their laws may have left of it is no
        evidence for another one.
    progress : callable, optional
        Called with (done, total).

    Raises
    ------
    DoubtfulError
        The effort of a run is clipped in more than a thousandth of the samples compared.
    """
    fitted = given_fit("diagnose", fitted)
    if fitted.model.structure.is_free:
        from ..freerun import FreeFit
        from ..freerun import diagnose as diagnose_free

        assert isinstance(fitted, FreeFit)
        return diagnose_free(fitted, progress=progress)
    require_trustworthy(fitted.runs)
    white = fitted.whitened
    found, features = try_all(white, progress)
    before = baseline(white).losses
    gains = np.column_stack([before - c.search.losses for c in found]) if found else None
    simpler = folded(white, found)
    # In the reversal zones the extrapolated starts are never quite right. A candidate that is no more than that comes
    # out as a simpler one: it cannot be named, and what it finds there is not held against the model.
    telling = [f for f in features if not (f.inside_zones and f.name in simpler)]
    tested = detection(white, telling, gains)
    judged = judge(white, found, tested, simpler, explained)
    return Diagnosis(
        fit=fitted,
        judgement=judged,
        where=regimes(fitted),
        map=residual_map(fitted),
        candidates=tuple(_tried(white, c, judged, tested) for c in found),
        detection=tested,
        found=tuple(found),
        unseen_rms=shown_rms(white, baseline(white)),
    )


def _tried(fitted: Fit, c: Candidate, judged: Judgement, tested: Detection) -> Tried:
    state = c.search.best
    assert state is not None
    runs = fitted.runs
    coefficients = plain_coefficients(fitted.problem, state)
    modelled = [predict(r, m, coefficients) for r, m in zip(runs, state.made.matrix, strict=True)]
    share, errors = gain(baseline(fitted), c.search)
    return Tried(
        effect=c.name,
        rms=_rms(runs, modelled),
        held_out_rms=shown_rms(fitted, c.search),
        gain=share,
        gain_errors=errors,
        p_value=tested.candidates.get(c.name),
        in_set=c.name in judged.equivalent,
        decoy=c.card.is_decoy,
        same_as=judged.folded.get(c.name),
        parameters=values_of(fitted, c),
    )


def _rms(runs: Sequence[Prepared], predicted: Sequence[np.ndarray]) -> float:
    return rms(usable(runs, [r.effort - p for r, p in zip(runs, predicted, strict=True)]))


def values_of(fitted: Fit, c: Candidate) -> dict[str, float]:
    """Return the best values of a candidate's own parameters."""
    from .values import effect_values

    assert c.search.best is not None
    return effect_values(fitted.problem, c.search.best, c.name)
