"""Where a model fails: the mean residual over position, speed and direction."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from .style import dressed, motion_axis, numbers, panels

if TYPE_CHECKING:
    from ..diagnosis.compare import Comparison
    from ..diagnosis.diagnose import Diagnosis
    from ..diagnosis.study import Study

# Blue: the model is too high. White: it agrees. Red: it is too low. Read by the colour blind, too.
SCALE = [[0.0, "#2166AC"], [0.25, "#92C5DE"], [0.5, "#F7F7F7"], [0.75, "#F4A582"], [1.0, "#B2182B"]]


def where_map(comparison: Comparison | Diagnosis) -> Any:
    """Return the mean residual of a comparison (or a look) as two heat maps, one per direction.

    Parameters
    ----------
    comparison : Comparison or Diagnosis
    """
    return _maps([(comparison, "")])


def where_before_after(study: Study) -> Any:
    """Return the maps of the first and the last look with one colour scale.

    Parameters
    ----------
    study : Study
    """
    if len(study.steps) == 1:
        return _maps([(study.first, "")])
    return _maps([(study.first, "as given: "), (study.last, "after the last step: ")])


def _maps(looks: list[tuple[Comparison | Diagnosis, str]]) -> Any:
    structure = looks[0][0].fit.model.structure
    factor, motion, unit = motion_axis(structure)
    titles = [f"{word}{motion} {way}" for _, word in looks for way in ("increasing", "decreasing")]
    picture = panels(
        rows=len(looks),
        cols=2,
        subplot_titles=titles,
        shared_xaxes=True,
        shared_yaxes=True,
        horizontal_spacing=0.05,
        vertical_spacing=0.14,
    )
    limit = 0.0
    for row, (look, _) in enumerate(looks, start=1):
        for column, cells in enumerate((look.map.increasing, look.map.decreasing), start=1):
            filled = np.abs(cells[np.isfinite(cells)])
            limit = max(limit, float(filled.max(initial=0.0)))
            picture.add_heatmap(
                x=numbers(look.map.position * factor),
                y=numbers(look.map.speed * factor),
                z=[numbers(line) for line in cells],
                coloraxis="coloraxis",
                hoverongaps=False,
                xgap=1,
                ygap=1,
                hovertemplate=f"%{{x:.4g}} {unit}, %{{y:.3g}} {unit}/s: %{{z:.3g}} {structure.effort_unit}<extra></extra>",
                row=row,
                col=column,
            )
    picture.update_xaxes(title_text=f"{motion} [{unit}]", row=len(looks))
    picture.update_yaxes(title_text=f"speed [{unit}/s]", col=1)
    bar = {"title": {"text": f"measured less<br>modelled [{structure.effort_unit}]"}, "thickness": 14}
    scale = {"colorscale": SCALE, "cmin": -(limit or 1.0), "cmax": limit or 1.0, "colorbar": bar}
    return dressed(picture, height=80 + 230 * len(looks), coloraxis=scale)
