"""Curves of a fit: measured and modelled loops, and the residual over time."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from .downsample import MAX_POINTS, extremes
from .style import AFTER, BEFORE, MEASURED, RUNS, dressed, motion_axis, numbers, panels, plain, plotly

if TYPE_CHECKING:
    from ..diagnosis.fit import Fit
    from ..diagnosis.study import Study

# Points of all curves of one figure together: a report with ten of them stays below 3 MB.
FIGURE_POINTS = 16000
# More panels than this do not fit a page; the others are left to the numbers.
MOST_PANELS = 12
PANEL_HEIGHT = 150


def loops(fit: Fit) -> Any:
    """Return measured and modelled torque (or force) over the motion, a curve per run.

    Parameters
    ----------
    fit : Fit
    """
    picture = plotly().Figure()
    for trace in _loop_traces(fit, AFTER, "model", _budget(2 * len(fit.runs))):
        picture.add_trace(trace)
    _, motion, unit = motion_axis(fit.model.structure)
    picture.update_xaxes(title_text=f"{motion} [{unit}]")
    picture.update_yaxes(title_text=_effort(fit))
    return dressed(picture, height=480, title="Measured and modelled loops")


def loops_before_after(study: Study) -> Any:
    """Return the loops of the model as given and of the model after the last step, side by side.

    Parameters
    ----------
    study : Study
    """
    first, last = study.steps[0].fit, study.steps[-1].fit
    added = len(study.steps) > 1
    titles = ["model as given", f"after step {len(study.steps) - 1}"] if added else ["model as given"]
    picture = panels(rows=1, cols=len(titles), subplot_titles=titles, shared_yaxes=True, horizontal_spacing=0.04)
    for column, fit in enumerate([first, last][: len(titles)], start=1):
        colour = BEFORE if column == 1 and added else AFTER
        words = ("model as given" if added else "model") if column == 1 else "model after the last step"
        for trace in _loop_traces(fit, colour, words, _budget(4 * len(fit.runs))):
            # The measurement is the same on both sides: one entry in the legend switches both.
            trace.showlegend = bool(trace.showlegend) and (column == 1 or trace.legendgroup != "measured")
            picture.add_trace(trace, row=1, col=column)
    _, motion, unit = motion_axis(first.model.structure)
    picture.update_xaxes(title_text=f"{motion} [{unit}]")
    picture.update_yaxes(title_text=_effort(first), col=1)
    return dressed(picture, height=440)


def residual_time(fit: Fit) -> Any:
    """Return the residual over time, a panel per run, with the strokes behind it.

    Parameters
    ----------
    fit : Fit
    """
    shown = list(zip(fit.runs, fit.residual, strict=True))[:MOST_PANELS]
    picture = panels(
        rows=len(shown), cols=1, subplot_titles=[plain(r.name) for r, _ in shown], vertical_spacing=0.3 / len(shown)
    )
    limit = max(float(np.abs(e[r.usable]).max(initial=0.0)) for r, e in shown) or 1.0
    for row, (r, error) in enumerate(shown, start=1):
        for s in r.strokes:
            if s.direction > 0:
                edges = {"x0": float(r.time_s[s.onset]), "x1": float(r.time_s[s.last - 1])}
                picture.add_vrect(**edges, fillcolor="#E8F0F8", line_width=0, layer="below", row=row, col=1)
        values = np.where(r.usable, error, np.nan)
        at = extremes(values, points=_budget(len(shown)))
        picture.add_scatter(
            x=numbers(r.time_s[at]),
            y=numbers(values[at]),
            mode="lines",
            line={"color": RUNS[(row - 1) % len(RUNS)], "width": 1},
            name=plain(r.name),
            showlegend=False,
            row=row,
            col=1,
        )
    picture.update_yaxes(range=[-1.05 * limit, 1.05 * limit], title_text=fit.noise_floor.unit)
    picture.update_xaxes(title_text="time [s]", row=len(shown), col=1)
    return dressed(picture, height=80 + PANEL_HEIGHT * len(shown))


def _loop_traces(fit: Fit, colour: str, words: str, points: int) -> list[Any]:
    go = plotly()
    factor, _, _ = motion_axis(fit.model.structure)
    measured, modelled = [], []
    for number, (r, predicted) in enumerate(zip(fit.runs, fit.predicted, strict=True)):
        x = r.motion[r.usable] * factor
        for values, into, name, line in (
            (r.effort, measured, "measured", {"color": MEASURED, "width": 2}),
            (predicted, modelled, words, {"color": colour, "width": 1.2}),
        ):
            y = values[r.usable]
            at = extremes(x, y, points=points)
            trace = go.Scatter(
                x=numbers(x[at]),
                y=numbers(y[at]),
                mode="lines",
                line=line,
                name=name,
                legendgroup=name,
                showlegend=number == 0,
                hovertext=plain(r.name),
                hoverinfo="x+y+text",
            )
            into.append(trace)
    return [*measured, *modelled]


def _budget(traces: int) -> int:
    return max(min(MAX_POINTS, FIGURE_POINTS // max(traces, 1)), 200)


def _effort(fit: Fit) -> str:
    structure = fit.model.structure
    return f"{structure.effort} [{structure.effort_unit}]"
