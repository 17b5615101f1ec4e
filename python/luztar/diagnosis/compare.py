"""Comparing a model with measurements: how large the error is against the noise floor, and where it is."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

from .detect import lack_of_fit
from .fit import Fit
from .given import given_fit
from .score import Detection
from .where import Map, Regime, regimes, residual_map


@dataclass(frozen=True)
class Comparison:
    """What ``luztar.compare`` returns.

    Attributes
    ----------
    fit : Fit
    where : tuple of Regime
    map : Map
    detection : Detection
        The tests for lack of fit.
    """

    fit: Fit
    where: tuple[Regime, ...]
    map: Map = field(repr=False)
    detection: Detection

    def to_dict(self) -> dict[str, Any]:
        """Return the comparison as the JSON interface prints it."""
        return {
            **self.fit.to_dict(),
            "where": [r.to_dict() for r in self.where],
            "lack_of_fit": {"p_value": self.detection.lack_of_fit, "along": self.detection.along},
        }

    def __str__(self) -> str:
        from .words import comparison_text

        return comparison_text(self)

    __repr__ = __str__

    def _repr_html_(self) -> str:
        from html import escape

        return f"<pre>{escape(str(self))}</pre>"

    def figure(self) -> Any:
        """Return a plotly figure: the mean residual over position, speed and direction."""
        from ..report.figures import where_map

        return where_map(self)


def compare(fitted: Fit) -> Comparison:
    """Say how far a fitted model is from the measurement and where.

    Parameters
    ----------
    fitted : Fit
        From ``luztar.fit``.
    """
    fitted = given_fit("compare", fitted)
    if fitted.model.structure.is_free:
        from ..freerun import FreeFit
        from ..freerun import compare as compare_free

        assert isinstance(fitted, FreeFit)
        return compare_free(fitted)
    return Comparison(fitted, regimes(fitted), residual_map(fitted), lack_of_fit(fitted))
