"""The picture of a plan: how well each effect can imitate each other one."""

from __future__ import annotations

import os
from typing import TYPE_CHECKING, Any

from ..model import card

if TYPE_CHECKING:
    from .plan import Plan

# White: they have nothing in common. Dark: one can stand in for the other.
SCALE = [[0.0, "#FFFFFF"], [0.5, "#C6DBEF"], [0.9, "#4292C6"], [0.95, "#08519C"], [1.0, "#7F0000"]]


def cosines(plan: Plan) -> Any:
    """Return the heat map of cosines; dark red cells are pairs that the test cannot tell apart.

    Parameters
    ----------
    plan : Plan
    """
    from ..report.style import dressed, numbers, plain, plotly

    structure = plan.model.structure_name
    names = [plain(card(n, structure).title) for n in plan.effects]
    picture = plotly().Figure()
    picture.add_heatmap(
        x=names,
        y=names,
        z=[numbers(row) for row in plan.cosines],
        zmin=0.0,
        zmax=1.0,
        colorscale=SCALE,
        xgap=1,
        ygap=1,
        colorbar={"title": {"text": "cosine"}, "thickness": 14},
        hovertemplate="%{y}<br>imitated by %{x}: %{z:.3f}<extra></extra>",
    )
    made = dressed(picture, height=220 + 22 * len(names), title=plain(f"What this test can confuse: {plan.test}"))
    made.update_xaxes(tickangle=-60, showgrid=False, zeroline=False, title_text="imitated by")
    made.update_yaxes(autorange="reversed", showgrid=False, zeroline=False)
    return made


def write(path: str | os.PathLike[str], plan: Plan) -> None:
    """Write a plan as one HTML file: the table in words, then the picture.

    Parameters
    ----------
    path : path
        An existing file is replaced.
    plan : Plan
    """
    from ..report.leaf import write_leaf

    write_leaf(path, "Plan of a test", str(plan), plan.figure(), "This figure is drawn by the browser.")
