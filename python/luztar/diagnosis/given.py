"""The arguments of a fit or a study, as users give them."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING, Any

from ..errors import ParameterError
from ..model import Model

if TYPE_CHECKING:
    from ..measurement import Run
    from .fit import Fit


def given_model(model: Any) -> Model:
    """Return the model, or say what was given in its place.

    Raises
    ------
    ParameterError
    """
    if not isinstance(model, Model):
        remedy = "The model comes first, then the runs: luztar.fit(luztar.Model.rig(), runs)."
        raise ParameterError(f"{type(model).__name__} is not a Model", "model", remedy)
    return model


def given_runs(name: str, runs: Run | Iterable[Run]) -> list[Run]:
    """Return the runs as a list: one alone is a list of one.

    Raises
    ------
    ParameterError
    """
    from ..measurement import Run

    given = [runs] if isinstance(runs, Run) else list(runs) if isinstance(runs, Iterable) else [runs]
    for run in given:
        if not isinstance(run, Run):
            remedy = "Give luztar.Run objects, or files through luztar.read(...)."
            raise ParameterError(f"{type(run).__name__} is not a Run", name, remedy)
    return given


def given_fit(what: str, fitted: Any) -> Fit:
    """Return the fit, or say how one is made.

    Raises
    ------
    ParameterError
    """
    from .fit import Fit

    if not isinstance(fitted, Fit):
        remedy = f"Call luztar.{what}(luztar.fit(model, runs))."
        raise ParameterError(f"{type(fitted).__name__} is not a Fit", "fitted", remedy)
    return fitted
