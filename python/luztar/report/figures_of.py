"""Which figures a report shows, as plain JSON values."""

from __future__ import annotations

import json
from typing import TYPE_CHECKING, Any

from . import figures
from .style import FONT, INK

if TYPE_CHECKING:
    from ..diagnosis.study import Study
    from ..tb038.check import Check


def figures_of(study: Study | None, check: Check | None) -> dict[str, Any]:
    """Return every figure of a report, keyed by its place in the page.

    Parameters
    ----------
    study : Study or None
    check : Check or None
    """
    made: dict[str, Any] = {}
    if study is not None:
        last = study.steps[-1].fit
        made["ladder"] = figures.ladder(study)
        made["loops"] = figures.loops_before_after(study)
        made["where"] = figures.where_before_after(study)
        if study.first.candidates:
            made["candidates-first"] = figures.candidates(study.first)
        if len(study.looks) > 1 and study.last.candidates:
            made["candidates-last"] = figures.candidates(study.last)
        made["parameters"] = figures.parameters(last)
        made["residual"] = figures.residual_time(last)
    out = {key: values(figure) for key, figure in made.items()}
    if check is not None:
        out["tb038"] = _of_check(check)
    return out


def values(figure: Any) -> dict[str, Any]:
    """Return a plotly figure as JSON values; numbers that are not finite are null."""
    # plotly's own encoder knows its arrays; what it writes is plain JSON.
    made = json.loads(figure.to_json())
    return {"data": made["data"], "layout": made["layout"]}


def _of_check(check: Check) -> dict[str, Any]:
    made = values(check.figure())
    made["layout"].pop("template", None)
    made["layout"] |= {
        "template": "none",
        "height": 560,
        "font": {"family": FONT, "size": 12, "color": INK},
        "title": None,
        "paper_bgcolor": "white",
        "plot_bgcolor": "white",
        "margin": {"l": 60, "r": 20, "t": 20, "b": 50},
        "legend": {"orientation": "h", "y": -0.14},
    }
    return made
